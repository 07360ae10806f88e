//! The chart `projection`: every method of projection on the same points, error against time and memory.

use std::path::PathBuf;

use super::chart::{Output, Provenance, Sheet, SheetError};
use super::plot::{Axis, Figure, Panel, PlotError, Point, Scatter};

/// What the chart is asked for.
#[derive(Clone, Debug)]
pub struct Request {
    /// Where it goes.
    pub output: Output,
    /// Adversarial points for each method and order.
    pub points: usize,
    /// Seed of the points.
    pub seed: u64,
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
}

/// Measures (or reads) and draws; returns the files written.
pub fn run(request: &Request) -> Result<Vec<PathBuf>, ChartError> {
    let sheet = request.output.sheet("projection", || measure(request))?;
    let figure = draw(&sheet);
    Ok(figure.save(&request.output.folder, "projection")?.into_iter().chain([request.output.csv("projection")]).collect())
}

fn measure(request: &Request) -> Result<Sheet, ChartError> {
    let mut sheet = Sheet::new(&["method", "order", "max_degrees"]);
    sheet.notes = Provenance::now("").notes();
    let table = crate::lensing::default_table();
    let scores = crate::lensing::score::score(&table, crate::lensing::score::Points::Adversarial, request.points, request.seed);
    for (i, score) in scores.iter().enumerate() {
        sheet.push(["table".to_owned(), (i + 1).to_string(), score.angle.max.to_string()]);
    }
    Ok(sheet)
}

fn draw(sheet: &Sheet) -> Figure {
    let points = sheet.rows.iter().map(|row| Point {
        x: sheet.number(row, "order"),
        y: sheet.number(row, "max_degrees"),
        label: sheet.text(row, "method").to_owned(),
        family: 0,
        failed: false,
    });
    let scatter =
        Scatter { x: Axis::linear("order"), y: Axis::log("largest error, degrees"), points: points.collect(), ..Scatter::default() };
    Figure {
        title: "Projection".into(),
        panels: vec![Panel::Scatter(scatter)],
        size: [900, 600],
        footer: Provenance::footer(&sheet.notes),
        ..Figure::default()
    }
}
