//! What a ship's history says of how it moved.

use glam::DVec3;
use lensrunner::sim::history::rotation;
use lensrunner::sim::{Command, History};
use lensrunner::spacetime::matter::{ShipState, step};
use lensrunner::spacetime::orbit::static_momentum;

/// A ship that falls, thrusts and turns by commands that change every few steps, its past known for ten r_s/c.
fn flown() -> History {
    let mut state = ShipState::new(DVec3::new(5.0, 1.0, 0.3), DVec3::new(-0.3, 0.25, 0.1));
    let mut history = History::new(0.0, &state);
    for k in 0..200 {
        let sign = if k / 7 % 2 == 0 { 1.0 } else { -1.0 };
        let command = Command { thrust: DVec3::new(0.0, 0.02, -0.05) * sign, rates: DVec3::new(0.3, 1.2, 0.0) * sign };
        state = step(&state, 1.0 / 32.0, command.thrust, command.rates);
        history.push(f64::from(k + 1) / 32.0, &state, &command);
    }
    history.reach_back(-10.0);
    history
}

/// The history keeps states and forces, no commands: what the engines gave comes back from them.
#[test]
fn the_thrust_is_that_of_the_commands() {
    let history = flown();
    let commanded = DVec3::new(0.0, 0.02, 0.05).length();
    // Within a command, across one that turns the thrust round, and over the start: a third of that span is before it.
    for (time, span, share) in [(1.0, 0.1, 1.0), (3.3, 1.0, 1.0), (0.2, 0.3, 2.0 / 3.0), (-4.0, 1.0, 0.0)] {
        let thrust = history.thrust(time, span);
        // Rounding of the forces' difference, which is a hundredth of them.
        assert!((thrust - share * commanded).abs() < 1e-12, "{time}: {thrust}");
    }
    // The last node is at 6.25.
    assert!((history.thrust(6.35, 0.2) - 0.5 * commanded).abs() < 1e-12);
}

#[test]
fn a_ship_moves_within_its_bounds() {
    let history = flown();
    for k in 0..120 {
        let from = -9.0 + 0.12 * f64::from(k);
        let span = [0.02, 0.1, 0.7][k as usize % 3];
        let bounds = history.bounds(from, from + span).unwrap();
        let times: Vec<f64> = (0..=300).map(|i| from + span * f64::from(i) / 300.0).collect();
        let samples: Vec<_> = times.iter().map(|t| history.at(*t)).collect();
        let step = span / 300.0;
        let (mut kinks, mut rates): (f64, Vec<DVec3>) = (0.0, Vec::new());
        for pair in samples.windows(2) {
            assert!(pair[0].position.distance(pair[1].position) <= bounds.velocity * step * (1.0 + 1e-9));
            assert!(pair[0].momentum.distance(pair[1].momentum) <= bounds.force * step * (1.0 + 1e-9));
            rates.push(rotation(pair[0].attitude, pair[1].attitude) / step);
            assert!(rates[rates.len() - 1].length() <= bounds.turning + 1e-9, "{from}");
            let p = pair[0].momentum.length();
            assert!(p >= bounds.momentum[0] - 1e-12 && p <= bounds.momentum[1] + 1e-12);
        }
        for three in samples.windows(3) {
            let bend = (three[0].position - 2.0 * three[1].position + three[2].position).length() / (step * step);
            assert!(bend <= bounds.acceleration * (1.0 + 1e-6) + 1e-5, "{from}: {bend} {bounds:?}");
            kinks += (three[0].momentum - 2.0 * three[1].momentum + three[2].momentum).length() / step;
        }
        assert!(kinks <= bounds.surge * span + bounds.jumps[0] + 1e-9, "{from}: {kinks} {bounds:?}");
        let turns: f64 = rates.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        assert!(turns <= bounds.jumps[1] + 0.1 * bounds.turning, "{from}: {turns} {bounds:?}");
    }
    assert_eq!(history.bounds(6.2, 6.3), None);
    assert_eq!(history.bounds(-1e3, 0.0), None);
}

