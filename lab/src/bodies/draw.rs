//! The picture of the chart `bodies`, from its sheets alone.

use super::scenes::Kind;
use super::sheet::{ALL, LARGEST, MEMORY, MISSING, ORDERS, TOGETHER, points};
use crate::chart::{Provenance, Sheet};
use crate::frame_times::parts::{PASS, PROCESSOR};
use crate::plot::{Axis, Figure, Guide, Line, Lines, Panel};

/// The most that WebGPU lets a pass see of a buffer, in MiB.
const MOST_BOUND: f64 = 128.0;
/// The processor's time that is aimed at, in µs: for a held body, and for a flying one and image order.
const AIMS: [f64; 2] = [0.3, 10.0];
/// What is drawn of a frame's time: whose, which part, its name.
const DRAWN: [[&str; 3]; 5] = [
    [PROCESSOR, TOGETHER, "processor together"],
    [PROCESSOR, "instances and aurora", "instances"],
    [PROCESSOR, "lists of bodies", "lists of bodies"],
    [PROCESSOR, "submission", "submission"],
    [PASS, TOGETHER, "passes together"],
];

/// Times of held and of flying bodies, and memory.
pub(super) fn figure(sheet: &Sheet, growth: &Sheet) -> Figure {
    let orders = sheet.note(ORDERS).and_then(|orders| orders.parse().ok()).unwrap_or(1.0);
    let times = |kind: Kind, title: &str, aim: f64| {
        let line = |[whose, part, name]: [&str; 3]| Line {
            name: name.into(),
            points: points(sheet, kind.name(), whose, part, "median_ms"),
            dots: true,
            failed: Vec::new(),
        };
        let aimed =
            points(sheet, kind.name(), PROCESSOR, TOGETHER, "median_ms").into_iter().map(|[bodies, _]| [bodies, 1e-3 * aim * bodies]);
        let aim = Line { name: format!("aim: {aim} µs a body"), points: aimed.collect(), ..Line::default() };
        Panel::Lines(Lines {
            title: title.into(),
            x: Axis::log("bodies"),
            y: Axis::log("ms of a frame, median"),
            lines: DRAWN.into_iter().map(line).chain([aim]).collect(),
            ..Lines::default()
        })
    };
    let memory = |kind: Kind, part: &str| {
        let points = points(sheet, kind.name(), MEMORY, part, "bytes").into_iter().map(|[bodies, bytes]| [bodies, bytes / 1_048_576.0]);
        Line { name: format!("{kind}, {part}"), points: points.collect(), dots: true, failed: Vec::new() }
    };
    let lines = [Kind::Held, Kind::Flying].into_iter().flat_map(|kind| [memory(kind, ALL), memory(kind, LARGEST)]);
    let memory = Panel::Lines(Lines {
        title: "Memory: all, and the largest buffer".into(),
        x: Axis::log("bodies"),
        y: Axis::log("MiB"),
        lines: lines.collect(),
        guides: vec![Guide { at: MOST_BOUND, label: "limit of a buffer".into() }],
        ..Lines::default()
    });
    let missing = sheet.of([("whose", MISSING)]).map(|row| {
        let [bodies, kind, why] = ["bodies", "kind", "part"].map(|column| sheet.text(row, column));
        let why: String = why.chars().take(110).collect();
        format!("{bodies} {kind}: {why}")
    });
    Figure {
        verdict: verdict(growth),
        title: "Growth with the number of bodies".into(),
        subtitle: "Times of a frame's parts; fitted to the upper half of the numbers. Lower is better.".into(),
        panels: vec![times(Kind::Held, "Held balls", AIMS[0]), times(Kind::Flying, "Flying ships", AIMS[1] * orders), memory],
        columns: 3,
        size: [1800, 720],
        footer: missing.chain(Provenance::footer(&sheet.notes)).collect(),
    }
}

/// What a body costs the processor, and how that grows.
fn verdict(growth: &Sheet) -> String {
    let of = |kind: Kind, column: &str| {
        let mut rows = growth.of([("kind", kind.name()), ("whose", PROCESSOR), ("part", TOGETHER)]);
        rows.next().map_or(f64::NAN, |row| growth.number(row, column))
    };
    let held = format!("A held body costs the processor {:.2} µs", of(Kind::Held, "microseconds_a_body"));
    let flying = format!("a flying one {:.1} µs an image order", of(Kind::Flying, "microseconds_a_body_and_order"));
    let [still, moving] = [Kind::Held, Kind::Flying].map(|kind| of(kind, "exponent"));
    format!("{held} and {flying}; they grow as N^{still:.2} and N^{moving:.2}")
}
