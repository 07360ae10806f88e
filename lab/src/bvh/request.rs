//! What the chart is asked for.

use std::path::PathBuf;

use crate::chart::{Output, SheetError};
use crate::plot::PlotError;
use crate::straight::scenes::bunny::PlyError;

/// What the chart is asked for.
#[derive(Clone, Debug)]
pub struct BvhRequest {
    /// Where it goes.
    pub output: Output,
    /// Names of scenes: balls4A, balls4B, balls4C, tree10, castle, bunny; and needles, which is not of Sei 2008.
    pub scenes: Vec<String>,
    /// Width and height in pixels.
    pub size: [usize; 2],
    /// How often each method runs; the median counts.
    pub rounds: usize,
    /// The Stanford bunny as PLY; where there is no such file, a blob of as many triangles takes its place.
    pub bunny: PathBuf,
    /// Compares hits instead of timing: the methods with each other, and with brute force in f64.
    pub check: bool,
}

/// Why there is no chart.
#[derive(Debug, thiserror::Error)]
pub enum ChartError {
    /// The CSV.
    #[error(transparent)]
    Sheet(#[from] SheetError),
    /// The picture.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// The bunny.
    #[error(transparent)]
    Ply(#[from] PlyError),
    /// Embree.
    #[cfg(feature = "embree")]
    #[error(transparent)]
    Embree(#[from] super::embree::EmbreeError),
    /// An unknown scene.
    #[error("--scenes {0}: unknown; there are {all}", all = ALL.join(", "))]
    Scene(String),
    /// A method gave an answer that rounding does not explain.
    #[error("{0} hits are wrong")]
    Wrong(usize),
}

impl ChartError {
    /// Whether the request was at fault.
    pub fn is_input(&self) -> bool {
        matches!(self, ChartError::Scene(_) | ChartError::Ply(_))
    }
}

/// Every scene: those, and one that trees of boxes hold badly.
pub const ALL: [&str; 7] = [SCENES[0], SCENES[1], SCENES[2], SCENES[3], SCENES[4], SCENES[5], "needles"];

/// Every scene of Sei 2008, in its order.
pub const SCENES: [&str; 6] = ["bunny", "castle", "tree10", "balls4A", "balls4B", "balls4C"];
