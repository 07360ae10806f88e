//! Maps of the error over (r, φ): where each method fails.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::points::POINTS;
use super::{ChartError, Request, chosen};
use crate::measure::chart::{Provenance, Sheet};
use crate::measure::methods::{Exact, Projector, Query};
use crate::measure::plot::{Axis, Figure, Map, Panel};
use crate::spacetime::light::{Branch, Order};

/// Camera radii.
const CAMERAS: [f64; 6] = [0.5, 1.02, 1.5, 3.0, 10.0, 1000.0];
/// The methods whose maps are drawn, where they take part.
const METHODS: [&str; 7] = ["flat", "poutanen", "rk4-64", "paper1-128", "residual-linear-f16", "table", "newton"];
/// Columns (r, logarithmic) and rows (φ).
const SIZE: [usize; 2] = [56, 36];
/// Colour scale, degrees.
const SCALE: [f64; 2] = [1e-6, 1e2];

/// The errors of order 1, degrees; empty where the method has no answer.
pub fn measure(request: &Request) -> Result<Sheet, ChartError> {
    let mut sheet = Sheet::new(&["method", "L", "r", "phi", "degrees"]);
    sheet.notes = Provenance::now("").notes();
    let order = Order::ALL[0];
    for (entry, method) in chosen(request)?.into_iter().filter(|(entry, _)| METHODS.contains(&entry.name)) {
        for camera in CAMERAS {
            let errors: Vec<(Query, Option<f64>)> = (0..SIZE[0] * SIZE[1])
                .into_par_iter()
                .map(|i| {
                    let share = |k: usize, n: usize| (k as f64 + 0.5) / n as f64;
                    let r = POINTS[0] * (POINTS[1] / POINTS[0]).powf(share(i % SIZE[0], SIZE[0]));
                    let query = Query { r, phi: PI * share(i / SIZE[0], SIZE[1]), camera };
                    let psi = |method: &dyn Projector| Some(method.project(query, order, Branch::Plus)?.psi_rain);
                    let error = psi(method.as_ref()).zip(psi(&Exact)).map(|(a, b)| (a - b).abs().to_degrees());
                    (query, error.filter(|e| e.is_finite()))
                })
                .collect();
            for (query, error) in errors {
                let error = error.map(|e| format!("{e:.2e}")).unwrap_or_default();
                sheet.push([entry.name.to_owned(), camera.to_string(), format!("{:.5}", query.r), format!("{:.4}", query.phi), error]);
            }
        }
    }
    Ok(sheet)
}

/// One row of maps for each method.
pub fn draw(sheet: &Sheet) -> Figure {
    let mut panels = Vec::new();
    let cells = SIZE[0] * SIZE[1];
    for (i, block) in sheet.rows.chunks(cells).enumerate() {
        let row = &block[0];
        let title = format!("{}, L = {}", sheet.text(row, "method"), sheet.text(row, "L"));
        // Eight colours a decade: the SVG's rectangles merge.
        let round = |v: f64| if v.is_nan() { v } else { 10f64.powf((8.0 * v.max(SCALE[0]).log10()).round() / 8.0) };
        let mut values: Vec<f64> = block.iter().map(|row| round(sheet.number(row, "degrees"))).collect();
        values.resize(cells, f64::NEG_INFINITY);
        panels.push(Panel::Map(Map {
            title,
            x: Axis::log("r, r_s").between(POINTS[0], POINTS[1]),
            y: Axis::linear("φ").between(0.0, PI),
            size: SIZE,
            values,
            colors: Axis::log("error, degrees").between(SCALE[0], SCALE[1]),
            legend: i % CAMERAS.len() == CAMERAS.len() - 1,
        }));
    }
    let rows = panels.len().div_ceil(CAMERAS.len()).max(1) as u32;
    Figure {
        title: "Where each method fails: the error of the primary image".into(),
        subtitle: "Blue is good: 1e-3° is a sixteenth of a pixel at 3840 over 60°. Red: no answer.".into(),
        panels,
        columns: CAMERAS.len(),
        size: [1800, 110 + 215 * rows],
        footer: Provenance::footer(&sheet.notes),
    }
}
