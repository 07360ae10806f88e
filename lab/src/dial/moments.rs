//! Moments that nobody chose: a scene of a class, a time of its flight, a camera turned at random; and frames of them, timed and compared.

use std::f64::consts::PI;
use std::time::Instant;

use glam::DQuat;
use lensrunner::render::Gpu;
use lensrunner::render::quality::costs::SceneClass;
use lensrunner::render::settings::Settings;
use lensrunner::render::shot::Moment;
use lensrunner::render::stage::{Stage, settings};
use lensrunner::scene::planet::AuroraShape;
use lensrunner::scene::{self, GameConfig, Scene};
use lensrunner::spacetime::Observer;
use rand::rngs::SmallRng;
use rand::{Rng, RngExt, SeedableRng};

use super::DialRequest;
use crate::chart::{ChartError, Sheet};
use crate::flip::mean_flip;
use crate::offscreen::{Offscreen, processor_time};

/// Latest time of a moment, in r_s/c.
const LATEST: f64 = 40.0;
/// The camera is turned by up to this, in rad: what lies before it is still in the picture, but not in its middle.
const TURNED: f64 = 0.5;
/// No nearer to the hole than this, in r_s: a camera that falls through the horizon is a class of its own.
const NEAREST: f64 = 1.2;
/// Frames of which the quickest is the time of one.
const TIMED: usize = 2;
/// Timings before those that count.
const WARM: usize = 2;
/// Scenes drawn before a class is given up.
const TRIES: usize = 200;

/// The renderer, a sheet with these columns that says where it comes from, and the numbers at random.
pub(super) fn begin(request: &DialRequest, columns: &[&str]) -> Result<(Bench, Sheet, SmallRng), ChartError> {
    let bench = Bench::new(request.size)?;
    let mut sheet = Sheet::measured(columns, &bench.gpu.adapter.name);
    let seed = request.seed();
    sheet.notes.push(("seed".into(), seed.to_string()));
    Ok((bench, sheet, SmallRng::seed_from_u64(seed)))
}

/// One moment.
#[derive(Clone, Debug, PartialEq)]
pub struct MomentCase {
    /// The scene's name.
    pub scene: String,
    /// T, in r_s/c.
    pub at: f64,
    /// Seed of its pilots.
    pub seed: u64,
    /// How far the camera is turned to the left and up, in rad.
    pub turn: [f64; 2],
}

/// The class of a scene, by what is in it.
pub fn class_of(scene: &Scene) -> SceneClass {
    let has_aurora = scene.planet.as_ref().is_some_and(|planet| planet.aurora != AuroraShape::None);
    let has_bodies = !scene.ships.is_empty() || !scene.props.is_empty() || scene.planet.is_some();
    SceneClass::of(has_bodies, scene.disk(&GameConfig::default()).is_some(), has_aurora)
}

/// All scenes and missions of a class.
pub fn scenes(class: SceneClass) -> Result<Vec<Scene>, ChartError> {
    let mut found = Vec::new();
    for name in scene::names().into_iter().chain(scene::mission_names()) {
        let scene = scene::load(&name)?;
        if class_of(&scene) == class {
            found.push(scene);
        }
    }
    Ok(found)
}

/// A moment of one of these scenes.
pub fn case(scenes: &[Scene], rng: &mut SmallRng) -> Option<MomentCase> {
    (0..TRIES).find_map(|_| {
        let scene = scenes.get(rng.random_range(0..scenes.len().max(1)))?;
        let case = MomentCase {
            scene: scene.name.clone(),
            at: (rng.random::<f64>() * LATEST * 32.0).round() / 32.0,
            seed: rng.next_u64() >> 32,
            turn: [0, 1].map(|_| TURNED * (2.0 * rng.random::<f64>() - 1.0)),
        };
        let moment = Moment::new(scene, &GameConfig::default(), case.at, case.seed);
        let ships = moment.ships();
        let sees = scene.camera.check(moment.time(), &ships).is_ok();
        (sees && scene.camera.viewpoint(moment.time(), &ships).radius() > NEAREST).then_some(case)
    })
}

/// The renderer for moments.
pub struct Bench {
    gpu: Gpu,
    offscreen: Offscreen,
    config: GameConfig,
    size: [u32; 2],
}

