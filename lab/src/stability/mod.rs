//! Where methods fail: one number for each method at each place, and whether it holds: `lensrunner-lab stability`.
//!
//! - [`light`]: directions and delays, beside the judge's.
//! - [`matter`]: flights, beside the reference of [`crate::flight`].
//! - [`drawing`]: places on surfaces in the picture, beside the judge's.
//! - [`straight`]: straight rays at corners and edges of closed bodies.
//! - [`held`]: places where no other method is set beside ours: what must hold, and the test that holds it.
//! - [`faults`]: puts faults in, which those tests must find.
//! - [`map`]: the page.

pub mod drawing;
pub mod faults;
pub mod held;
pub mod light;
pub mod map;
pub mod matter;
pub mod straight;

use std::path::PathBuf;

use clap::Args;

use crate::chart::{ChartError, Output, Sheet};

/// Where methods fail: a page with a number for each method at each place, and the tests that hold the rest.
#[derive(Args, Clone, Debug)]
pub struct StabilityRequest {
    /// Where page and sheet go.
    #[command(flatten)]
    pub output: Output,
    /// Leaves out pictures, and what must be baked first.
    #[arg(long)]
    pub quick: bool,
    /// Puts a fault for each test of the page into a copy of the committed sources and runs them there: each must fail.
    #[arg(long, conflicts_with_all = ["redraw", "quick"])]
    pub faults: bool,
}

/// The parts, in the order of the page.
pub const PARTS: [&str; 4] = ["light", "matter", "drawing", "straight rays"];

/// Columns of the sheet.
pub const COLUMNS: [&str; 8] = ["part", "place", "method", "ours", "value", "unit", "limit", "holds"];

/// What a method does at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// One of [`PARTS`].
    pub part: &'static str,
    /// Where.
    pub place: &'static str,
    /// The method.
    pub method: String,
    /// Whether the game uses it.
    pub ours: bool,
    /// Its greatest error there; NaN where it gives no answer.
    pub value: f64,
    /// Of what.
    pub unit: &'static str,
    /// The greatest error that holds.
    pub limit: f64,
}

impl Finding {
    /// Whether the method holds.
    pub fn holds(&self) -> bool {
        self.value <= self.limit
    }

    fn cells(&self) -> String {
        let Finding { part, place, method, value, unit, limit, .. } = self;
        let [ours, holds] = [self.ours, self.holds()].map(u8::from);
        format!("{part}|{place}|{method}|{ours}|{value:.3e}|{unit}|{limit:e}|{holds}")
    }
}

/// Measures all places.
pub fn measure(quick: bool) -> Result<Vec<Finding>, ChartError> {
    let mut all = light::measure(quick);
    all.extend(matter::measure()?);
    if !quick {
        all.extend(drawing::measure()?);
    }
    all.extend(straight::measure());
    Ok(all)
}

/// Measures (or reads) and writes `stability.csv` and `stability.md`; returns the files.
pub fn run(request: &StabilityRequest) -> Result<Vec<PathBuf>, ChartError> {
    let output = &request.output;
    let sheet = output.sheet("stability", || {
        let mut sheet = Sheet::measured(&COLUMNS, "");
        measure(request.quick)?.iter().for_each(|finding| sheet.line(finding.cells()));
        Ok::<_, ChartError>(sheet)
    })?;
    let page = output.folder.join("stability.md");
    let held = held::held().map_err(|error| ChartError::Failed(format!("held.toml: {error}")))?;
    std::fs::write(&page, map::page(&sheet, &held)).map_err(|error| ChartError::Write(page.clone(), error.to_string()))?;
    Ok(vec![output.csv("stability"), page])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ours are green everywhere; and the check sees red: every rival fails somewhere.
    #[test]
    fn ours_hold_everywhere() {
        let all = measure(true).unwrap();
        for finding in all.iter().filter(|finding| finding.ours) {
            assert!(finding.holds(), "{finding:?}");
        }
        for method in ["rk4-256", "flat", "RK4", "splitting, order 2", "bvh"] {
            assert!(all.iter().any(|finding| finding.method == method && !finding.holds()), "{method} fails nowhere");
        }
    }
}
