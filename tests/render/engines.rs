//! Nozzles shine by what the engines burnt when the light left.

use glam::{DQuat, DVec3};
use lensrunner::render::settings::Settings;
use lensrunner::render::stage::{Stage, third_person};
use lensrunner::scene::{self, GameConfig, Scene};
use lensrunner::sim::{Command, History};
use lensrunner::spacetime::matter::step;

use crate::render::support::{LentRenderer, renderer};

const SIZE: [u32; 2] = [160, 90];

/// The chase, ready to be drawn again and again.
struct Chase {
    renderer: LentRenderer,
    stage: Stage,
    scene: Scene,
    config: GameConfig,
}

impl Chase {
    fn new() -> Chase {
        let (config, scene) = (GameConfig::default(), scene::load("chase").unwrap());
        let mut renderer = renderer(SIZE);
        let stage = Stage::new(&mut renderer, &scene, &config);
        Chase { renderer, stage, scene, config }
    }

    /// The player's ship from behind, after T = 2 under a share of full thrust until `until`: its light in all, and whether nozzles follow
    /// the engines.
    fn light(&mut self, share: f64, until: f64, follows: bool) -> f64 {
        let Chase { renderer, stage, scene, config } = self;
        let mut state = scene.ships.iter().find(|ship| ship.player).unwrap().state;
        let mut history = History::new(0.0, &state);
        for k in 1..=64 {
            let time = f64::from(k) / 32.0;
            let thrust = if time <= until { DVec3::NEG_Z * (share * config.ship.thrust) } else { DVec3::ZERO };
            state = step(&state, 1.0 / 32.0, thrust, DVec3::ZERO);
            history.push(time, &state, &Command { thrust, rates: DVec3::ZERO });
        }
        let engines = follows.then_some([config.ship.thrust, config.enemy.thrust]);
        // Straight from behind, nozzles fill a good part of the picture.
        let camera = third_person(&state, DVec3::Z * (2.0 * config.ship.size), DQuat::IDENTITY, 0.6);
        let settings = Settings { engines, orders: 1, stars: false, milky_way: false, ..Settings::finest() };
        let histories: Vec<&History> = scene.ships.iter().map(|_| &history).collect();
        let other = scene.ships.iter().position(|ship| !ship.player);
        let picture = renderer.picture(&stage.frame(camera, SIZE, 2.0, &histories, other, &settings), true).unwrap();
        // Of the ship alone: what has a layer.
        let bodies = picture.linear.iter().zip(&picture.layers).filter(|(_, layer)| layer[0] > 0.0);
        bodies.map(|(light, _)| f64::from(light[2])).sum()
    }
}

#[test]
fn nozzles_shine_by_the_thrust() {
    // The hull is lit all the same, but otherwise at each of the places that the thrust brings it to: what nozzles lack is compared at the
    // same one.
    let mut chase = Chase::new();
    let [none, half, full] = [0.0, 0.5, 1.0].map(|share| [false, true].map(|follows| chase.light(share, 2.0, follows)));
    assert!((full[1] / full[0] - 1.0).abs() < 0.005, "under full thrust nothing is lacking: {full:?}");
    assert!(none[1] < 0.4 * none[0], "coasting {none:?}");
    // Coasting, all but a thousandth of what is left is the hull.
    let lacking = (half[0] - half[1]) / (half[0] - none[1]);
    assert!((lacking - 0.75).abs() < 0.02, "at half of the thrust {lacking} of the light are lacking: {half:?} {none:?}");
}

/// A ship is seen as it was when its light left, about T = 1.5: engines shut down after that still burn, those shut down shortly before are
/// fading.
#[test]
fn nozzles_fade() {
    let mut chase = Chase::new();
    let [burning, late, fading, out] = [2.0, 1.75, 1.375, 0.9].map(|until| chase.light(1.0, until, true));
    // The light on the hull changes with its motion.
    assert!((late / burning - 1.0).abs() < 0.05, "{burning} {late}");
    assert!(out < 0.8 * fading && fading < 0.8 * burning, "{burning} {fading} {out}");
}
