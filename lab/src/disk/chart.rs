//! The chart `disk`: the two tables of Yamashita 2025 with the error of the picture beside each time, and speed against error.
//!
//! Table 1: each representation alone, seen from 80°, and its error from other places. Table 2: one scripted chase through all situations,
//! the same for every row (`chase.rs`); and the same, asked for, frame by frame (`flight.rs`).

use super::bench::Bench;
use super::request::{ChartError, Contestant, DiskRequest, REFERENCE, TIME, View, contestants, eye, median, own, passes};
use lensrunner::spacetime::Observer;
use std::path::PathBuf;

use glam::DVec3;

use crate::chart::{Provenance, Sheet};
use crate::plot::{Axis, Bars, Figure, Guide, Line, Lines, Panel, Point, Scatter, Series};
use lensrunner::render::Gpu;
use lensrunner::scene::GameConfig;
use lensrunner::scene::disk::Gas;

use super::chase::{chase, summary};
use super::error::{PictureError, compare, peak};
use super::exact::picture;
use super::flight::{self, flight};
use super::places::errors_by_place;

/// Measures (or reads) and draws; returns the files written.
pub fn run(request: &DiskRequest, config: &GameConfig, gpu: Gpu) -> Result<Vec<PathBuf>, ChartError> {
    let contestants = contestants(config);
    let bench = &mut Bench::new(gpu, &contestants, request.size);
    let alone = request.output.sheet("disk-alone", || alone(request, &contestants, bench))?;
    let chase = request.output.sheet("disk-chase", || chase(request, &contestants, bench))?;
    request.output.sheet("disk-places", || errors_by_place(request, &contestants, bench))?;
    let summary = summary(&chase);
    summary.save(&request.output.csv("disk-summary"))?;
    let figure = figure(&alone, &chase, &summary);
    let mut files = figure.save(&request.output.folder, "disk")?.to_vec();
    files.extend(["disk-alone", "disk-chase", "disk-summary", "disk-places"].map(|name| request.output.csv(name)));
    if request.flight > 0 {
        let flown = request.output.sheet("disk-flight", || flight(request, config, bench))?;
        flight::summary(&flown).save(&request.output.csv("disk-flight-summary"))?;
        files.extend(["disk-flight", "disk-flight-summary"].map(|name| request.output.csv(name)));
    }
    Ok(files)
}

/// From 80° at 27 r_s, as the scene `disk`.
fn portrait() -> Observer {
    let position = DVec3::new(0.0, -26.5898, 4.6885);
    eye(position, -position)
}

fn alone(request: &DiskRequest, contestants: &[Contestant], bench: &mut Bench) -> Result<Sheet, ChartError> {
    let mut sheet =
        Sheet::new(&["contestant", "family", "disk_ms", "passes_ms", "wall_ms", "against_arcs_4200", "psnr_db", "flip", "mean_difference"]);
    sheet.notes = Provenance::now(bench.adapter()).notes();
    let view = View { eye: portrait(), time: TIME, sky: false, counted: false };
    let named = contestants.iter().position(|contestant| contestant.name == REFERENCE);
    let reference = named.ok_or(ChartError::Reference)?;
    let base = &contestants[0].config;
    let truth = picture(&Gas::new(&base.disk, base.hole.mass_solar), &view.eye, request.error_size, TIME, 3, 6);
    let mut errors: Vec<PictureError> = Vec::new();
    for number in 0..contestants.len() {
        let shown = bench.frame(Some(number), &view, Some(request.error_size))?;
        errors.push(compare(&shown.picture, &truth, request.error_size, peak(&truth)));
    }
    let mut times = vec![[const { Vec::new() }; 3]; contestants.len()];
    for _ in 0..request.rounds {
        let without = bench.timed(None, &view)?;
        for (number, [own_times, pass_times, whole]) in times.iter_mut().enumerate() {
            let shown = bench.timed(Some(number), &view)?;
            own_times.push(own(&shown, &without));
            pass_times.push(passes(&shown));
            whole.push(shown.whole);
        }
    }
    let against = times[reference][0].clone();
    for ((contestant, error), [own_times, pass_times, whole]) in contestants.iter().zip(errors).zip(&mut times) {
        // Round by round, for what else runs on the machine changes from round to round.
        let mut ratios: Vec<f64> = own_times.iter().zip(&against).map(|(own, reference)| own / reference).collect();
        sheet.push([
            contestant.name.clone(),
            contestant.family.to_string(),
            format!("{:.3}", median(own_times)),
            format!("{:.3}", median(pass_times)),
            format!("{:.3}", median(whole)),
            format!("{:.3}", median(&mut ratios)),
            format!("{:.2}", error.psnr),
            format!("{:.4}", error.flip),
            format!("{:.4}", error.relative),
        ]);
    }
    Ok(sheet)
}

fn figure(alone: &Sheet, chase: &Sheet, summary: &Sheet) -> Figure {
    Figure {
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
        points: chase
            .rows
            .iter()
            .filter(|row| chase.text(row, "contestant") == name)
            .map(|row| [chase.number(row, "step"), chase.number(row, "disk_ms")])
            .collect(),
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
