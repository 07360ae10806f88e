//! One picture of a scene at a time T, without a window.

use std::path::Path;
use std::sync::Arc;

use bevy::prelude::*;
use thiserror::Error;

use crate::scene::{self, ConfigError, GameConfig, SceneError, Scene};
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

/// Everything around: table, stars, Milky Way, from the project's files.
pub fn surroundings() -> Surroundings {
    let folder = scene::assets_folder();
    Surroundings { table: Arc::new(crate::lensing::load_or_bake(&folder)), stars: load_stars(&folder), milky_way: load_milky_way(&folder) }
}

fn load_stars(_folder: &Path) -> Vec<Star> {
    Vec::new()
}

fn load_milky_way(_folder: &Path) -> super::sky::Panorama {
    vec![(1, 1, vec![[0.0; 3]])]
}

/// A scene with its ships at a time T.
pub struct Moment {
    world: App,
    names: Vec<String>,
}

impl Moment {
    /// Plays the scene from T = 0 to T = `at`.
    pub fn new(scene: &Scene, config: &GameConfig, at: f64, seed: u64) -> Moment {
        let sim = simulate::SimScene { ships: scene.ships.clone(), rules: scene.rules(config) };
        let mut world = simulate::world_of(&sim, seed);
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
    let frame = stage.frame(camera, moment.time(), &moment.histories(), None, &settings(config));
    Ok(renderer.picture(&frame, request.layers)?)
}