/// What is asked of a history over a while before its first node holds within its bounds.
fn moves_within_bounds(history: &History) {
    for k in 0..200 {
        let (from, span) = (-60.0 + 0.3 * f64::from(k), 0.25);
        let bounds = history.bounds(from, from + span).unwrap();
        let samples: Vec<_> = (0..=100).map(|i| history.at(from + span * f64::from(i) / 100.0)).collect();
        for pair in samples.windows(2) {
            let rounding = 1e-15 + 1e-12 * pair[0].momentum.length();
            assert!(pair[0].position.distance(pair[1].position) <= bounds.velocity * span / 100.0 * (1.0 + 1e-9) + 1e-15, "{from}");
            assert!(pair[0].momentum.distance(pair[1].momentum) <= bounds.force * span / 100.0 * (1.0 + 1e-9) + rounding, "{from}");
            let p = pair[0].momentum.length();
            assert!(p >= bounds.momentum[0] - rounding && p <= bounds.momentum[1] + rounding, "{from}: {p} {bounds:?}");
        }
    }
}

/// Outside nothing comes out of the white hole: a ship whose orbit would have hovered, at its start or, of one that falls, where it began
/// to.
#[test]
fn what_would_have_come_out_of_the_hole_hovered() {
    let thrown = ShipState::new(DVec3::new(3.0, 0.0, 0.0), DVec3::new(1.0, 0.2, 0.0));
    let hovering = ShipState::new(DVec3::new(0.0, 6.0, 0.0), static_momentum(DVec3::Y * 6.0).unwrap());
    for state in [thrown, hovering] {
        let mut history = History::new(0.0, &state);
        let unreached = history.clone();
        history.reach_back(-1e4);
        for time in [-1e5, -40.0, -0.5, -0.03125] {
            let before = history.at(time);
            assert_eq!(before.position, state.position, "{time}");
            assert!(before.velocity.length() < 1e-15, "{time}");
            assert_eq!(before.momentum, static_momentum(state.position).unwrap());
            assert_eq!(unreached.at(time), before);
        }
        // It takes up its motion in a thirty-second of r_s/c.
        assert!(history.at(-0.001).momentum.distance(state.momentum) < 0.01);
        moves_within_bounds(&history);
    }
    // Dropped from r = 8 so long ago that it is at r = 4 now.
    let mut state = ShipState::new(DVec3::X * 8.0, static_momentum(DVec3::X * 8.0).unwrap());
    let mut fallen = 0.0;
    while state.position.length() > 4.0 {
        state = step(&state, 1.0 / 32.0, DVec3::ZERO, DVec3::ZERO);
        fallen += 1.0 / 32.0;
    }
    let mut history = History::new(0.0, &state);
    history.reach_back(-1e3);
    let start = history.at(-1e3).position;
    // The turning point is found to a step of the past.
    assert!((start.x - 8.0).abs() < 0.02 && start.truncate().y == 0.0, "{start}");
    assert!(history.at(-fallen + 2.0).position.x < 7.99);
}

/// Inside the horizon nothing hovers: followed backwards such a ship hugs r = 1, with a momentum that grows until it is held there.
#[test]
fn what_came_out_of_the_hole_inside_is_held_in_the_end_and_knows_it() {
    let state = ShipState::new(DVec3::new(-0.337928, -0.133675, -0.199831), DVec3::new(-1.506309, 0.064824, -1.116405));
    let mut history = History::new(0.0, &state);
    history.reach_back(-1e4);
    let last = history.at(-1e4);
    assert!((last.position.length() - 1.0).abs() < 1e-5 && last.momentum.length() > 1e6, "{last:?}");
    let held = history.bounds(-1e3, -500.0).unwrap();
    assert_eq!((held.velocity, held.force, held.turning, held.momentum), (0.0, 0.0, 0.0, [last.momentum.length(); 2]));
    moves_within_bounds(&history);
}

/// A look beyond the known past gives what [`History::reach_back`] gives, in whatever order the looks come, for a fast ship too; and a
/// clone and a longer known past agree with it.
#[test]
fn looks_beyond_the_known_past_are_the_past() {
    let fast = ShipState::new(DVec3::new(10.0, 0.0, 0.0), DVec3::new(0.0, 1000.0, 0.0));
    let fallen = ShipState::new(DVec3::new(0.6, 0.1, 0.0), DVec3::new(0.4, 0.5, 0.0));
    for state in [fast, fallen] {
        let looked = History::new(0.0, &state);
        let mut known = looked.clone();
        known.reach_back(-3000.0);
        let times = [-5.0, -2000.0, -0.3, -1999.9, -2900.0, -700.0, -2.0];
        for time in times {
            assert_eq!(looked.at(time), known.at(time), "{time}");
        }
        let mut later = looked.clone();
        later.reach_back(-100.0);
        for time in times {
            assert_eq!(later.at(time), known.at(time), "{time}");
        }
    }
}
