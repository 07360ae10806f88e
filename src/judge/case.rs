//! `lensrunner trace`: a scene's picture by the judge, every pixel by a geodesic of its own.

use std::path::Path;
use std::time::{Duration, Instant};

use glam::{DQuat, DVec3};
use indicatif::{ProgressBar, ProgressStyle};

use crate::judge::picture::post_process::{PostProcess, post_process};
use crate::judge::picture::shade::Shift;
use crate::judge::picture::sky::{Background, stars};
use crate::judge::picture::{Disk, Layer, Motion, Picture, Pose, Quality, Surroundings, Sway, Thing, World, Worldline, picture};
use crate::judge::trace::PixelCamera;
use crate::picture_file::{Channel, PictureFileError, check_writable, write_exr, write_png};
use crate::scene::camera::viewpoint::CameraEnded;
use crate::scene::disk::Gas;
use crate::scene::lighting::Lights;
use crate::scene::planet::{AuroraShape, Planet};
use crate::scene::{self, Assembly, Body, ConfigError, GameConfig, Scene, SceneError};
use crate::sim::history::MotionBounds;
use crate::sim::{History, Moment};
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
    /// The ships' worldlines, in scene order.
    pub histories: Vec<History>,
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
        let mut histories: Vec<History> = moment.histories().into_iter().cloned().collect();
        for history in &mut histories {
            // To where light, in past the hole, some turns around and out again, no longer comes up with the ship; at most to the oldest
            // light that the judge looks for.
            let mut back = 120.0 + 2.0 * camera.observer.position.length();
            loop {
                history.reach_back(time - back);
                if back > 1e5 || history.at(time - back).position.length() + 120.0 + 2.0 * camera.observer.position.length() < back {
                    break;
                }
                back *= 1.5;
            }
        }
        let assembly = scene.assemble(&config);
        Case { scene, config, assembly, time, histories, camera, ended }
    }

    /// An error if the camera is where nothing is seen.
    pub fn check(&self) -> Result<(), CameraEnded> {
        self.ended
    }

    /// The world as the judge sees it, the ships on these worldlines, in scene order.
    pub fn world<'a>(&'a self, ships: &[&'a dyn Worldline]) -> World<'a> {
        let lights = Lights::of(&self.scene, &self.config);
        let things = self.assembly.objects.iter().enumerate().filter_map(|(number, object)| {
            let (motion, position) = match object.body {
                Body::Held { position, attitude } => (Motion::Held { position, attitude }, position),
                Body::Ship(index) => {
                    let line = *ships.get(index)?;
                    (Motion::Flying(line), line.at(self.time).position)
                }
                // These are the game's: no scene has any at its start.
                Body::Bolt(_) | Body::Ghost => return None,
                Body::Planet => {
                    let planet: &dyn Worldline = self.scene.planet.as_ref()?;
                    (Motion::Flying(planet), planet.at(self.time).position)
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
    pub fn shift(&self) -> Shift {
        Shift { doppler: self.config.render.doppler, beaming: self.config.render.beaming }
    }

    /// The judge's picture, with the sky or without; `done` is told how many pixels have been finished.
    pub fn trace(&self, quality: &Quality, with_sky: bool, done: &(dyn Fn(u64) + Sync)) -> Picture {
        let ships: Vec<&dyn Worldline> = self.histories.iter().map(|history| history as &dyn Worldline).collect();
        self.trace_with(&ships, quality, with_sky, done)
    }

    /// The same in `limit` seconds at most, if that is given; an error where it is not finished then.
    pub fn trace_within(
        &self,
        quality: &Quality,
        with_sky: bool,
        limit: Option<f64>,
        done: &(dyn Fn(u64) + Sync),
    ) -> Result<Picture, OverTime> {
        let ships: Vec<&dyn Worldline> = self.histories.iter().map(|history| history as &dyn Worldline).collect();
        let deadline = limit.and_then(|limit| Instant::now().checked_add(Duration::try_from_secs_f64(limit).ok()?));
        let picture = self.trace_until(&ships, quality, with_sky, deadline, done);
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
        quality: &Quality,
        with_sky: bool,
        done: &(dyn Fn(u64) + Sync),
    ) -> Picture {
        self.trace_until(ships, quality, with_sky, None, done)
    }

    fn trace_until<'a>(
        &'a self,
        ships: &[&'a dyn Worldline],
        quality: &Quality,
        with_sky: bool,
        deadline: Option<Instant>,
        done: &(dyn Fn(u64) + Sync),
    ) -> Picture {
        let sky = &self.scene.sky;
        let disk = self.scene.disk(&self.config).map(|disk| Disk::new(Gas::new(&disk, self.config.hole.mass_solar)));
        let (milky_way, _) = scene::sky::milky_way::load_or_dark();
        let brightness = if with_sky && sky.milky_way { self.config.sky.milky_way_brightness * sky.brightness } else { 0.0 };
        let background = Background::new(&milky_way, brightness as f32);
        let spots = if with_sky && sky.stars {
            let (catalogue, _) = scene::sky::stars::load_or_stand_in();
            let brightness = self.config.sky.star_brightness * sky.brightness;
            stars(&catalogue, &self.camera, self.config.render.lensing, quality.tolerance, brightness, self.shift())
        } else {
            Vec::new()
        };
        let setting = Surroundings { background: &background, stars: &spots, disk: disk.as_ref(), shift: self.shift() };
        let mut world = self.world(ships);
        if let Some(deadline) = deadline {
            world.stop_at(deadline);
        }
        picture(&world, &setting, &self.camera, quality, done)
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
    pub fn post_process(&self) -> PostProcess {
        let render = &self.config.render;
        PostProcess {
            bloom: render.bloom as f32,
            key: self.scene.disk(&self.config).map_or(render.exposure_key, |disk| disk.exposure_key) as f32,
            exposure_range: [render.exposure_min, render.exposure_max].map(|stops| stops.exp2() as f32),
        }
    }
}

/// Traces the picture into a file, with a progress bar; gives the rays per second and thread.
pub fn trace_to_file(request: &TraceRequest, config: Option<&Path>, output: &Path, layers: bool) -> Result<f64, TraceError> {
    let side = request.check()?;
    let ending = output.extension().and_then(|extension| extension.to_str());
    // A wrong name is said before the work.
    if !matches!(ending, Some("png" | "exr")) {
        return Err(PictureFileError::Format(output.to_path_buf()).into());
    }
    if layers && ending == Some("png") {
        return Err(TraceError::Input("--layers needs an .exr: a PNG holds the finished picture alone".into()));
    }
    let config = scene::config::find(config)?;
    let scene = scene::load(&request.scene)?;
    // A place that cannot be written to is said before the work too.
    check_writable(output)?;
    if request.at > 100.0 {
        eprintln!("playing to T = {}", request.at);
    }
    let case = Case::new(scene, config, request.at, request.size);
    case.check()?;
    for warning in &case.assembly.warnings {
        eprintln!("warning: {warning}");
    }
    if let Some(what) = case.left_out() {
        eprintln!("note: {what}");
    }
    let threads = rayon::ThreadPoolBuilder::new()
        .num_threads(request.threads)
        .build()
        .map_err(|error| TraceError::Threads { threads: request.threads, reason: error.to_string() })?;
    let [width, height] = request.size;
    let bar = ProgressBar::new(u64::from(width) * u64::from(height));
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} pixels, {per_sec}, {eta} left") {
        bar.set_style(style);
    }
    let started = Instant::now();
    let quality = Quality { samples: side, tolerance: request.tolerance, packet: request.packet };
    let picture = threads.install(|| case.trace_within(&quality, true, request.limit, &|pixels| bar.inc(pixels)));
    bar.finish_and_clear();
    let picture = picture?;
    if let Some(what) = picture.given_up_in_words() {
        eprintln!("note: {what}");
    }
    let rate = f64::from(width) * f64::from(height) * f64::from(request.samples)
        / (started.elapsed().as_secs_f64() * threads.current_num_threads() as f64);
    if ending == Some("png") {
        write_png(output, &post_process(&picture.light, picture.size, &case.post_process()), picture.size)?;
    } else {
        write_exr(output, picture.size, &channels(&picture, layers))?;
    }
    Ok(rate)
}

/// The channels of a picture: light, and on request what the pixels show. Names are those of `shot --layers` where they mean the same.
pub fn channels(picture: &Picture, layers: bool) -> Vec<Channel> {
    let channel = |name: &'static str, data: Vec<f32>| Channel { name, data };
    let light = |k: usize| picture.light.iter().map(|rgb| rgb[k]).collect();
    let mut channels = vec![channel("R", light(0)), channel("G", light(1)), channel("B", light(2))];
    if layers {
        let layer = |value: &dyn Fn(&crate::judge::picture::Layer) -> f32| picture.layers.iter().map(value).collect();
        channels.extend([
            channel("object.id", layer(&|l| l.object as f32)),
            channel("triangle.id", layer(&|l| l.triangle as f32)),
            channel("barycentric.a", layer(&|l| l.barycentrics[0])),
            channel("barycentric.b", layer(&|l| l.barycentrics[1])),
            channel("barycentric.c", layer(&|l| l.barycentrics[2])),
            channel("texture.u", layer(&|l| l.uv[0])),
            channel("texture.v", layer(&|l| l.uv[1])),
            channel("image.order", layer(&|l| l.order as f32)),
            channel("swept.angle", layer(&|l| l.swept as f32)),
            channel("travel.time", layer(&|l| l.delay as f32)),
            channel("frequency.ratio", layer(&|l| l.g as f32)),
        ]);
    }
    channels
}
