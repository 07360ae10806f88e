//! Guidance to a target by what really comes of it in flight: who brakes at the sign stops at the target, who brakes later flies past it.

use glam::DVec3;

use lensrunner::scene::GameConfig;
use lensrunner::sim::assist::{AssistMode, AssistSettings, Reference, Stick, drift};
use lensrunner::sim::flight::{Command, Flight, fly};
use lensrunner::sim::guidance::{Brake, approach, guidance, meets};
use lensrunner::sim::intercept::{Advice, Way, intercept};
use lensrunner::sim::known::{Known, known, resting};
use lensrunner::sim::pilot::rollout::Point;
use lensrunner::sim::{Engine, History, PlayerCommands};
use lensrunner::spacetime::matter::ShipState;
use lensrunner::spacetime::orbit::circular_orbit;

const STEP: f64 = 1.0 / 32.0;
/// How long an advice stands, in r_s/c: what it asks for is thrust within that time.
const STANDS: f64 = 0.15;
/// Catch radius, in r_s.
const REACH: f64 = 0.8;

fn engine() -> Engine {
    Engine { max_thrust: 0.06, max_rate: 1.0, reach: 0.125 }
}

/// A target on a circle of this radius, and a hunter that closes in on it at this speed (c) from this far (r_s), from behind.
fn closing(radius: f64, speed: f64, from: f64) -> [ShipState; 2] {
    let target = circular_orbit(radius, 0.0).expect("a circle");
    let along = Point::from(&target).from_local(DVec3::Y);
    let mut hunter = target;
    hunter.position -= along * from;
    // dx/dT of the target and the speed beyond it, by a search for the momentum.
    let wanted = Point::from(&target).velocity() + along * speed;
    for _ in 0..60 {
        let error = wanted - Point::from(&hunter).velocity();
        hunter.momentum += error;
    }
    [hunter, target]
}

/// The least distance that is left, and the speed against the target in the end, if the hunter matches from the first moment on at which
/// `begins` says so.
fn braked([mut hunter, mut target]: [ShipState; 2], begins: impl Fn(Brake, f64) -> bool) -> (f64, f64) {
    let settings = AssistSettings::from(&GameConfig::default());
    let commands = PlayerCommands { assist: AssistMode::Target, matching: true, ..PlayerCommands::holding(&Stick::default()) };
    let (mut braking, mut nearest, mut left) = (false, f64::INFINITY, 0.0);
    for _ in 0..(20.0 / STEP) as usize {
        let guide = guidance(&Point::from(&hunter), &Point::from(&target), engine().max_thrust, REACH);
        let range = guide.apart.length();
        braking |= begins(guide.brake, range);
        (nearest, left) = (nearest.min(range), guide.velocity.length());
        let velocity = Point::from(&target).velocity();
        let command = if braking { commands.command(&hunter, &engine(), Some(velocity), &settings).command } else { Command::default() };
        let next =
            |state: &ShipState, command| fly(&Flight { state: *state, fuel: f64::INFINITY }, 0.0, STEP, command, &[], |_| ()).0.state;
        (hunter, target) = (next(&hunter, command), next(&target, Command::default()));
    }
    (nearest, left)
}

/// Far out, where space is flat, it stops half a catch radius before the target, and the way of the reaction; nearer the hole tides move
/// that by a catch radius at most. Braked at half of that distance it flies past.
#[test]
fn who_brakes_at_the_sign_stops_at_the_target() {
    for speed in [0.1, 0.2, 0.3, 0.4, 0.5] {
        for (radius, most) in [(1e4, 0.5 * REACH + 0.75 * speed + 0.02), (12.0, 1.5 * REACH + 0.75 * speed)] {
            let (range, left) = braked(closing(radius, speed, 1.0 + 10.0 * speed), |brake, _| brake == Brake::Now);
            assert!(range > 0.0 && range < most && left < 0.03, "{speed} c at r = {radius}: {left} c, {range} r_s");
        }
    }
    let (range, _) = braked(closing(1e4, 0.4, 5.0), |_, range| range < 0.9);
    assert!(range < 0.02, "braked late it goes through: {range} r_s");
}

