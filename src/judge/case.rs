//! A scene's picture by the judge, every pixel by a geodesic of its own.

use std::path::Path;
use web_time::{Duration, Instant};

use glam::{DQuat, DVec3};

use crate::judge::picture::post_process::PostProcessSettings;
use crate::judge::picture::shade::LightShift;
use crate::judge::picture::sky::{SkyBackground, stars};
use crate::judge::picture::{BodyMotion, Disk, Environment, Layer, Pose, Sampling, Sway, Thing, TracedPicture, World, Worldline, picture};
use crate::judge::trace::PixelCamera;
use crate::picture_file::PictureFileError;
use crate::picture_file::moment::read_moment;
use crate::scene::camera::viewpoint::CameraEnded;
use crate::scene::disk::Gas;
use crate::scene::lighting::Lights;
use crate::scene::planet::{AuroraShape, Planet};
use crate::scene::{self, Assembly, Body, ConfigError, GameConfig, Scene, SceneError};
use crate::sim::history::MotionBounds;
use crate::sim::snapshot::Snapshot;
use crate::sim::{History, Moment};
use crate::spacetime::Observer;
use crate::spacetime::orbit::orbital_frequency;

/// The local error of each step of a ray unless asked otherwise, relative to r.
pub const DEFAULT_TOLERANCE: f64 = 1e-12;

/// What to trace.
#[derive(Clone, Debug)]
pub struct TraceRequest {
    /// A scene's name or file.
    pub scene: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// T in r_s/c.
    pub at: f64,
    /// Rays a pixel; a square number.
    pub samples: u32,
    /// Threads; 0 as many as there are cores.
    pub threads: usize,
    /// Local error of each step of a ray.
    pub tolerance: f64,
    /// Rays along each side of a packet; 1 for each alone.
    pub packet: u32,
    /// How long the tracing may take, in seconds; None for as long as it needs.
    pub limit: Option<f64>,
}

/// The moment in a file, flown again, to be drawn in `size` pixels or those of the picture.
pub fn flown_again(from: &Path, size: Option<[u32; 2]>) -> Result<(Snapshot, Moment), Box<dyn std::error::Error>> {
    let snapshot = Snapshot::from_text(from, &read_moment(from)?)?;
    let moment = snapshot.fly(from)?;
    Ok((snapshot.resized(size.unwrap_or(snapshot.size)), moment))
}

