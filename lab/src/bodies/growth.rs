//! How a cost grows with the number of bodies: fitted to the upper half of the numbers, where what every frame costs counts less.

use super::scenes::Kind;
use super::sheet::{FIRST, MEMORY, MISSING, ORDERS, WHOLE, points};
use crate::chart::{Sheet, mean};

/// The columns of the sheet `bodies-growth`. `exponent`: the slope of the cost's logarithm over that of the number. The others: the slope
/// of the cost over the number.
const COLUMNS: [&str; 7] = ["kind", "whose", "part", "exponent", "microseconds_a_body", "microseconds_a_body_and_order", "bytes_a_body"];

/// How a cost grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// The cost grows as this power of the number.
    pub exponent: f64,
    /// Cost of one more body.
    pub each: f64,
}

impl Growth {
    /// Fits the upper half, at least two, of points (number, cost) in the order of their numbers; None where there are fewer. The exponent
    /// takes what costs nothing as a millionth.
    pub fn of(points: &[[f64; 2]]) -> Option<Growth> {
        let upper = &points[(points.len() / 2).min(points.len().saturating_sub(2))..];
        let logarithms: Vec<[f64; 2]> = upper.iter().map(|point| point.map(|value| value.max(1e-6).ln())).collect();
        Some(Growth { exponent: slope(&logarithms)?, each: slope(upper)? })
    }
}

/// The slope of the straight line of least squares.
fn slope(points: &[[f64; 2]]) -> Option<f64> {
    let [x, y] = [0, 1].map(|axis| mean(&points.iter().map(|point| point[axis]).collect::<Vec<f64>>()));
    let (along, square) = points.iter().fold((0.0, 0.0), |(a, s), p| (a + (p[0] - x) * (p[1] - y), s + (p[0] - x) * (p[0] - x)));
    (square > 0.0).then(|| along / square)
}

/// The growth of every part; of times the medians are fitted.
pub fn sheet(measured: &Sheet) -> Sheet {
    let mut growth = Sheet::new(&COLUMNS);
    growth.notes.clone_from(&measured.notes);
    let orders = measured.note(ORDERS).and_then(|orders| orders.parse().ok()).unwrap_or(1.0);
    let mut parts: Vec<[&str; 2]> = Vec::new();
    for row in &measured.rows {
        let part = ["whose", "part"].map(|column| measured.text(row, column));
        if !parts.contains(&part) && part[0] != MISSING && part != [WHOLE, FIRST] {
            parts.push(part);
        }
    }
    for kind in [Kind::Held, Kind::Flying] {
        for &[whose, part] in &parts {
            let column = if whose == MEMORY { "bytes" } else { "median_ms" };
            let Some(Growth { exponent, each }) = Growth::of(&points(measured, kind.name(), whose, part, column)) else { continue };
            if whose == MEMORY {
                growth.line(format_args!("{kind}|{whose}|{part}|{exponent:.3}|||{each:.1}"));
            } else {
                let (each, order) = (1e3 * each, 1e3 * each / orders);
                growth.line(format_args!("{kind}|{whose}|{part}|{exponent:.3}|{each:.4}|{order:.4}|"));
            }
        }
    }
    growth
}
