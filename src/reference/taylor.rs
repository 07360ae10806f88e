//! Taylor coefficients of light's equations of motion, for one ray or for four side by side.

use std::ops::{Add, Mul, Sub};

/// The highest order of the series; the optimum at a tolerance of 1e-17 is 22.
pub const MAX_ORDER: usize = 24;

/// Coefficients of a vector in the plane of the orbit, in r_s/(r_s/c)ⁿ.
pub(super) type Vectors<N> = [[N; 2]; MAX_ORDER + 1];

/// One number or several side by side; each lane rounds as a lone f64 does.
pub(super) trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    fn splat(value: f64) -> Self;
    fn sqrt(self) -> Self;
    fn reciprocal(self) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn splat(value: f64) -> f64 {
        value
    }
    #[inline(always)]
    fn sqrt(self) -> f64 {
        self.sqrt()
    }
    #[inline(always)]
    fn reciprocal(self) -> f64 {
        1.0 / self
    }
}

/// Four numbers.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(32))]
pub(super) struct Four(pub [f64; 4]);

impl Add for Four {
    type Output = Four;
    #[inline(always)]
    fn add(self, other: Four) -> Four {
        Four(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl Sub for Four {
    type Output = Four;
    #[inline(always)]
    fn sub(self, other: Four) -> Four {
        Four(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }
}

impl Mul for Four {
    type Output = Four;
    #[inline(always)]
    fn mul(self, other: Four) -> Four {
        Four(std::array::from_fn(|i| self.0[i] * other.0[i]))
    }
}

impl Number for Four {
    #[inline(always)]
    fn splat(value: f64) -> Four {
        Four([value; 4])
    }
    #[inline(always)]
    fn sqrt(self) -> Four {
        Four(self.0.map(f64::sqrt))
    }
    #[inline(always)]
    fn reciprocal(self) -> Four {
        Four(self.0.map(|x| 1.0 / x))
    }
}

/// The Taylor coefficients 0 to `order` of x and p in τ: dx/dτ = qx − ip, dp/dτ = (3/2)fx − qp. Each coefficient of a product is a sum over the
/// earlier ones; sums over the same terms share a loop.
#[inline(always)]
pub(super) fn series<N: Number>(position: [N; 2], momentum: [N; 2], order: usize, x: &mut Vectors<N>, p: &mut Vectors<N>) {
    assert!((1..=MAX_ORDER).contains(&order), "order {order}");
    (x[0], p[0]) = (position, momentum);
    let zero = [N::splat(0.0); MAX_ORDER + 1];
    let mut s = zero; // r² = x·x
    let mut w = zero; // ω² = p·p
    let mut m = zero; // x·p
    let mut q = zero; // r^{-3/2} = s^{-3/4}: βn = qx
    let mut g = zero; // r^{-7/2} = s^{-7/4}
    let mut i = zero; // 1/ω = w^{-1/2}
    let mut f = zero; // gm
    // Both are at least 0: (1/s₀, 1/w₀).
    let mut over = [N::splat(0.0); 2];
    for n in 0..order {
        let (mut sum_s, mut sum_w, mut sum_m) = (N::splat(0.0), N::splat(0.0), N::splat(0.0));
        for k in 0..=n {
            let (xa, pa, xb, pb) = (x[k], p[k], x[n - k], p[n - k]);
            sum_s = sum_s + dot(xa, xb);
            sum_w = sum_w + dot(pa, pb);
            sum_m = sum_m + dot(xa, pb);
        }
        (s[n], w[n], m[n]) = (sum_s, sum_w, sum_m);
        if n == 0 {
            let r = sum_s.sqrt();
            over = [sum_s.reciprocal(), sum_w.reciprocal()];
            q[0] = (r * r.sqrt()).reciprocal();
            g[0] = q[0] * over[0];
            i[0] = sum_w.sqrt().reciprocal();
        } else {
            // y = s^a: n s₀ yₙ = Σ_{j=1..n} (j(a + 1) − n) s_j y_{n−j}, which is s y' = a s' y term by term.
            let (mut sum_q, mut sum_g, mut sum_i) = (N::splat(0.0), N::splat(0.0), N::splat(0.0));
            let count = n as f64;
            for j in 1..=n {
                let k = j as f64;
                sum_q = sum_q + N::splat(0.25 * k - count) * s[j] * q[n - j];
                sum_g = sum_g + N::splat(-0.75 * k - count) * s[j] * g[n - j];
                sum_i = sum_i + N::splat(0.5 * k - count) * w[j] * i[n - j];
            }
            let part = N::splat(1.0 / count);
            q[n] = sum_q * part * over[0];
            g[n] = sum_g * part * over[0];
            i[n] = sum_i * part * over[1];
        }
        let mut sum_f = N::splat(0.0);
        for k in 0..=n {
            sum_f = sum_f + g[k] * m[n - k];
        }
        f[n] = sum_f;
        let (mut dx, mut dp) = ([N::splat(0.0); 2], [N::splat(0.0); 2]);
        for k in 0..=n {
            let fx = N::splat(1.5) * f[k];
            for axis in 0..2 {
                dx[axis] = dx[axis] + (q[k] * x[n - k][axis] - i[k] * p[n - k][axis]);
                dp[axis] = dp[axis] + (fx * x[n - k][axis] - q[k] * p[n - k][axis]);
            }
        }
        let next = N::splat(1.0 / (n + 1) as f64);
        x[n + 1] = dx.map(|d| next * d);
        p[n + 1] = dp.map(|d| next * d);
    }
}

#[inline(always)]
fn dot<N: Number>(a: [N; 2], b: [N; 2]) -> N {
    a[0] * b[0] + a[1] * b[1]
}
