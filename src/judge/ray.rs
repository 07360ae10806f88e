//! The light that reaches a camera from one look direction, followed backwards in time with dense output.

use glam::{DVec2, DVec3};

use super::geodesic::{Segment, State};

/// Where to stop following a ray, besides its capture; each limit ends the ray at the first step past it.
#[derive(Clone, Copy, Debug)]
pub struct Stop {
    /// Stop when the ray is past this radius (r_s) and can only move outwards.
    pub radius: f64,
    /// Stop when this angle (radians) has been swept.
    pub swept: f64,
    /// Stop when the delay (r_s/c) is past this.
    pub delay: f64,
    /// Stop when a captured ray has come this close to r = 1 (r_s).
    pub horizon_gap: f64,
    /// But not before this delay (r_s/c): until then it may meet what crossed the horizon.
    pub clings_until: f64,
}

impl Default for Stop {
    /// Follows every ray until it is clear of the hole or within 1e-6 of the horizon.
    fn default() -> Self {
        Stop { radius: 100.0, swept: f64::INFINITY, delay: f64::INFINITY, horizon_gap: 1e-6, clings_until: 0.0 }
    }
}

/// Why a ray ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// It passed `Stop::radius` on its way to infinity.
    Escaped,
    /// Followed backwards it clings to r = 1 for ever: it shows the shadow, but for what hovers at the horizon.
    Captured,
    /// `Stop::swept` or `Stop::delay` was reached first.
    Limit,
    /// [`MAX_STEPS`] were not enough (only for rays that wind at the photon sphere to within rounding).
    Steps,
}

/// No ray needs more steps than this: 3 steps a radian at the photon sphere, 5 for each factor e in r.
pub const MAX_STEPS: usize = 2000;

/// The end of light followed backwards to where it came from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RayFate {
    /// It shows the shadow.
    Captured,
    /// It came from the sky.
    Escaped {
        /// Unit vector from the hole to the place on the sky that is seen.
        direction: DVec3,
        /// The angle Φ∞ swept around the hole, radians.
        swept: f64,
    },
}

/// The ray at one moment.
#[derive(Clone, Copy, Debug)]
pub struct RaySample {
    /// x in r_s.
    pub position: DVec3,
    /// Rain-frame momentum towards the future, in units of the frequency that a rain observer at the camera sees.
    pub momentum: DVec3,
    /// The angle Φ swept around the hole since the camera, radians.
    pub swept: f64,
    /// T_camera − T, r_s/c.
    pub delay: f64,
}

/// A null geodesic followed from a camera backwards in time.
#[derive(Clone, Debug)]
pub struct TracedRay {
    /// The plane of the orbit: `axes[0]` points from the hole to the camera, `axes[1]` the way the ray sweeps.
    pub axes: [DVec3; 2],
    /// The steps, in order of delay.
    pub segments: Vec<Segment>,
    /// Φ at the start of each segment, and at the end of the last.
    pub swept: Vec<f64>,
    /// Why it ended.
    pub end: End,
}

impl TracedRay {
    /// Follows the light seen in direction `look` (rain frame, any length but zero) by a camera at `position` (r_s from the hole,
    /// not zero) with a local error of `tolerance` in each step.
    pub fn trace(position: DVec3, look: DVec3, tolerance: f64, stop: &Stop) -> TracedRay {
        let (axes, in_plane) = orbit_plane(position, look);
        let mut ray = TracedRay::trace_in_plane(position.length(), in_plane, tolerance, stop);
        ray.axes = axes;
        ray
    }

    /// The same in the plane of the orbit: the camera at (`radius`, 0), `look` in the rain frame with look.y ≥ 0.
    pub fn trace_in_plane(radius: f64, look: DVec2, tolerance: f64, stop: &Stop) -> TracedRay {
        let mut follower = RayFollower::new(radius, look, tolerance, *stop);
        let mut ray = TracedRay { axes: [DVec3::X, DVec3::Y], segments: Vec::with_capacity(32), swept: vec![0.0], end: End::Steps };
        while let Some(segment) = follower.step() {
            ray.segments.push(segment);
            ray.swept.push(follower.swept);
        }
        ray.end = follower.end.unwrap_or(End::Steps);
        ray
    }

