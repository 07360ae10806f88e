//! The game's renderer before the judge.

use crate::measure::compare::{Frame, Shown};
use crate::measure::trace::Case;
use crate::render::shot::with_and_without_sky;

/// Draws the case as the game does.
pub fn draw(case: &Case) -> Result<Frame, String> {
    let [sky, bare] = with_and_without_sky(&case.scene, case.assembly.clone(), &case.config, case.time, case.camera.size)
        .map_err(|error| error.to_string())?;
    let rgb = |light: &[[f32; 4]]| light.iter().map(|p| [p[0], p[1], p[2]]).collect();
    let shown = bare.layers.iter().zip(&bare.surface).enumerate().map(|(i, (what, surface))| Shown {
        object: what[0] as u32,
        order: what[1] as u32,
        uv: [surface[0], surface[1]],
        // Thin images add up.
        coverage: if surface[2] < 1.0 { bare.thin.get(i).map_or(0.0, |sum| sum.min(1.0)) } else { 1.0 },
    });
    Ok(Frame { size: sky.size, light: rgb(&sky.linear), bare: rgb(&bare.linear), shown: shown.collect() })
}
