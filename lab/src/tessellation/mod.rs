//! The chart `tessellation`: how far surface points are displaced on the picture, against vertices and time, by ways to divide triangles.
//!
//! The pictures are those of the game's renderer, the judge is that of `compare`.

mod draw;
mod measure;
mod ways;

pub use measure::measure;
pub use ways::NAMES;

use std::path::PathBuf;

use clap::Args;
use lensrunner::argument::whole;
use lensrunner::scene::picture_size;

use crate::chart::{ChartError, Output};

/// Ways to divide triangles: displacement of surface points on the picture against vertices and time.
#[derive(Args, Clone, Debug)]
pub struct TessellationRequest {
    /// Where it goes.
    #[command(flatten)]
    pub output: Output,
    /// Scenes: TOML files, or names in assets/scenes.
    #[arg(long = "scene", value_name = "NAME|FILE", value_delimiter = ',', default_value = "ring,parade,galaxy")]
    pub scenes: Vec<String>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = picture_size)]
    pub size: [u32; 2],
    /// Bounds in pixels; 0.5, the game's own, is what the others are told against.
    #[arg(long, value_name = "PX,…", value_delimiter = ',', default_value = "0.125,0.25,0.5,1,2,4,8")]
    pub bounds: Vec<f64>,
    /// Rounds of timing in which all ways take turns; the median counts.
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = whole::<usize>(1, 255))]
    pub rounds: usize,
}

/// Measures (or reads) and draws; returns the files written.
pub fn run(request: &TessellationRequest) -> Result<Vec<PathBuf>, ChartError> {
    let output = &request.output;
    let sheet = output.sheet("tessellation", || measure::measure(request))?;
    let files = draw::draw(&sheet).save(&output.folder, "tessellation")?;
    Ok(files.into_iter().chain([output.csv("tessellation")]).collect())
}
