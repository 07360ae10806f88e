//! Whole chases: the same seed gives the same bits, the quarry lives, the autopilot catches.

use std::path::Path;

use bevy::ecs::schedule::{LogLevel, ScheduleBuildSettings};
use bevy::prelude::*;
use glam::DVec3;
use lensrunner::scene::{GameConfig, Scene};
use lensrunner::sim::app_of;
use lensrunner::sim::assist::{AssistSettings, Reference, Stick, assisted, drift};
use lensrunner::sim::flight::{Flight, fly};
use lensrunner::sim::pilot::plan::{SAFE_RADIUS, fall_risk};
use lensrunner::sim::pilot::rollout::Point;
use lensrunner::sim::{Chase, Clock, Engine, Fleet, Fuel, History, Outcome, PlayerCommands, ShipMotion, SimulationPlugins, outcome};
use lensrunner::spacetime::matter::{ShipState, energy, step};
use lensrunner::spacetime::orbit::{circular_orbit, static_momentum};

use crate::sim::simulate::run;

/// Hunter and quarry 7 r_s apart, given by plain numbers: every operation from here on is + − × ÷ √, so the hash holds on any machine.
pub const CHASE: &str = r#"
[[ship]]
name = "hunter"
position = [9, 0, 0]
momentum = [0.36, 0.25, 0.05]
ai = "pursue"
player = true
fuel = 7
[[ship]]
name = "quarry"
position = [4.25, 5.5, 1.5]
momentum = [0.0, 0.45, 0.12]
ai = "flee"
fuel = 4
"#;

fn scene(text: &str) -> Scene {
    Scene::from_toml(Path::new("test.toml"), text).expect("a scene")
}

/// Steps the chase until it is decided; panics when it never is. `look` sees the world after every step.
fn play(scene: &Scene, seed: u64, mut look: impl FnMut(&World)) -> (Outcome, f64) {
    let mut app = app_of(scene, &GameConfig::default(), seed);
    loop {
        app.world_mut().run_schedule(FixedUpdate);
        look(app.world());
        if let Some(end) = outcome(app.world()) {
            assert!(app.world().resource::<Clock>().tick > 0);
            return end;
        }
    }
}

fn motion(world: &World, index: usize) -> ShipState {
    world.get::<ShipMotion>(world.resource::<Fleet>().0[index]).expect("a ship").0
}

#[test]
fn a_whole_chase_has_the_same_bits_every_time() {
    let (rows, log, one) = run(CHASE, 120.0, 10.0, 7);
    let (_, _, two) = run(CHASE, 120.0, 0.7, 7);
    let (_, _, other) = run(CHASE, 120.0, 10.0, 8);
    assert!(rows.len() > 4, "{log}");
    assert_eq!(one.hash, two.hash);
    assert_ne!(one.hash, other.hash, "the seed matters");
    assert_eq!(one.hash.to_string(), "36bf6b49afb3829f", "the chase of seed 7 has changed: {log}");
}

#[test]
fn the_quarry_flees_without_falling_in_and_is_caught_more_often_than_not() {
    let chase = lensrunner::scene::load("chase").expect("the game's scene");
    let seeds = 12;
    let mut caught = 0;
    for seed in 0..seeds {
        let (mut lowest, mut burnt, start) = (f64::INFINITY, 0.0f64, chase.ships[1].fuel);
        let (end, time) = play(&chase, seed, |world| {
            lowest = lowest.min(motion(world, 0).position.length()).min(motion(world, 1).position.length());
            let quarry = world.resource::<Chase>().quarry.expect("a quarry");
            burnt = start - world.get::<Fuel>(quarry).expect("a tank").left;
        });
        assert!(matches!(end, Outcome::Caught | Outcome::TimeOut), "seed {seed}: {end} at {time}");
        assert!(lowest > 1.5, "seed {seed}: came down to {lowest}");
        assert!(burnt > 0.2, "seed {seed}: the quarry hardly moved, {burnt} c burnt by {time}");
        caught += usize::from(end == Outcome::Caught);
    }
    assert!(caught * 4 >= seeds as usize * 3, "caught {caught} of {seeds}");
}

