//! Maps of the error over (r, φ): where each method fails.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::draw::HALF_PIXEL;
use super::{ProjectionRequest, chosen};
use crate::chart::{ChartError, Provenance, Sheet};
use crate::plot::{Axis, Figure, Guide, Map, Panel};
use lensrunner::lensing::adversarial::POINTS;
use lensrunner::lensing::methods::{Exact, ProjectionInput, Projector};
use lensrunner::spacetime::light::{Branch, Order};

/// Camera radii with points outside the horizon; the first of them also with points inside.
const CAMERAS: [f64; 6] = [0.5, 1.02, 1.5, 3.0, 10.0, 1000.0];
/// The methods whose maps are drawn, where they take part.
const METHODS: [&str; 5] = ["table", "paper1-128", "rk4-64", "poutanen", "flat"];
/// Columns (r) and rows (φ).
const SIZE: [usize; 2] = [56, 36];
/// Colour scale, degrees.
const SCALE: [f64; 2] = [1e-5, 1e2];

/// The plane of a map: a camera, and where its points are.
#[derive(Clone, Copy, Debug)]
struct Plane {
    camera: f64,
    /// Points inside the horizon, farther out than the camera: r evenly spread, both signs of E, the worse counts. Else points outside, ln
    /// r evenly spread, E > 0.
    inside: bool,
}

impl Plane {
    fn all() -> Vec<Plane> {
        let outside = CAMERAS.map(|camera| Plane { camera, inside: false });
        [Plane { camera: CAMERAS[0], inside: true }].into_iter().chain(outside).collect()
    }

    fn radii(self) -> [f64; 2] {
        if self.inside { [self.camera, 1.0] } else { POINTS }
    }

    /// The largest φ: from inside a point next to the horizon is seen as far around as the hole's geometry lets light sweep, π − arccos(1 −
    /// 2L).
    fn farthest(self) -> f64 {
        if self.inside { PI - (1.0 - 2.0 * self.camera).acos() } else { PI }
    }

    fn input(self, column: usize, row: usize) -> ProjectionInput {
        let share = |k: usize, n: usize| (k as f64 + 0.5) / n as f64;
        let ([low, high], x) = (self.radii(), share(column, SIZE[0]));
        let r = if self.inside { low + x * (high - low) } else { low * (high / low).powf(x) };
        ProjectionInput { r, phi: self.farthest() * share(row, SIZE[1]), camera: self.camera }
    }

    /// The error of order 1, degrees; NaN where the method has no answer or invents one, −∞ where there is no light.
    fn error(self, method: &dyn Projector, input: ProjectionInput) -> f64 {
        let branches: &[Branch] = if self.inside { &[Branch::Plus, Branch::Minus] } else { &[Branch::Plus] };
        let one = |branch: &Branch| {
            let psi = |method: &dyn Projector| Some(method.project(input, Order::ALL[0], *branch)?.psi_rain);
            match (psi(method), psi(&Exact)) {
                (Some(psi), Some(truth)) => (psi - truth).abs().to_degrees(),
                (None, None) => f64::NEG_INFINITY,
                _ => f64::NAN,
            }
        };
        branches.iter().map(one).fold(f64::NEG_INFINITY, |worst, e| if e.is_nan() || worst.is_nan() { f64::NAN } else { worst.max(e) })
    }
}

