//! Ships and gyroscopes against closed forms (r_s = c = 1). Nothing here uses the code under test to make its own oracle: numbers in
//! units of M are from 20-digit evaluations of the closed forms named beside them, halved or doubled into r_s.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3, DVec4};
use lensrunner::spacetime::frames::{boost, dot, rain_to_ship, relative_velocity, ship_to_rain};
use lensrunner::spacetime::matter::{
    ShipState, angular_momentum, boosted_acceleration, came_out_of_the_hole, energy, gamma, has_ended, momentum_of, rate, runge_kutta,
    static_speed, step, step_until, velocity,
};
use lensrunner::spacetime::orbit::{Elements, circular_orbit, orbital_frequency, static_momentum};
use proptest::prelude::*;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// Rounding over some 10⁴ steps of order one.
const ROUNDING: f64 = 1e-12;
/// What steps of [`H`] leave after a few hundred r_s/c on stable orbits, ten times what was measured.
const INTEGRATION: f64 = 1e-9;
/// The game's step, r_s/c.
const H: f64 = 0.03125;

fn close(got: f64, want: f64, tolerance: f64, what: &str) {
    assert!((got - want).abs() <= tolerance, "{what}: got {got}, want {want}, off by {:e}, allowed {tolerance:e}", got - want);
}

/// Coasts (or thrusts) for `time` in the game's steps, the last one shorter.
fn fly(start: ShipState, time: f64, thrust: DVec3, rates: DVec3) -> ShipState {
    let count = (time / H).floor();
    let mut now = start;
    for _ in 0..count as u64 {
        now = step(&now, H, thrust, rates);
    }
    let end = step(&now, time - count * H, thrust, rates);
    assert!(end.position.distance(start.position) + end.momentum.distance(start.momentum) > 0.0 || time == 0.0);
    end
}

fn coast(start: ShipState, time: f64) -> ShipState {
    let end = fly(start, time, DVec3::ZERO, DVec3::ZERO);
    assert!(end.proper_time > start.proper_time, "no step was taken");
    end
}

fn resting_at(r: f64) -> ShipState {
    let position = DVec3::new(r, 0.0, 0.0);
    ShipState::new(position, static_momentum(position).expect("outside the horizon"))
}

#[test]
fn circular_orbits_have_the_closed_form_energy_momentum_speed_and_period() {
    // r, E, L, Ω, v_static, T_coord, T_proper in M: (1−2/r)/√(1−3/r), √r/√(1−3/r), r^{-3/2}, 1/√(r−2), 2π/Ω, 2π/(Ωu^t).
    let table = [
        (6.0, 0.942809041582, 3.46410161514, 0.0680413817440, 0.5, 92.3435877717, 65.2967771124),
        (8.0, 0.948683298051, 3.577708764, 0.0441941738242, 0.408248290464, 142.172254021, 112.397035697),
        (10.0, 0.956182887468, 3.77964473009, 0.0316227766017, 0.353553390593, 198.691765316, 166.237457641),
        (20.0, 0.976187060184, 4.85071250073, 0.0111803398875, 0.235702260396, 561.985178483, 518.124733737),
        (100.0, 0.995039241831, 10.1534616513, 0.001, 0.101015254455, 6283.18530718, 6188.21986327),
    ];
    for (r, e, l, omega, v, coordinate, proper) in table {
        let start = circular_orbit(r / 2.0, 0.3).expect("an orbit");
        close(energy(&start), e, 1e-11, "E");
        close(angular_momentum(&start).z, l / 2.0, 1e-10, "L");
        close(orbital_frequency(r / 2.0), omega * 2.0, 1e-12, "frequency");
        close(static_speed(&start).expect("outside"), v, 1e-11, "speed");
        let end = coast(start, coordinate / 2.0);
        close(end.position.distance(start.position), 0.0, 1e-7, "position after one turn");
        close(end.proper_time, proper / 2.0, 1e-8, "proper time of one turn");
        close(energy(&end), energy(&start), ROUNDING, "energy kept");
    }
}

#[test]
fn a_circle_at_4m_leaves_at_the_growth_rate_of_its_instability() {
    // λ_T = Ω√(6/r − 1) = 0.08838834765 / M at r = 4 M.
    let start = circular_orbit(2.0, 0.0).expect("an orbit");
    let nudged = ShipState { momentum: start.momentum * (1.0 + 1e-9), ..start };
    let away = |t: f64| coast(nudged, t).position.length() - coast(start, t).position.length();
    // The mode that dies out as fast must have done so.
    let (early, late) = (40.0, 60.0);
    let growth = (away(late) / away(early)).ln() / (late - early);
    close(growth, 2.0 * 0.08838834765, 2e-4, "growth rate");
}

