//! The game's renderer before the judge.

use std::sync::{Mutex, PoisonError};

use crate::compare::command::MARKS;
use crate::compare::{Frame, Shown};
use lensrunner::judge::case::Case;
use lensrunner::render::Renderer;
use lensrunner::render::gpu::readback::Picture;
use lensrunner::render::shot::{Compared, ShotError, for_comparison, marked, renderer};

/// The game's renderer, kept from case to case: its device and its passes are made once.
#[derive(Default)]
pub struct Contestant(Mutex<Option<Renderer>>);

impl Contestant {
    /// Draws the case as the game does; the points of surfaces come from the same frame with marked models.
    pub fn draw(&self, case: &Case) -> Result<Frame, String> {
        self.with_renderer(case, |renderer| {
            let [sky, bare, first, second] = for_comparison(renderer, &compared_case(case), MARKS)?;
            let rgb = |light: &[[f32; 4]]| light.iter().map(|p| [p[0], p[1], p[2]]).collect();
            let shown = (0..first.layers.len()).map(|i| shown(&first, &second, i));
            Ok(Frame { size: sky.size, light: rgb(&sky.linear), bare: rgb(&bare.linear), shown: shown.collect() })
        })
    }

    /// What its pixels show, and nothing of its light: a quarter of the work.
    pub fn show(&self, case: &Case) -> Result<Vec<Shown>, String> {
        self.with_renderer(case, |renderer| {
            let layers = marked(renderer, &compared_case(case), MARKS[0])?;
            Ok((0..layers.layers.len()).map(|i| shown(&layers, &layers, i)).collect())
        })
    }

    fn with_renderer<T>(&self, case: &Case, draw: impl FnOnce(&mut Renderer) -> Result<T, ShotError>) -> Result<T, String> {
        // After a panic, or an error of the device, the next case gets a renderer of its own.
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        let mut renderer = kept.map_or_else(|| renderer(case.camera.size), Ok).map_err(|error| error.to_string())?;
        let drawn = draw(&mut renderer);
        if matches!(drawn, Ok(_) | Err(ShotError::Outside(_))) {
            *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(renderer);
        }
        drawn.map_err(|error| error.to_string())
    }
}

fn compared_case(case: &Case) -> Compared<'_> {
    Compared {
        scene: &case.scene,
        assembly: &case.assembly,
        config: &case.config,
        time: case.time,
        histories: case.histories.iter().collect(),
        camera: case.camera.observer,
        size: case.camera.size,
    }
}

/// Draws the case on a device of its own.
pub fn draw(case: &Case) -> Result<Frame, String> {
    Contestant::default().draw(case)
}

fn shown(first: &Picture, second: &Picture, i: usize) -> Shown {
    let [what, surface] = [first.layers[i], first.surface[i]];
    Shown {
        object: what[0] as u32,
        order: what[1] as u32,
        body: [surface[0], surface[1], second.surface[i][0]],
        // Thin images add up.
        coverage: if surface[2] < OPAQUE { first.thin.get(i).map_or(0.0, |sum| sum.min(1.0)) } else { 1.0 },
    }
}

/// From this coverage on a triangle is an opaque one, whose coverage of 1 has been interpolated and rounded.
const OPAQUE: f32 = 0.999;