    /// The delay at which the ray ends, r_s/c.
    pub fn last_delay(&self) -> f64 {
        self.segments.last().map_or(0.0, Segment::end)
    }

    /// The ray at `delay`, or None outside of what was followed.
    pub fn at_delay(&self, delay: f64) -> Option<RaySample> {
        if !(0.0..=self.last_delay()).contains(&delay) {
            return None;
        }
        let i = self.segments.partition_point(|s| s.start <= delay).saturating_sub(1);
        Some(self.sample(i, delay - self.segments[i].start))
    }

    /// The ray where it has swept Φ = `swept`, or None where it never does in what was followed. A radial ray sweeps nothing.
    pub fn at_swept(&self, swept: f64) -> Option<RaySample> {
        let (i, elapsed) = self.find_swept(swept)?;
        Some(self.sample(i, elapsed))
    }

    pub(super) fn find_swept(&self, swept: f64) -> Option<(usize, f64)> {
        let last = *self.swept.last()?;
        if !(swept >= 0.0 && swept <= last && last > 0.0) {
            return None;
        }
        let i = self.swept.partition_point(|&s| s < swept).saturating_sub(1);
        let segment = &self.segments[i];
        // a·x = 0 on the half line at angle `swept`, rising because Φ does.
        let a = DVec2::new(-swept.sin(), swept.cos());
        Some((i, segment.cross_line(a, 0.0, 0.0, segment.length)))
    }

    /// The sample `elapsed` after the start of segment `index`.
    pub fn sample(&self, index: usize, elapsed: f64) -> RaySample {
        let segment = &self.segments[index];
        let state = segment.at(elapsed);
        RaySample {
            position: self.embed(state.position),
            momentum: self.embed(state.momentum),
            swept: unwrap(state.position.y.atan2(state.position.x), self.swept[index]),
            delay: segment.start + elapsed,
        }
    }

    /// Φ∞ of a ray that ended as `Escaped`, else None.
    pub fn sky_swept(&self) -> Option<f64> {
        if self.end != End::Escaped {
            return None;
        }
        let segment = self.segments.last()?;
        Some(self.swept.last()? + swept_beyond(&segment.at(segment.length)))
    }

    /// From the plane of the orbit to space.
    pub fn embed(&self, v: DVec2) -> DVec3 {
        self.axes[0] * v.x + self.axes[1] * v.y
    }
}

/// The plane of the orbit of light seen in direction `look` (any length but zero) from `position`: its two axes, and the unit look in them.
pub(super) fn orbit_plane(position: DVec3, look: DVec3) -> ([DVec3; 2], DVec2) {
    let outward = position.normalize();
    let look = look.normalize();
    let across = look - outward * look.dot(outward);
    let sine = across.length();
    let sideways = if sine > 0.0 { across / sine } else { outward.any_orthonormal_vector() };
    ([outward, sideways], DVec2::new(look.dot(outward), sine))
}

/// A ray on its way, one step at a time: who finds what he looks for need not follow it to its end.
#[derive(Clone, Debug)]
pub struct RayFollower {
    state: State,
    delay: f64,
    /// Φ swept up to now, radians.
    pub swept: f64,
    tolerance: f64,
    stop: Stop,
    /// Light of negative energy never leaves the inside.
    doomed: bool,
    steps: usize,
    /// Why the ray ended, once it has.
    pub end: Option<End>,
}

impl RayFollower {
    /// A ray from a camera at (`radius`, 0) in the plane of its orbit, seen in direction `look` (rain frame, look.y ≥ 0).
    pub fn new(radius: f64, look: DVec2, tolerance: f64, stop: Stop) -> RayFollower {
        let state = State { position: DVec2::new(radius, 0.0), momentum: -look };
        RayFollower { state, delay: 0.0, swept: 0.0, tolerance, stop, doomed: state.energy() <= 0.0, steps: 0, end: None }
    }

    /// The next step of the ray; None once it has ended.
    pub fn step(&mut self) -> Option<Segment> {
        if self.end.is_some() {
            return None;
        }
        let segment = Segment::step(self.delay, self.state, self.tolerance);
        self.advance(segment.end(), segment.at(segment.length));
        Some(segment)
    }

    /// Where the next step begins: the delay (r_s/c) and the light then.
    pub fn here(&self) -> (f64, State) {
        (self.delay, self.state)
    }

