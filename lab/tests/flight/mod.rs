//! The chart of integrators: orders of convergence, and the reference against closed forms.

use std::f64::consts::{PI, TAU};

use lensrunner::spacetime::orbit::orbital_frequency;
use lensrunner_lab::flight::cases::{self, DROP, ECCENTRIC_PERIOD, FlightCase};
use lensrunner_lab::flight::measure::Errors;
use lensrunner_lab::flight::methods::{Effort, Method, fly};
use lensrunner_lab::flight::truth::{Drive, energy, later};

fn case(name: &str) -> FlightCase {
    cases::all().unwrap().into_iter().find(|case| case.name == name).unwrap()
}

/// One period of the eccentric orbit: the error of a method of order n falls by 2ⁿ where its step is halved.
#[test]
fn methods_have_their_orders() {
    let orbit = FlightCase { span: ECCENTRIC_PERIOD, ..case("eccentric") };
    let truth = orbit.truth();
    let phase = |method, steps| Errors::of(&fly(method, &orbit, Effort::Steps(steps)), &truth).phase;
    // Before steps are short terms of higher orders count as well; of DOP853 they still do where it meets rounding.
    for (method, steps, orders) in [
        (Method::Rk4, 256, 3.65..4.8),
        (Method::Split2, 256, 1.65..2.8),
        (Method::Split4, 64, 3.65..4.8),
        (Method::Dopri5, 64, 4.65..5.8),
        (Method::Dop853, 4, 7.65..10.0),
    ] {
        let (coarse, fine) = (phase(method, steps), phase(method, 2 * steps));
        let found = (coarse / fine).log2();
        assert!(orders.contains(&found), "{method:?}: {found:.2} from {coarse:e} to {fine:e}");
    }
}

/// With the engine on the splitting keeps its order, too.
#[test]
fn splittings_keep_their_orders_under_thrust() {
    let powered = FlightCase { span: 50.0, ..case("powered") };
    let truth = powered.truth();
    let phase = |method, steps| Errors::of(&fly(method, &powered, Effort::Steps(steps)), &truth).phase;
    for (method, order) in [(Method::Split2, 2.0), (Method::Split4, 4.0)] {
        let found = (phase(method, 32) / phase(method, 64)).log2();
        assert!((found - order).abs() < 0.35, "{method:?}: {found:.2}");
    }
}

/// Steps by tolerance hold what is asked for, within what errors gather over a period.
#[test]
fn tolerances_are_kept() {
    let orbit = FlightCase { span: ECCENTRIC_PERIOD, ..case("eccentric") };
    let truth = orbit.truth();
    for method in [Method::Dopri5, Method::Dop853] {
        for tolerance in [1e-6, 1e-9, 1e-12] {
            let errors = Errors::of(&fly(method, &orbit, Effort::Tolerance(tolerance)), &truth);
            assert!(errors.phase < 1e3 * tolerance && errors.energy < 1e2 * tolerance, "{method:?} {tolerance:e}: {errors:?}");
        }
    }
}

#[test]
fn the_reference_is_that_of_closed_forms() {
    // A circle at r = 3: φ = ΩT, τ = T √(1 − 3/(2r)).
    let circle = case("circle");
    let turn = TAU / orbital_frequency(3.0);
    let [r, phi, _, momentum, _, tau] = later(circle.polar(), turn, Drive::default());
    assert!((r - 3.0).abs() < 1e-11 && (phi - TAU).abs() < 1e-11, "{r} {phi}");
    assert!((tau - turn * 0.5f64.sqrt()).abs() < 1e-10 && (momentum - 3f64.sqrt()).abs() < 1e-13, "{tau} {momentum}");
    // Between apoapses p = 10 M, e = 0.5 turns by 4 √(p/(p − 6 + 2e)) K(4e/(p − 6 + 2e)).
    let orbit = case("eccentric");
    let [r, phi, ..] = later(orbit.polar(), ECCENTRIC_PERIOD, Drive::default());
    assert!((r - 10.0).abs() < 1e-9 && (phi - 10.055_168_010_18).abs() < 1e-9, "{r} {phi}");
    // A fall from rest: τ = ½ R^(3/2) [2 √(ρ − ρ²) + acos(2ρ − 1)], ρ = r/R.
    let fall = case("fall");
    let [r, _, _, _, _, tau] = later(fall.polar(), fall.span, Drive::default());
    let share = r / DROP;
    let closed = 0.5 * DROP.powf(1.5) * (2.0 * (share - share * share).sqrt() + (2.0 * share - 1.0).acos());
    assert!((tau - closed).abs() < 1e-11 && (r - 0.1).abs() < 0.01, "{tau} {closed}, r = {r}");
    // Outward thrust a from rest: E − ar stays.
    let mut start = fall.polar();
    let hover = energy(start) - 0.1 * start[0];
    start = later(start, 30.0, Drive { thrust: 0.1, turning: 0.0 });
    assert!(start[0] > 6.0 && (energy(start) - 0.1 * start[0] - hover).abs() < 1e-11, "{start:?}");
    // A gyroscope on the circle turns by 2π(1 − √(1 − 3/(2r))) less than the ship, which is nothing against the stars at r → ∞.
    let [_, _, _, _, angle, _] = later(circle.polar(), turn, Drive::default());
    assert!((angle.rem_euclid(TAU) - TAU * (1.0 - 0.5f64.sqrt())).abs() < 1e-10 || angle.abs() < PI, "{angle}");
}

/// The game's own steps on all flights.
#[test]
fn the_game_loses_no_flight() {
    for case in cases::all().unwrap() {
        let steps = (case.segment() * 32.0).ceil() as u32;
        let errors = Errors::of(&fly(Method::Game, &case, Effort::Steps(steps)), &case.truth());
        assert!(!errors.failed() && errors.energy < 1e-11 && errors.phase < 1e-6, "{}: {errors:?}", case.name);
    }
}

/// Where steps are too long a flight is lost, and it is said.
#[test]
fn long_steps_fail() {
    let circle = case("circle");
    let truth = circle.truth();
    for method in [Method::Rk4, Method::Split2, Method::Split4] {
        let errors = Errors::of(&fly(method, &circle, Effort::Steps(8)), &truth);
        assert!(errors.failed(), "{method:?}: {errors:?}");
    }
}
