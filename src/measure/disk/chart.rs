//! The chart `disk`: paper 2's two tables with the error of the picture beside each time, and speed against error.
//!
//! Table 1: each representation alone, seen from 80°, and its error from other places. Table 2: one scripted chase through all situations, the same for every row. Who draws
//! is handed in from above: the instruments know no renderer.

use std::path::PathBuf;

use glam::DVec3;

use crate::measure::chart::{Output, Provenance, Sheet, SheetError};
use crate::measure::plot::{Axis, Bars, Figure, Guide, Line, Lines, Panel, PlotError, Point, Scatter, Series};
use crate::scene::GameConfig;
use crate::scene::camera::static_momentum;
use crate::scene::disk::Gas;
use crate::spacetime::frames;

use super::error::{PictureError, compare};
use super::exact::{Eye, picture};
use super::places::errors_by_place;

/// What the chart is asked for.
#[derive(Clone, Debug)]
pub struct Request {
    /// Where it goes.
    pub output: Output,
    /// Width and height of the pictures that are timed.
    pub size: [u32; 2],
    /// Width and height of the pictures that are compared with the exact one.
    pub error_size: [u32; 2],
    /// Rounds of timing; all contestants take turns in each.
    pub rounds: usize,
    /// Places along the scripted chase.
    pub steps: usize,
}

/// One way to draw the disk.
#[derive(Clone, Debug)]
pub struct Contestant {
    /// What it is called.
    pub name: String,
    /// 0 arcs, 1 polygons, 2 sprites, 3 arcs at another error budget.
    pub family: usize,
    /// The configuration that draws it.
    pub config: GameConfig,
}

/// A drawn frame.
#[derive(Clone, Debug, Default)]
pub struct Shown {
    /// The whole frame on the clock, in ms.
    pub whole: f64,
    /// The processor time of all threads, in ms, where a software adapter draws.
    pub processor: Option<f64>,
    /// Passes with their times by the adapter's timestamps, in ms.
    pub passes: Vec<(String, f64)>,
    /// Linear light, if it was asked for.
    pub picture: Vec<[f32; 3]>,
}

/// Draws a frame of a contestant (by its number; None: without a disk) for an eye at a time T; with a size it brings the picture back, drawn at that
/// size.
pub type Draw<'a> = dyn FnMut(Option<usize>, &Eye, f64, Option<[u32; 2]>) -> Result<Shown, String> + 'a;

