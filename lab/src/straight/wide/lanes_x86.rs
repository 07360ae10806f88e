//! The wide instructions of x86-64. Measured to pay: AVX2 makes two to three times the speed of the portable lanes, which the compiler
//! makes of SSE2; AVX-512 a further third where sixteen rays descend together.
//!
//! Each type must be used only where its instructions have been detected: [`super::tree::Wide`] chooses it nowhere else. That is what every
//! `SAFETY` here calls "the instructions exist".
#![allow(unsafe_code)]

use std::arch::x86_64::*;

use super::lanes::{Eight, Lanes, Mask, Sixteen, inlined};

/// AVX2 and FMA.
#[derive(Clone, Copy)]
pub(super) struct Avx(__m256);

/// Four columns of eight rows, from `first` ≤ 3.
#[inline(always)]
fn four_columns(rows: &[[f32; 7]; 8], first: usize) -> [Avx; 4] {
    let [a, b, c, d, e, f, g, h] = rows;
    let (p, q, r, s) = (two_rows(a, e, first), two_rows(b, f, first), two_rows(c, g, first), two_rows(d, h, first));
    // SAFETY: the instructions exist, see above.
    unsafe {
        let (pq, rs) = (_mm256_unpacklo_ps(p, q), _mm256_unpacklo_ps(r, s));
        let (pq_high, rs_high) = (_mm256_unpackhi_ps(p, q), _mm256_unpackhi_ps(r, s));
        [
            Avx(_mm256_shuffle_ps::<0x44>(pq, rs)),
            Avx(_mm256_shuffle_ps::<0xee>(pq, rs)),
            Avx(_mm256_shuffle_ps::<0x44>(pq_high, rs_high)),
            Avx(_mm256_shuffle_ps::<0xee>(pq_high, rs_high)),
        ]
    }
}

/// Four numbers of each of two rows, from `first` ≤ 3.
#[inline(always)]
fn two_rows(low: &[f32; 7], high: &[f32; 7], first: usize) -> __m256 {
    let (low, high) = (&low[first..first + 4], &high[first..first + 4]);
    // SAFETY: the instructions exist, see above; the slices hold four numbers each.
    unsafe { _mm256_set_m128(_mm_loadu_ps(high.as_ptr()), _mm_loadu_ps(low.as_ptr())) }
}

/// The least number of each half of four registers: of the lower halves, then of the upper ones.
#[inline(always)]
fn four_leasts(a: __m256, b: __m256, c: __m256, d: __m256) -> __m256 {
    // SAFETY: the instructions exist, see above.
    unsafe {
        let ab = _mm256_min_ps(_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b));
        let cd = _mm256_min_ps(_mm256_unpacklo_ps(c, d), _mm256_unpackhi_ps(c, d));
        _mm256_min_ps(_mm256_shuffle_ps::<0x44>(ab, cd), _mm256_shuffle_ps::<0xee>(ab, cd))
    }
}

// SAFETY (all blocks of this impl): the instructions exist, see above. All bits of a lane are set or none.
impl Mask for Avx {
    inlined! {
        fn and(self, other: Self) -> Self = Avx(unsafe { _mm256_and_ps(self.0, other.0) });
        fn or(self, other: Self) -> Self = Avx(unsafe { _mm256_or_ps(self.0, other.0) });
        fn bits(self) -> u32 = unsafe { _mm256_movemask_ps(self.0) as u32 };
    }
}

// SAFETY (all blocks of this impl): the instructions exist, see above.
impl Eight for Avx {
    #[inline(always)]
    fn columns(rows: &[[f32; 7]; 8]) -> [Self; 7] {
        // Numbers 0 to 3 and 3 to 6 of each row: four at a time, none beyond its end.
        let [a, b, c, _] = four_columns(rows, 0);
        let [d, e, f, g] = four_columns(rows, 3);
        [a, b, c, d, e, f, g]
    }
    #[inline(always)]
    fn last_columns(rows: &[[f32; 7]; 8]) -> [Self; 4] {
        four_columns(rows, 3)
    }
    #[inline(always)]
    fn leasts([a, b, c, d, e, f, g, h]: [Self; 8]) -> Self {
        let (low, high) = (four_leasts(a.0, b.0, c.0, d.0), four_leasts(e.0, f.0, g.0, h.0));
        Avx(unsafe { _mm256_min_ps(_mm256_permute2f128_ps::<0x20>(low, high), _mm256_permute2f128_ps::<0x31>(low, high)) })
    }
    #[inline(always)]
    fn prefetch<T>(soon: &T) {
        let start = std::ptr::from_ref(soon).cast::<i8>();
        for line in (0..size_of::<T>()).step_by(64) {
            // Inside the object that the reference names.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(start.add(line)) };
        }
    }
}