/// The time for a picture was up before it was finished.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("not finished in {limit} s, the limit: {pixels} of {all} pixels were traced")]
pub struct OverTime {
    /// The time that it had, in seconds.
    pub limit: f64,
    /// How many pixels were finished.
    pub pixels: u64,
    /// How many the picture has.
    pub all: u64,
}

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum TraceError {
    /// The scene is wrong: exit code 2.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// `game.toml` is wrong: exit code 2.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// An argument is wrong: exit code 2.
    #[error("{0}")]
    Input(String),
    /// The camera sees nothing then: exit code 2.
    #[error(transparent)]
    Camera(#[from] CameraEnded),
    /// The picture takes longer than it may: exit code 1.
    #[error(transparent)]
    OverTime(#[from] OverTime),
    /// The file's name says nothing known (exit code 2), or it could not be written (exit code 1).
    #[error(transparent)]
    File(#[from] PictureFileError),
    /// The threads could not be started: exit code 1.
    #[error("cannot start {threads} threads: {reason}")]
    Threads {
        /// How many were asked for.
        threads: usize,
        /// The system's reason.
        reason: String,
    },
}

impl TraceError {
    /// Whether the asker is at fault.
    pub fn is_input(&self) -> bool {
        matches!(
            self,
            TraceError::Scene(_)
                | TraceError::Config(_)
                | TraceError::Input(_)
                | TraceError::Camera(_)
                | TraceError::File(PictureFileError::Format(_))
        )
    }
}

impl TraceRequest {
    /// Checks the numbers; gives the samples along each side of a pixel.
    pub fn check(&self) -> Result<u32, TraceError> {
        let input = |text: String| Err(TraceError::Input(text));
        if !(0.0..=1e5).contains(&self.at) {
            return input(format!("--at {}: T must be a number from 0 to 100000 r_s/c", self.at));
        }
        let side = self.samples.isqrt();
        if side == 0 || side * side != self.samples || side > 16 {
            return input(format!("--samples {}: must be a square number from 1 to 256 (a grid in each pixel)", self.samples));
        }
        if !(1e-17..=1e-3).contains(&self.tolerance) {
            return input(format!("--tolerance {}: must be from 1e-17 to 1e-3", self.tolerance));
        }
        if !(1..=8).contains(&self.packet) {
            return input(format!("--packet {}: must be from 1 (every ray alone) to 8 rays along a side", self.packet));
        }
        if self.threads > 1024 {
            return input(format!("--threads {}: must be from 0 (as many as there are cores) to 1024", self.threads));
        }
        if self.limit.is_some_and(|limit| !(limit > 0.0 && limit <= 1e9)) {
            return input(format!("--limit {}: must be from above 0 to 1e9 seconds", self.limit.unwrap_or(0.0)));
        }
        Ok(side)
    }
}

/// A planet in closed form, at every T.
impl Worldline for Planet {
    fn at(&self, time: f64) -> Pose {
        // A circular orbit outside r = 3/2 has a state at any T, and no other planet is let in from a file.
        self.state(time).map_or(Pose { position: DVec3::ZERO, momentum: DVec3::ZERO, attitude: DQuat::IDENTITY }, |state| Pose {
            position: state.position,
            momentum: state.momentum,
            attitude: state.attitude,
        })
    }

    fn sway(&self, from: f64, _to: f64) -> Option<Sway> {
        // Everything goes round evenly.
        let state = self.state(from)?;
        let (r, p) = (state.position.length(), state.momentum.length());
        let frequency = orbital_frequency(r);
        Some(Sway {
            velocity: frequency * r,
            acceleration: frequency * frequency * r,
            momentum: [p, p],
            force: frequency * p,
            surge: frequency * frequency * p,
            turning: std::f64::consts::TAU / self.day.abs(),
            jumps: [0.0; 2],
        })
    }
}

impl Worldline for History {
    fn at(&self, time: f64) -> Pose {
        let sample = History::at(self, time);
        Pose { position: sample.position, momentum: sample.momentum, attitude: sample.attitude }
    }

    fn exists_at(&self, time: f64) -> bool {
        History::exists_at(self, time)
    }

    fn sway(&self, from: f64, to: f64) -> Option<Sway> {
        let MotionBounds { velocity, acceleration, momentum, force, surge, turning, jumps } = self.bounds(from, to)?;
        Some(Sway { velocity, acceleration, momentum, force, surge, turning, jumps })
    }
}

/// A scene at one T with all that the judge needs to look at it.
pub struct Case {
    /// The scene.
    pub scene: Scene,
    /// Its configuration.
    pub config: GameConfig,
    /// Its models and where each is used.
    pub assembly: Assembly,
    /// The clock T, in r_s/c.
    pub time: f64,
    /// The ships' worldlines, in scene order; in a flight then nobody's, in the place of a ghost, and those of the bolts.
    pub histories: Vec<History>,
    /// The ship that is not drawn, if it is one: the cockpit's own.
    pub hidden: Option<usize>,
    /// The camera.
    pub camera: PixelCamera,
    ended: Result<(), CameraEnded>,
}

impl Case {
    /// Plays `scene` to T = `at` and places its camera for a picture of `size` pixels.
    pub fn new(scene: Scene, config: GameConfig, at: f64, size: [u32; 2]) -> Case {
        let moment = Moment::new(&scene, &config, at, 0);
        Case::of(scene, config, &moment, size)
    }

    /// The same of a scene that has been played to this moment.
    pub fn of(scene: Scene, config: GameConfig, moment: &Moment, size: [u32; 2]) -> Case {
        let time = moment.time();
        let view = scene.camera.viewpoint(time, &moment.ships());
        let ended = scene.camera.check(time, &moment.ships());
        let camera = PixelCamera { observer: view, size };
        let histories = known_back(moment.histories().into_iter().cloned().collect(), time, &camera);
        let assembly = scene.assemble(&config);
        Case { scene, config, assembly, time, histories, hidden: None, camera, ended }
    }

    /// The same with bolts, seen by a camera of one's own in which the ship `hidden` is not drawn.
    pub fn seen(scene: Scene, config: GameConfig, moment: &Moment, observer: Observer, hidden: Option<usize>, size: [u32; 2]) -> Case {
        let (time, camera) = (moment.time(), PixelCamera { observer, size });
        let histories = moment.all_histories().into_iter().cloned().collect();
        let assembly = scene.assemble(&config);
        Case { scene, config, assembly, time, histories: known_back(histories, time, &camera), hidden, camera, ended: Ok(()) }
    }

    /// The moment of a picture, flown again, seen by its camera in a picture of `size` pixels.
    pub fn again(snapshot: &Snapshot, moment: &Moment, size: [u32; 2]) -> Case {
        let (scene, config, time) = (moment.scene.clone(), snapshot.levelled(&moment.scene), snapshot.time);
        let camera = PixelCamera { observer: snapshot.shot.camera, size };
        let histories = known_back(moment.all_histories().into_iter().cloned().collect(), time, &camera);
        let assembly = scene.assemble(&config);
        Case { scene, config, assembly, time, histories, hidden: snapshot.shot.hidden, camera, ended: Ok(()) }
    }

    /// An error if the camera is where nothing is seen.
    pub fn check(&self) -> Result<(), CameraEnded> {
        self.ended
    }

    /// The world as the judge sees it, the ships on these worldlines, in scene order.
    pub fn world<'a>(&'a self, ships: &[&'a dyn Worldline]) -> World<'a> {
        let lights = Lights::of(&self.scene, &self.config);
        let flying = |index: usize| ships.get(index).map(|line| (BodyMotion::Flying(*line), line.at(self.time).position));
        let things = self.assembly.objects.iter().enumerate().filter_map(|(number, object)| {
            let (motion, position) = match object.body {
                Body::Static { position, attitude } => (BodyMotion::Static { position, attitude }, position),
                Body::Ship(index) if self.hidden == Some(index) => return None,
                Body::Ship(index) => flying(index)?,
                // After the ships and the ghost; no scene has any at its start.
                Body::Bolt(number) => flying(self.scene.ships.len() + 1 + number)?,
                Body::Ghost => return None,
                Body::Planet => {
                    let planet: &dyn Worldline = self.scene.planet.as_ref()?;
                    (BodyMotion::Flying(planet), planet.at(self.time).position)
                }
            };
            let light = lights.on(&object.body, position);
            Some(Thing { model: object.model, scale: object.scale, motion, light, id: number as u32 + 1 })
        });
        World::new(&self.assembly.models, things.collect(), self.time, self.config.render.lensing)
    }

    /// What the judge leaves out of the scene, in words; None if that is nothing.
    pub fn left_out(&self) -> Option<&'static str> {
        let shines = |planet: &Planet| planet.aurora != AuroraShape::None;
        let has_aurora = self.config.aurora.enabled && self.scene.planet.as_ref().is_some_and(shines);
        has_aurora.then_some("the planet's aurora is left out: the judge knows surfaces, disk and sky")
    }

    /// How light changes on its way.
    pub fn shift(&self) -> LightShift {
        LightShift { doppler: self.config.render.doppler, beaming: self.config.render.beaming }
    }

    /// The judge's picture, with the sky or without; `done` is told how many pixels have been finished.
    pub fn trace(&self, sampling: &Sampling, with_sky: bool, done: &(dyn Fn(u64) + Sync)) -> TracedPicture {
        let ships: Vec<&dyn Worldline> = self.histories.iter().map(|history| history as &dyn Worldline).collect();
        self.trace_with(&ships, sampling, with_sky, done)
    }

    /// The same in `limit` seconds at most, if that is given; an error where it is not finished then.
    pub fn trace_within(
        &self,
        sampling: &Sampling,
        with_sky: bool,
        limit: Option<f64>,
        done: &(dyn Fn(u64) + Sync),
    ) -> Result<TracedPicture, OverTime> {
        let ships: Vec<&dyn Worldline> = self.histories.iter().map(|history| history as &dyn Worldline).collect();
        let deadline = limit.and_then(|limit| Instant::now().checked_add(Duration::try_from_secs_f64(limit).ok()?));
        let picture = self.trace_until(&ships, sampling, with_sky, deadline, done);
        match limit {
            Some(limit) if picture.missing > 0 => {
                let all = picture.light.len() as u64;
                Err(OverTime { limit, pixels: all - picture.missing, all })
            }
            _ => Ok(picture),
        }
    }

    /// The same with the ships on other worldlines than their own.
    pub fn trace_with<'a>(
        &'a self,
        ships: &[&'a dyn Worldline],
        sampling: &Sampling,
        with_sky: bool,
        done: &(dyn Fn(u64) + Sync),
    ) -> TracedPicture {
        self.trace_until(ships, sampling, with_sky, None, done)
    }

    fn trace_until<'a>(
        &'a self,
        ships: &[&'a dyn Worldline],
        sampling: &Sampling,
        with_sky: bool,
        deadline: Option<Instant>,
        done: &(dyn Fn(u64) + Sync),
    ) -> TracedPicture {
        let sky = &self.scene.sky;
        let disk = self.scene.disk(&self.config).map(|disk| Disk::new(Gas::new(&disk, self.config.hole.mass_solar)));
        let (milky_way, _) = scene::sky::milky_way::load_or_dark();
        let brightness = if with_sky && sky.milky_way { self.config.sky.milky_way_brightness * sky.brightness } else { 0.0 };
        let background = SkyBackground::new(&milky_way, brightness as f32);
        let spots = if with_sky && sky.stars {
            let (catalogue, _) = scene::sky::stars::load_or_stand_in();
            let brightness = self.config.sky.star_brightness * sky.brightness;
            stars(&catalogue, &self.camera, self.config.render.lensing, sampling.tolerance, brightness, self.shift())
        } else {
            Vec::new()
        };
        let environment = Environment { background: &background, stars: &spots, disk: disk.as_ref(), shift: self.shift() };
        let mut world = self.world(ships);
        if let Some(deadline) = deadline {
            world.stop_at(deadline);
        }
        picture(&world, &environment, &self.camera, sampling, done)
    }

    /// The point of its body that a pixel of a picture shows, in the body's axes and the model's unit; the origin where it shows none.
    pub fn body(&self, layer: &Layer) -> DVec3 {
        let Some(object) = (layer.object as usize).checked_sub(1).and_then(|k| self.assembly.objects.get(k)) else { return DVec3::ZERO };
        self.on_model(object.model, layer.triangle as usize, layer.barycentrics.map(f64::from))
    }

    /// The point of a triangle of a model with these barycentric weights, in the model's axes and unit.
    pub fn on_model(&self, model: usize, triangle: usize, weights: [f64; 3]) -> DVec3 {
        let model = &self.assembly.models[model];
        let corners = model.triangles[triangle].map(|index| DVec3::from(model.vertices[index as usize].position.map(f64::from)));
        (0..3).map(|k| corners[k] * weights[k]).sum()
    }

    /// How the game makes a picture of light.
    pub fn post_process(&self) -> PostProcessSettings {
        let render = &self.config.render;
        PostProcessSettings {
            bloom: render.bloom as f32,
            key: self.scene.disk(&self.config).map_or(render.exposure_key, |disk| disk.exposure_key) as f32,
            exposure_range: [render.exposure_min, render.exposure_max].map(|stops| stops.exp2() as f32),
        }
    }
}

/// The worldlines, known back to where light to the camera at T = `time`, in past the hole, some turns around and out again, no longer
/// comes up with the ship; at most to the oldest light that the judge looks for.
fn known_back(mut histories: Vec<History>, time: f64, camera: &PixelCamera) -> Vec<History> {
    let far = 120.0 + 2.0 * camera.observer.position.length();
    for history in &mut histories {
        let mut back = far;
        loop {
            history.reach_back(time - back);
            if back > 1e5 || history.at(time - back).position.length() + far < back {
                break;
            }
            back *= 1.5;
        }
    }
    histories
}
