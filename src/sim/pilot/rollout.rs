//! Cheap flights into the future, for planning: position and momentum only, Runge–Kutta of order 4 with long steps.
//!
//! Only + − × ÷ √, as in the real step, so that plans and with them whole chases have the same bits everywhere.

use glam::DVec3;

use crate::spacetime::matter::{ShipState, boosted_acceleration, gamma, tidal_pull};
use crate::spacetime::metric::river_speed;

/// A burn: constant thrust on local axes, then coasting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedBurn {
    /// Proper acceleration on local axes (outward, along the motion around the hole, along the orbit's axis), c²/r_s.
    pub thrust: DVec3,
    /// For this long, in r_s/c.
    pub duration: f64,
}

impl PlannedBurn {
    /// No thrust at all.
    pub const COAST: PlannedBurn = PlannedBurn { thrust: DVec3::ZERO, duration: 0.0 };

    /// The proper acceleration (rest-frame axes) at `at`, in the middle of a step of `h` that begins `time` after the burn did.
    pub fn acceleration(&self, at: &Point, time: f64, h: f64) -> DVec3 {
        if time + 0.5 * h < self.duration { at.from_local(self.thrust) } else { DVec3::ZERO }
    }
}

/// Position (r_s) and rain-frame momentum per mass (c).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// x on the slice T = const.
    pub x: DVec3,
    /// p = γv in the rain frame.
    pub p: DVec3,
}

impl From<&ShipState> for Point {
    fn from(state: &ShipState) -> Self {
        Point { x: state.position, p: state.momentum }
    }
}

impl Point {
    /// dx/dT, in c.
    pub fn velocity(&self) -> DVec3 {
        let r = self.x.length();
        self.p / gamma(self.p) - self.x * (river_speed(r) / r)
    }

    /// Energy per mass, as `matter::energy`.
    pub fn energy(&self) -> f64 {
        let r = self.x.length();
        gamma(self.p) - self.x.dot(self.p) * (river_speed(r) / r)
    }

    fn rate(&self, acceleration: DVec3) -> Point {
        let force = boosted_acceleration(self.p, acceleration) / gamma(self.p);
        Point { x: self.velocity(), p: tidal_pull(self.x, self.p) + force }
    }

    fn plus(&self, h: f64, rate: &Point) -> Point {
        Point { x: self.x + rate.x * h, p: self.p + rate.p * h }
    }

    /// One step of `h` under the proper acceleration `acceleration` (rest-frame axes by pure boost).
    pub fn step(&self, h: f64, acceleration: DVec3) -> Point {
        let k1 = self.rate(acceleration);
        let k2 = self.plus(0.5 * h, &k1).rate(acceleration);
        let k3 = self.plus(0.5 * h, &k2).rate(acceleration);
        let k4 = self.plus(h, &k3).rate(acceleration);
        Point { x: self.x + (k1.x + (k2.x + k3.x) * 2.0 + k4.x) * (h / 6.0), p: self.p + (k1.p + (k2.p + k3.p) * 2.0 + k4.p) * (h / 6.0) }
    }

    /// The inverse of [`Point::from_local`].
    pub fn to_local(&self, v: DVec3) -> DVec3 {
        let outward = self.x / self.x.length();
        let axis = self.x.cross(self.p).try_normalize().unwrap_or_else(|| outward.any_orthonormal_vector());
        DVec3::new(v.dot(outward), v.dot(axis.cross(outward)), v.dot(axis))
    }

    /// `local` (outward, along the motion around the hole, along the orbit's axis) on rest-frame axes.
    pub fn from_local(&self, local: DVec3) -> DVec3 {
        let outward = self.x / self.x.length();
        let axis = self.x.cross(self.p).try_normalize().unwrap_or_else(|| outward.any_orthonormal_vector());
        outward * local.x + axis.cross(outward) * local.y + axis * local.z
    }
}

/// How a rollout goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// T per step, in r_s/c.
    pub step: f64,
    /// Number of steps.
    pub count: usize,
}

/// The flight from `start` under `burn`, down to the radius `floor` (r_s): `count` + 1 points.
pub fn track(start: Point, burn: &PlannedBurn, span: Span, floor: f64) -> Vec<Point> {
    let mut track = Vec::with_capacity(span.count + 1);
    let mut now = start;
    track.push(now);
    for index in 0..span.count {
        now = advance(&now, span.step, floor, |at| burn.acceleration(at, index as f64 * span.step, span.step));
        track.push(now);
    }
    track
}

/// Nearer to the hole than this, in r_s, a step is flown in so many pieces: from there the rain falls to the end in 3.5 r_s/c.
const NEAR_HOLE: f64 = 3.0;
/// See [`NEAR_HOLE`].
const PIECES: u32 = 4;

/// One planning step; near the hole it is halved twice. Below the radius `floor` (r_s) the ship is lost to the plan and stays where it is.
pub fn advance(now: &Point, h: f64, floor: f64, acceleration: impl Fn(&Point) -> DVec3) -> Point {
    let r_squared = now.x.length_squared();
    if r_squared < floor * floor {
        return *now;
    }
    let pieces = if r_squared < NEAR_HOLE * NEAR_HOLE { PIECES } else { 1 };
    let mut point = *now;
    for _ in 0..pieces {
        point = point.step(h / f64::from(pieces), acceleration(&point));
    }
    point
}

/// A step of free fall.
pub fn coast(now: &Point, h: f64) -> Point {
    advance(now, h, 1.0, |_| DVec3::ZERO)
}

/// The flight for `span` (r_s/c) under `burn`, in steps of at most half of one.
pub fn flown(point: &Point, span: f64, burn: &PlannedBurn) -> Point {
    let steps = (span * 2.0).ceil().max(1.0);
    (0..steps as usize).fold(*point, |point, _| advance(&point, span / steps, 1.0, |at| burn.acceleration(at, 0.0, 0.0)))
}

/// The proper acceleration (rest-frame axes) that adds `coordinate` to d²x/dT² of free fall.
pub fn proper_acceleration(p: DVec3, coordinate: DVec3) -> DVec3 {
    let gamma = gamma(p);
    let force = (coordinate + p * p.dot(coordinate)) * (gamma * gamma);
    force - p * (p.dot(force) / (gamma * (1.0 + gamma)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn proper_acceleration_gives_the_coordinate_acceleration_asked_for() {
        let point = Point { x: DVec3::new(4.0, 1.0, -2.0), p: DVec3::new(0.4, -0.7, 0.2) };
        let wanted = DVec3::new(0.01, 0.02, -0.03);
        let alpha = proper_acceleration(point.p, wanted);
        let h = 1e-4;
        let free = point.step(h, DVec3::ZERO).velocity();
        let forced = point.step(h, alpha).velocity();
        assert!(((forced - free) / h - wanted).length() < 1e-5);
    }
}
