//! The elementary functions that the lookup calls, for `formulas` in both precisions: in f32 short polynomials without branches, good to
//! the last place or two, that the compiler can inline, in pairs of terms that do not wait for each other; in f64, for the bake, the
//! library's.

/// In f32. The coefficients are minimax fits over the ranges given.
#[allow(clippy::excessive_precision)]
pub mod single {
    use wide::{f32x4, i32x4};

    /// `yes` where x > 0, else `no`.
    #[inline(always)]
    pub fn above(x: f32, yes: f32, no: f32) -> f32 {
        if x > 0.0 { yes } else { no }
    }

    /// The smaller of two that are numbers: one instruction, where the library's `min` also decides about NaN.
    #[inline(always)]
    pub fn least(a: f32, b: f32) -> f32 {
        if a < b { a } else { b }
    }

    /// The larger of two that are numbers.
    #[inline(always)]
    pub fn most(a: f32, b: f32) -> f32 {
        if a > b { a } else { b }
    }

    /// The bits of √½, where the mantissa that a logarithm is taken of begins.
    const MANTISSA_START: u32 = 0x3f35_04f3;

    /// ln(1 + f) = f − f²/2 + f³ (LN₀ − LN₁ f + LN₂ f² − …): minimax for 1 + f in √½..=√2, off by 4e-9.
    const LN: [f32; 8] = [
        0.333_333_167_26, 0.250_008_104_06, 0.200_022_862_71, 0.166_245_540_16, 0.141_811_920_37, 0.131_287_551_67, 0.128_816_468_81,
        0.078_596_097_35,
    ];
    /// Below this |x|, ln(1 + x) is taken of x itself and not of a mantissa: just inside √½..=√2, 1 − √½ = 0.293.
    const SMALL: f32 = 0.29;

    /// ln(1 + f) for 1 + f in √½..=√2.
    #[inline(always)]
    fn ln_near_one(f: f32) -> f32 {
        let square = f * f;
        let p = (LN[0] - f * LN[1]) + square * (LN[2] - f * LN[3]);
        let q = (LN[4] - f * LN[5]) + square * (LN[6] - f * LN[7]);
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

    /// ln a, ln b, ln c and ln(1 + x), the last accurate for small x.
    #[inline(always)]
    pub fn ln4([a, b, c]: [f32; 3], x: f32) -> [f32; 4] {
        let bits: i32x4 = bytemuck::cast(f32x4::from([a, b, c, 1.0 + x]));
        let exponent = (bits - i32x4::splat(MANTISSA_START as i32)) >> 23;
        let mantissa: f32x4 = bytemuck::cast(bits - (exponent << 23));
        let small = f32x4::from([1.0, 1.0, 1.0, x]);
        let f = small.abs().simd_lt(f32x4::splat(SMALL)).select(small, mantissa - f32x4::ONE);
        let square = f * f;
        let p = (LN[0] - f * LN[1]) + square * (LN[2] - f * LN[3]);
        let q = (LN[4] - f * LN[5]) + square * (LN[6] - f * LN[7]);
        let near = f + square * (f * (p + square * square * q) - 0.5);
        (f32x4::from_i32x4(exponent) * std::f32::consts::LN_2 + near).to_array()
    }

    /// ln(1 + x) for x > −1, accurate for small x.
    #[inline(always)]
    pub fn log1p(x: f32) -> f32 {
        let (exponent, f) = parted(1.0 + x);
        exponent as f32 * std::f32::consts::LN_2 + ln_near_one(above(SMALL - x.abs(), x, f))
    }

    /// arctan t for |t| ≤ tan(π/8): off by 1e-9 of it.
    #[inline(always)]
    pub fn short_arctan(t: f32) -> f32 {
        let y = t * t;
        let (y2, p) = (y * y, -0.333_333_154_97 + y * 0.199_984_888_90);
        t + t * y * (p + y2 * ((-0.142_438_377_05 + y * 0.105_959_151_30) - y2 * 0.060_832_230_04))
    }

    /// Stumpff's functions (sin √x / √x, cos √x), hyperbolic for x < 0, of both, for −1 ≤ x ≤ 4.5 (√x up to 2.12): off by 2e-9.
    #[inline(always)]
    pub fn stumpffs(a: f32, b: f32) -> [(f32, f32); 2] {
        let lanes = |s: f32, c: f32| f32x4::from([s, c, s, c]);
        let x = f32x4::from([a, a, b, b]);
        let square = x * x;
        let low = 1.0 + x * lanes(-0.166_666_670_045_43, -0.499_999_999_988_26);
        let middle = lanes(0.008_333_337_684_15, 0.041_666_667_398_3) + x * lanes(-0.000_198_409_309_41, -0.001_388_889_194_47);
        let high = lanes(2.750_985_84e-6, 2.480_098_260_69e-5) + x * lanes(-2.349_98e-8, -2.750_805_330_53e-7);
        let last = square * lanes(0.0, 1.959_04e-9);
        let value = low + square * (middle + square * (high + last));
        let [s, c, t, d] = value.to_array();
        [(s, c), (t, d)]
    }

    /// Those of one.
    #[inline(always)]
    pub fn stumpff(x: f32) -> (f32, f32) {
        stumpffs(x, x)[0]
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

    /// ln(1 + x).
    pub fn log1p(x: f64) -> f64 {
        x.ln_1p()
    }

    /// Stumpff's functions (sin √x / √x, cos √x), hyperbolic for x < 0.
    pub fn stumpff(x: f64) -> (f64, f64) {
        if x.abs() < 1e-8 {
            return (1.0 - x / 6.0, 1.0 - x / 2.0);
        }
        let root = x.abs().sqrt();
        if x > 0.0 { (root.sin() / root, root.cos()) } else { (root.sinh() / root, root.cosh()) }
    }

    /// Those of both.
    pub fn stumpffs(a: f64, b: f64) -> [(f64, f64); 2] {
        [stumpff(a), stumpff(b)]
    }
}
