//! The equations of light in Cartesian Painlevé–Gullstrand form, and one step of their solution backwards in time.
//!
//! H = |p| − β n·p, β = r^{-1/2}, so forwards in T: dx/dT = p/|p| − βn, dp/dT = (β/r)[p − (3/2)(n·p)n]. Light moves in a plane
//! through the hole, so two components are enough. The parameter is the delay τ = T_camera − T: dx/dτ is bounded by 1 + β, is
//! smooth at r = 1, and a ray that clings to the horizon approaches it as e^{−τ}, which needs no special care.
//!
//! Method: Taylor series of order chosen from the tolerance, coefficients by the recurrences of automatic differentiation, step
//! from the last two coefficients (À. Jorba and M. Zou, "A software package for the numerical integration of ODEs by means of
//! high-order Taylor methods", Experimental Mathematics 14 (2005) 99, sections 3.1 and 3.2). The series is the dense output, as
//! exact between the ends of a step as at them.

use glam::DVec2;

/// The highest order of the series; the optimum at a tolerance of 1e-17 is 22.
pub const MAX_ORDER: usize = 24;

type Series = [DVec2; MAX_ORDER + 1];

/// Light at one moment, in the plane of its orbit: position in r_s from the hole, and rain-frame momentum (towards the future;
/// the scale is free).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// x in r_s.
    pub position: DVec2,
    /// p in the rain frame; |p| is the frequency a rain observer sees.
    pub momentum: DVec2,
}

impl State {
    /// E = |p| − β n·p, conserved; negative only below the horizon.
    pub fn energy(&self) -> f64 {
        let r = self.position.length();
        self.momentum.length() - self.position.dot(self.momentum) / (r * r.sqrt())
    }

    /// The angular momentum x × p, conserved.
    pub fn angular_momentum(&self) -> f64 {
        self.position.perp_dot(self.momentum)
    }

    /// dr/dτ: positive where the ray, followed backwards in time, moves away from the hole.
    pub fn radial_rate(&self) -> f64 {
        let r = self.position.length();
        1.0 / r.sqrt() - self.position.dot(self.momentum) / (r * self.momentum.length())
    }
}

/// One step of the solution: a Taylor polynomial in the delay since its start, good from 0 to `length`.
#[derive(Clone, Debug)]
pub struct Segment {
    /// The delay τ at which the segment starts, in r_s/c.
    pub start: f64,
    /// How much delay it covers, in r_s/c.
    pub length: f64,
    order: usize,
    x: Series,
    p: Series,
}

impl Segment {
    /// The step that follows `state` backwards in time, with a local error of about `tolerance` relative to r and |p|.
    pub fn step(start: f64, state: State, tolerance: f64) -> Segment {
        let order = order_for(tolerance);
        let (x, p) = series(state, order);
        let r = state.position.length();
        let w = state.momentum.length();
        // Never further than r in one step, so that no step can sweep half a turn even when the last coefficients happen to vanish.
        let mut length: f64 = r / (1.0 + 1.0 / r.sqrt());
        for n in [order - 1, order] {
            let size = (x[n].abs().max_element() / r).max(p[n].abs().max_element() / w);
            if size > 0.0 {
                length = length.min((tolerance / size).powf(1.0 / n as f64));
            }
        }
        Segment { start, length, order, x, p }
    }

    /// Light in flat space, without a hole: from `state` straight on against its momentum, for a delay of `length`.
    pub fn straight(start: f64, state: State, length: f64) -> Segment {
        let (mut x, mut p) = ([DVec2::ZERO; MAX_ORDER + 1], [DVec2::ZERO; MAX_ORDER + 1]);
        (x[0], x[1], p[0]) = (state.position, -state.momentum.normalize(), state.momentum);
        Segment { start, length, order: 1, x, p }
    }

    /// The delay at the end of the segment.
    pub fn end(&self) -> f64 {
        self.start + self.length
    }

    /// The state `elapsed` (0 to `length`) after the start of the segment.
    pub fn at(&self, elapsed: f64) -> State {
        State { position: self.position(elapsed), momentum: self.evaluate(&self.p, elapsed) }
    }

    /// The position `elapsed` after the start of the segment.
    pub fn position(&self, elapsed: f64) -> DVec2 {
        self.evaluate(&self.x, elapsed)
    }

    /// dx/dτ `elapsed` after the start of the segment.
    pub fn velocity(&self, elapsed: f64) -> DVec2 {
        let mut v = DVec2::ZERO;
        for n in (1..=self.order).rev() {
            v = v * elapsed + n as f64 * self.x[n];
        }
        v
    }

    /// d²x/dτ² `elapsed` after the start of the segment.
    pub fn acceleration(&self, elapsed: f64) -> DVec2 {
        let mut a = DVec2::ZERO;
        for n in (2..=self.order).rev() {
            a = a * elapsed + (n * (n - 1)) as f64 * self.x[n];
        }
        a
    }

    /// A bound on |d²x/dτ²| over the segment, in 1/r_s: each term at its largest.
    pub fn bend(&self) -> f64 {
        let mut sum = 0.0;
        for n in (2..=self.order).rev() {
            sum = sum * self.length + (n * (n - 1)) as f64 * self.x[n].length();
        }
        sum
    }

    /// A bound on how far the segment strays from its start, in r_s.
    pub fn reach(&self) -> f64 {
        let mut sum = 0.0;
        for n in (1..=self.order).rev() {
            sum = (sum + self.x[n].length()) * self.length;
        }
        sum
    }