/// Why there is no chart.
#[derive(Debug, thiserror::Error)]
pub enum ChartError {
    /// The CSV.
    #[error(transparent)]
    Sheet(#[from] SheetError),
    /// The picture.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// The renderer.
    #[error("{0}")]
    Draw(String),
}

/// Passes that are the disk's own.
const DISK_PASSES: [&str; 3] = ["disk arcs", "disk mesh", "disk"];
/// What ratios are told against.
const REFERENCE: &str = "arcs 4200";
/// T of all frames, in r_s/c.
pub(super) const TIME: f64 = 100.0;

/// All ways, in the order of paper 2's tables, then arcs at other budgets.
pub fn contestants(config: &GameConfig) -> Vec<Contestant> {
    let with = |name: String, family, change: &dyn Fn(&mut GameConfig)| {
        let mut config = config.clone();
        change(&mut config);
        Contestant { name, family, config }
    };
    let mut all = vec![
        with("polygons 960".into(), 1, &|c| c.disk.representation = "polygons".into()),
        with("sprites 100 000".into(), 2, &|c| c.disk.representation = "sprites".into()),
    ];
    for arcs in [570u32, 1_100, 2_100, 4_200, 8_500, 17_000] {
        all.push(with(format!("arcs {arcs}"), 0, &|c| {
            c.disk.arcs = arcs;
            c.disk.width = 0.16 * (4200.0 / f64::from(arcs)).sqrt();
        }));
    }
    for budget in [3e-3, 1e-3, 1e-4] {
        all.push(with(format!("arcs 4200; Δ {budget} rad"), 3, &|c| c.disk.error_budget = budget));
    }
    all
}

/// Measures (or reads) and draws; returns the files written.
pub fn run(request: &Request, config: &GameConfig, adapter: &str, draw: &mut Draw) -> Result<Vec<PathBuf>, ChartError> {
    let contestants = contestants(config);
    let alone = request.output.sheet("disk-alone", || alone(request, &contestants, adapter, draw))?;
    let chase = request.output.sheet("disk-chase", || chase(request, &contestants, adapter, draw))?;
    request.output.sheet("disk-places", || errors_by_place(request, &contestants, adapter, draw))?;
    let figure = figure(&alone, &chase);
    let mut files = figure.save(&request.output.folder, "disk")?.to_vec();
    files.extend(["disk-alone", "disk-chase", "disk-places"].map(|name| request.output.csv(name)));
    Ok(files)
}

/// A hovering eye that looks along `look`.
pub(super) fn eye(position: DVec3, look: DVec3) -> Eye {
    Eye {
        position,
        momentum: static_momentum(position).unwrap_or_default(),
        attitude: frames::look(look, DVec3::Z).unwrap_or_default(),
        field_of_view: 60f64.to_radians(),
    }
}

/// From 80° at 27 r_s, as the scene `disk`.
fn portrait() -> Eye {
    let position = DVec3::new(0.0, -26.5898, 4.6885);
    eye(position, -position)
}

/// What the disk costs: the passes that are its own by timestamps. A software adapter draws on the processor, where other programs run as well and
/// passes overlap: there it is the processor time of the frame less that of a frame without a disk.
fn own(shown: &Shown, without: &Shown) -> f64 {
    match (shown.processor, without.processor) {
        (Some(with), Some(without)) => with - without,
        _ => passes(shown),
    }
}

fn passes(shown: &Shown) -> f64 {
    shown.passes.iter().filter(|(label, _)| DISK_PASSES.contains(&label.as_str())).map(|(_, time)| time).sum()
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

fn alone(request: &Request, contestants: &[Contestant], adapter: &str, draw: &mut Draw) -> Result<Sheet, ChartError> {
    let mut sheet = Sheet::new(&[
        "contestant",
        "family",
        "disk_ms",
        "passes_ms",
        "frame_ms",
        "against_arcs_4200",
        "psnr_db",
        "flip",
        "mean_difference",
    ]);
    sheet.notes = Provenance::now(adapter).notes();
    let eye = portrait();
    let base = &contestants[0].config;
    let truth = picture(&Gas::new(&base.disk, base.hole.mass_solar), &eye, request.error_size, TIME, 3, 6);
    let mut errors: Vec<PictureError> = Vec::new();
    for number in 0..contestants.len() {
        let shown = draw(Some(number), &eye, TIME, Some(request.error_size)).map_err(ChartError::Draw)?;
        errors.push(compare(&shown.picture, &truth, request.error_size));
    }
    let mut times = vec![[const { Vec::new() }; 3]; contestants.len()];
    for _ in 0..request.rounds {
        let without = timed(None, &eye, draw)?;
        for (number, [own_times, pass_times, whole]) in times.iter_mut().enumerate() {
            let shown = timed(Some(number), &eye, draw)?;
            own_times.push(own(&shown, &without));
            pass_times.push(passes(&shown));
            whole.push(shown.whole);
        }
    }
    let reference = contestants.iter().position(|contestant| contestant.name == REFERENCE).unwrap_or_default();
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

/// A frame: the mean of two, after two that make targets and whose timestamps are another's.
fn timed(number: Option<usize>, eye: &Eye, draw: &mut Draw) -> Result<Shown, ChartError> {
    let mut frame = || draw(number, eye, TIME, None).map_err(ChartError::Draw);
    frame()?;
    frame()?;
    let (first, second) = (frame()?, frame()?);
    Ok(Shown {
        whole: 0.5 * (first.whole + second.whole),
        processor: first.processor.zip(second.processor).map(|(a, b)| 0.5 * (a + b)),
        ..second
    })
}

/// The scripted chase at a share from 0 to 1 of its way, and what it passes through: from far, in through the inner edge, out over the disk, down through
/// it, and away below.
pub fn script(share: f64) -> (Eye, &'static str) {
    let legs: [(&str, [DVec3; 2]); 5] = [
        ("from far", [DVec3::new(0.0, -26.0, 6.0), DVec3::new(2.0, -12.0, 3.0)]),
        ("inside the inner edge", [DVec3::new(2.0, -12.0, 3.0), DVec3::new(1.2, -2.0, 0.35)]),
        ("skimming", [DVec3::new(3.5, -2.0, 0.3), DVec3::new(8.0, 5.0, 0.3)]),
        ("crossing", [DVec3::new(8.0, 5.0, 0.3), DVec3::new(8.5, 6.0, -0.3)]),
        ("below", [DVec3::new(8.5, 6.0, -0.3), DVec3::new(14.0, 14.0, -6.0)]),
    ];
    let place = share.clamp(0.0, 1.0) * legs.len() as f64;
    let leg = (place as usize).min(legs.len() - 1);
    let (name, [from, to]) = legs[leg];
    let position = from + (to - from) * (place - leg as f64);
    // Towards the hole from far; along the orbit, past it, from near.
    let inward = -position.normalize();
    let along = DVec3::Z.cross(position).normalize();
    let look = match leg {
        0 => inward,
        1 => inward + along * 0.3,
        2 | 3 => along + inward * 0.7,
        _ => inward,
    };
    (eye(position, look), name)
}

fn chase(request: &Request, contestants: &[Contestant], adapter: &str, draw: &mut Draw) -> Result<Sheet, ChartError> {
    let mut sheet = Sheet::new(&["contestant", "family", "step", "situation", "frame_ms", "disk_ms", "arcs_ms", "mesh_ms", "draw_ms"]);
    sheet.notes = Provenance::now(adapter).notes();
    let steps = request.steps.max(2);
    for step in 0..steps {
        let (eye, situation) = script((step as f64 + 0.5) / steps as f64);
        let without = timed(None, &eye, draw)?;
        for (number, contestant) in contestants.iter().enumerate().filter(|(_, contestant)| contestant.family != 3) {
            let shown = timed(Some(number), &eye, draw)?;
            let pass = |label: &str| shown.passes.iter().find(|(name, _)| name == label).map_or(0.0, |(_, time)| *time);
            sheet.push([
                contestant.name.clone(),
                contestant.family.to_string(),
                step.to_string(),
                situation.to_owned(),
                format!("{:.3}", shown.processor.unwrap_or(shown.whole)),
                format!("{:.3}", own(&shown, &without)),
                format!("{:.3}", pass(DISK_PASSES[0])),
                format!("{:.3}", pass(DISK_PASSES[1])),
                format!("{:.3}", pass(DISK_PASSES[2])),
            ]);
        }
    }
    Ok(sheet)
}

fn figure(alone: &Sheet, chase: &Sheet) -> Figure {
    let families = ["arcs", "polygons", "sprites", "arcs 4 200, other Δ"].map(str::to_owned).to_vec();
    let points = alone.rows.iter().map(|row| Point {
        x: alone.number(row, "disk_ms"),
        y: alone.number(row, "flip"),
        label: alone.text(row, "contestant").to_owned(),
        family: alone.number(row, "family") as usize,
        failed: false,
        chosen: false,
    });
    let scatter = Scatter {
        title: "Speed against error, disk alone".into(),
        x: Axis::log("disk alone, ms"),
        y: Axis::linear("FLIP against the exact picture, mean"),
        points: points.collect(),
        families,
        pareto: true,
        ..Scatter::default()
    };
    let names: Vec<String> = alone.rows.iter().take(8).map(|row| alone.text(row, "contestant").to_owned()).collect();
    let frames = |name: &str| -> Vec<f64> {
        chase.rows.iter().filter(|row| chase.text(row, "contestant") == name).map(|row| chase.number(row, "frame_ms")).collect()
    };
    let mean: Vec<Option<f64>> = names.iter().map(|name| Some(1e3 / mean_of(&frames(name)))).collect();
    let worst: Vec<Option<f64>> = names.iter().map(|name| Some(1e3 / frames(name).into_iter().fold(0.0, f64::max))).collect();
    let bars = Bars {
        title: "The scripted chase, whole frames".into(),
        y: Axis::linear("frames per second"),
        groups: names.iter().map(|name| name.replacen(' ', "\n", 1)).collect(),
        series: vec![Series { name: "mean".into(), values: mean }, Series { name: "worst".into(), values: worst }],
        values: true,
        ..Bars::default()
    };
    let lines = ["polygons 960", "sprites 100 000", "arcs 1100", "arcs 4200", "arcs 17000"].map(|name| Line {
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
    let mut turns = Vec::new();
    let mut before = String::new();
    for row in &chase.rows {
        let situation = chase.text(row, "situation");
        if situation != before {
            before = situation.to_owned();
            turns.push(Guide { at: chase.number(row, "step") - 0.5, label: before.clone() });
        }
    }
    let course = Lines {
        title: "Passes of the disk along the chase".into(),
        x: Axis::linear("step"),
        y: Axis::log("ms"),
        lines: lines.to_vec(),
        guides_x: turns,
        ..Lines::default()
    };
    Figure {
        title: "The accretion disk: arcs, polygons, sprites".into(),
        subtitle: "Less is better in the left and the lower panel, more in the right one. All contestants take turns.".into(),
        panels: vec![Panel::Scatter(scatter), Panel::Bars(bars), Panel::Lines(course)],
        columns: 2,
        size: [1500, 1100],
        footer: Provenance::footer(&alone.notes),
    }
}

fn mean_of(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}
