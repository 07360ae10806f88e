//! The chart `aurora`: time against the number of electrons (figure 5 of Sekiguchi et al.), and error against time, for each view.

use crate::say::say;
use std::path::PathBuf;

use super::experiment::{self, ExperimentRequest, Row, Runner, View};
use crate::chart::{Output, Provenance, Sheet, SheetError};
use crate::plot::{Axis, Figure, Line, Lines, Panel, PlotError, Point, Scatter};

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

const COLUMNS: [&str; 10] =
    ["view", "method", "electrons", "radius_km", "points", "walk_ms", "splat_ms", "total_ms", "error", "difference"];

/// A radius in km from the command line.
pub fn radius(text: &str) -> Result<f32, String> {
    match text.parse() {
        Ok(radius) if (0.1..=50.0).contains(&radius) => Ok(radius),
        _ => Err("not a number from 0.1 to 50".into()),
    }
}

/// A size in pixels from the command line.
pub fn size(text: &str) -> Result<[usize; 2], String> {
    let sides: Option<Vec<usize>> = text.split('x').map(|side| side.parse().ok().filter(|side| (8..=4096).contains(side))).collect();
    match sides.as_deref() {
        Some(&[width, height]) => Ok([width, height]),
        _ => Err("not WIDTHxHEIGHT with sides from 8 to 4096".into()),
    }
}

/// Measures (or reads) and draws; returns the files written. `adapter` and `runners` come from whoever has a GPU.
pub fn run(
    output: &Output,
    request: &ExperimentRequest,
    adapter: &str,
    runners: &mut [Box<dyn Runner>],
) -> Result<Vec<PathBuf>, ChartError> {
    let sheet = output.sheet("aurora", || -> Result<Sheet, ChartError> {
        let table = lensrunner::lensing::default_table();
        let bar = indicatif::ProgressBar::new_spinner();
        let rows = experiment::run(request, &table, runners, |what| {
            bar.set_message(what.to_owned());
            bar.tick();
        });
        bar.finish_and_clear();
        Ok(to_sheet(&rows, adapter))
    })?;
    say(ratios(&sheet));
    let figure = draw(&sheet);
    Ok(figure.save(&output.folder, "aurora")?.into_iter().chain([output.csv("aurora")]).collect())
}

/// The table of the rows.
pub fn to_sheet(rows: &[Row], adapter: &str) -> Sheet {
    let mut sheet = Sheet::new(&COLUMNS);
    sheet.notes = Provenance::now(adapter).notes();
    for row in rows {
        let number = |x: f64| format!("{x:.4}");
        sheet.push([
            row.view.to_owned(),
            row.method.clone(),
            row.count.to_string(),
            row.radius.to_string(),
            format!("{:.0}", row.points),
            number(row.walk),
            number(row.splat),
            number(row.total),
            number(row.error),
            // Of the exact walk in flat space it is rounding, far below what other columns show.
            format!("{:.3e}", row.difference),
        ]);
    }
    sheet
}

/// Distinct values of a column in the order they come.
fn distinct(sheet: &Sheet, column: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for row in &sheet.rows {
        let text = sheet.text(row, column);
        if !found.iter().any(|known| known == text) {
            found.push(text.to_owned());
        }
    }
    found
}

/// What the names of rows end with that are drawn by all threads, and by a graphics adapter.
const THREADS: &str = "-threads";
const ADAPTER: &str = "-gpu";

/// The colour of a row: that of the same way on one thread, as there are more rows than colours that can be told apart.
fn family(methods: &[String], method: &str) -> usize {
    let own = method.trim_end_matches(THREADS).trim_end_matches(ADAPTER);
    methods.iter().filter(|method| !method.ends_with(THREADS) && !method.ends_with(ADAPTER)).position(|method| method == own).unwrap_or(0)
}

/// Differences are drawn no lower: those of rounding.
const LEAST_DIFFERENCE: f64 = 1e-7;

/// Three rows of panels, a column for each view: time against electrons at the middle radius, error against time for all, and against time
/// the difference from the particle method with the same random numbers.
pub fn draw(sheet: &Sheet) -> Figure {
    let shown = Shown::new(sheet);
    let measured = distinct(sheet, "view");
    let views: Vec<&str> = View::ALL.iter().map(|(_, name)| *name).filter(|name| measured.iter().any(|view| view == name)).collect();
    let mut panels: Vec<Panel> = views.iter().map(|view| shown.times(view)).collect();
    panels.extend(views.iter().map(|view| shown.errors(view)));
    // A sheet of before has no such column.
    let known = sheet.column("difference").is_ok();
    if known {
        panels.extend(views.iter().map(|view| shown.differences(view)));
    }
    Figure {
        title: "Aurora: walks on the screen against particles in space".into(),
        subtitle:
            "Means over the auroras; the same electrons and random numbers in every method. Dashed: all threads, or the graphics adapter (-gpu). “bent” is seen through the lensing of a hole."
                .into(),
        panels,
        columns: views.len().max(1),
        size: [1900, if known { 1600 } else { 1100 }],
        footer: Provenance::footer(&sheet.notes),
    }
}

/// What the panels show of the table.
struct Shown<'a> {
    sheet: &'a Sheet,
    methods: Vec<String>,
    /// The middle one of the radii.
    radius: String,
    /// The greatest number of electrons.
    most: String,
}