#[test]
fn radial_falls_take_their_closed_form_times() {
    // From rest at infinity, and from rest at R (cycloid); from, to, τ in M.
    let rain = |r: f64| ShipState::new(DVec3::new(0.0, 0.0, r), DVec3::ZERO);
    for (start, to, tau) in
        [(rain(5.0), 1.0, 13.5737865166653), (resting_at(5.0), 1.0, 33.7008698518923), (resting_at(3.0), 1.0, 14.8269210050055)]
    {
        let at = |time: f64| step(&start, time, DVec3::ZERO, DVec3::ZERO);
        let (mut low, mut high) = (0.0, 40.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if at(middle).position.length() > to { low = middle } else { high = middle }
        }
        close(at(low).proper_time, tau / 2.0, 1e-10, "proper time of the fall");
    }
}

#[test]
fn a_fall_reaches_the_singularity_when_it_must() {
    // 10 M → 0: 14.9071198499986 (rain), 35.1240736552036 (from rest), in M; what is left at 0.01 r_s is under 7e-4.
    for (start, tau) in [(ShipState::new(DVec3::X * 5.0, DVec3::ZERO), 14.9071198499986), (resting_at(5.0), 35.1240736552036)] {
        let (end, covered) = step_until(&start, 100.0, DVec3::ZERO, DVec3::ZERO, |_, _| ());
        assert!(has_ended(&end) && end.is_finite());
        assert!(covered < 100.0);
        let left = tau / 2.0 - end.proper_time;
        assert!((0.0..7e-4).contains(&left), "{left}");
        close(energy(&end), energy(&start), 1e-10, "energy at the singularity");
    }
}

#[test]
fn periapsis_advance_and_periods_are_those_of_elliptic_integrals() {
    // p, e, E, L, Δφ, T_τ, T_t in M; Δφ = 4√(p/(p−6+2e))·K(4e/(p−6+2e)).
    for (p, e, en, l, dphi, proper, coordinate) in [
        (10.0, 0.5, 0.9660917830793, 3.849001794598, 10.05516801018, 377.5340208386, 433.9005423115),
        (12.0, 0.3, 0.9653557425579, 4.020151261037, 8.902518432363, 361.8636125564, 412.9940970502),
        (7.01, 0.5, 0.9562170668868, 3.615131468137, 30.19178902545, 379.4817366014, 513.0103996302),
    ] {
        let elements = Elements { semi_latus_rectum: p / 2.0, eccentricity: e, inclination: 0.0, node: 0.0, phase: 0.0, anomaly: PI };
        let start = elements.state().expect("an orbit");
        close(energy(&start), en, 1e-12, "E");
        close(angular_momentum(&start).z, l / 2.0, 1e-11, "L");
        let end = coast(start, coordinate / 2.0);
        close(end.position.length(), p / 2.0 / (1.0 - e), 1e-7, "back at the apoapsis");
        let azimuth = end.position.y.atan2(end.position.x).rem_euclid(TAU);
        close(azimuth, dphi % TAU, 1e-6, "azimuth");
        close(end.proper_time, proper / 2.0, 1e-7, "proper time");
    }
}

#[test]
fn free_gyroscopes_turn_by_the_geodetic_angle() {
    // 2π(1 − √(1 − 3/r)) per turn, forwards; r, angle, T in M.
    for (r, angle, period) in
        [(6.0, 1.84030236902, 92.3435877717), (10.0, 1.02629532136, 198.691765316), (20.0, 0.490374679884, 561.985178483)]
    {
        let end = coast(circular_orbit(r / 2.0, 0.0).expect("an orbit"), period / 2.0);
        let (axis, turned) = end.attitude.to_axis_angle();
        close(turned * axis.z.signum(), angle, 1e-8, "geodetic angle");
    }
}