#[test]
fn the_autopilot_catches_a_passive_target() {
    for (seed, orbit) in
        [(0, "radius = 5"), (1, "radius = 8, inclination = 0.4, phase = 2"), (2, "semi_latus_rectum = 6, eccentricity = 0.3, phase = 4")]
    {
        let text = format!(
            "[[ship]]\nname = \"hunter\"\norbit = {{ radius = 6, phase = -1.2 }}\nai = \"pursue\"\n[[ship]]\nname = \"target\"\norbit = {{ {orbit} }}\n"
        );
        let (end, time) = play(&scene(&text), seed, |_| ());
        assert_eq!(end, Outcome::Caught, "{orbit}: at T = {time}");
        assert!(time > 2.0 && time < 250.0, "{orbit}: {time}");
    }
}

#[test]
fn a_catch_takes_the_hold_time_without_a_break() {
    // Two coasting ships on one circle, 0.3 r_s apart; the pilot that makes it a chase has no fuel.
    let text = "[rules]\nhold_time = 3\ncapture_radius = 0.5\n[[ship]]\nname = \"hunter\"\norbit = { radius = 6 }\nai = \"pursue\"\nfuel = 0\n\
        [[ship]]\nname = \"target\"\norbit = { radius = 6, phase = 0.05 }\n";
    let (end, time) = play(&scene(text), 0, |_| ());
    assert_eq!((end, time), (Outcome::Caught, 3.0));
}

#[test]
fn a_break_in_the_hold_starts_it_again() {
    let text = "[rules]\nhold_time = 3\n[[ship]]\nname = \"hunter\"\norbit = { radius = 6 }\nai = \"pursue\"\nfuel = 0\n\
        [[ship]]\nname = \"target\"\norbit = { radius = 6, phase = 0.05 }\n";
    let mut app = app_of(&scene(text), &GameConfig::default(), 0);
    let target = app.world().resource::<Fleet>().0[1];
    loop {
        if app.world().resource::<Clock>().time == 2.0 {
            // For one step it is elsewhere.
            let before = motion(app.world(), 1);
            let away = ShipState { position: -before.position, momentum: -before.momentum, ..before };
            app.world_mut().entity_mut(target).insert(ShipMotion(away));
            app.world_mut().run_schedule(FixedUpdate);
            app.world_mut().entity_mut(target).insert(ShipMotion(step(&before, 0.03125, DVec3::ZERO, DVec3::ZERO)));
        }
        app.world_mut().run_schedule(FixedUpdate);
        if let Some(end) = outcome(app.world()) {
            // Away in the step that ends at 2.03125.
            assert_eq!(end, (Outcome::Caught, 5.03125));
            return;
        }
    }
}

#[test]
fn an_orbit_without_fall_risk_stays_up_and_one_that_falls_has_it() {
    let mut counts = [0, 0];
    for index in 0..400 {
        let angle = f64::from(index);
        let position = DVec3::X * (2.5 + 0.02 * angle);
        let momentum = DVec3::new(0.5 * (3.1 * angle).sin(), 0.15 + 0.4 * (1.7 * angle).cos().abs(), 0.2 * (2.3 * angle).sin());
        let start = ShipState::new(position, momentum);
        let safe = fall_risk(&Point::from(&start), 10.0) == 0.0;
        assert_eq!(safe, fall_risk(&Point::from(&start), 0.0) == 0.0);
        let (mut now, mut lowest) = (start, f64::INFINITY);
        for _ in 0..600 {
            now = step(&now, 0.5, DVec3::ZERO, DVec3::ZERO);
            lowest = lowest.min(now.position.length());
        }
        assert!(!safe || lowest > SAFE_RADIUS, "{start:?} came down to {lowest}");
        assert!(safe || lowest < SAFE_RADIUS || energy(&start) >= 0.97, "{start:?} never came below {lowest}");
        counts[usize::from(safe)] += 1;
    }
    assert!(counts[0] > 50 && counts[1] > 50, "{counts:?}");
}

