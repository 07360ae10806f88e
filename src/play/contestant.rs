//! The game's renderer before the judge.

use crate::measure::compare::command::MARKS;
use crate::measure::compare::{Frame, Shown};
use crate::measure::trace::Case;
use crate::render::readback::Picture;
use crate::render::shot::for_comparison;

/// Draws the case as the game does; the points of surfaces come from the same frame with marked models.
pub fn draw(case: &Case) -> Result<Frame, String> {
    let [sky, bare, first, second] =
        for_comparison(&case.scene, &case.assembly, MARKS, &case.config, case.time, case.camera.size).map_err(|error| error.to_string())?;
    let rgb = |light: &[[f32; 4]]| light.iter().map(|p| [p[0], p[1], p[2]]).collect();
    let shown = (0..first.layers.len()).map(|i| shown(&first, &second, i));
    Ok(Frame { size: sky.size, light: rgb(&sky.linear), bare: rgb(&bare.linear), shown: shown.collect() })
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