#[test]
fn driven_gyroscopes_turn_by_the_fermi_walker_angle() {
    // On any circle: 2π[1 − γ(1 − 3M/r)] with γ = (1 − 2M/r − r²ω²)^{-1/2}; the thrust is outward, γ²(1/r² − rω²)√(1 − 2/r).
    // At 3 M the circle is unstable and quickly left, so only a part of a turn is flown.
    let circles: [[f64; 5]; 3] =
        [[10.0, 0.02, 0.00706126729737, 1.23806981816, 1.0], [3.0, 0.05, 0.19245008973, TAU, 0.1], [3.0, 0.15, 0.19245008973, TAU, 0.3]];
    for [r, omega, known_thrust, gyro, part] in circles {
        let gamma = 1.0 / (1.0 - 2.0 / r - r * r * omega * omega).sqrt();
        let thrust = gamma * gamma * (1.0 / (r * r) - r * omega * omega) * (1.0 - 2.0 / r).sqrt();
        close(thrust, known_thrust, 1e-11, "the thrust that the circle takes");
        let e = gamma * (1.0 - 2.0 / r);
        let l = gamma * r * r * omega;
        let (r, thrust, l, omega) = (r / 2.0, thrust * 2.0, l / 2.0, omega * 2.0);
        let beta = 1.0 / r.sqrt();
        let momentum = DVec3::new(beta * e / (1.0 - beta * beta), l / r, 0.0);
        // The static observer's outward unit vector on the rain tetrad, then on the ship's.
        let hover = 1.0 / (1.0 - beta * beta).sqrt();
        let outward = DVec4::new(hover, 0.0, 0.0, hover * beta);
        let on_ship = boost(momentum) * outward;
        close(on_ship.w, 0.0, ROUNDING, "the thrust is at right angles to the four-velocity");
        // The body turns with the circle: once a turn against the stars, 2π − gyro against a gyroscope.
        let turn_proper = TAU / (omega * gamma);
        let rates = DVec3::Z * ((TAU - gyro) / turn_proper);
        let start = ShipState::new(DVec3::X * r, momentum);
        let end = fly(start, part * TAU / omega, on_ship.truncate() * thrust, rates);
        let turn = DQuat::from_rotation_z(part * TAU);
        close(end.position.distance(turn * start.position), 0.0, 1e-6, "on the circle");
        close(end.momentum.distance(turn * start.momentum), 0.0, 1e-6, "going round it");
        close(end.attitude.dot(turn).abs(), 1.0, 1e-9, "turned with it");
        close(end.proper_time, part * turn_proper, 1e-7, "proper time");
    }
}

#[test]
fn hovering_takes_the_closed_form_thrust() {
    // (M/r²)/√(1 − 2M/r), in M.
    let hovers: [[f64; 2]; 5] =
        [[2.5, 0.3577708764], [3.0, 0.19245008973], [4.0, 0.0883883476483], [6.0, 0.034020690872], [20.0, 0.00263523138347]];
    for [r, thrust] in hovers {
        let start = resting_at(r / 2.0);
        let change = rate(&start, DVec3::X * (2.0 * thrust), DVec3::ZERO);
        close(change.position.length(), 0.0, ROUNDING, "it hovers");
        close(change.momentum.length(), 0.0, 1e-9, "and stays");
        // dτ/dT of a static observer in Painlevé–Gullstrand time is that in Schwarzschild time.
        close(change.proper_time, (1.0 - 2.0 / r).sqrt(), ROUNDING, "its clock runs slow");
    }
}

#[test]
fn radial_thrust_keeps_energy_minus_thrust_times_radius() {
    // a = 0.05/M from rest at r = 10 M: after τ = 40 M, r = 52.1998827194 M and E = 3.0044213270.
    let a = 0.1;
    let start = resting_at(5.0);
    let mut now = start;
    while now.proper_time < 20.0 {
        let span = H.min((20.0 - now.proper_time) * (1.0 + now.momentum.length_squared()).sqrt());
        now = step(&now, span, DVec3::X * a, DVec3::ZERO);
        if span < 1e-13 {
            break;
        }
    }
    close(now.position.x, 52.1998827194 / 2.0, 1e-8, "r");
    close(energy(&now), 3.0044213270, 1e-9, "E");
    close(energy(&now) - a * now.position.x, energy(&start) - a * 5.0, ROUNDING, "E − ar");
}

#[test]
fn without_a_hole_near_thrust_is_the_hyperbola_of_special_relativity() {
    let a = 0.5;
    let start = ShipState::new(DVec3::new(1e8, 0.0, 0.0), DVec3::ZERO);
    let end = fly(start, 10.0, DVec3::Y * a, DVec3::ZERO);
    let tau = (a * 10.0f64).asinh() / a;
    // The rain still falls at 1e-4 c there.
    close(end.proper_time, tau, 1e-6, "τ = asinh(aT)/a");
    close(end.position.y, ((a * tau).cosh() - 1.0) / a, 1e-6, "x = (cosh aτ − 1)/a");
}

