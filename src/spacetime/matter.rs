//! Ships and gyroscopes: powered and free motion in Painlevé–Gullstrand phase space, r_s = c = 1.
//!
//! A four-velocity is u = γe₀ + pⁱeᵢ on the rain tetrad (e₀ = ∂_T − βn·∂, eᵢ = ∂ᵢ), so the mass shell is γ = √(1 + p²) by construction.
//! With g = (β/r)[p − (3/2)(n·p)n], the tidal pull of the river, and α the proper acceleration in the ship's rest frame (axes by pure
//! boost),
//!
//! * dx/dT = p/γ − βn
//! * dp/dT = g + [α + p(p·α)/(1+γ)]/γ
//! * dτ/dT = 1/γ
//! * dq/dT = ½(Ω/γ)q + ½q(ω/γ), Ω = p × (g − α)/(1+γ): Fermi–Walker transport (gravity and Thomas parts) and the commanded body rates ω.
//!
//! Regular for every r > 0. Each step uses + − × ÷ √ only, which IEEE 754 rounds exactly: a replay has the same bits on every processor.

use glam::{DQuat, DVec3};

use super::metric::river_speed;
use super::tableau;

/// A ship is taken to have reached the singularity here, in r_s. A fall from rest at infinity has (2/3)·r^{3/2} = 7·10⁻⁴ r_s/c left.
pub const SINGULARITY_RADIUS: f64 = 0.01;

/// The largest share of the ship's shortest time scale that one Runge–Kutta step covers; [`substeps`] has the rule.
/// 1/8 keeps the energy of a fall to the singularity to 1e-11; farther out than 2 r_s the game's own step is shorter anyway.
pub const STEP_SHARE: f64 = 0.125;

/// The number of Runge–Kutta steps one call of [`step`] may take; reached only by absurd thrust, rates or step lengths.
const MAX_SUBSTEPS: u32 = 1 << 20;

/// What moves: one ship, at one instant T.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShipState {
    /// Position x on the flat slice T = const, in r_s; the hole is at the origin.
    pub position: DVec3,
    /// Rain-frame spatial momentum per mass, p = γv, in c.
    pub momentum: DVec3,
    /// Turns body axes into rain axes, through the pure boost of `momentum`. Body axes: +x right, +y up, −z forward.
    pub attitude: DQuat,
    /// Proper time τ, in r_s/c.
    pub proper_time: f64,
}

/// d/dT of a [`ShipState`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShipRate {
    /// dx/dT, in c.
    pub position: DVec3,
    /// dp/dT, in c²/r_s.
    pub momentum: DVec3,
    /// dq/dT, in c/r_s.
    pub attitude: DQuat,
    /// dτ/dT.
    pub proper_time: f64,
}

impl ShipState {
    /// A ship at `position` with rain-frame momentum `momentum`, body axes along the rain axes, τ = 0.
    pub fn new(position: DVec3, momentum: DVec3) -> Self {
        ShipState { position, momentum, attitude: DQuat::IDENTITY, proper_time: 0.0 }
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        self.position.is_finite() && self.momentum.is_finite() && self.attitude.is_finite() && self.proper_time.is_finite()
    }

    /// The state a span `h` of T on at this rate: what every Runge–Kutta method is made of.
    pub fn plus(&self, h: f64, rate: &ShipRate) -> ShipState {
        ShipState {
            position: self.position + rate.position * h,
            momentum: self.momentum + rate.momentum * h,
            attitude: self.attitude + rate.attitude * h,
            proper_time: self.proper_time + rate.proper_time * h,
        }
    }
}

impl ShipRate {
    /// Nothing changes.
    pub const ZERO: ShipRate =
        ShipRate { position: DVec3::ZERO, momentum: DVec3::ZERO, attitude: DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), proper_time: 0.0 };

    /// This and `weight` times `other`.
    pub fn plus(&self, weight: f64, other: &ShipRate) -> ShipRate {
        ShipRate {
            position: self.position + other.position * weight,
            momentum: self.momentum + other.momentum * weight,
            attitude: self.attitude + other.attitude * weight,
            proper_time: self.proper_time + other.proper_time * weight,
        }
    }
}

/// γ = u⁰ = dT/dτ = √(1 + p²), the Lorentz factor against the rain frame.
pub fn gamma(momentum: DVec3) -> f64 {
    (1.0 + momentum.length_squared()).sqrt()
}

/// dx/dT = p/γ − βn, in c: the velocity over the flat slices.
pub fn velocity(state: &ShipState) -> DVec3 {
    let r = state.position.length();
    state.momentum / gamma(state.momentum) - state.position * (river_speed(r) / r)
}

