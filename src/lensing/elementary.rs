//! The elementary functions that the lookup calls, for `formulas` in both precisions: in f32 short polynomials without branches, good to the last
//! place or two, that the compiler can inline, in pairs of terms that do not wait for each other; in f64, for the bake, the library's.

/// In f32. The coefficients are minimax fits over the ranges given.
#[allow(clippy::excessive_precision)]
pub mod single {
    /// `yes` where x > 0, else `no`, both at hand. Which it is changes from point to point, and a branch foreseen wrongly costs more than both;
    /// the compiler makes branches of plain conditions, so the mask is made in the registers themselves.
    #[cfg(target_arch = "x86_64")]
    #[allow(unsafe_code)]
    #[inline(always)]
    pub fn above(x: f32, yes: f32, no: f32) -> f32 {
        use std::arch::x86_64::{_mm_and_ps, _mm_andnot_ps, _mm_cmpgt_ss, _mm_cvtss_f32, _mm_or_ps, _mm_set_ss};
        // SAFETY: these are instructions of SSE, which every processor of this kind has.
        unsafe {
            let mask = _mm_cmpgt_ss(_mm_set_ss(x), _mm_set_ss(0.0));
            _mm_cvtss_f32(_mm_or_ps(_mm_and_ps(mask, _mm_set_ss(yes)), _mm_andnot_ps(mask, _mm_set_ss(no))))
        }
    }

    /// `yes` where x > 0, else `no`.
    #[cfg(not(target_arch = "x86_64"))]
    #[inline(always)]
    pub fn above(x: f32, yes: f32, no: f32) -> f32 {
        if x > 0.0 { yes } else { no }
    }

    /// The bits of √½, where the mantissa that a logarithm is taken of begins.
    const MANTISSA_START: u32 = 0x3f35_04f3;

    /// ln(1 + f) for 1 + f in √½..=√2: off by 4e-9.
    #[inline(always)]
    fn ln_near_one(f: f32) -> f32 {
        let square = f * f;
        let p = (0.333_333_167_26 - f * 0.250_008_104_06) + square * (0.200_022_862_71 - f * 0.166_245_540_16);
        let q = (0.141_811_920_37 - f * 0.131_287_551_67) + square * (0.128_816_468_81 - f * 0.078_596_097_35);
        f + square * (f * (p + square * square * q) - 0.5)
    }

    /// The exponent of x > 0 and what its mantissa exceeds 1 by.
    #[inline(always)]
    fn parted(x: f32) -> (i32, f32) {
        let bits = x.to_bits();
        let exponent = (bits.wrapping_sub(MANTISSA_START) as i32) >> 23;
        (exponent, f32::from_bits(bits.wrapping_sub((exponent << 23) as u32)) - 1.0)
    }

    /// ln x for a normal x > 0; anything finite for other x.
    #[inline(always)]
    pub fn ln(x: f32) -> f32 {
        let (exponent, f) = parted(x);
        exponent as f32 * std::f32::consts::LN_2 + ln_near_one(f)
    }

    /// Four of them at once.
    #[inline(always)]
    pub fn ln4([a, b, c, d]: [f32; 4]) -> [f32; 4] {
        [ln(a), ln(b), ln(c), ln(d)]
    }

    /// ln(1 + x) for x > −1, accurate for small x.
    #[inline(always)]
    pub fn log1p(x: f32) -> f32 {
        let (exponent, f) = parted(1.0 + x);
        exponent as f32 * std::f32::consts::LN_2 + ln_near_one(above(0.29 - x.abs(), x, f))
    }

    /// arctan t for |t| ≤ tan(π/8): off by 1e-9 of it.
    #[inline(always)]
    pub fn short_arctan(t: f32) -> f32 {
        let y = t * t;
        let (y2, p) = (y * y, -0.333_333_154_97 + y * 0.199_984_888_90);
        t + t * y * (p + y2 * ((-0.142_438_377_05 + y * 0.105_959_151_30) - y2 * 0.060_832_230_04))
    }

    /// Stumpff's functions (sin √x / √x, cos √x), hyperbolic for x < 0, for −1 ≤ x ≤ 4.4 (√x up to 2.1): off by 2e-9.
    #[inline(always)]
    pub fn stumpff(x: f32) -> [f32; 2] {
        let (x2, x4) = (x * x, x * x * (x * x));
        let s = (-0.166_666_670_045_43 + x * 0.008_333_337_684_15) + x2 * (-0.000_198_409_309_41 + x * 2.750_985_84e-6);
        let c = (-0.499_999_999_988_26 + x * 0.041_666_667_398_3) + x2 * (-0.001_388_889_194_47 + x * 2.480_098_260_69e-5);
        [1.0 + x * (s - x4 * 2.349_98e-8), 1.0 + x * (c + x4 * (-2.750_805_330_53e-7 + x * 1.959_04e-9))]
    }
}

/// In f64.
pub mod double {
    /// `yes` where x > 0, else `no`.
    pub fn above(x: f64, yes: f64, no: f64) -> f64 {
        if x > 0.0 { yes } else { no }
    }

    /// ln x.
    pub fn ln(x: f64) -> f64 {
        x.ln()
    }

    /// Four of them.
    pub fn ln4(x: [f64; 4]) -> [f64; 4] {
        x.map(f64::ln)
    }

    /// ln(1 + x).
    pub fn log1p(x: f64) -> f64 {
        x.ln_1p()
    }

    /// Stumpff's functions (sin √x / √x, cos √x), hyperbolic for x < 0.
    pub fn stumpff(x: f64) -> [f64; 2] {
        if x.abs() < 1e-8 {
            return [1.0 - x / 6.0, 1.0 - x / 2.0];
        }
        let root = x.abs().sqrt();
        if x > 0.0 { [root.sin() / root, root.cos()] } else { [root.sinh() / root, root.cosh()] }
    }
}