// SAFETY (all blocks of this impl): the instructions exist, see above; loads and stores go through references to eight numbers, unaligned.
impl Lanes for Avx {
    type Mask = Avx;
    type Array = [f32; 8];
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Avx(unsafe { _mm256_set1_ps(value) })
    }
    #[inline(always)]
    fn load(from: &[f32; 8]) -> Self {
        Avx(unsafe { _mm256_loadu_ps(from.as_ptr()) })
    }
    #[inline(always)]
    fn store(self) -> [f32; 8] {
        let mut out = [0.0; 8];
        unsafe { _mm256_storeu_ps(out.as_mut_ptr(), self.0) };
        out
    }
    inlined! {
        fn add(self, other: Self) -> Self = Avx(unsafe { _mm256_add_ps(self.0, other.0) });
        fn sub(self, other: Self) -> Self = Avx(unsafe { _mm256_sub_ps(self.0, other.0) });
        fn mul(self, other: Self) -> Self = Avx(unsafe { _mm256_mul_ps(self.0, other.0) });
        fn div(self, other: Self) -> Self = Avx(unsafe { _mm256_div_ps(self.0, other.0) });
        fn min(self, other: Self) -> Self = Avx(unsafe { _mm256_min_ps(self.0, other.0) });
        fn max(self, other: Self) -> Self = Avx(unsafe { _mm256_max_ps(self.0, other.0) });
        fn abs(self) -> Self = Avx(unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0) });
        fn roughly(self, factor: Self, addend: Self) -> Self = Avx(unsafe { _mm256_fmadd_ps(self.0, factor.0, addend.0) });
        fn less(self, other: Self) -> Self = Avx(unsafe { _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0) });
        fn at_most(self, other: Self) -> Self = Avx(unsafe { _mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0) });
        fn select(mask: Self, yes: Self, no: Self) -> Self = Avx(unsafe { _mm256_blendv_ps(no.0, yes.0, mask.0) });
    }
    #[inline(always)]
    fn least(self) -> f32 {
        unsafe {
            let four = _mm_min_ps(_mm256_castps256_ps128(self.0), _mm256_extractf128_ps::<1>(self.0));
            let two = _mm_min_ps(four, _mm_movehl_ps(four, four));
            _mm_cvtss_f32(_mm_min_ss(two, _mm_shuffle_ps::<1>(two, two)))
        }
    }
    #[inline(always)]
    fn greatest(self) -> f32 {
        unsafe {
            let four = _mm_max_ps(_mm256_castps256_ps128(self.0), _mm256_extractf128_ps::<1>(self.0));
            let two = _mm_max_ps(four, _mm_movehl_ps(four, four));
            _mm_cvtss_f32(_mm_max_ss(two, _mm_shuffle_ps::<1>(two, two)))
        }
    }
}

/// AVX-512: F, DQ and VL.
#[derive(Clone, Copy)]
pub(super) struct Avx512(__m512);

/// One bit a lane.
#[derive(Clone, Copy)]
pub(super) struct Bits(__mmask16);

impl Mask for Bits {
    inlined! {
        fn and(self, other: Self) -> Self = Bits(self.0 & other.0);
        fn or(self, other: Self) -> Self = Bits(self.0 | other.0);
        fn bits(self) -> u32 = u32::from(self.0);
    }
}

