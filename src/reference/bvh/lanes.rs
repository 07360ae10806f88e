//! Eight numbers at once.

/// Eight f32 side by side. Each operation rounds like the scalar one, so every implementation gives the same bits.
pub(super) trait Lanes: Copy {
    fn splat(value: f32) -> Self;
    fn load(from: &[f32; 8]) -> Self;
    fn store(self) -> [f32; 8];
    /// The seven columns of eight rows.
    fn columns(rows: &[[f32; 7]; 8]) -> [Self; 7];
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    /// The smaller; `other` where either is not a number.
    fn min(self, other: Self) -> Self;
    /// The larger; `other` where either is not a number.
    fn max(self, other: Self) -> Self;
    /// self < other: a mask, all bits of a lane set or none.
    fn less(self, other: Self) -> Self;
    /// self ≤ other.
    fn at_most(self, other: Self) -> Self;
    /// One bit a lane of a mask, lane 0 lowest.
    fn bits(self) -> u32;
    /// The lanes set in both masks.
    fn and(self, other: Self) -> Self;
    /// The lanes set in either mask.
    fn or(self, other: Self) -> Self;
    /// Lanes of `yes` where the mask is set, else of `no`.
    fn select(self, yes: Self, no: Self) -> Self;
    /// The least lane. No lane may be other than a number.
    fn least(self) -> f32;
    /// The greatest lane. No lane may be other than a number.
    fn greatest(self) -> f32;
    /// The least lane of each of eight. No lane may be other than a number.
    fn leasts(rows: [Self; 8]) -> Self;
    /// Asks for memory that will be needed soon.
    fn prefetch<T>(soon: &T);
    /// With the other sign (0 stays 0).
    #[inline(always)]
    fn negative(self) -> Self {
        Self::splat(0.0).sub(self)
    }
    /// Without the sign.
    #[inline(always)]
    fn abs(self) -> Self {
        self.max(self.negative())
    }
}

/// For processors without AVX2, and to test against.
#[derive(Clone, Copy)]
pub(super) struct Portable([f32; 8]);

#[inline(always)]
fn zip(a: Portable, b: Portable, f: impl Fn(f32, f32) -> f32) -> Portable {
    Portable(std::array::from_fn(|i| f(a.0[i], b.0[i])))
}

#[inline(always)]
fn compare(a: Portable, b: Portable, f: impl Fn(f32, f32) -> bool) -> Portable {
    zip(a, b, |a, b| f32::from_bits(if f(a, b) { u32::MAX } else { 0 }))
}

impl Lanes for Portable {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Portable([value; 8])
    }
    #[inline(always)]
    fn load(from: &[f32; 8]) -> Self {
        Portable(*from)
    }
    #[inline(always)]
    fn store(self) -> [f32; 8] {
        self.0
    }
    #[inline(always)]
    fn columns(rows: &[[f32; 7]; 8]) -> [Self; 7] {
        std::array::from_fn(|column| Portable(rows.map(|row| row[column])))
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        zip(self, other, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        zip(self, other, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        zip(self, other, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        zip(self, other, |a, b| a / b)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        zip(self, other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        zip(self, other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn less(self, other: Self) -> Self {
        compare(self, other, |a, b| a < b)
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> Self {
        compare(self, other, |a, b| a <= b)
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        (0..8).fold(0, |bits, i| bits | self.0[i].to_bits() >> 31 << i)
    }
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        zip(self, other, |a, b| f32::from_bits(a.to_bits() & b.to_bits()))
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        zip(self, other, |a, b| f32::from_bits(a.to_bits() | b.to_bits()))
    }
    #[inline(always)]
    fn select(self, yes: Self, no: Self) -> Self {
        Portable(std::array::from_fn(|i| if self.0[i].is_sign_negative() { yes.0[i] } else { no.0[i] }))
    }
    #[inline(always)]
    fn least(self) -> f32 {
        self.0.into_iter().fold(f32::INFINITY, f32::min)
    }
    #[inline(always)]
    fn greatest(self) -> f32 {
        self.0.into_iter().fold(f32::NEG_INFINITY, f32::max)
    }
    #[inline(always)]
    fn leasts(rows: [Self; 8]) -> Self {
        Portable(rows.map(Lanes::least))
    }
    #[inline(always)]
    fn prefetch<T>(_: &T) {}
}

#[cfg(target_arch = "x86_64")]
pub(super) use avx::Avx;

/// Measured to pay: two to three times the speed of the portable lanes, which the compiler makes of SSE2.
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
mod avx {
    use std::arch::x86_64::*;

    use super::Lanes;

    /// Must be used only where AVX2 has been detected: [`super::super::wide::Wide`] chooses it nowhere else.
    #[derive(Clone, Copy)]
    pub(in super::super) struct Avx(__m256);

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

    // SAFETY (all blocks of this impl): the instructions exist, see above; loads and stores go through references to eight numbers, unaligned.
    impl Lanes for Avx {
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
        #[inline(always)]
        fn columns(rows: &[[f32; 7]; 8]) -> [Self; 7] {
            // Numbers 0 to 3 and 3 to 6 of each row: four at a time, none beyond its end.
            let [a, b, c, _] = four_columns(rows, 0);
            let [d, e, f, g] = four_columns(rows, 3);
            [a, b, c, d, e, f, g]
        }
        #[inline(always)]
        fn add(self, other: Self) -> Self {
            Avx(unsafe { _mm256_add_ps(self.0, other.0) })
        }
        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            Avx(unsafe { _mm256_sub_ps(self.0, other.0) })
        }
        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            Avx(unsafe { _mm256_mul_ps(self.0, other.0) })
        }
        #[inline(always)]
        fn div(self, other: Self) -> Self {
            Avx(unsafe { _mm256_div_ps(self.0, other.0) })
        }
        #[inline(always)]
        fn min(self, other: Self) -> Self {
            Avx(unsafe { _mm256_min_ps(self.0, other.0) })
        }
        #[inline(always)]
        fn max(self, other: Self) -> Self {
            Avx(unsafe { _mm256_max_ps(self.0, other.0) })
        }
        #[inline(always)]
        fn less(self, other: Self) -> Self {
            Avx(unsafe { _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0) })
        }
        #[inline(always)]
        fn at_most(self, other: Self) -> Self {
            Avx(unsafe { _mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0) })
        }
        #[inline(always)]
        fn bits(self) -> u32 {
            unsafe { _mm256_movemask_ps(self.0) as u32 }
        }
        #[inline(always)]
        fn and(self, other: Self) -> Self {
            Avx(unsafe { _mm256_and_ps(self.0, other.0) })
        }
        #[inline(always)]
        fn or(self, other: Self) -> Self {
            Avx(unsafe { _mm256_or_ps(self.0, other.0) })
        }
        #[inline(always)]
        fn select(self, yes: Self, no: Self) -> Self {
            Avx(unsafe { _mm256_blendv_ps(no.0, yes.0, self.0) })
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
}