    /// The elapsed time in [from, to] at which the position crosses the line a·x = c, given that a·x − c has opposite signs at
    /// the two ends (Newton, kept inside the bracket).
    pub fn cross_line(&self, a: DVec2, c: f64, from: f64, to: f64) -> f64 {
        root(from, to, |s| (a.dot(self.position(s)) - c, a.dot(self.velocity(s))))
    }

    fn evaluate(&self, series: &Series, elapsed: f64) -> DVec2 {
        series[..=self.order].iter().rev().fold(DVec2::ZERO, |sum, &c| sum * elapsed + c)
    }
}

/// A root of f in [a, b], where f has opposite signs at the ends and `f` gives (value, derivative): Newton, with bisection
/// whenever Newton leaves the bracket, to rounding.
pub fn root(mut a: f64, mut b: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    let first = f(a).0;
    if first == 0.0 {
        return a;
    }
    let rising = first < 0.0;
    let mut s = 0.5 * (a + b);
    // 60 bisections exhaust the digits of f64; Newton needs about five steps.
    for _ in 0..60 {
        let (value, slope) = f(s);
        if value == 0.0 {
            return s;
        }
        if (value < 0.0) == rising {
            a = s;
        } else {
            b = s;
        }
        let newton = s - value / slope;
        let next = if newton > a.min(b) && newton < a.max(b) { newton } else { 0.5 * (a + b) };
        if (next - s).abs() <= 2.0 * f64::EPSILON * next.abs() {
            return next;
        }
        s = next;
    }
    s
}

/// The cheapest order for a tolerance is −(1/2) ln tolerance (Jorba and Zou, section 3.2.1); two more for the estimate.
fn order_for(tolerance: f64) -> usize {
    ((-0.5 * tolerance.ln()).ceil() as usize + 2).clamp(6, MAX_ORDER)
}

/// The Taylor coefficients of x and p in τ: dx/dτ = qx − ip, dp/dτ = (3/2)fx − qp. Each coefficient of a product is a sum over the
/// earlier ones; sums over the same terms share a loop.
fn series(state: State, order: usize) -> (Series, Series) {
    let mut x = [DVec2::ZERO; MAX_ORDER + 1];
    let mut p = [DVec2::ZERO; MAX_ORDER + 1];
    (x[0], p[0]) = (state.position, state.momentum);
    let zero = [0.0; MAX_ORDER + 1];
    let mut s = zero; // r² = x·x
    let mut w = zero; // ω² = p·p
    let mut m = zero; // x·p
    let mut q = zero; // r^{-3/2} = s^{-3/4}: βn = qx
    let mut g = zero; // r^{-7/2} = s^{-7/4}
    let mut i = zero; // 1/ω = w^{-1/2}
    let mut f = zero; // gm
    for n in 0..order {
        let (mut sum_s, mut sum_w, mut sum_m) = (0.0, 0.0, 0.0);
        for ((xa, pa), (xb, pb)) in pairs(&x, &p, n).zip(pairs(&x, &p, n).rev()) {
            sum_s += xa.dot(*xb);
            sum_w += pa.dot(*pb);
            sum_m += xa.dot(*pb);
        }
        (s[n], w[n], m[n]) = (sum_s, sum_w, sum_m);
        if n == 0 {
            let r = s[0].sqrt();
            q[0] = 1.0 / (r * r.sqrt());
            g[0] = q[0] / s[0];
            i[0] = 1.0 / w[0].sqrt();
        } else {
            // y = s^a: n s₀ yₙ = Σ_{j=1..n} (j(a + 1) − n) s_j y_{n−j}, which is s y' = a s' y term by term.
            let (mut sum_q, mut sum_g, mut sum_i) = (0.0, 0.0, 0.0);
            let count = n as f64;
            let mut k = 0.0;
            for ((sa, wa), ((qb, gb), ib)) in s[1..=n].iter().zip(&w[1..=n]).zip(q[..n].iter().zip(&g[..n]).zip(&i[..n]).rev()) {
                k += 1.0;
                sum_q += (0.25 * k - count) * sa * qb;
                sum_g += (-0.75 * k - count) * sa * gb;
                sum_i += (0.5 * k - count) * wa * ib;
            }
            q[n] = sum_q / (count * s[0]);
            g[n] = sum_g / (count * s[0]);
            i[n] = sum_i / (count * w[0]);
        }
        f[n] = g[..=n].iter().zip(m[..=n].iter().rev()).map(|(a, b)| a * b).sum();
        let (mut dx, mut dp) = (DVec2::ZERO, DVec2::ZERO);
        for (((q, i), f), (x, p)) in q[..=n].iter().zip(&i[..=n]).zip(&f[..=n]).zip(pairs(&x, &p, n).rev()) {
            dx += *q * *x - *i * *p;
            dp += 1.5 * f * *x - *q * *p;
        }
        let next = 1.0 / (n + 1) as f64;
        x[n + 1] = next * dx;
        p[n + 1] = next * dp;
    }
    (x, p)
}

/// Coefficients 0 to n of two series together.
fn pairs<'a>(x: &'a Series, p: &'a Series, n: usize) -> impl DoubleEndedIterator<Item = (&'a DVec2, &'a DVec2)> + ExactSizeIterator {
    x[..=n].iter().zip(&p[..=n])
}