#[test]
fn the_sign_comes_in_order_and_not_without_need() {
    let at = |from: f64| {
        let [hunter, target] = closing(1e4, 0.3, from).map(|state| Point::from(&state));
        guidance(&hunter, &target, 0.06, REACH)
    };
    // (γ − 1)/a = 0.805, 0.75 of reaction at 0.3 c = 0.225, half of the catch radius = 0.4.
    assert_eq!([4.0, 1.6, 1.3].map(|from| at(from).brake), [Brake::Free, Brake::Soon, Brake::Now]);
    let parting = at(-2.0);
    assert!(parting.brake == Brake::Free && parting.closing() < -0.29, "{parting:?}");
    let wide = {
        let [mut hunter, target] = closing(1e4, 0.3, 1.3).map(|state| Point::from(&state));
        hunter.x.z += 3.0;
        guidance(&hunter, &target, 0.06, REACH)
    };
    assert!(wide.brake == Brake::Free, "{wide:?}");
    let [hunter, target] = closing(1e4, 0.0, 2.0).map(|state| Point::from(&state));
    let still = guidance(&hunter, &target, 0.06, REACH);
    assert!(still.brake == Brake::Free && still.sideways() < 1e-3, "{still:?}");
}

/// The key takes away the motion against the target, whatever the circle through the ship is.
#[test]
fn matching_is_against_the_target() {
    let [hunter, target] = closing(12.0, 0.0, 2.0);
    let other = ShipState { momentum: hunter.momentum + DVec3::new(0.05, -0.1, 0.08), ..hunter };
    let reference = Reference::Target(Point::from(&target).velocity());
    let (_, left) = braked([other, target], |_, _| true);
    assert!(left < 0.01 && drift(&other, reference).length() > 0.1, "{left}");
}

/// What falls freely is known by its light as by its true state; what thrusts is not.
#[test]
fn light_tells_where_a_free_fall_leads() {
    let own = circular_orbit(9.0, 0.3).expect("a circle");
    let target = circular_orbit(7.0, 2.0).expect("a circle");
    let history = History::new(0.0, &target);
    let [told, seen] = [true, false].map(|now| known(&own, 3.0, &history, now).expect("known"));
    assert!(told.age == 0.0 && seen.age > 4.0, "{} {}", told.age, seen.age);
    let off = seen.point.x.distance(told.point.x);
    assert!(off < 0.02, "{off} r_s");
    let mut history = History::new(0.0, &target);
    let mut state = target;
    for k in 0..64 {
        let command = Command { thrust: DVec3::X * 0.1, rates: DVec3::ZERO };
        let time = f64::from(k) * STEP;
        let (end, _) =
            fly(&Flight { state, fuel: 9.0 }, time, time + STEP, command, &[], |leg| history.push(leg.time, leg.state, &leg.command));
        state = end.state;
    }
    let [told, seen] = [true, false].map(|now| known(&own, 2.0, &history, now).expect("known"));
    assert!(seen.point.x.distance(told.point.x) > 0.05, "light of before the thrust");
}

#[test]
fn an_approach_is_where_two_meet() {
    let [hunter, target] = closing(1e4, 0.2, 3.0).map(|state| Point::from(&state));
    let near = approach(&hunter, &Known { point: target, age: 0.0, rests: false }).expect("they meet");
    assert!(near.distance < 1.0 && (near.ahead - 15.0).abs() < 4.0, "{near:?}");
    // A gate stays where it is.
    let rests = resting(DVec3::new(4.0, 8.0, 1.0)).expect("outside");
    let near = approach(&Point::from(&circular_orbit(9.0, 0.9).expect("a circle")), &rests).expect("they meet");
    assert!(near.places[1] == rests.point.x, "{near:?}");
    assert!(meets(&hunter, &target, 30.0, 1.0) && !meets(&hunter, &target, 5.0, 1.0));
}

/// The state after `span` of T under a proper acceleration on rest-frame axes, by the real step.
fn flown(state: &ShipState, span: f64, acceleration: DVec3) -> ShipState {
    let thrust = state.attitude.conjugate() * acceleration;
    let command = Command { thrust, rates: DVec3::ZERO };
    fly(&Flight { state: *state, fuel: f64::INFINITY }, 0.0, span, command, &[], |_| ()).0.state
}

