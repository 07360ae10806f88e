//! The chart `tessellation`: how far surface points are displaced on the picture, against vertices and time, by ways to divide triangles.
//!
//! The pictures are those of the game's renderer, the judge is that of `compare`.

mod draw;
mod measure;
mod ways;

pub use measure::measure;
pub use ways::NAMES;

use std::path::PathBuf;

use lensrunner::render::DeviceError;
use lensrunner::render::gpu::readback::PictureError;
use lensrunner::scene::SceneError;

use crate::chart::{Output, SheetError};
use crate::plot::PlotError;

/// What the chart is asked for.
#[derive(Clone, Debug)]
pub struct TessellationRequest {
    /// Where it goes.
    pub output: Output,
    /// Names or files of scenes.
    pub scenes: Vec<String>,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Bounds, in pixels, for the ways that have one.
    pub bounds: Vec<f64>,
    /// Rounds of timing in which all ways take turns; the median counts.
    pub rounds: usize,
}

/// Why there is no chart.
#[derive(Debug, thiserror::Error)]
pub enum TessellationError {
    /// The CSV.
    #[error(transparent)]
    Sheet(#[from] SheetError),
    /// The chart's picture.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// A scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// There is no device to draw with.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// A picture.
    #[error(transparent)]
    Picture(#[from] PictureError),
}

/// Measures (or reads) and draws; returns the files written.
pub fn run(request: &TessellationRequest) -> Result<Vec<PathBuf>, TessellationError> {
    let output = &request.output;
    let sheet = output.sheet("tessellation", || measure::measure(request))?;
    let files = draw::draw(&sheet).save(&output.folder, "tessellation")?;
    Ok(files.into_iter().chain([output.csv("tessellation")]).collect())
}
