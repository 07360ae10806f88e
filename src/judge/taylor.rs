//! Taylor coefficients of light's equations of motion, for one ray or for several side by side.

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

/// How many rays go side by side: two of a processor's registers of four, as one alone waits for its own sums (234 and 294 ns a ray).
pub const LANES: usize = 8;

/// As many numbers.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(32))]
pub(super) struct Lanes(pub [f64; LANES]);

impl Add for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn add(self, other: Lanes) -> Lanes {
        Lanes(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl Sub for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn sub(self, other: Lanes) -> Lanes {
        Lanes(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }
}

impl Mul for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn mul(self, other: Lanes) -> Lanes {
        Lanes(std::array::from_fn(|i| self.0[i] * other.0[i]))
    }
}

impl Number for Lanes {
    #[inline(always)]
    fn splat(value: f64) -> Lanes {
        Lanes([value; LANES])
    }
    #[inline(always)]
    fn sqrt(self) -> Lanes {
        Lanes(self.0.map(f64::sqrt))
    }
    #[inline(always)]
    fn reciprocal(self) -> Lanes {
        Lanes(self.0.map(|x| 1.0 / x))
    }
}

/// What the recurrences remember, coefficient by coefficient.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch<N> {
    /// r² = x·x.
    s: [N; MAX_ORDER + 1],
    /// ω² = p·p.
    w: [N; MAX_ORDER + 1],
    /// x·p.
    m: [N; MAX_ORDER + 1],
    /// r^{-3/2} = s^{-3/4}: βn = qx.
    q: [N; MAX_ORDER + 1],
    /// r^{-7/2} = q/s.
    g: [N; MAX_ORDER + 1],
    /// 1/ω = w^{-1/2}.
    i: [N; MAX_ORDER + 1],
    /// (3/2)gm.
    f: [N; MAX_ORDER + 1],
}

/// The Taylor coefficients 0 to `order` of x and p in τ: dx/dτ = qx − ip, dp/dτ = fx − qp. Each coefficient of a product is a sum over the
/// earlier ones; sums over the same terms share a loop.
#[inline(always)]
pub(super) fn series<N: Number>(
    position: [N; 2],
    momentum: [N; 2],
    order: usize,
    x: &mut Vectors<N>,
    p: &mut Vectors<N>,
    scratch: &mut Scratch<N>,
) {
    assert!((1..=MAX_ORDER).contains(&order), "order {order}");
    let Scratch { s, w, m, q, g, i, f } = scratch;
    (x[0], p[0]) = (position, momentum);
    // Both are at least 0: (1/s₀, 1/w₀).
    let mut over = [N::splat(0.0); 2];
    for n in 0..order {
        (s[n], w[n]) = (square(x, n), square(p, n));
        let mut sum_m = N::splat(0.0);
        for k in 0..=n {
            sum_m = sum_m + dot(x[k], p[n - k]);
        }
        m[n] = sum_m;
        if n == 0 {
            let r = s[0].sqrt();
            over = [s[0].reciprocal(), w[0].reciprocal()];
            q[0] = (r * r.sqrt()).reciprocal();
            g[0] = q[0] * over[0];
            i[0] = w[0].sqrt().reciprocal();
        } else {
            // y = s^a: n s₀ yₙ = Σ_{j=1..n} (j(a + 1) − n) s_j y_{n−j}, which is s y' = a s' y term by term.
            let (mut sum_q, mut sum_i) = (N::splat(0.0), N::splat(0.0));
            let count = n as f64;
            for j in 1..=n {
                let k = j as f64;
                sum_q = sum_q + N::splat(0.25 * k - count) * s[j] * q[n - j];
                sum_i = sum_i + N::splat(0.5 * k - count) * w[j] * i[n - j];
            }
            let part = N::splat(1.0 / count);
            q[n] = sum_q * part * over[0];
            i[n] = sum_i * part * over[1];
            // sg = q term by term.
            let mut sum_g = N::splat(0.0);
            for j in 1..=n {
                sum_g = sum_g + s[j] * g[n - j];
            }
            g[n] = (q[n] - sum_g) * over[0];
        }
        let mut sum_f = N::splat(0.0);
        for k in 0..=n {
            sum_f = sum_f + g[k] * m[n - k];
        }
        f[n] = N::splat(1.5) * sum_f;
        let (mut dx, mut dp) = ([N::splat(0.0); 2], [N::splat(0.0); 2]);
        for k in 0..=n {
            for axis in 0..2 {
                dx[axis] = dx[axis] + (q[k] * x[n - k][axis] - i[k] * p[n - k][axis]);
                dp[axis] = dp[axis] + (f[k] * x[n - k][axis] - q[k] * p[n - k][axis]);
            }
        }
        let next = N::splat(1.0 / (n + 1) as f64);
        x[n + 1] = dx.map(|d| next * d);
        p[n + 1] = dp.map(|d| next * d);
    }
}

/// Coefficient n of the square of a vector: equal terms once.
#[inline(always)]
fn square<N: Number>(v: &Vectors<N>, n: usize) -> N {
    let mut sum = N::splat(0.0);
    for k in 0..n.div_ceil(2) {
        sum = sum + dot(v[k], v[n - k]);
    }
    sum = sum + sum;
    if n.is_multiple_of(2) { sum + dot(v[n / 2], v[n / 2]) } else { sum }
}

#[inline(always)]
fn dot<N: Number>(a: [N; 2], b: [N; 2]) -> N {
    a[0] * b[0] + a[1] * b[1]
}