/// One row of the sheet for each method, plane and φ; the errors at all r stand in it side by side.
pub fn measure(request: &ProjectionRequest) -> Result<Sheet, ChartError> {
    let mut sheet = Sheet::measured(&["method", "L", "points", "phi"], "");
    sheet.columns.extend((1..=SIZE[0]).map(|k| format!("r{k}")));
    sheet.notes.push((
        "cells".into(),
        format!(
            "errors of order 1 in degrees at {} radii in the middles of equal steps; outside of ln r from {} to {} r_s; inside of r from L to 1; \
             NaN no answer or one where no light goes; -inf no light",
            SIZE[0], POINTS[0], POINTS[1]
        ),
    ));
    let mut methods = chosen(request)?;
    methods.retain(|(entry, _)| METHODS.contains(&entry.name));
    methods.sort_by_key(|(entry, _)| METHODS.iter().position(|name| *name == entry.name));
    for (entry, method) in methods {
        for plane in Plane::all() {
            let errors: Vec<f64> = (0..SIZE[0] * SIZE[1])
                .into_par_iter()
                .map(|i| plane.error(method.as_ref(), plane.input(i % SIZE[0], i / SIZE[0])))
                .collect();
            for (row, errors) in errors.chunks(SIZE[0]).enumerate() {
                let place = if plane.inside { "inside" } else { "outside" };
                let mut cells = vec![entry.name.to_owned(), plane.camera.to_string(), place.to_owned()];
                cells.push(format!("{:.4}", plane.input(0, row).phi));
                cells.extend(errors.iter().map(|e| if e.is_finite() { format!("{e:.1e}") } else { e.to_string() }));
                sheet.push(cells);
            }
        }
    }
    Ok(sheet)
}

/// One row of maps for each method.
pub fn draw(sheet: &Sheet) -> Figure {
    let planes = Plane::all();
    let mut panels = Vec::new();
    for (i, block) in sheet.rows.chunks(SIZE[1]).enumerate() {
        let (method, plane) = (sheet.text(&block[0], "method"), planes[i % planes.len()]);
        // Four colours a decade: the SVG's rectangles merge.
        let round = |v: f64| if v.is_finite() { 10f64.powf((4.0 * v.max(SCALE[0]).log10()).round() / 4.0) } else { v };
        let numbers = block.iter().flat_map(|row| row.iter().skip(4));
        let mut values: Vec<f64> = numbers.map(|cell| round(cell.parse().unwrap_or(f64::NAN))).collect();
        values.resize(SIZE[0] * SIZE[1], f64::NEG_INFINITY);
        let [low, high] = plane.radii();
        let (x, title) = if plane.inside {
            (Axis::linear("r, r_s"), format!("{method}, L = {}, r < 1", plane.camera))
        } else {
            (Axis::log("r, r_s"), format!("{method}, L = {}", plane.camera))
        };
        panels.push(Panel::Map(Map {
            title,
            x: x.between(low, high),
            y: Axis::linear("φ").between(0.0, plane.farthest()),
            size: SIZE,
            values,
            colors: Axis::log("error, degrees").between(SCALE[0], SCALE[1]),
            legend: i % planes.len() == planes.len() - 1,
            marks: vec![plane.camera],
            guides: vec![Guide { at: HALF_PIXEL, label: "½ px".into() }],
        }));
    }
    let rows = panels.len().div_ceil(planes.len()).max(1) as u32;
    Figure {
        verdict: verdict(sheet),
        title: "Where each method fails: the error of the primary image (order 1) over r and φ".into(),
        subtitle: "Blue is below half a pixel at 3840 over 60°, green and yellow can be seen. Red: no answer, or one where no light goes. White: no light.\n\
                   Dashed: r = L, the camera's own radius. First column: camera and point both inside the horizon, the worse of E > 0 and E < 0."
            .into(),
        panels,
        columns: planes.len(),
        size: [1700, 130 + 185 * rows],
        footer: Provenance::footer(&sheet.notes),
    }
}

/// The share of all places with light at which each method is off by more than half a pixel or has no answer.
fn verdict(sheet: &Sheet) -> String {
    let share = |method: &str| {
        let rows = sheet.rows.iter().filter(|row| sheet.text(row, "method") == method);
        let lit: Vec<f64> = rows.flat_map(|row| row.iter().skip(4)).map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
        let lit: Vec<f64> = lit.into_iter().filter(|error| *error != f64::NEG_INFINITY).collect();
        let failed = lit.iter().filter(|error| error.is_nan() || **error > HALF_PIXEL).count();
        100.0 * failed as f64 / lit.len().max(1) as f64
    };
    let told: Vec<String> = sheet.distinct("method").into_iter().map(|method| format!("{method} in {:.0} %", share(method))).collect();
    format!("Places where a method is off by more than half a pixel: {}", told.join(", "))
}
