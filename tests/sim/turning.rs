//! How ships turn: no vertex faster than a quarter of light against the centre, and no turn sooner than light crosses the ship; whoever
//! flies, at whatever pace.

use bevy::app::FixedUpdate;
use glam::DVec3;
use lensrunner::scene::mission::Difficulty;
use lensrunner::scene::pilot_kind::PilotKind;
use lensrunner::scene::{self, GameConfig};
use lensrunner::sim::history::rotation;
use lensrunner::sim::{Fleet, History, Ship, app_of, board, outcome};
use lensrunner::spacetime::matter::{ShipState, gamma, step};

/// The body rates over each step of a ship that coasts or burns, from its worldline alone: what is left of the change of its attitude when
/// the transport along its momentum is taken away. Body axes, rad per proper r_s/c; and the proper time of the step.
fn rates(history: &History, clock_step: f64, steps: usize) -> Vec<(DVec3, f64)> {
    let states: Vec<ShipState> = (0..=steps)
        .map(|k| {
            let sample = history.at(k as f64 * clock_step);
            let (position, momentum, attitude) = (sample.position, sample.momentum, sample.attitude);
            ShipState { position, momentum, attitude, proper_time: sample.proper_time }
        })
        .collect();
    let between = |pair: &[ShipState]| {
        // Transport with the thrust that leads from one momentum to the other, as far as a step tells it.
        let free = step(&pair[0], clock_step, DVec3::ZERO, DVec3::ZERO);
        let span = clock_step / gamma(pair[0].momentum);
        let pushed = pair[0].attitude.conjugate() * ((pair[1].momentum - free.momentum) / span);
        let carried = step(&pair[0], clock_step, pushed, DVec3::ZERO);
        let turn = carried.attitude.conjugate() * pair[1].attitude;
        (rotation(glam::DQuat::IDENTITY, turn) / span, span)
    };
    states.windows(2).map(between).collect()
}

#[test]
fn no_vertex_is_faster_than_a_quarter_of_light_and_no_turn_begins_at_once() {
    let mut fastest: f64 = 0.0;
    for (name, pace, pilot) in [
        ("02-first-pursuit", 0.05, PilotKind::Hands),
        ("02-first-pursuit", 0.375, PilotKind::Hands),
        ("06-the-long-shot", 1.5, PilotKind::Hands),
        ("06-the-long-shot", 0.05, PilotKind::Expert),
        ("09-two-of-them", 0.05, PilotKind::Naive),
    ] {
        let scene = scene::load(name).unwrap();
        let mut config = GameConfig::default();
        config.clock.pace = pace;
        config.ship.turn_rate = 20.0;
        let config = scene.config(&config, Difficulty::Normal);
        let mut app = app_of(&scene, &config, 3);
        board(app.world_mut(), pilot);
        let mut steps = 0;
        while steps < 600 && outcome(app.world()).is_none() {
            app.world_mut().run_schedule(FixedUpdate);
            steps += 1;
        }
        assert!(steps > 100, "{name}: over after {steps} steps");
        let world = app.world();
        for (&entity, spec) in world.resource::<Fleet>().0.iter().zip(&scene.ships) {
            let history = world.get::<History>(entity).unwrap();
            // Of the ship's own model, by its vertices.
            let model = lensrunner::scene::model::import::load_or_placeholder(spec.model.as_deref().unwrap()).0;
            let size = if spec.ai == scene::ship::Ai::Flee { config.enemy.size } else { config.ship.size };
            let reach = model.vertices.iter().map(|v| glam::Vec3::from(v.position).length()).fold(0.0, f32::max);
            let reach = f64::from(reach) * size;
            let rates = rates(history, config.clock.step, steps);
            let tips: Vec<f64> = rates.iter().map(|(rate, _)| rate.length() * reach).collect();
            let most = tips.iter().copied().fold(0.0, f64::max);
            fastest = fastest.max(most);
            // What the worldline does not tell of the thrust is some 1e-3.
            assert!(most < 0.252, "{name} at {pace}, {}: a vertex at {most} c", world.get::<Ship>(entity).unwrap().name);
            // From rest to the fastest turn in the time in which light goes from tip to tip.
            let quickest = 0.25 / reach / (2.0 * reach);
            for pair in rates.windows(2) {
                let jump = pair[1].0.distance(pair[0].0);
                assert!(jump < quickest * pair[1].1 * 1.01 + 0.01, "{name} at {pace}: the turn jumps by {jump}");
            }
        }
    }
    assert!(fastest > 0.24, "nobody turned as fast as a ship may: {fastest} c");
}

/// The same seed gives the same hands, another seed others; what they do, a replay flies again.
#[test]
fn seeded_hands_fly_again_what_they_flew() {
    use lensrunner::sim::replay::record;
    use lensrunner::sim::run::RunRequest;
    let scene = scene::load("06-the-long-shot").unwrap();
    let request = |seed| RunRequest { pilot: PilotKind::Hands, seed, until: Some(10.0), ..RunRequest::default() };
    let [(first, replay), (again, _), (other, _)] = [1, 1, 2].map(|seed| record(&scene, &GameConfig::default(), &request(seed)));
    assert_eq!(first, again);
    assert_ne!(first.hash, other.hash);
    replay.verify(std::path::Path::new("hands"), None, &GameConfig::default()).unwrap();
}

#[test]
fn a_scene_may_have_a_ship_flown_by_hands() {
    let text = "[[ship]]\nname = \"own\"\nai = \"hands\"\norbit = { radius = 8.0 }\n";
    let scene = scene::Scene::from_toml(std::path::Path::new("hands.toml"), text).unwrap();
    let mut app = app_of(&scene, &GameConfig::default(), 1);
    (0..200).for_each(|_| app.world_mut().run_schedule(FixedUpdate));
    let ship = app.world().resource::<Fleet>().0[0];
    let turned = rates(app.world().get::<History>(ship).unwrap(), 1.0 / 32.0, 200);
    assert!(turned.iter().filter(|(rate, _)| rate.length() > 0.1).count() > 50);
}
