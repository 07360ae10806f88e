//! One picture of a scene at a time T, without a window.

use std::path::Path;
use std::sync::Arc;

use bevy::prelude::*;
use thiserror::Error;

use crate::lensing;
use crate::scene::{self, ConfigError, GameConfig, Scene, SceneError};
use crate::sim::{Clock, Fleet, History, ShipMotion, simulate};
use crate::spacetime::matter::ShipState;

use super::readback::{Picture, PictureError};
use super::renderer::{Renderer, Surroundings};
use super::stage::{Stage, settings};
use super::types::Star;
use super::{DeviceError, Gpu};

/// Why there is no picture.
#[derive(Debug, Error)]
pub enum ShotError {
    /// The scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// `game.toml` is wrong.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// There is nothing to draw with.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// It could not be written.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// The time is wrong.
    #[error("--at {0}: T must be a number from 0 to 100000 r_s/c")]
    Time(f64),
}

/// What to draw.
#[derive(Clone, Debug)]
pub struct Request<'a> {
    /// A scene's name or file.
    pub scene: &'a str,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// T in r_s/c.
    pub at: f64,
    /// Whether layers are wanted.
    pub layers: bool,
}

/// Everything around: table, stars, Milky Way, from the project's files. What cannot be read is said in the log and replaced.
pub fn surroundings() -> Surroundings {
    let file = scene::assets_folder().join("..").join("tables").join("default.lut");
    let complain = |error: &lensing::TableError| warn!("{error}; the table is baked anew");
    let table = lensing::load_or_bake(&file, lensing::Scheme::Residual, lensing::SMALL_NODES, complain, |_| ());
    let (stars, wrong) = scene::stars::load_or_stand_in();
    if let Some(error) = wrong {
        warn!("{error}; a made-up sky stands in");
    }
    let (milky_way, wrong) = scene::milky_way::load_or_dark();
    if let Some(error) = wrong {
        warn!("{error}; the sky stays dark");
    }
    Surroundings {
        table: Arc::new(table),
        stars: stars.iter().map(star).collect(),
        milky_way: milky_way.levels.iter().map(panorama_level).collect(),
    }
}

fn star(star: &scene::stars::Star) -> Star {
    let [x, y, z] = star.direction.to_array();
    Star { direction: [x, y, z, star.flux], colour: [star.temperature, 0.0, 0.0, 0.0] }
}

/// Brightness as the colour of the black body that it goes with, 1 being [`scene::milky_way::PEAK`].
fn panorama_level(level: &scene::milky_way::Level) -> (u32, u32, Vec<[f32; 3]>) {
    let colour = |brightness: f32| {
        let rgb = scene::blackbody::blackbody_rgb(f64::from(scene::milky_way::temperature(brightness)));
        let scale = brightness / scene::blackbody::luminance(rgb).max(f64::MIN_POSITIVE) as f32;
        rgb.map(|channel| channel as f32 * scale)
    };
    // Eight bits make few different brightnesses on the finest level; the colour is worked out once for each of 1,024.
    let ramp: Vec<[f32; 3]> = (0..=1024).map(|k| colour(k as f32 / 1024.0)).collect();
    let pixels = level.brightness.iter().map(|&brightness| {
        let x = brightness.clamp(0.0, 1.0) * 1024.0;
        let i = (x as usize).min(1023);
        std::array::from_fn(|c| ramp[i][c] + (x - i as f32) * (ramp[i + 1][c] - ramp[i][c]))
    });
    (level.width as u32, level.height as u32, pixels.collect())
}

/// The size of a picture, `WIDTHxHEIGHT`.
pub fn size(text: &str) -> Result<[u32; 2], String> {
    let wrong = || format!("`{text}` is no size: WIDTHxHEIGHT in pixels, each from 1 to 8192, as 1280x720");
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(wrong)?;
    let side = |text: &str| text.parse().ok().filter(|side| (1..=8192).contains(side)).ok_or_else(wrong);
    Ok([side(width)?, side(height)?])
}

/// A scene with its ships at a time T.
pub struct Moment {
    world: App,
    names: Vec<String>,
}

impl Moment {
    /// Plays the scene from T = 0 to T = `at`.
    pub fn new(scene: &Scene, config: &GameConfig, at: f64, seed: u64) -> Moment {
        let mut world = simulate::app_of(scene, config, seed);
        let clock = *world.world().resource::<Clock>();
        let steps = (at / clock.step).round() as u64;
        for _ in 0..steps {
            world.world_mut().run_schedule(FixedUpdate);
        }
        Moment { world, names: scene.ships.iter().map(|ship| ship.name.clone()).collect() }
    }

    /// The clock.
    pub fn time(&self) -> f64 {
        self.world.world().resource::<Clock>().time
    }

    /// States of the ships by name, in scene order.
    pub fn ships(&self) -> Vec<(&str, ShipState)> {
        let world = self.world.world();
        let fleet = &world.resource::<Fleet>().0;
        fleet.iter().zip(&self.names).filter_map(|(&entity, name)| Some((name.as_str(), world.get::<ShipMotion>(entity)?.0))).collect()
    }

    /// Worldlines of the ships, in scene order.
    pub fn histories(&self) -> Vec<&History> {
        let world = self.world.world();
        world.resource::<Fleet>().0.iter().filter_map(|&entity| world.get::<History>(entity)).collect()
    }
}

/// Draws the picture.
pub fn shot(request: &Request, config: &GameConfig) -> Result<Picture, ShotError> {
    if !(0.0..=1e5).contains(&request.at) {
        return Err(ShotError::Time(request.at));
    }
    let scene = scene::load(request.scene)?;
    let gpu = Gpu::headless()?;
    let mut renderer = Renderer::new(&gpu, &surroundings(), wgpu::TextureFormat::Rgba8UnormSrgb, request.size);
    let stage = Stage::new(&mut renderer, &scene, config);
    let moment = Moment::new(&scene, config, request.at, 0);
    let camera = stage.camera(moment.time(), &moment.ships());
    let frame = stage.frame(camera, request.size[0], moment.time(), &moment.histories(), None, &settings(config));
    Ok(renderer.picture(&frame, request.layers)?)
}

/// Draws the picture into a file, with the configuration of `config`.
pub fn shot_to_file(request: &Request, config: Option<&Path>, output: &Path) -> Result<(), ShotError> {
    let config = config.map(scene::config::load).transpose()?.unwrap_or_default();
    // A wrong name is said before the work.
    if !matches!(output.extension().and_then(|extension| extension.to_str()), Some("png" | "exr")) {
        return Err(PictureError::Format(output.display().to_string()).into());
    }
    shot(request, &config)?.write(output)?;
    Ok(())
}
