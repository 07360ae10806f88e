//! The game's renderer before the judge.

use std::sync::{Mutex, PoisonError};

use crate::compare::command::MARKS;
use crate::compare::{ContestantFrame, Shown};
use lensrunner::judge::case::Case;
use lensrunner::render::gpu::device::wait;
use lensrunner::render::gpu::readback::{PictureError, ReadbackPicture};
use lensrunner::render::settings::Settings;
use lensrunner::render::shot::surroundings;
use lensrunner::render::stage::{Stage, settings};
use lensrunner::render::{DeviceError, Gpu, Renderer};
use lensrunner::scene::{GameConfig, Model};

/// The game's renderer, kept from case to case: its device and its passes are made once.
#[derive(Default)]
pub struct GameContestant {
    renderer: Mutex<Option<Renderer>>,
    /// Divides edges by their midpoints alone (`Settings::midpoint`).
    midpoint: bool,
}

impl GameContestant {
    /// The same renderer with the criterion of Yamashita 2025, or with its own.
    pub fn set_midpoint(&mut self, midpoint: bool) {
        self.midpoint = midpoint;
    }

    /// Draws the case as the game does: with its sky, without, and twice with layers, of models marked finely and coarsely. Auroras have a
    /// judge of their own and are left out.
    pub fn draw(&self, case: &Case) -> Result<ContestantFrame, String> {
        self.with_renderer(case, |renderer| {
            let mut stage = stage_of(renderer, case, None);
            let [sky, bare] = [
                drawn(renderer, case, &mut stage, false, self.with(case, true))?,
                drawn(renderer, case, &mut stage, false, self.with(case, false))?,
            ];
            let surfaces = match case.scene.disk(&case.config) {
                Some(_) => without_disk(renderer, case, self.with(case, false))?.linear,
                None => bare.linear.clone(),
            };
            let [first, second] = MARKS.map(|mark| marked(renderer, case, mark, self.with(case, false)));
            let (first, second) = (first?, second?);
            let rgb = |light: &[[f32; 4]]| -> Vec<[f32; 3]> { light.iter().map(|p| [p[0], p[1], p[2]]).collect() };
            let shown = (0..first.layers.len()).map(|i| shown(&first, &second, i));
            let [light, bare, surfaces] = [&sky.linear, &bare.linear, &surfaces].map(|light| rgb(light));
            Ok(ContestantFrame { size: sky.size, light, bare, surfaces, shown: shown.collect() })
        })
    }

    /// What its pixels show, and nothing of its light: a quarter of the work.
    pub fn show(&self, case: &Case) -> Result<Vec<Shown>, String> {
        self.with_renderer(case, |renderer| {
            let layers = marked(renderer, case, MARKS[0], self.with(case, false))?;
            Ok((0..layers.layers.len()).map(|i| shown(&layers, &layers, i)).collect())
        })
    }

    /// The settings of a case, with its sky or without.
    fn with(&self, case: &Case, sky: bool) -> Settings {
        let settings = Settings { midpoint: self.midpoint, ..settings(&case.config) };
        if sky { settings } else { Settings { stars: false, milky_way: false, ..settings } }
    }

    fn with_renderer<T>(&self, case: &Case, draw: impl FnOnce(&mut Renderer) -> Result<T, DrawError>) -> Result<T, String> {
        // After a panic, or an error of the device, the next case gets a renderer of its own.
        let kept = self.renderer.lock().unwrap_or_else(PoisonError::into_inner).take();
        let mut renderer = kept.map_or_else(|| renderer(case.camera.size), Ok).map_err(|error| error.to_string())?;
        let drawn = draw(&mut renderer);
        if matches!(drawn, Ok(_) | Err(DrawError::Outside(_))) {
            *self.renderer.lock().unwrap_or_else(PoisonError::into_inner) = Some(renderer);
        }
        drawn.map_err(|error| error.to_string())
    }
}

/// Why a case is not drawn.
#[derive(Debug, thiserror::Error)]
enum DrawError {
    #[error(transparent)]
    Picture(#[from] PictureError),
    #[error("{0} triangles lay outside of where their object's image can be")]
    Outside(u32),
}

/// A renderer without a window, for pictures of this size at first.
fn renderer(size: [u32; 2]) -> Result<Renderer, DeviceError> {
    Ok(Renderer::new(&Gpu::headless()?, &surroundings(), wgpu::TextureFormat::Rgba8UnormSrgb, size))
}

/// The picture with layers, without the sky, of models marked so.
fn marked(renderer: &mut Renderer, case: &Case, mark: fn(&Model) -> Model, settings: Settings) -> Result<ReadbackPicture, DrawError> {
    let mut stage = stage_of(renderer, case, Some(mark));
    drawn(renderer, case, &mut stage, true, settings)
}

/// The picture without the disk. What shines on the bodies stays.
fn without_disk(renderer: &mut Renderer, case: &Case, settings: Settings) -> Result<ReadbackPicture, DrawError> {
    let config = prepared(renderer, case);
    let table = renderer.table().clone();
    let (mut stage, mut upload) = wait(Stage::prepare(&table, &case.scene, case.assembly.clone(), &config, None));
    upload.disk = None;
    renderer.upload(&upload);
    drawn(renderer, case, &mut stage, false, settings)
}

fn stage_of(renderer: &mut Renderer, case: &Case, mark: Option<fn(&Model) -> Model>) -> Stage {
    let config = prepared(renderer, case);
    Stage::of(renderer, &case.scene, case.assembly.clone(), &config, mark)
}

/// Gives the renderer the size of a case; the configuration that is drawn by.
fn prepared(renderer: &mut Renderer, case: &Case) -> GameConfig {
    renderer.resize(case.camera.size);
    let mut config = case.config.clone();
    config.aurora.enabled = false;
    config
}

fn drawn(renderer: &mut Renderer, case: &Case, stage: &mut Stage, layers: bool, settings: Settings) -> Result<ReadbackPicture, DrawError> {
    let histories: Vec<_> = case.histories.iter().collect();
    let frame = stage.frame(case.camera.observer, case.camera.size, case.time, &histories, case.hidden, &settings);
    let picture = renderer.picture(&frame, layers)?;
    match renderer.counters()?.outside {
        0 => Ok(picture),
        count => Err(DrawError::Outside(count)),
    }
}

/// Draws the case on a device of its own.
pub fn draw(case: &Case) -> Result<ContestantFrame, String> {
    GameContestant::default().draw(case)
}

fn shown(first: &ReadbackPicture, second: &ReadbackPicture, i: usize) -> Shown {
    let [what, surface] = [first.layers[i], first.surface[i]];
    Shown {
        object: what[0] as u32,
        order: what[1] as u32,
        body: [surface[0], surface[1], second.surface[i][0]],
        // Thin images add up.
        coverage: if surface[2] < OPAQUE { first.thin.get(i).map_or(0.0, |sum| sum.min(OPAQUE)) } else { 1.0 },
    }
}

/// From this coverage on a triangle is an opaque one, whose coverage of 1 has been interpolated and rounded.
const OPAQUE: f32 = 0.999;