/// The inverse of [`velocity`]: the rain-frame momentum per mass p (in c, on the rain tetrad's axes) of what is at `position` (r_s, on the
/// slice T = const) and has dx/dT = `velocity` there (in c). None where nothing can move so, at the speed of light or faster against the
/// rain.
pub fn momentum_of(position: DVec3, velocity: DVec3) -> Option<DVec3> {
    // Against the rain, which falls with −βn.
    let r = position.length();
    let v = velocity + position * (river_speed(r) / r);
    let square = v.length_squared();
    (square < 1.0).then(|| v / (1.0 - square).sqrt())
}

/// g = (β/r)[p − (3/2)(n·p)n], in c²/r_s: dp/dT of free fall.
pub fn tidal_pull(position: DVec3, momentum: DVec3) -> DVec3 {
    let r_squared = position.length_squared();
    let r = r_squared.sqrt();
    let stretch = 1.0 / (r * r.sqrt());
    (momentum - position * (1.5 * position.dot(momentum) / r_squared)) * stretch
}

/// d/dT of `state` under the proper acceleration `thrust` (body axes, c²/r_s) and the body rates `rates` (body axes, rad per proper r_s/c).
pub fn rate(state: &ShipState, thrust: DVec3, rates: DVec3) -> ShipRate {
    let ShipState { position, momentum, attitude, .. } = *state;
    let gamma = gamma(momentum);
    let per_gamma = 1.0 / gamma;
    let r_squared = position.length_squared();
    let r = r_squared.sqrt();
    let stretch = 1.0 / (r * r.sqrt());
    let pull = (momentum - position * (1.5 * position.dot(momentum) / r_squared)) * stretch;
    let acceleration = attitude * thrust;
    let boosted = acceleration + momentum * (momentum.dot(acceleration) / (1.0 + gamma));
    let spin = momentum.cross(pull - acceleration) * (per_gamma / (1.0 + gamma));
    ShipRate {
        position: momentum * per_gamma - position * stretch,
        momentum: pull + boosted * per_gamma,
        attitude: (pure(spin) * attitude + attitude * pure(rates * per_gamma)) * 0.5,
        proper_time: per_gamma,
    }
}

/// How many Runge–Kutta steps a span of `h` is cut into: the ship's relative change per unit T, |dx/dT|/r from the fastest it can be,
/// and the turning of thrust and body, must stay under [`STEP_SHARE`] a step.
pub fn substeps(state: &ShipState, h: f64, thrust: DVec3, rates: DVec3) -> u32 {
    let r = state.position.length();
    let hurry = (1.0 + river_speed(r)) / r + thrust.length() + rates.length();
    let wanted = (h.abs() * hurry / STEP_SHARE).ceil();
    if wanted >= f64::from(MAX_SUBSTEPS) { MAX_SUBSTEPS } else { (wanted as u32).max(1) }
}

/// The state a span `h` of T later (or earlier, h < 0), under constant body-axes `thrust` (c²/r_s) and `rates` (rad per proper r_s/c).
///
/// Deterministic substeps: near the hole the span is cut again after each substep, by [`substeps`]. Stops early once the ship is at
/// [`SINGULARITY_RADIUS`] or below; [`step_until`] says when that was.
pub fn step(state: &ShipState, h: f64, thrust: DVec3, rates: DVec3) -> ShipState {
    step_until(state, h, thrust, rates, |_, _| ()).0
}

/// As [`step`], calling `visit(elapsed, state)` after every substep, and returning also how much of `h` was really covered.
pub fn step_until(state: &ShipState, h: f64, thrust: DVec3, rates: DVec3, mut visit: impl FnMut(f64, &ShipState)) -> (ShipState, f64) {
    let mut now = *state;
    let mut elapsed = 0.0;
    while elapsed != h && !has_ended(&now) {
        let left = h - elapsed;
        let n = substeps(&now, left, thrust, rates);
        let span = if n == 1 { left } else { left / f64::from(n) };
        if n > 1 && elapsed + span == elapsed {
            break; // shorter than rounding: no further progress is possible
        }
        now = runge_kutta(&now, span, thrust, rates);
        elapsed = if n == 1 { h } else { elapsed + span };
        visit(elapsed, &now);
    }
    (now, elapsed)
}

/// Whether the ship is at the singularity, or its numbers have failed.
pub fn has_ended(state: &ShipState) -> bool {
    !state.is_finite() || state.position.length_squared() <= SINGULARITY_RADIUS * SINGULARITY_RADIUS
}

