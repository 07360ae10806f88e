//! The game's renderer before the judge.

use std::sync::{Mutex, PoisonError};

use crate::measure::compare::command::MARKS;
use crate::measure::compare::{Frame, Shown};
use crate::measure::trace::Case;
use crate::render::Renderer;
use crate::render::readback::Picture;
use crate::render::shot::{ShotError, for_comparison, renderer};

/// The game's renderer, kept from case to case: its device and its passes are made once.
#[derive(Default)]
pub struct Contestant(Mutex<Option<Renderer>>);

impl Contestant {
    /// Draws the case as the game does; the points of surfaces come from the same frame with marked models.
    pub fn draw(&self, case: &Case) -> Result<Frame, String> {
        // After a panic or an error the next case gets a renderer of its own.
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        let said = |error: ShotError| error.to_string();
        let mut renderer = kept.map_or_else(|| renderer(case.camera.size), Ok).map_err(said)?;
        let drawn = for_comparison(&mut renderer, &case.scene, &case.assembly, MARKS, &case.config, case.time, case.camera.size);
        let [sky, bare, first, second] = drawn.map_err(said)?;
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(renderer);
        let rgb = |light: &[[f32; 4]]| light.iter().map(|p| [p[0], p[1], p[2]]).collect();
        let shown = (0..first.layers.len()).map(|i| shown(&first, &second, i));
        Ok(Frame { size: sky.size, light: rgb(&sky.linear), bare: rgb(&bare.linear), shown: shown.collect() })
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
