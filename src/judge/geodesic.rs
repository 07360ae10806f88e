//! The equations of light in Cartesian Painlevé–Gullstrand form, and one step of their solution backwards in time.
//!
//! H = |p| − β n·p, β = r^{-1/2}, so forwards in T: dx/dT = p/|p| − βn, dp/dT = (β/r)[p − (3/2)(n·p)n]. Light moves in a plane
//! through the hole, so two components are enough. The parameter is the delay τ = T_camera − T: dx/dτ is bounded by 1 + β, is
//! smooth at r = 1, and a ray that clings to the horizon approaches it as e^{−τ/2}, which needs no special care.
//!
//! Method: Taylor series of order chosen from the tolerance, coefficients by the recurrences of automatic differentiation, step
//! from the last two coefficients (À. Jorba and M. Zou, "A software package for the numerical integration of ODEs by means of
//! high-order Taylor methods", Experimental Mathematics 14 (2005) 99, sections 3.1 and 3.2). The series is the dense output, as
//! exact between the ends of a step as at them.

use glam::DVec2;

use super::taylor::{Scratch, series};

pub use super::taylor::MAX_ORDER;

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
    pub(super) order: usize,
    pub(super) x: Series,
    pub(super) p: Series,
}

impl Segment {
    /// The step that follows `state` backwards in time, with a local error of about `tolerance` relative to r and |p|.
    pub fn step(start: f64, state: State, tolerance: f64) -> Segment {
        let order = order_for(tolerance);
        let (mut x, mut p) = ([[0.0; 2]; MAX_ORDER + 1], [[0.0; 2]; MAX_ORDER + 1]);
        series(state.position.to_array(), state.momentum.to_array(), order, &mut x, &mut p, &mut Scratch::default());
        let (x, p) = (x.map(DVec2::from_array), p.map(DVec2::from_array));
        Segment { start, length: step_length(&state, order, tolerance, |n| [x[n], p[n]]), order, x, p }
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

/// How long a step with these coefficients of x and p may be for the tolerance.
pub(super) fn step_length(state: &State, order: usize, tolerance: f64, coefficients: impl Fn(usize) -> [DVec2; 2]) -> f64 {
    let r = state.position.length();
    let w = state.momentum.length();
    // Never further than r in one step, so that no step can sweep half a turn even when the last coefficients happen to vanish.
    let longest = r / (1.0 + 1.0 / r.sqrt());
    let mut exponent = f64::INFINITY;
    for n in [order - 1, order] {
        let [x, p] = coefficients(n);
        let size = (x.abs().max_element() / r).max(p.abs().max_element() / w);
        if size > 0.0 {
            exponent = exponent.min((tolerance / size).ln() / n as f64);
        }
    }
    exponent.exp().min(longest)
}

/// The cheapest order for a tolerance is −(1/2) ln tolerance (Jorba and Zou, section 3.2.1); two more for the estimate.
pub(super) fn order_for(tolerance: f64) -> usize {
    ((-0.5 * tolerance.ln()).ceil() as usize + 2).clamp(6, MAX_ORDER)
}