#[test]
fn a_hunter_that_falls_in_has_lost_and_one_that_dawdles_too() {
    let text = |position: &str, limit: f64| {
        format!(
            "[rules]\ntime_limit = {limit}\n[[ship]]\nname = \"hunter\"\nposition = {position}\nmomentum = [0, 0, 0]\nai = \"pursue\"\nfuel = 0\n\
            [[ship]]\nname = \"target\"\norbit = {{ radius = 8 }}\n"
        )
    };
    // Rain from 5 r_s is at the horizon at T = 6.787; the first step after ends at 6.8125.
    assert_eq!(play(&scene(&text("[-5, 0, 0]", 100.0)), 0, |_| ()), (Outcome::HunterLost, 6.8125));
    assert_eq!(play(&scene(&text("[-50, 0, 0]", 2.0)), 0, |_| ()), (Outcome::TimeOut, 2.0));
}

#[test]
fn a_ship_flown_by_hand_is_left_alone_by_its_pilot() {
    let mut app = app_of(&scene(CHASE), &GameConfig::default(), 0);
    *app.world_mut().resource_mut::<PlayerCommands>() = PlayerCommands { autopilot: false, ..PlayerCommands::default() };
    let before = energy(&motion(app.world(), 0));
    (0..200).for_each(|_| app.world_mut().run_schedule(FixedUpdate));
    assert!((energy(&motion(app.world(), 0)) - before).abs() < 1e-12, "it coasted");
    app.world_mut().resource_mut::<PlayerCommands>().autopilot = true;
    (0..200).for_each(|_| app.world_mut().run_schedule(FixedUpdate));
    assert!((energy(&motion(app.world(), 0)) - before).abs() > 1e-3, "its pilot flies again");
}

#[test]
fn the_fixed_step_leaves_nothing_to_chance() {
    let mut app = App::new();
    app.add_plugins(SimulationPlugins);
    app.edit_schedule(FixedUpdate, |schedule| {
        schedule.set_build_settings(ScheduleBuildSettings { ambiguity_detection: LogLevel::Error, ..default() });
    });
    app.world_mut().schedule_scope(FixedUpdate, |world, schedule| {
        schedule.initialize(world).expect("no two systems that could run in either order touch the same data");
        assert!(schedule.systems_len() >= 4);
    });
}

#[test]
fn the_history_is_the_flight() {
    let mut app = app_of(&scene(CHASE), &GameConfig::default(), 3);
    let mut seen = vec![(0.0, motion(app.world(), 1))];
    for _ in 0..640 {
        app.world_mut().run_schedule(FixedUpdate);
        seen.push((app.world().resource::<Clock>().time, motion(app.world(), 1)));
    }
    let history = app.world().get::<History>(app.world().resource::<Fleet>().0[1]).expect("a history");
    for (time, state) in seen.iter().step_by(37) {
        let sample = history.at(*time);
        assert!(sample.position.distance(state.position) < 1e-12 && sample.momentum.distance(state.momentum) < 1e-12);
    }
    assert!(seen[0].1.position.distance(seen[640].1.position) > 1.0);
    // Between nodes: velocity is the change of position.
    let (t, h) = (7.123, 1e-3);
    let slope = (history.at(t + h).position - history.at(t - h).position) / (2.0 * h);
    assert!(slope.distance(history.at(t).velocity) < 1e-6);
}

#[test]
fn a_history_told_to_forget_keeps_what_it_was_told_to() {
    let start = circular_orbit(4.0, 0.0).expect("an orbit");
    let mut history = History::new(0.0, &start);
    history.forget_beyond(3.0);
    let mut state = start;
    for index in 1..=1000 {
        state = step(&state, 0.1, DVec3::ZERO, DVec3::ZERO);
        history.push(0.1 * f64::from(index), &state, &Default::default());
    }
    assert!(history.len() <= 62 && history.len() >= 30, "{}", history.len());
    let want = step(&start, 97.2, DVec3::ZERO, DVec3::ZERO).position;
    assert!(history.at(97.2).position.distance(want) < 1e-6);
}