impl<'a> Shown<'a> {
    fn new(sheet: &'a Sheet) -> Shown<'a> {
        let (radii, counts) = (distinct(sheet, "radius_km"), distinct(sheet, "electrons"));
        Shown {
            sheet,
            methods: distinct(sheet, "method"),
            radius: radii.get(radii.len() / 2).cloned().unwrap_or_default(),
            most: counts.last().cloned().unwrap_or_default(),
        }
    }

    /// The rows of a view at the radius shown.
    fn rows(&self, view: &str) -> impl Iterator<Item = &'a Vec<String>> {
        let sheet = self.sheet;
        sheet.rows.iter().filter(move |row| sheet.text(row, "view") == view && sheet.text(row, "radius_km") == self.radius)
    }

    /// Time against electrons, a line for each method.
    fn times(&self, view: &str) -> Panel {
        let lines = self.methods.iter().map(|method| Line {
            name: method.clone(),
            points: self
                .rows(view)
                .filter(|row| self.sheet.text(row, "method") == method)
                .map(|row| [self.sheet.number(row, "electrons"), self.sheet.number(row, "total_ms")])
                .collect(),
            dashed: method.ends_with(THREADS) || method.ends_with(ADAPTER),
            dots: true,
            color: Some(family(&self.methods, method)),
        });
        Panel::Lines(Lines {
            title: format!("{view}: splats of {} km", self.radius),
            x: Axis::log("electrons"),
            y: Axis::log("time of a frame, ms"),
            lines: lines.collect(),
            ..Lines::default()
        })
    }

    /// A column against time, a point for each method with the most electrons.
    fn points(&self, view: &str, column: &str) -> Vec<Point> {
        let point = |row: &Vec<String>| Point {
            x: self.sheet.number(row, "total_ms"),
            y: self.sheet.number(row, column),
            label: self.sheet.text(row, "method").to_owned(),
            family: family(&self.methods, self.sheet.text(row, "method")),
            failed: false,
            chosen: false,
        };
        self.rows(view).filter(|row| self.sheet.text(row, "electrons") == self.most).map(point).collect()
    }

    fn errors(&self, view: &str) -> Panel {
        Panel::Scatter(Scatter {
            title: format!("{view}: {} electrons", self.most),
            x: Axis::log("time of a frame, ms"),
            // Through bent light there is no line integral to judge by.
            y: Axis::linear(if view == "bent" { "error against many more electrons" } else { "error against the line integral" }),
            points: self.points(view, "error"),
            pareto: true,
            ..Scatter::default()
        })
    }

    fn differences(&self, view: &str) -> Panel {
        // The particle method itself, on one thread, is no point: it differs by nothing.
        let mut points = self.points(view, "difference");
        points.retain(|point| point.y > 0.0);
        points.iter_mut().for_each(|point| point.y = point.y.max(LEAST_DIFFERENCE));
        Panel::Scatter(Scatter {
            title: format!("{view}: the same random numbers"),
            x: Axis::log("time of a frame, ms"),
            y: Axis::log("difference from the particle method"),
            points,
            ..Scatter::default()
        })
    }
}

/// The ratios that the experiment is about, a line for each view at the greatest number of electrons and the middle radius, as a Markdown
/// table: milliseconds of the particle method and of the exact walk, and how many times less the walk takes.
pub fn ratios(sheet: &Sheet) -> String {
    let Shown { radius, most, .. } = Shown::new(sheet);
    let mut text = String::from(
        "| view | walk | walk, the fall tabulated for both | whole pass, table | whole pass, pyramid | the same on all threads | the paper's baseline → exact, pyramid | walk on the adapter | whole pass on the adapter | error: exact, with pyramid, linear | difference from the particle method: exact, with pyramid, linear |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for view in distinct(sheet, "view") {
        let of = |method: &str, column: &str| {
            let found = sheet.rows.iter().find(|row| {
                let is = |column: &str, text: &str| sheet.text(row, column) == text;
                is("view", &view) && is("method", method) && is("radius_km", &radius) && is("electrons", &most)
            });
            found.map_or(f64::NAN, |row| sheet.number(row, column))
        };
        let pair = |slow: &str, fast: &str, column: &str| {
            let (slow, fast) = (of(slow, column), of(fast, column));
            if slow.is_nan() { "–".to_owned() } else { format!("{slow:.1} → {fast:.2} ({:.1} ×)", slow / fast) }
        };
        let columns = [
            pair("particles", "exact", "walk_ms"),
            pair("particles-tabled", "exact", "walk_ms"),
            pair("particles", "exact", "total_ms"),
            pair("particles-pyramid", "exact-pyramid", "total_ms"),
            pair("particles-pyramid-threads", "exact-pyramid-threads", "total_ms"),
            pair("particles-no-table", "exact-pyramid", "total_ms"),
            pair("particles-gpu", "exact-gpu", "walk_ms"),
            pair("particles-gpu", "exact-gpu", "total_ms"),
            ["exact", "exact-pyramid", "linear"].map(|method| format!("{:.3}", of(method, "error"))).join(", "),
            ["exact", "exact-pyramid", "linear"].map(|method| format!("{:.4}", of(method, "difference"))).join(", "),
        ];
        text += &format!("| {view} | {} |\n", columns.join(" | "));
    }
    text
}
