//! Eight numbers at once.

/// Eight f32 side by side. Each operation rounds like the scalar one, so every implementation gives the same bits.
pub(super) trait Lanes: Copy {
    fn splat(value: f32) -> Self;
    fn load(from: &[f32; 8]) -> Self;
    fn store(self) -> [f32; 8];
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    /// The smaller; `other` where either is not a number.
    fn min(self, other: Self) -> Self;
    /// The larger; `other` where either is not a number.
    fn max(self, other: Self) -> Self;
    /// One bit a lane, lane 0 lowest: self < other.
    fn less(self, other: Self) -> u32;
    /// self ≤ other.
    fn at_most(self, other: Self) -> u32;
    /// One bit a lane: the sign, of zeros and of what is not a number too.
    fn signs(self) -> u32;
    /// The bits of both.
    fn and(self, other: Self) -> Self;
    /// The bits of either.
    fn or(self, other: Self) -> Self;
}

/// For processors without AVX2, and to test against.
#[derive(Clone, Copy)]
pub(super) struct Portable([f32; 8]);

#[inline(always)]
fn zip(a: Portable, b: Portable, f: impl Fn(f32, f32) -> f32) -> Portable {
    Portable(std::array::from_fn(|i| f(a.0[i], b.0[i])))
}

#[inline(always)]
fn compare(a: Portable, b: Portable, f: impl Fn(f32, f32) -> bool) -> u32 {
    (0..8).fold(0, |bits, i| bits | u32::from(f(a.0[i], b.0[i])) << i)
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
    fn less(self, other: Self) -> u32 {
        compare(self, other, |a, b| a < b)
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        compare(self, other, |a, b| a <= b)
    }
    #[inline(always)]
    fn signs(self) -> u32 {
        compare(self, self, |a, _| a.is_sign_negative())
    }
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        zip(self, other, |a, b| f32::from_bits(a.to_bits() & b.to_bits()))
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        zip(self, other, |a, b| f32::from_bits(a.to_bits() | b.to_bits()))
    }
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
        fn less(self, other: Self) -> u32 {
            unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0)) as u32 }
        }
        #[inline(always)]
        fn at_most(self, other: Self) -> u32 {
            unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0)) as u32 }
        }
        #[inline(always)]
        fn signs(self) -> u32 {
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
    }
}
