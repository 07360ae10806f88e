//! Bodies whose flight nobody would fly, and none could: whatever was recorded, a frame of it takes no more than some times the work of the
//! same ship at rest, and shows nothing that has no numbers.

use std::sync::{LazyLock, Mutex, PoisonError};

use glam::{DQuat, DVec3};
use lensrunner::lensing::Slice;
use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::types::Counters;
use lensrunner::render::instances::{DrawnObject, Illumination, InstanceView, ObjectMotion, instances_of};
use lensrunner::render::models::ModelRange;
use lensrunner::render::settings::Settings;
use lensrunner::render::stage::{Stage, settings, third_person};
use lensrunner::scene::model::import::load_or_placeholder;
use lensrunner::scene::pilot_kind::PilotKind;
use lensrunner::scene::{self, GameConfig};
use lensrunner::sim::flight::Command;
use lensrunner::sim::{History, Moment};
use lensrunner::spacetime::Observer;
use lensrunner::spacetime::matter::{ShipState, momentum_of, step};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::render::support::{LentRenderer, renderer};

const SIZE: [u32; 2] = [160, 90];
const LENGTH: f64 = 0.25;
/// What a frame may take, over what the same ship at rest takes.
const MOST: f64 = 4.0;

struct Yard {
    renderer: LentRenderer,
    ship: ModelRange,
    reach: f64,
}

static YARD: LazyLock<Mutex<Yard>> = LazyLock::new(|| {
    let mut renderer = renderer(SIZE);
    let model = load_or_placeholder("hunter.glb").0;
    let ship = renderer.add_model(&model);
    Mutex::new(Yard { renderer, ship, reach: f64::from(model.radius()) * LENGTH })
});

impl Yard {
    /// What the frame at T = `time` counts, seen by `camera`; and whether every number of its light is finite.
    fn frame(&mut self, camera: Observer, time: f64, motion: ObjectMotion) -> (Counters, bool) {
        let settings = Settings { stars: false, milky_way: false, bloom: 0.0, ..settings(&GameConfig::default()) };
        let slice = Slice::new(self.renderer.table(), camera.radius());
        let pixel = 2.0 * (0.5 * camera.field_of_view).tan() / f64::from(SIZE[0]);
        let view = InstanceView { camera: &camera, slice: &slice, pixel, aspect: None, settings: &settings };
        let light = Illumination { ambient: [1.0; 3], ..Illumination::default() };
        let (model, coarse) = (self.ship, self.ship);
        let object = DrawnObject { model, coarse, stand_ins: &[], motion, reach: self.reach, scale: LENGTH, id: 1, light };
        let placed = instances_of(&view, time, &object, settings.orders);
        let picture = self.renderer.picture(&FrameInput { camera, time, placed, held: None, aurora: None, settings }, false).unwrap();
        (self.renderer.counters().unwrap(), picture.linear.iter().flatten().all(|x| x.is_finite()))
    }
}

/// Vertices that are projected, pieces that are measured, and triangles.
fn work(counters: &Counters) -> f64 {
    f64::from(counters.vertices) + 12.0 * f64::from(counters.split) + f64::from(counters.indices) / 3.0
}

/// A camera behind a ship in this state, as the game has it; turned about the ship.
fn behind(state: &ShipState, turn: DVec3) -> Observer {
    let turned = ShipState { attitude: (state.attitude * DQuat::from_scaled_axis(turn)).normalize(), ..*state };
    third_person(&turned, DVec3::new(0.0, 0.62, 3.4) * LENGTH, DQuat::IDENTITY, 1.0)
}

fn state_at(history: &History, time: f64) -> ShipState {
    let sample = history.at(time);
    let (position, momentum, attitude) = (sample.position, sample.momentum, sample.attitude);
    ShipState { position, momentum, attitude, proper_time: sample.proper_time }
}

/// Draws the flight at T = `time` and the same ship at rest before the same camera.
fn check(history: &History, time: f64, turn: DVec3) -> Result<(), TestCaseError> {
    let now = state_at(history, time);
    let camera = behind(&now, turn);
    if !camera.position.is_finite() || camera.radius() < 1.01 || now.position.length() < 1.05 {
        return Ok(());
    }
    let mut yard = YARD.lock().unwrap_or_else(PoisonError::into_inner);
    let (moving, is_finite) = yard.frame(camera, time, ObjectMotion::Flying(history));
    prop_assert!(is_finite, "light without numbers");
    prop_assert_eq!(moving.caught, 0, "{:?} of a ship at {} with p = {}", moving, now.position, now.momentum);
    // Held where its light left it, as far as the camera tells.
    let left = state_at(history, time - camera.position.distance(now.position));
    let (still, _) = yard.frame(camera, time, ObjectMotion::Static { position: left.position, attitude: left.attitude });
    let least = work(&still).max(f64::from(yard.ship.vertices[1]));
    prop_assert!(work(&moving) <= MOST * least, "{} of {}: {moving:?}, at rest {still:?}", work(&moving), work(&still));
    Ok(())
}