/// A short hard push to the mark, corrected once on the way, leads to the target, from far off and round the hole too.
#[test]
fn a_push_to_the_mark_leads_to_the_target() {
    const PUSH: f64 = 1.0 / 64.0;
    for (radius, phase) in [(9.0, 0.3), (7.0, 1.5), (10.0, 1.9), (6.0, -1.0), (8.0, 4.0)] {
        let mut own = circular_orbit(9.0, 0.0).expect("a circle");
        let mut target = ShipState { ..circular_orbit(radius, phase).expect("a circle") };
        for share in [0.5, 0.5, 1.0] {
            let known = Known { point: Point::from(&target), age: 0.0, rests: false };
            // An engine that gives any push.
            let advice = intercept(&Point::from(&own), &known, 9.0, None).unwrap_or_else(|| panic!("{radius} {phase}: no way"));
            own = flown(&flown(&own, PUSH, advice.push / PUSH), share * advice.ahead - PUSH, DVec3::ZERO);
            target = flown(&target, share * advice.ahead, DVec3::ZERO);
        }
        let apart = own.position.distance(target.position);
        assert!(apart < 0.4, "{radius} {phase}: {apart} r_s");
    }
}

/// The whole of what the screen asks for: thrust to the mark, coast where there is none, match at the sign to brake.
#[test]
fn who_follows_mark_and_sign_holds_the_target() {
    let settings = AssistSettings::from(&GameConfig::default());
    let matches = PlayerCommands { assist: AssistMode::Target, matching: true, ..PlayerCommands::holding(&Stick::default()) };
    for (radius, phase, tilt) in [(7.0, 0.8, 0.0), (9.0, 1.5, 0.2), (11.0, 0.6, -0.3), (7.5, -0.7, 0.1), (6.0, 2.0, 0.2)] {
        let mut own = circular_orbit(9.0, 0.0).expect("a circle");
        let mut target = circular_orbit(radius, phase).expect("a circle");
        let turn = glam::DQuat::from_rotation_x(tilt);
        (target.position, target.momentum) = (turn * target.position, turn * target.momentum);
        let (mut held, mut spent) = (0.0, 0.0);
        let mut way = Way::default();
        for time in (0..(200.0 / STEP) as usize).map(|k| k as f64 * STEP) {
            let known = Known { point: Point::from(&target), age: 0.0, rests: false };
            let point = Point::from(&own);
            let guide = guidance(&point, &known.point, engine().max_thrust, REACH);
            let near = guide.apart.length() < REACH;
            held = if near { held + STEP } else { 0.0 };
            if held > 2.0 {
                break;
            }
            let advice = way.follow(&point, &known, time, engine().max_thrust, REACH);
            let command = match advice.filter(|advice| *advice != Advice::Wait) {
                _ if near || guide.brake == Brake::Now => matches.command(&own, &engine(), Some(known.point.velocity()), &settings).command,
                Some(advice) => {
                    let push = advice.thrust().map_or(DVec3::ZERO, |advice| advice.push / STANDS);
                    Command { thrust: own.attitude.conjugate() * push.clamp_length_max(engine().max_thrust), rates: DVec3::ZERO }
                }
                // Near it: nose to it, the assist against it, thrust while there is room.
                None => {
                    own.attitude = glam::DQuat::from_rotation_arc(DVec3::NEG_Z, guide.apart.normalize());
                    let ahead = if guide.brake == Brake::Free { DVec3::NEG_Z } else { DVec3::ZERO };
                    let stick = Stick { thrust: ahead, turn: DVec3::ZERO };
                    let commands = PlayerCommands { assist: AssistMode::Target, ..PlayerCommands::holding(&stick) };
                    commands.command(&own, &engine(), Some(known.point.velocity()), &settings).command
                }
            };
            spent += command.thrust.length() * STEP;
            let next =
                |state: &ShipState, command| fly(&Flight { state: *state, fuel: f64::INFINITY }, 0.0, STEP, command, &[], |_| ()).0.state;
            (own, target) = (next(&own, command), next(&target, Command::default()));
        }
        assert!(held > 2.0 && spent < 3.0, "{radius} {phase} {tilt}: held {held}, spent {spent} c");
    }
}
