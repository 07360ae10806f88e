//! The chart `flight`: integrators of matter on five flights, error in energy, angular momentum and phase against cost, and the step at
//! which each fails.
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

use clap::Args;
use lensrunner::argument::whole;

use crate::chart::{ChartError, Output};

/// Integrators of matter: error in energy, angular momentum and phase against cost on five flights, and the step at which each fails.
#[derive(Args, Clone, Debug)]
pub struct FlightRequest {
    /// Where it goes.
    #[command(flatten)]
    pub output: Output,
    /// How often each flight is timed; the median counts.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = whole::<usize>(1, 255))]
    pub rounds: usize,
    /// The most evaluations of the equations of motion in a flight; what takes more is left out.
    #[arg(long, value_name = "N", default_value_t = 1_000_000, value_parser = whole::<u64>(1_000, u64::MAX))]
    pub evaluations: u64,
}

/// Measures (or reads) and draws; returns the files written.
pub fn run(request: &FlightRequest) -> Result<Vec<PathBuf>, ChartError> {
    let output = &request.output;
    let sheet = output.sheet("flight", || measure::measure(request))?;
    let limits = measure::limits(&sheet);
    limits.save(&output.csv("flight-limits"))?;
    let files = draw::draw(&sheet).save(&output.folder, "flight")?;
    Ok(files.into_iter().chain(["flight", "flight-limits"].map(|name| output.csv(name))).collect())
}
