//! One picture of a scene at a time T, without a window.

use std::path::Path;
use std::sync::Arc;

use bevy::log::warn;
use thiserror::Error;

use crate::lensing;
use crate::scene::camera::viewpoint::CameraEnded;
pub use crate::scene::picture_size as size;
use crate::scene::{self, ConfigError, GameConfig, SceneError};
pub use crate::sim::Moment;
use crate::sim::snapshot::Snapshot;

use crate::render::frame::FrameInput;
use crate::render::gpu::device::{OPTIONAL, wait};
use crate::render::gpu::readback::{PictureError, ReadbackPicture};
use crate::render::gpu::types::Star;
use crate::render::renderer::{Renderer, Surroundings};
use crate::render::settings::Settings;
use crate::render::stage::{Stage, settings};
use crate::render::{DeviceError, Gpu};

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
    /// The camera sees nothing then.
    #[error(transparent)]
    Observer(#[from] CameraEnded),
}

impl ShotError {
    /// Whether what was asked for is wrong, not the machine.
    pub fn is_input(&self) -> bool {
        !matches!(self, ShotError::Device(_) | ShotError::Picture(_)) || matches!(self, ShotError::Picture(PictureError::Format(_)))
    }
}

/// What to draw.
#[derive(Clone, Debug)]
pub struct ShotRequest<'a> {
    /// A scene's name or file.
    pub scene: &'a str,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// T in r_s/c.
    pub at: f64,
    /// Whether layers are wanted.
    pub layers: bool,
    /// Whether the ship marked as the player's is lit as the game does it; not so where light itself is asked for.
    pub fill: bool,
}

/// Everything around: table, stars, Milky Way, from the project's files. What cannot be read is said in the log and replaced.
pub fn surroundings() -> Surroundings {
    let table = lensing::default_table_or(|error| warn!("{error}; another takes its place"));
    let (stars, wrong) = scene::sky::stars::load_or_stand_in();
    if let Some(error) = wrong {
        warn!("{error}; a made-up sky stands in");
    }
    let (milky_way, wrong) = scene::sky::milky_way::load_or_dark();
    if let Some(error) = wrong {
        warn!("{error}; the sky stays dark");
    }
    Surroundings {
        table: Arc::new(table),
        stars: stars.iter().map(star).collect(),
        milky_way: milky_way.levels.iter().map(|level| (level.width as u32, level.height as u32, level.brightness.clone())).collect(),
    }
}

fn star(star: &scene::sky::stars::Star) -> Star {
    let scene::sky::stars::Star { direction, flux, temperature, .. } = *star;
    Star { direction: direction.to_array(), flux, temperature, luminance: 0.0, unused: [0.0; 2] }
}

/// Draws the picture.
pub fn shot(request: &ShotRequest, config: &GameConfig) -> Result<ReadbackPicture, ShotError> {
    wait(shot_later(request, config))
}

/// The same, where one cannot wait.
pub async fn shot_later(request: &ShotRequest<'_>, config: &GameConfig) -> Result<ReadbackPicture, ShotError> {
    if !(0.0..=1e5).contains(&request.at) {
        return Err(ShotError::Time(request.at));
    }
    let scene = scene::load(request.scene)?;
    let gpu = Gpu::open(OPTIONAL).await?;
    let mut renderer = Renderer::new(&gpu, &surroundings(), wgpu::TextureFormat::Rgba8UnormSrgb, request.size);
    let (mut stage, upload) = Stage::prepare(renderer.table(), &scene, scene.assemble(config), config, None).await;
    renderer.upload(&upload);
    let moment = Moment::new(&scene, config, request.at, 0);
    scene.camera.check(moment.time(), &moment.ships())?;
    let camera = stage.camera(moment.time(), &moment.ships());
    let own_ship = scene.ships.iter().position(|ship| ship.player).filter(|_| request.fill);
    let settings = Settings { own_ship, ..settings(config) };
    let frame = stage.frame(camera, request.size, moment.time(), &moment.histories(), None, &settings);
    complete(&mut renderer, &frame, request.layers).await
}

/// Draws the moment of a picture of the game again, in `size` pixels. `fill`: the player's ship is lit as the game does it; not so where
/// light itself is asked for. The eye has adapted; the ghost of an earlier flight is left out, and an aurora is as after no frames before.
pub fn shot_again(snapshot: &Snapshot, moment: &Moment, size: [u32; 2], layers: bool, fill: bool) -> Result<ReadbackPicture, ShotError> {
    let (config, shot) = (snapshot.config(), &snapshot.shot);
    let gpu = Gpu::headless()?;
    let mut renderer = Renderer::new(&gpu, &surroundings(), wgpu::TextureFormat::Rgba8UnormSrgb, size);
    let mut stage = Stage::new(&mut renderer, &moment.scene, &snapshot.levelled(&moment.scene));
    let settings =
        Settings { own_ship: shot.lit.filter(|_| fill), engines: Some([config.ship.thrust, config.enemy.thrust]), ..settings(&config) };
    let frame = stage.frame(shot.camera, size, snapshot.time, &moment.all_histories(), shot.hidden, &settings);
    wait(complete(&mut renderer, &frame, layers))
}

/// The picture; what it lacks is said in the log.
async fn complete(renderer: &mut Renderer, frame: &FrameInput, layers: bool) -> Result<ReadbackPicture, ShotError> {
    let picture = renderer.picture_later(frame, layers).await?;
    if let Some(complaint) = renderer.counters_later().await?.complaint() {
        warn!("the picture is not complete: {complaint}");
    }
    Ok(picture)
}

/// Draws the picture into a file.
pub fn shot_to_file(request: &ShotRequest, config: &GameConfig, output: &Path) -> Result<(), ShotError> {
    // A wrong name is said before the work.
    if !matches!(output.extension().and_then(|extension| extension.to_str()), Some("png" | "exr")) {
        return Err(PictureError::Format(output.display().to_string()).into());
    }
    shot(request, config)?.write(output)?;
    Ok(())
}

/// The same of the moment of a picture; a PNG carries that moment on.
pub fn shot_again_to_file(snapshot: &Snapshot, moment: &Moment, layers: bool, fill: bool, output: &Path) -> Result<(), ShotError> {
    if !matches!(output.extension().and_then(|extension| extension.to_str()), Some("png" | "exr")) {
        return Err(PictureError::Format(output.display().to_string()).into());
    }
    shot_again(snapshot, moment, snapshot.size, layers, fill)?.write_with_text(output, Some(&snapshot.to_text()))?;
    Ok(())
}
