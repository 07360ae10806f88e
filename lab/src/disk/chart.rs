//! The chart `disk`: paper 2's two tables with the error of the picture beside each time, and speed against error.
//!
//! Table 1: each representation alone, seen from 80°, and its error from other places. Table 2: one scripted chase through all situations, the same
//! for every row (`chase.rs`); and the same, asked for, frame by frame (`flight.rs`). Who draws is handed in from above: the instruments know no renderer.

use lensrunner::spacetime::Observer;
use std::path::PathBuf;

use glam::DVec3;

use crate::chart::{Output, Provenance, Sheet, SheetError};
use crate::plot::{Axis, Bars, Figure, Guide, Line, Lines, Panel, PlotError, Point, Scatter, Series};
use lensrunner::scene::GameConfig;
use lensrunner::scene::camera::static_momentum;
use lensrunner::scene::disk::Gas;
use lensrunner::spacetime::frames;

use super::chase::{chase, summary};
use super::error::{PictureError, compare, peak};
use super::exact::picture;
use super::flight::{self, flight};
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
    /// Frames in which the chase is flown as in the game; 0 for none.
    pub flight: usize,
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
    /// Until it was handed to the adapter, on the clock, in ms.
    pub before: f64,
    /// Passes with their times by the adapter's timestamps, in ms.
    pub passes: Vec<(String, f64)>,
    /// Fragments that the disk's draw shaded, where the adapter counts them.
    pub fragments: Option<u64>,
    /// Linear light, if it was asked for.
    pub picture: Vec<[f32; 3]>,
}

impl Shown {
    /// The time of a pass in ms; 0 if it is not there.
    pub(super) fn pass(&self, label: &str) -> f64 {
        self.passes.iter().filter(|(name, _)| name == label).map(|(_, time)| time).sum()
    }
}

/// What is looked at.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// From where.
    pub eye: Observer,
    /// T, in r_s/c.
    pub time: f64,
    /// Whether stars and the Milky Way stand behind the disk, as the configuration has them; black else.
    pub sky: bool,
    /// Whether fragments are counted, which takes a little time.
    pub counted: bool,
}

/// Draws a frame of a contestant (by its number; None: without a disk) for a view; with a size it brings the picture back, drawn at that size.
pub type Draw<'a> = dyn FnMut(Option<usize>, &View, Option<[u32; 2]>) -> Result<Shown, String> + 'a;

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
pub(super) const DISK_PASSES: [&str; 3] = ["disk arcs", "disk mesh", "disk"];
/// What ratios are told against.
pub(super) const REFERENCE: &str = "arcs 4200";
/// T of all frames but the chase's, in r_s/c.
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
        with("polygons 960 at rest".into(), 1, &|c| c.disk.representation = "polygons-at-rest".into()),
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
    let summary = summary(&chase);
    summary.save(&request.output.csv("disk-summary"))?;
    let figure = figure(&alone, &chase, &summary);
    let mut files = figure.save(&request.output.folder, "disk")?.to_vec();
    files.extend(["disk-alone", "disk-chase", "disk-summary", "disk-places"].map(|name| request.output.csv(name)));
    if request.flight > 0 {
        let flown = request.output.sheet("disk-flight", || flight(request, config, adapter, draw))?;
        flight::summary(&flown).save(&request.output.csv("disk-flight-summary"))?;
        files.extend(["disk-flight", "disk-flight-summary"].map(|name| request.output.csv(name)));
    }
    Ok(files)
}

/// A hovering eye that looks along `look`.
pub(super) fn eye(position: DVec3, look: DVec3) -> Observer {
    Observer {
        position,
        momentum: static_momentum(position).unwrap_or_default(),
        attitude: frames::look(look, DVec3::Z).unwrap_or_default(),
        field_of_view: 60f64.to_radians(),
    }
}

/// From 80° at 27 r_s, as the scene `disk`.
fn portrait() -> Observer {
    let position = DVec3::new(0.0, -26.5898, 4.6885);
    eye(position, -position)
}

/// What the disk costs: the passes that are its own by timestamps. A software adapter draws on the processor, where other programs run as well and
/// passes overlap: there it is the processor time of the frame less that of a frame without a disk.
pub(super) fn own(shown: &Shown, without: &Shown) -> f64 {
    match (shown.processor, without.processor) {
        (Some(with), Some(without)) => with - without,
        _ => passes(shown),
    }
}

fn passes(shown: &Shown) -> f64 {
    DISK_PASSES.iter().map(|label| shown.pass(label)).sum()
}

/// The middle one; NaN of none.
pub(super) fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

fn alone(request: &Request, contestants: &[Contestant], adapter: &str, draw: &mut Draw) -> Result<Sheet, ChartError> {
    let mut sheet =
        Sheet::new(&["contestant", "family", "disk_ms", "passes_ms", "wall_ms", "against_arcs_4200", "psnr_db", "flip", "mean_difference"]);
    sheet.notes = Provenance::now(adapter).notes();
    let view = View { eye: portrait(), time: TIME, sky: false, counted: false };
    let base = &contestants[0].config;
    let truth = picture(&Gas::new(&base.disk, base.hole.mass_solar), &view.eye, request.error_size, TIME, 3, 6);
    let mut errors: Vec<PictureError> = Vec::new();
    for number in 0..contestants.len() {
        let shown = draw(Some(number), &view, Some(request.error_size)).map_err(ChartError::Draw)?;
        errors.push(compare(&shown.picture, &truth, request.error_size, peak(&truth)));
    }
    let mut times = vec![[const { Vec::new() }; 3]; contestants.len()];
    for _ in 0..request.rounds {
        let without = timed(None, &view, draw)?;
        for (number, [own_times, pass_times, whole]) in times.iter_mut().enumerate() {
            let shown = timed(Some(number), &view, draw)?;
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
pub(super) fn timed(number: Option<usize>, view: &View, draw: &mut Draw) -> Result<Shown, ChartError> {
    let mut frame = || draw(number, view, None).map_err(ChartError::Draw);
    frame()?;
    frame()?;
    let (first, second) = (frame()?, frame()?);
    Ok(Shown {
        whole: 0.5 * (first.whole + second.whole),
        processor: first.processor.zip(second.processor).map(|(a, b)| 0.5 * (a + b)),
        ..second
    })
}

fn figure(alone: &Sheet, chase: &Sheet, summary: &Sheet) -> Figure {
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
    let names: Vec<String> = summary.rows.iter().map(|row| summary.text(row, "contestant").to_owned()).collect();
    let fps = |column: &str| -> Vec<Option<f64>> { summary.rows.iter().map(|row| Some(1e3 / summary.number(row, column))).collect() };
    let [mean_fps, worst_fps] = ["mean_ms", "worst_ms"].map(fps);
    let bars = Bars {
        title: "The scripted chase, whole frames".into(),
        y: Axis::linear("frames per second"),
        groups: names.iter().map(|name| name.replacen(' ', "\n", 1)).collect(),
        series: vec![Series { name: "mean".into(), values: mean_fps }, Series { name: "worst".into(), values: worst_fps }],
        values: true,
        ..Bars::default()
    };
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
    let course = Lines {
        title: "The disk along the chase".into(),
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
