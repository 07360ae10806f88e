//! Moments of flights: which are looked at, how they are frozen, what jumps.

use std::f64::consts::PI;
use std::path::Path;

use glam::DVec3;
use lensrunner::judge::case::Case;
use lensrunner::scene::pilot_kind::PilotKind;
use lensrunner::scene::{GameConfig, Scene};
use lensrunner::sim::Moment;
use lensrunner_lab::compare::Shown;
use lensrunner_lab::compare::flight::eye::eye;
use lensrunner_lab::compare::flight::freeze::freeze;
use lensrunner_lab::compare::flight::hands::{self, Tally, pace};
use lensrunner_lab::compare::flight::jump::jumps;
use lensrunner_lab::compare::flight::moments::{Survey, choose, survey};
use lensrunner_lab::compare::judged::{Terms, judge};

/// A ship on an orbit, seen by a camera that hovers over its plane's edge: behind the hole once in each turn.
const ORBIT: &str = "
[camera]
position = [20.0, 0.0, 0.0]

[[ship]]
name = \"hunter\"
orbit = { radius = 4.0, phase = 0.3 }

[planet]
orbit_radius = 30.0
radius = 1.0
aurora = \"none\"

[disk]
";

fn scene() -> Scene {
    Scene::from_toml(Path::new("test.toml"), ORBIT).unwrap()
}

#[test]
fn oppositions_are_found_and_the_rest_is_spread() {
    let config = GameConfig::default();
    let found = survey(&scene(), &config, 1, 160.0, PilotKind::Expert);
    assert_eq!(found.steps as f64 * config.clock.step, 160.0);
    // A turn takes 2π√(2·4³) = 71 r_s/c: two oppositions.
    let near = found.angles.windows(3).filter(|w| w[1] > w[0] && w[1] >= w[2] && w[1] > PI - 0.01).count();
    assert_eq!(near, 2);
    let chosen = choose(&found, 20, config.clock.step, 1);
    assert_eq!(chosen.len(), 20);
    assert!(chosen.windows(2).all(|pair| pair[0] < pair[1]) && *chosen.last().unwrap() < found.steps && chosen[0] >= 2);
    let opposite = chosen.iter().filter(|step| found.angles[**step as usize - 1] > PI - 0.02).count();
    assert!((9..=11).contains(&opposite), "{opposite}");
    assert_eq!(chosen, choose(&found, 20, config.clock.step, 1));
    assert_ne!(chosen, choose(&found, 20, config.clock.step, 2));
    // Too short a flight has none.
    assert!(choose(&Survey { steps: 2, angles: vec![1.0, 2.0] }, 5, 0.1, 1).is_empty());
}

#[test]
fn a_frozen_moment_is_the_same_place_without_its_past() {
    let config = GameConfig::default();
    let moment = Moment::new(&scene(), &config, 10.0, 0);
    let then = Case::of(scene(), config.clone(), &moment, [80, 45]);
    let text = freeze(ORBIT, &then).unwrap();
    let frozen = Case::new(Scene::from_toml(Path::new("frozen.toml"), &text).unwrap(), config, 0.0, [80, 45]);
    let near = |a: DVec3, b: DVec3| assert!(a.distance(b) < 1e-9, "{a} {b}");
    for back in [0.0, 5.0, 30.0] {
        // A coasting ship has the same past.
        let (old, new) = (then.histories[0].at(10.0 - back), frozen.histories[0].at(-back));
        assert!(old.position.distance(new.position) < 1e-6 && old.attitude.angle_between(new.attitude) < 1e-6);
        let planet = |case: &Case, time: f64| case.scene.planet.unwrap().state(time).unwrap().position;
        near(planet(&then, 10.0 - back), planet(&frozen, -back));
    }
    near(then.camera.observer.position, frozen.camera.observer.position);
    near(then.camera.observer.momentum, frozen.camera.observer.momentum);
    assert!(then.camera.observer.attitude.angle_between(frozen.camera.observer.attitude) < 1e-6);
    assert_eq!(then.camera.observer.field_of_view, frozen.camera.observer.field_of_view);
    assert!(frozen.scene.disk(&frozen.config).is_some());
}

/// Some moments of a mission that hands fly, at each of the five paces: beside the judge's picture none is beyond a limit, and of the own
/// ship's points 99 of 100 are within a quarter of a pixel.
#[test]
fn a_ship_in_hands_is_drawn_where_it_is() {
    let scene = lensrunner::scene::load("06-the-long-shot").unwrap();
    let contestant = lensrunner_lab::contestant::GameContestant::default();
    let mut tally = Tally::default();
    for (seed, count) in [(0, 1), (1, 1), (2, 1), (3, 2), (4, 2)] {
        let mut config = scene.config(&GameConfig::default(), lensrunner::scene::Difficulty::Normal);
        config.clock.pace = pace(seed);
        let chosen = hands::choose(&scene, &config, seed, 20.0, count);
        assert_eq!(chosen, hands::choose(&scene, &config, seed, 20.0, count));
        let mut moment = Moment::with_pilot(&scene, &config, seed, PilotKind::Hands);
        let mut now = 0;
        for step in chosen {
            moment.advance(step - now);
            now = step;
            // The cockpit's own ship is not drawn: such a moment judges others.
            let Some((view, camera, hidden)) = eye(&scene, &config, &moment, seed, step) else { continue };
            let case = Case::seen(scene.clone(), config.clone(), &moment, camera, hidden, [240, 135]);
            let judged = judge(&case, &Terms::default(), &|case: &Case| contestant.draw(case)).unwrap();
            assert!(judged.faults.is_empty(), "pace {}, {}: {:?}", config.clock.pace, view.name(), judged.faults);
            tally.add(&scene, config.clock.pace, view, &judged);
        }
    }
    let sheet = tally.sheet();
    let all = sheet.rows.last().unwrap();
    println!("{}", tally.text());
    assert!(sheet.number(all, "own_points") > 500.0 && sheet.number(all, "own_p99_px") < 0.25);
}

#[test]
fn an_image_that_fills_the_screen_from_one_frame_to_the_next_jumps() {
    let size = [40u32, 30];
    // A square image of an object around the middle.
    let frame = |side: u32, coverage: f32| -> Vec<Shown> {
        (0..size[0] * size[1])
            .map(|i| {
                let (x, y) = (i % size[0], i / size[0]);
                let inside = x.abs_diff(20) < side && y.abs_diff(15) < side;
                if inside { Shown { object: 1, order: 2, body: [0.0; 3], coverage } } else { Shown::default() }
            })
            .collect()
    };
    assert!(jumps(&frame(5, 1.0), &frame(5, 1.0), size).is_empty());
    // It may come up from nothing, by a few pixels.
    assert!(jumps(&frame(0, 1.0), &frame(1, 1.0), size).is_empty());
    let found = jumps(&frame(2, 1.0), &frame(20, 1.0), size);
    assert!(found.len() == 1 && (found[0].object, found[0].order) == (1, 2) && found[0].areas == [9.0, 1170.0], "{found:?}");
    assert_eq!(jumps(&frame(3, 1.0), &frame(6, 1.0), size).len(), 1);
}