#[test]
fn a_gyroscope_on_a_fast_circle_far_away_shows_thomas_precession() {
    // Far from the hole a circle of radius ρ is flown with α = γ²v²/ρ; the gyroscope turns 2π(1 − γ) a turn.
    let (v, rho, far) = (0.6, 2.0, 1e10);
    let gamma = 1.0 / (1.0f64 - v * v).sqrt();
    let period = TAU * rho / v;
    let start = ShipState::new(DVec3::new(rho, 0.0, far), DVec3::Y * (gamma * v));
    // Against a gyroscope the thrust turns γ times a turn.
    let rates = DVec3::Z * (TAU * gamma / (period / gamma));
    let end = fly(start, period, DVec3::NEG_X * (gamma * gamma * v * v / rho), rates);
    let shift = end.position - start.position;
    close(shift.truncate().length(), 0.0, 1e-6, "the circle closes");
    close(end.attitude.w.abs(), 1.0, 1e-9, "thrust and gyroscope agree");
}

/// Fast, slow, powered and free, outside and inside.
fn any_state() -> impl Strategy<Value = ShipState> {
    let direction =
        || (0.0..TAU, -1.0..1.0f64).prop_map(|(a, z)| DVec3::new((1.0 - z * z).sqrt() * a.cos(), (1.0 - z * z).sqrt() * a.sin(), z));
    (0.3..30.0f64, direction(), 0.0..3.0f64, direction(), direction(), 0.0..PI)
        .prop_map(|(r, n, p, m, axis, angle)| ShipState { attitude: DQuat::from_axis_angle(axis, angle), ..ShipState::new(n * r, m * p) })
}

proptest! {
    #![proptest_config(crate::support::fixed(200))]

    #[test]
    fn coasting_keeps_energy_and_angular_momentum(start in any_state()) {
        let (end, covered) = step_until(&start, 5.0, DVec3::ZERO, DVec3::ZERO, |_, _| ());
        prop_assert!(covered > 0.0 && end.position != start.position);
        // Near the singularity p grows as 1/r and its rounding with it.
        let scale = 1.0 + end.momentum.length();
        prop_assert!((energy(&end) - energy(&start)).abs() < INTEGRATION * scale, "{} {}", energy(&end), energy(&start));
        prop_assert!(angular_momentum(&end).distance(angular_momentum(&start)) < INTEGRATION * scale);
    }

    #[test]
    fn proper_time_runs_at_most_as_fast_as_t(start in any_state(), thrust in -0.5..0.5f64) {
        let (end, covered) = step_until(&start, 1.0, DVec3::new(0.0, thrust, 0.1), DVec3::ZERO, |_, _| ());
        prop_assert!(covered > 0.0 && end.proper_time > 0.0 && end.proper_time < covered);
    }

    #[test]
    fn thrust_does_the_work_that_it_should(start in any_state(), x in -0.3..0.3f64, z in -0.3..0.3f64) {
        // dE/dτ = A⁰ − βn·A and dL/dτ = x × A with A = α + p(p·α)/(1+γ), A⁰ = p·α.
        let thrust = DVec3::new(x, 0.05, z);
        let h = 1e-3 * start.position.length().min(1.0);
        let (back, ahead) = (step(&start, -h, thrust, DVec3::ZERO), step(&start, h, thrust, DVec3::ZERO));
        let d_tau = ahead.proper_time - back.proper_time;
        let alpha = start.attitude * thrust;
        let a = boosted_acceleration(start.momentum, alpha);
        let r = start.position.length();
        let work = start.momentum.dot(alpha) - start.position.dot(a) / (r * r.sqrt());
        let torque = start.position.cross(a);
        prop_assert!(((energy(&ahead) - energy(&back)) / d_tau - work).abs() < 2e-4);
        prop_assert!(((angular_momentum(&ahead) - angular_momentum(&back)) / d_tau).distance(torque) < 2e-3);
    }

    #[test]
    fn momentum_is_found_from_the_velocity(state in any_state()) {
        // Rounding of v is multiplied by dp/dv = γ³, 32 here at most.
        let back = momentum_of(state.position, velocity(&state)).unwrap();
        prop_assert!(back.distance(state.momentum) < ROUNDING, "{back} of {state:?}");
        // Light goes past the rain at c, and nothing faster.
        let n = state.position.normalize();
        prop_assert!(momentum_of(state.position, n * (1.001 - 1.0 / state.position.length().sqrt())).is_none());
    }

    #[test]
    fn the_way_back_leads_home(start in any_state(), x in -0.3..0.3f64) {
        let (thrust, rates) = (DVec3::new(x, 0.1, -0.1), DVec3::new(0.3, x, -0.2));
        let (there, covered) = step_until(&start, 0.25, thrust, rates, |_, _| ());
        prop_assume!(covered == 0.25 && there.position.length() > 0.1);
        let home = step(&there, -0.25, thrust, rates);
        prop_assert!(home.position.distance(start.position) < 1e-8, "{home:?}");
        prop_assert!(home.attitude.dot(start.attitude).abs() > 1.0 - 1e-10);
    }

    #[test]
    fn the_ship_tetrad_is_orthonormal_and_undone_by_its_inverse(state in any_state()) {
        let there = rain_to_ship(state.momentum, state.attitude);
        let back = ship_to_rain(state.momentum, state.attitude);
        prop_assert!((there * back).abs_diff_eq(glam::DMat4::IDENTITY, 1e-12));
        let rest = there * state.momentum.extend(gamma(state.momentum));
        prop_assert!((rest - DVec4::W).length() < 1e-12, "the ship rests in its own frame");
        for (i, a) in [back.x_axis, back.y_axis, back.z_axis, back.w_axis].iter().enumerate() {
            for (j, b) in [back.x_axis, back.y_axis, back.z_axis, back.w_axis].iter().enumerate() {
                let want = if i != j { 0.0 } else if i == 3 { -1.0 } else { 1.0 };
                prop_assert!((dot(*a, *b) - want).abs() < 1e-11);
            }
        }
    }
}

