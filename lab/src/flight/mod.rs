//! The chart `flight`: integrators of matter on five flights, error in energy, angular momentum and phase against cost, and the step at which
//! each fails.
//!
//! - [`cases`]: what is flown; [`methods`]: how.
//! - [`truth`]: the reference, which shares no code with them.
//! - [`measure`]: errors and times; `draw`: the picture of them.

pub mod cases;
mod draw;
pub mod measure;
pub mod methods;
pub mod truth;

use std::path::PathBuf;

use lensrunner::spacetime::orbit::OrbitError;

use crate::chart::{Output, SheetError};
use crate::plot::PlotError;

/// What the chart is asked for.
#[derive(Clone, Debug)]
pub struct FlightRequest {
    /// Where it goes.
    pub output: Output,
    /// How often each flight is timed; the median counts.
    pub rounds: usize,
    /// The most evaluations of a flight: finer steps are left out.
    pub evaluations: u64,
}

/// Why there is no chart.
#[derive(Debug, thiserror::Error)]
pub enum FlightError {
    /// The CSV.
    #[error(transparent)]
    Sheet(#[from] SheetError),
    /// The picture.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// A flight that there is not.
    #[error(transparent)]
    Orbit(#[from] OrbitError),
}

/// Measures (or reads) and draws; returns the files written.
pub fn run(request: &FlightRequest) -> Result<Vec<PathBuf>, FlightError> {
    let output = &request.output;
    let sheet = output.sheet("flight", || measure::measure(request))?;
    let limits = measure::limits(&sheet);
    limits.save(&output.csv("flight-limits"))?;
    let files = draw::draw(&sheet).save(&output.folder, "flight")?;
    Ok(files.into_iter().chain(["flight", "flight-limits"].map(|name| output.csv(name))).collect())
}
