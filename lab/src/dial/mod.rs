//! What each step of each knob of the picture's quality costs and saves, and whether the predictions made from that hold: `chart dial`.
//!
//! - [`moments`]: scenes, times and cameras at random, by class; frames of them.
//! - [`prices`]: the price list that the game reads (`tables/quality.csv`).
//! - [`check`]: rungs chosen at random, predicted and measured.
//! - [`levels`]: the levels that players choose between, and everything at its finest.
//! - [`moving`]: frames one after the other, with a rung that changes and without.
//! - [`draw`]: the ladder of each class, and the check, as a picture.
//!
//! The error is mean FLIP from the finest picture of the same size, which the judge holds to half a pixel ([`crate::compare`]).

pub mod check;
pub mod draw;
pub mod levels;
pub mod moments;
pub mod moving;
pub mod prices;

use thiserror::Error;

use crate::chart::SheetError;
use crate::plot::PlotError;
use lensrunner::render::DeviceError;
use lensrunner::render::gpu::readback::PictureError;
use lensrunner::render::quality::prices::PricesError;
use lensrunner::scene::SceneError;

/// What to measure.
#[derive(Clone, Debug)]
pub struct DialRequest {
    /// Moments of each class, or of all together for a check.
    pub moments: usize,
    /// Seed of the moments.
    pub seed: u64,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

/// Why there is no chart.
#[derive(Debug, Error)]
pub enum DialError {
    /// There is nothing to draw with.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// A scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// No picture.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// The measured prices do not make a table.
    #[error(transparent)]
    Prices(#[from] PricesError),
    /// A table cannot be read or written.
    #[error(transparent)]
    Sheet(#[from] SheetError),
    /// The chart cannot be written.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// No scene has a moment of this class.
    #[error("no scene of the class {0} has a moment with a camera outside of r = 1.2 r_s")]
    Empty(&'static str),
}

/// The value that the share `q` of `values` does not exceed.
pub(crate) fn quantile(values: &mut [f64], q: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(((values.len().max(1) - 1) as f64 * q).round() as usize).copied().unwrap_or(f64::NAN)
}