fn any_vector(most: f64) -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-1.0..1.0f64).prop_map(move |v| DVec3::from_array(v) * most)
}

/// A step of a flight: thrust (c²/r_s), turn (rad per r_s/c), and a jump of the place (r_s) that no simulation makes.
#[derive(Clone, Debug)]
struct Jerk {
    thrust: DVec3,
    rates: DVec3,
    jump: DVec3,
}

fn jerk() -> impl Strategy<Value = Jerk> {
    let scale = || prop_oneof![4 => Just(0.0), 4 => 0.0..1.0, 1 => 0.0..100.0];
    let jumps = prop_oneof![9 => Just(0.0), 1 => 0.0..1.0];
    (any_vector(1.0), any_vector(1.0), any_vector(1.0), scale(), scale(), jumps).prop_map(|(thrust, rates, jump, push, turn, far)| Jerk {
        thrust: thrust * push,
        rates: rates * turn * 8.0,
        jump: jump * far,
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, max_shrink_iters: 20, failure_persistence: None, rng_seed: RngSeed::Fixed(53), ..ProptestConfig::default() })]

    /// What no simulation records: turns of many times light at the tips, thrust at which no body keeps its shape, jumps.
    #[test]
    fn any_history_takes_bounded_work_and_has_numbers(
        radius in 1.3..12.0f64,
        velocity in any_vector(0.55),
        attitude in any_vector(3.0),
        jerks in prop::collection::vec(jerk(), 48),
        turn in any_vector(3.0),
    ) {
        let position = DVec3::new(radius, 0.3, -0.2);
        let momentum = momentum_of(position, velocity).unwrap_or_default();
        let mut state = ShipState { attitude: DQuat::from_scaled_axis(attitude), ..ShipState::new(position, momentum) };
        let mut history = History::new(0.0, &state);
        let mut time = 0.0;
        for Jerk { thrust, rates, jump } in jerks {
            time += 1.0 / 32.0;
            state = step(&state, 1.0 / 32.0, thrust, rates);
            state.position += jump;
            if !state.is_finite() || state.position.length() < 1.05 || state.momentum.length() > 1e6 {
                return Ok(());
            }
            history.push(time, &state, &Command { thrust, rates });
        }
        check(&history, time, turn)?;
    }

    /// What hands do to the game's own ships, at any pace and with any turn rate that a setting may have.
    #[test]
    fn whatever_hands_fly_takes_bounded_work(seed in 0u64..1000, pace in 0.01..3.0f64, rate in 0.05..20.0f64, steps in 40u64..200, turn in any_vector(3.0)) {
        let scene = scene::load("06-the-long-shot").unwrap();
        let mut config = GameConfig::default();
        (config.clock.pace, config.ship.turn_rate) = (pace, rate);
        let mut moment = Moment::with_pilot(&scene, &config, seed, PilotKind::Hands);
        moment.advance(steps);
        check(moment.histories()[0], moment.time(), turn)?;
    }
}

/// From the cockpit, in the frame after a bolt was fired there: its surface goes through the camera, and what lies before the near plane is
/// not split.
#[test]
fn a_surface_goes_through_the_camera() {
    let (scene, mut config) = (scene::load("06-the-long-shot").unwrap(), GameConfig::default());
    config.clock.pace = 1.5;
    let config = scene.config(&config, scene::Difficulty::Easy);
    let mut moment = Moment::with_pilot(&scene, &config, 1, PilotKind::Hands);
    moment.advance((12.25 / config.clock.step) as u64 + 1);
    let nobody = History::nobody();
    let histories: Vec<&History> = moment.histories().into_iter().chain([&nobody]).chain(moment.bolts()).collect();
    let mut renderer = renderer(SIZE);
    let mut stage = Stage::new(&mut renderer, &scene, &config);
    // Fired by hands at T = 12.24: the camera is still within it.
    let time = 12.25;
    let camera = third_person(&state_at(histories[0], time), DVec3::ZERO, DQuat::IDENTITY, 1.0);
    assert!(moment.bolts().iter().any(|bolt| bolt.exists_at(time) && bolt.at(time).position.distance(camera.position) < 0.035));
    let frame = stage.frame(camera, SIZE, time, &histories, Some(0), &settings(&config));
    renderer.picture(&frame, false).unwrap();
    let counters = renderer.counters().unwrap();
    assert!(counters.caught == 0 && counters.split < 1_000, "{counters:?}");
}