#[test]
fn before_the_start_a_ship_was_on_its_free_orbit() {
    let start = circular_orbit(4.0, 1.0).expect("an orbit");
    let mut history = History::new(0.0, &start);
    // A turn takes 2π√(2·4³); 20 turns ago it was here.
    let turns = -20.0 * std::f64::consts::TAU * 128f64.sqrt();
    let slow = history.at(turns);
    history.reach_back(turns);
    let quick = history.at(turns);
    assert!(quick.position.distance(start.position) < 1e-5, "{}", quick.position.distance(start.position));
    assert!(slow.position.distance(quick.position) < 1e-6);
    assert!(history.at(0.5 * turns / 20.0).position.distance(start.position) > 7.9, "half a turn ago it was opposite");
}

fn engine() -> Engine {
    Engine { max_thrust: 0.06, max_rate: 1.0, reach: 0.125 }
}

/// Flies with the assist for `time`, hands off unless `stick` says otherwise.
fn fly_assisted(start: ShipState, time: f64, stick: Stick, reference: Reference, settings: &AssistSettings) -> ShipState {
    let mut flight = Flight { state: start, fuel: f64::INFINITY };
    let h = 0.03125;
    for index in 0..(time / h) as u64 {
        let command = assisted(&flight.state, &stick, &engine(), reference, settings).command;
        assert!(command.thrust.length() <= engine().max_thrust * (1.0 + 1e-12));
        let from = index as f64 * h;
        flight = fly(&flight, from, from + h, command, &[], |_| ()).0;
    }
    flight.state
}

const FREE: AssistSettings = AssistSettings { damping_time: 3.0, avoid_radius: None };

#[test]
fn the_assist_lets_drift_fade_against_each_reference() {
    let orbit = circular_orbit(8.0, 0.0).expect("an orbit");
    let target = DVec3::new(0.0, 0.2, 0.05);
    for reference in [Reference::Static, Reference::Orbit, Reference::Target(target)] {
        // The nose points along −z and drift in that direction is kept: start with none.
        let start = ShipState { momentum: orbit.momentum * 1.05 + DVec3::new(0.1, 0.0, 0.02), ..orbit };
        let before = drift(&start, reference).truncate().length();
        let after = drift(&fly_assisted(start, 25.0, Stick::default(), reference, &FREE), reference).truncate().length();
        // A target that is not in free fall leaves the pull of the hole, 0.008 c²/r_s, times the damping time.
        assert!(before > 0.03 && after < 0.1 * before + 0.01, "{reference:?}: {before} to {after}");
    }
}

#[test]
fn the_assist_keeps_forward_motion_and_the_stick_has_its_way() {
    let hover = |position: DVec3| ShipState::new(position, static_momentum(position).expect("outside"));
    let start = hover(DVec3::new(30.0, 0.0, 0.0));
    let moving = ShipState { momentum: start.momentum - DVec3::Z * 0.3, ..start };
    let end = fly_assisted(moving, 10.0, Stick::default(), Reference::Static, &FREE);
    assert!(drift(&end, Reference::Static).z < -0.25);
    let pushed = fly_assisted(start, 5.0, Stick { thrust: DVec3::X, turn: DVec3::ZERO }, Reference::Static, &FREE);
    let sideways = drift(&pushed, Reference::Static).x;
    assert!((sideways - 0.29).abs() < 0.03, "0.06 c²/r_s for 5 r_s/c: {sideways}");
}

#[test]
fn the_assist_keeps_off_the_hole() {
    let start = ShipState::new(DVec3::new(7.0, 0.0, 0.0), DVec3::new(0.2, 0.25, 0.0));
    let falls = step(&start, 40.0, DVec3::ZERO, DVec3::ZERO).position.length() < 1.0;
    assert!(falls, "left alone it falls in");
    let settings = AssistSettings { avoid_radius: Some(2.0), ..FREE };
    let mut now = start;
    let mut lowest = f64::INFINITY;
    for _ in 0..100 {
        now = fly_assisted(now, 1.0, Stick::default(), Reference::Orbit, &settings);
        lowest = lowest.min(now.position.length());
    }
    assert!(lowest > 1.5, "{lowest}");
}