    /// Takes the step that ends at this delay (r_s/c) in this state.
    pub fn advance(&mut self, delay: f64, state: State) {
        (self.delay, self.state) = (delay, state);
        self.swept = unwrap(self.state.position.y.atan2(self.state.position.x), self.swept);
        self.steps += 1;
        let r = self.state.position.length();
        let outwards = self.state.radial_rate() > 0.0;
        if self.swept >= self.stop.swept || self.delay >= self.stop.delay {
            self.end = Some(End::Limit);
        } else if (self.doomed || is_captured(r, outwards))
            && (r - 1.0).abs() <= self.stop.horizon_gap
            && self.delay >= self.stop.clings_until
        {
            self.end = Some(End::Captured);
        } else if is_escaping(r, outwards) && r >= self.stop.radius {
            self.end = Some(End::Escaped);
        } else if self.steps >= MAX_STEPS {
            self.end = Some(End::Steps);
        }
    }

    /// The energy of the light, in units of the frequency that a rain observer at the camera sees.
    pub fn energy(&self) -> f64 {
        self.state.energy()
    }

    /// Φ∞ of a ray that has escaped, else None.
    pub fn sky_swept(&self) -> Option<f64> {
        (self.end == Some(End::Escaped)).then(|| self.swept + swept_beyond(&self.state))
    }
}

/// Whether light followed backwards is captured for certain. In an affine parameter d²r = b²(r − 3/2)/r⁴ has the sign of
/// r − 3/2, so outside the horizon what moves inwards below 3/2 does so for ever.
fn is_captured(r: f64, outwards: bool) -> bool {
    !outwards && r < 1.5
}

/// Whether light followed backwards escapes for certain, by the same law.
fn is_escaping(r: f64, outwards: bool) -> bool {
    outwards && r > 1.5
}

/// Where the light seen in direction `look` (rain frame) by a camera at `position` came from. The verdict is exact: a ray is
/// followed until the sign of d²r forbids a return, never judged by a distance or a number of steps.
pub fn fate(position: DVec3, look: DVec3, tolerance: f64) -> RayFate {
    let ray =
        TracedRay::trace(position, look, tolerance, &Stop { radius: sky_radius(position.length()), horizon_gap: 0.5, ..Stop::default() });
    match ray.sky_swept() {
        Some(swept) => RayFate::Escaped { direction: ray.embed(DVec2::from_angle(swept)), swept },
        None => RayFate::Captured,
    }
}

/// From this radius on the rest of the way is known without steps: at least four times any impact parameter seen by a camera
/// at `camera` (b ≤ r_p/√(1 − 1/r_p) for a closest approach r_p ≤ r).
pub fn sky_radius(camera: f64) -> f64 {
    5.0 * camera.max(5.0)
}

/// The angle that outward light still sweeps between here and infinity: ∫ b dr/(r² √(1 − (b²/r²)(1 − 1/r))) in u = 1/r, with
/// b = L/E, by Gauss and Legendre in eight points. Where b/r ≤ 1/4 the nearest singularity lies 7 half-lengths from the middle, so the
/// error is below 14^-16.
fn swept_beyond(state: &State) -> f64 {
    const NODES: [f64; 4] = [0.183_434_642_495_649_8, 0.525_532_409_916_329, 0.796_666_477_413_626_7, 0.960_289_856_497_536_3];
    const WEIGHTS: [f64; 4] = [0.362_683_783_378_362, 0.313_706_645_877_887_3, 0.222_381_034_453_374_48, 0.101_228_536_290_376_26];
    let b = (state.angular_momentum() / state.energy()).abs();
    let u = 1.0 / state.position.length();
    let rate = |v: f64| b / (1.0 - b * b * v * v * (1.0 - v)).sqrt();
    let half = 0.5 * u;
    NODES.iter().zip(WEIGHTS).map(|(&x, w)| w * half * (rate(half * (1.0 + x)) + rate(half * (1.0 - x)))).sum()
}

/// The angle `raw` (from atan2) with whole turns added so that it follows `previous`; a step turns by less than half a turn.
pub(super) fn unwrap(raw: f64, previous: f64) -> f64 {
    use std::f64::consts::TAU;
    raw + TAU * ((previous - raw) / TAU).round()
}