/// One step of order 8 with 12 evaluations of [`rate`] (Hairer, Nørsett, Wanner, *Solving Ordinary Differential Equations I*, section II.5,
/// DOP853), the attitude brought back to unit length.
pub fn runge_kutta(state: &ShipState, h: f64, thrust: DVec3, rates: DVec3) -> ShipState {
    let mut slopes = [ShipRate::ZERO; tableau::STAGES];
    slopes[0] = rate(state, thrust, rates);
    for stage in 1..tableau::STAGES {
        let mean = weighted(&slopes, tableau::NODES[stage - 1]);
        slopes[stage] = rate(&state.plus(h, &mean), thrust, rates);
    }
    let mut end = state.plus(h, &weighted(&slopes, tableau::WEIGHTS));
    let length_squared = end.attitude.length_squared();
    end.attitude *= 1.0 / length_squared.sqrt();
    end
}

fn weighted(slopes: &[ShipRate], weights: &[(usize, f64)]) -> ShipRate {
    weights.iter().fold(ShipRate::ZERO, |sum, &(stage, weight)| sum.plus(weight, &slopes[stage]))
}

fn pure(v: DVec3) -> DQuat {
    DQuat::from_xyzw(v.x, v.y, v.z, 0.0)
}

/// The proper acceleration `acceleration` (rest-frame axes by pure boost, c²/r_s) in rain components: A = α + p(p·α)/(1+γ), with A⁰ = p·α.
pub fn boosted_acceleration(momentum: DVec3, acceleration: DVec3) -> DVec3 {
    acceleration + momentum * (momentum.dot(acceleration) / (1.0 + gamma(momentum)))
}

/// Below this part of its γ a radial velocity is none, and below this the potential is level: a million times the rounding of a state.
const AT_REST: f64 = 1e-9;

/// Whether a free orbit through this state, followed backwards, goes down to r = 1 without turning: outside the horizon it came out of the
/// white hole, which no ship in this game did. It rises, (dr/dτ)² = E² − V(r) with V = (1 − 1/r)(1 + L²/r²), and V has no peak below it
/// that is higher than E²; the peak of V lies at r = L² − L√(L² − 3) (Chandrasekhar 1983, section 19).
///
/// Unstable circles are left to free orbits: followed far backwards rounding makes them leave, to either side.
pub fn came_out_of_the_hole(state: &ShipState) -> bool {
    let r = state.position.length();
    let g = gamma(state.momentum);
    let rising = state.momentum.dot(state.position) / r - river_speed(r) * g;
    let squared = angular_momentum(state).length_squared();
    if r <= 1.0 || rising < -AT_REST * g {
        return false;
    }
    // What neither rises nor falls is at the highest point of its orbit if V rises there; where V is level it is on a circle, which it
    // never left.
    let steepness = 1.0 - squared * (2.0 * r - 3.0) / (r * r);
    if rising < AT_REST * g && steepness < AT_REST {
        return false;
    }
    let Some([_, height]) = barrier(squared).filter(|[peak, _]| r > *peak) else { return true };
    let e = energy(state);
    e * e > height
}

/// The barrier of V for L² = `squared` (r_s²c²): the radius of its peak, in r_s, and V there; None where there is none.
pub fn barrier(squared: f64) -> Option<[f64; 2]> {
    let peak = squared - (squared * (squared - 3.0).max(0.0)).sqrt();
    (squared > 3.0).then(|| [peak, (1.0 - 1.0 / peak) * (1.0 + squared / (peak * peak))])
}

/// Energy per mass E = −u·∂_T = γ − βn·p, constant without thrust.
pub fn energy(state: &ShipState) -> f64 {
    let r = state.position.length();
    gamma(state.momentum) - state.position.dot(state.momentum) * (river_speed(r) / r)
}

/// Angular momentum per mass L = x × p, in r_s·c, constant without thrust.
pub fn angular_momentum(state: &ShipState) -> DVec3 {
    state.position.cross(state.momentum)
}

/// The speed, in c, that a static observer at the ship's place measures; None where none exists (r ≤ 1).
pub fn static_speed(state: &ShipState) -> Option<f64> {
    let r = state.position.length();
    let e = energy(state);
    (r > 1.0).then(|| (1.0 - (1.0 - 1.0 / r) / (e * e)).max(0.0).sqrt())
}

/// dt/dτ = E/(1 − 1/r), the rate of the far clock as Schwarzschild time; None for r ≤ 1.
pub fn far_clock_rate(state: &ShipState) -> Option<f64> {
    let r = state.position.length();
    (r > 1.0).then(|| energy(state) / (1.0 - 1.0 / r))
}