#[test]
fn only_the_fall_from_rest_at_infinity_keeps_pace_with_t() {
    let rain = ShipState::new(DVec3::new(3.0, -4.0, 1.0), DVec3::ZERO);
    let end = coast(rain, 5.0);
    close(end.proper_time, 5.0, ROUNDING, "τ = T");
    let pushed = coast(ShipState { momentum: DVec3::X * 0.01, ..rain }, 5.0);
    assert!(pushed.proper_time < 5.0 - 1e-5);
}

#[test]
fn relative_velocity_adds_as_in_special_relativity() {
    let p = |v: f64| DVec3::X * (v / (1.0 - v * v).sqrt());
    close(relative_velocity(p(0.5), p(-0.5)).x, -0.8, ROUNDING, "(0.5 + 0.5)/(1 + 0.25)");
    close(velocity(&resting_at(3.0)).length(), 0.0, ROUNDING, "a static observer stays");
}

/// The closed form against the orbit itself, followed backwards until it turns or is at the horizon.
#[test]
fn what_came_out_of_the_hole_is_known_by_its_constants() {
    let mut random = StdRng::seed_from_u64(7);
    let mut direction = move || DVec3::from_array([0; 3].map(|_| random.random_range(-1.0..1.0)));
    let mut counts = [0; 2];
    for _ in 0..120 {
        let position = direction() * 12.0;
        if position.length() < 1.05 {
            continue;
        }
        let state = ShipState::new(position, position.normalize() * 1.5 + direction() * 1.5);
        let rising = |state: &ShipState| velocity(state).dot(state.position) > 0.0;
        let mut now = state;
        // Followed backwards what rises comes from below.
        while rising(&now) && now.position.length() > 1.001 {
            let h = 0.01 * (now.position.length() - 1.0).min(1.0) / (1.0 + now.momentum.length()).min(4.0);
            now = runge_kutta(&now, -h, DVec3::ZERO, DVec3::ZERO);
        }
        let came_out = rising(&state) && now.position.length() <= 1.001;
        assert_eq!(came_out_of_the_hole(&state), came_out, "{state:?}");
        counts[usize::from(came_out)] += 1;
    }
    assert!(counts.into_iter().min() > Some(6), "{counts:?}");
}

/// Circles, unstable ones too, were always there; so was what flies by. What is dropped was thrown up from the hole.
#[test]
fn circles_never_came_out_of_the_hole() {
    for radius in [1.55, 1.6, 1.8, 2.0, 2.25, 2.5, 2.75, 3.0, 3.05, 6.0, 40.0] {
        for k in 0..40 {
            let elements = Elements { inclination: 0.07 * f64::from(k), node: 0.3, ..Elements::circle(radius, 0.9 * f64::from(k)) };
            assert!(!came_out_of_the_hole(&elements.state().unwrap()), "r = {radius}, {k}");
        }
    }
    for radius in [1.01, 2.0, 6.0, 1e4] {
        let position = DVec3::new(0.6, -0.3, 0.5).normalize() * radius;
        assert!(came_out_of_the_hole(&ShipState::new(position, static_momentum(position).unwrap())), "r = {radius}");
    }
}
