//! The picture of the chart `disk`, from its sheets alone.

use crate::chart::{Provenance, Sheet};
use crate::plot::{Axis, Bars, Figure, Guide, Line, Lines, Panel, Point, Scatter, Series};

use super::request::REFERENCE;

/// Speed against error alone, frame rates along the chase, and the disk's time step by step.
pub fn figure(alone: &Sheet, chase: &Sheet, summary: &Sheet) -> Figure {
    Figure {
        verdict: verdict(alone),
        title: "The accretion disk: arcs, polygons, sprites".into(),
        subtitle: "Less is better in the left and the lower panel, more in the right one. All contestants take turns.".into(),
        panels: vec![Panel::Scatter(speed_and_error(alone)), Panel::Bars(rates(summary)), Panel::Lines(course(chase))],
        columns: 2,
        size: [1500, 1100],
        footer: Provenance::footer(&alone.notes),
    }
}

/// Time against error of the disk alone.
fn speed_and_error(alone: &Sheet) -> Scatter {
    let points = alone.rows.iter().map(|row| Point {
        x: alone.number(row, "disk_ms"),
        y: alone.number(row, "flip"),
        label: alone.text(row, "contestant").to_owned(),
        family: alone.number(row, "family") as usize,
        failed: false,
        chosen: false,
    });
    Scatter {
        title: "Speed against error, disk alone".into(),
        x: Axis::log("disk alone, ms"),
        y: Axis::linear("FLIP against the exact picture, mean"),
        points: points.collect(),
        families: ["arcs", "polygons", "sprites", "arcs 4 200, other Δ"].map(str::to_owned).to_vec(),
        pareto: true,
        ..Scatter::default()
    }
}

/// Frames per second along the chase.
fn rates(summary: &Sheet) -> Bars {
    let names = summary.rows.iter().map(|row| summary.text(row, "contestant").replacen(' ', "\n", 1));
    let fps = |column: &str| -> Vec<Option<f64>> { summary.rows.iter().map(|row| Some(1e3 / summary.number(row, column))).collect() };
    let [mean, worst] = ["mean_ms", "worst_ms"].map(fps);
    Bars {
        title: "The scripted chase, whole frames".into(),
        y: Axis::linear("frames per second"),
        groups: names.collect(),
        series: vec![Series { name: "mean".into(), values: mean }, Series { name: "worst".into(), values: worst }],
        values: true,
        ..Bars::default()
    }
}

/// The time of the disk step by step.
fn course(chase: &Sheet) -> Lines {
    let lines = ["polygons 960", "polygons 960 at rest", "sprites 100 000", "arcs 1100", "arcs 4200", "arcs 17000"].map(|name| Line {
        name: name.to_owned(),
        points: chase.of([("contestant", name)]).map(|row| [chase.number(row, "step"), chase.number(row, "disk_ms")]).collect(),
        dots: true,
        ..Line::default()
    });
    // A guide ends each situation: its label stands on the left of it.
    let mut turns: Vec<Guide> = Vec::new();
    for row in &chase.rows {
        let (end, situation) = (chase.number(row, "step") + 0.5, chase.text(row, "situation"));
        match turns.last_mut().filter(|last| last.label == situation) {
            Some(last) => last.at = end,
            None => turns.push(Guide { at: end, label: situation.to_owned() }),
        }
    }
    Lines {
        title: "The disk along the chase".into(),
        x: Axis::linear("step"),
        y: Axis::log("ms"),
        lines: lines.to_vec(),
        guides_x: turns,
        ..Lines::default()
    }
}

/// What the reference costs and how far it is off, beside the two other ways.
fn verdict(alone: &Sheet) -> String {
    let of = |name: &str, column: &str| alone.of([("contestant", name)]).next().map_or(f64::NAN, |row| alone.number(row, column));
    let ratio = |name: &str, column: &str| of(REFERENCE, column) / of(name, column);
    format!(
        "4,200 arcs take {:.2} of the time of 960 polygons at {:.2} of their error, and {:.2} of the time of 100,000 sprites at {:.1} times theirs",
        ratio("polygons 960", "disk_ms"),
        ratio("polygons 960", "flip"),
        ratio("sprites 100 000", "disk_ms"),
        ratio("sprites 100 000", "flip"),
    )
}