/// A moment on the renderer.
pub struct Shown {
    stage: Stage,
    moment: Moment,
    camera: Observer,
    /// The settings of the configuration.
    pub finest: Settings,
}

/// A finished picture.
pub struct Taken {
    /// sRGB-linear light as shown, 0 to 1.
    pub light: Vec<[f32; 3]>,
    /// The same as it is stored: sRGB, four bytes a pixel.
    pub bytes: Vec<u8>,
}

impl Bench {
    /// Opens the device.
    pub fn new(size: [u32; 2]) -> Result<Bench, ChartError> {
        let gpu = Gpu::headless()?;
        let offscreen = Offscreen::new(&gpu, size);
        Ok(Bench { gpu, offscreen, config: GameConfig::default(), size })
    }

    /// Uploads a moment.
    pub fn show(&mut self, case: &MomentCase) -> Result<Shown, ChartError> {
        let scene = scene::load(&case.scene)?;
        let stage = Stage::new(&mut self.offscreen.renderer, &scene, &self.config);
        let moment = Moment::new(&scene, &self.config, case.at, case.seed);
        let mut camera = stage.camera(moment.time(), &moment.ships());
        camera.attitude *= DQuat::from_rotation_y(case.turn[0]) * DQuat::from_rotation_x(case.turn[1]);
        debug_assert!(case.turn.iter().all(|turn| turn.abs() < PI));
        // As the game draws it: the player's own ship is not metered.
        let own_ship = scene.ships.iter().position(|ship| ship.player);
        let engines = Some([self.config.ship.thrust, self.config.enemy.thrust]);
        Ok(Shown { stage, moment, camera, finest: Settings { own_ship, engines, ..settings(&self.config) } })
    }

    /// These settings beside others, whose picture is `finest`: mean FLIP, and milliseconds a frame of both, one after the other, so that
    /// what else the machine does tells on both alike.
    pub fn beside(&mut self, shown: &mut Shown, finest: &Taken, others: &Settings, settings: &Settings) -> Result<[f64; 3], ChartError> {
        let taken = self.picture(shown, settings)?;
        Ok([self.error(finest, &taken), self.time(shown, settings)?, self.time(shown, others)?])
    }

    /// Draws it with these settings.
    pub fn picture(&mut self, shown: &mut Shown, settings: &Settings) -> Result<Taken, ChartError> {
        let frame = shown.stage.frame(shown.camera, self.size, shown.moment.time(), &shown.moment.histories(), None, settings);
        let picture = self.offscreen.renderer.picture(&frame, false)?;
        let light = picture.display.chunks_exact(4).map(|pixel| [0, 1, 2].map(|k| linear(pixel[k]))).collect();
        Ok(Taken { light, bytes: picture.display })
    }

    /// Milliseconds a frame with these settings: the instances, the passes, until all is done. On a software driver of the processor, all
    /// threads together.
    fn time(&mut self, shown: &mut Shown, settings: &Settings) -> Result<f64, ChartError> {
        let mut frame = || shown.stage.frame(shown.camera, self.size, shown.moment.time(), &shown.moment.histories(), None, settings);
        // A software driver works on the processor: its time is not disturbed by other programs.
        let is_software = self.gpu.adapter.device_type == wgpu::DeviceType::Cpu;
        let start = Instant::now();
        let clock = || processor_time().filter(|_| is_software).unwrap_or_else(|| 1e3 * start.elapsed().as_secs_f64());
        let mut milliseconds = f64::INFINITY;
        for _ in 0..TIMED {
            let begin = clock();
            self.offscreen.draw(&frame())?;
            milliseconds = milliseconds.min(clock() - begin);
        }
        Ok(milliseconds)
    }

    /// The picture with these settings, once memory and clocks have settled.
    pub fn finest(&mut self, shown: &mut Shown, settings: &Settings) -> Result<Taken, ChartError> {
        let finest = shown.finest;
        (0..WARM).try_for_each(|_| self.time(shown, &finest).map(|_| ()))?;
        self.picture(shown, settings)
    }

    /// Mean FLIP of a picture from the finest.
    pub fn error(&self, finest: &Taken, taken: &Taken) -> f64 {
        mean_flip(&finest.light, &taken.light, self.size)
    }
}

/// Light of an sRGB byte (IEC 61966-2-1).
pub fn linear(byte: u8) -> f32 {
    let value = f32::from(byte) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}