// SAFETY (all blocks of this impl): the instructions exist, see above; loads and stores go through references to sixteen numbers,
// unaligned.
impl Lanes for Avx512 {
    type Mask = Bits;
    type Array = [f32; 16];
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Avx512(unsafe { _mm512_set1_ps(value) })
    }
    #[inline(always)]
    fn load(from: &[f32; 16]) -> Self {
        Avx512(unsafe { _mm512_loadu_ps(from.as_ptr()) })
    }
    #[inline(always)]
    fn store(self) -> [f32; 16] {
        let mut out = [0.0; 16];
        unsafe { _mm512_storeu_ps(out.as_mut_ptr(), self.0) };
        out
    }
    inlined! {
        fn add(self, other: Self) -> Self = Avx512(unsafe { _mm512_add_ps(self.0, other.0) });
        fn sub(self, other: Self) -> Self = Avx512(unsafe { _mm512_sub_ps(self.0, other.0) });
        fn mul(self, other: Self) -> Self = Avx512(unsafe { _mm512_mul_ps(self.0, other.0) });
        fn div(self, other: Self) -> Self = Avx512(unsafe { _mm512_div_ps(self.0, other.0) });
        fn min(self, other: Self) -> Self = Avx512(unsafe { _mm512_min_ps(self.0, other.0) });
        fn max(self, other: Self) -> Self = Avx512(unsafe { _mm512_max_ps(self.0, other.0) });
        fn abs(self) -> Self = Avx512(unsafe { _mm512_abs_ps(self.0) });
        fn roughly(self, factor: Self, addend: Self) -> Self = Avx512(unsafe { _mm512_fmadd_ps(self.0, factor.0, addend.0) });
        fn less(self, other: Self) -> Bits = Bits(unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0) });
        fn at_most(self, other: Self) -> Bits = Bits(unsafe { _mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, other.0) });
        fn select(mask: Bits, yes: Self, no: Self) -> Self = Avx512(unsafe { _mm512_mask_blend_ps(mask.0, no.0, yes.0) });
        fn least(self) -> f32 = Avx(self.folded()).least();
        fn greatest(self) -> f32 =
            unsafe { Avx(_mm256_max_ps(_mm512_castps512_ps256(self.0), _mm512_extractf32x8_ps::<1>(self.0))).greatest() };
    }
}

// SAFETY (all blocks of this impl): the instructions exist, see above.
impl Sixteen for Avx512 {
    #[inline(always)]
    fn spans(x: Self, y: Self) -> [f32; 4] {
        let both = four_leasts(x.folded(), x.negative().folded(), y.folded(), y.negative().folded());
        let mut out = [0.0; 4];
        unsafe { _mm_storeu_ps(out.as_mut_ptr(), _mm_min_ps(_mm256_castps256_ps128(both), _mm256_extractf128_ps::<1>(both))) };
        out
    }
    #[inline(always)]
    fn beside(self, other: Self) -> [[f32; 2]; 16] {
        // From 16 on the lanes are the other's.
        let mut out = [[0.0; 2]; 16];
        unsafe {
            let first = _mm512_set_epi32(23, 7, 22, 6, 21, 5, 20, 4, 19, 3, 18, 2, 17, 1, 16, 0);
            let second = _mm512_add_epi32(first, _mm512_set1_epi32(8));
            _mm512_storeu_ps(out[..8].as_mut_ptr().cast(), _mm512_permutex2var_ps(self.0, first, other.0));
            _mm512_storeu_ps(out[8..].as_mut_ptr().cast(), _mm512_permutex2var_ps(self.0, second, other.0));
        }
        out
    }
    #[inline(always)]
    fn with(self, lane: usize, number: f32) -> Self {
        Avx512(unsafe { _mm512_mask_blend_ps(1 << lane, self.0, _mm512_set1_ps(number)) })
    }
    #[inline(always)]
    fn columns(rows: &[[f32; 7]; 16]) -> [Self; 7] {
        let [low, high]: &[[[f32; 7]; 8]; 2] = bytemuck::cast_ref(rows);
        joined(&Avx::columns(low), &Avx::columns(high))
    }
    #[inline(always)]
    fn last_columns(rows: &[[f32; 7]; 16]) -> [Self; 4] {
        let [low, high]: &[[[f32; 7]; 8]; 2] = bytemuck::cast_ref(rows);
        joined(&four_columns(low, 3), &four_columns(high, 3))
    }
}

impl Avx512 {
    /// The lesser of each two lanes, eight apart.
    #[inline(always)]
    fn folded(self) -> __m256 {
        // SAFETY: the instructions exist, see above.
        unsafe { _mm256_min_ps(_mm512_castps512_ps256(self.0), _mm512_extractf32x8_ps::<1>(self.0)) }
    }
}

/// Eights side by side.
#[inline(always)]
fn joined<const N: usize>(low: &[Avx; N], high: &[Avx; N]) -> [Avx512; N] {
    let mut both = [Avx512::splat(0.0); N];
    for i in 0..N {
        // SAFETY: the instructions exist, see above.
        both[i] = Avx512(unsafe { _mm512_insertf32x8::<1>(_mm512_castps256_ps512(low[i].0), high[i].0) });
    }
    both
}
