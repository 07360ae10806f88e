//! The chart `aurora`: time against the number of electrons (figure 5 of Sekiguchi et al.), and error against time, for each view.

use crate::say::say;
use std::path::PathBuf;

use super::experiment::{self, ExperimentRequest, Row, Runner, View};
use crate::chart::{Output, Provenance, Sheet, SheetError};
use crate::plot::{Axis, Bars, Figure, Guide, Line, Lines, Panel, PlotError, Point, Scatter, Series};

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

/// What is drawn: the name in the table, and what it is called.
const SHOWN: [(&str, &str); 6] = [
    ("particles-no-table", "particles, the paper's baseline"),
    ("particles", "particles"),
    ("particles-pyramid", "particles, pyramid"),
    ("linear", "linear walk"),
    ("exact", "exact walk"),
    ("exact-pyramid", "exact walk, pyramid"),
];

/// Pairs of rows that are set against each other, and a column: particles, walk.
const FACTORS: [(&str, &str, &str, &str); 5] = [
    ("the walk\nalone", "particles", "exact", "walk_ms"),
    ("pass,\ntable", "particles", "exact", "total_ms"),
    ("pass,\npyramid", "particles-pyramid", "exact-pyramid", "total_ms"),
    ("the same,\nall threads", "particles-pyramid-threads", "exact-pyramid-threads", "total_ms"),
    ("pass on the\nadapter", "particles-gpu", "exact-gpu", "total_ms"),
];

/// Differences are drawn no lower: those of rounding.
const LEAST_DIFFERENCE: f64 = 1e-7;

/// A row of panels for each view: time against electrons at the middle radius, error against time, the difference from the particle method
/// with the same random numbers, and how many times as fast the exact walk is.
pub fn draw(sheet: &Sheet) -> Figure {
    let shown = Shown::new(sheet);
    let measured = distinct(sheet, "view");
    let views: Vec<&str> = View::ALL.iter().map(|(_, name)| *name).filter(|name| measured.iter().any(|view| view == name)).collect();
    let panels = views.iter().flat_map(|view| [shown.times(view), shown.errors(view), shown.differences(view), shown.factors(view)]);
    Figure {
        verdict: shown.verdict(&views),
        title: "Aurora: walks on the screen against particles in space".into(),
        subtitle: "Means over the auroras; the same electrons and random numbers in every method. One thread unless said. “bent” is seen \
                   through the lensing of a hole. Left of and below the others is better."
            .into(),
        panels: panels.collect(),
        columns: 4,
        size: [1900, 150 + 400 * views.len() as u32],
        footer: Provenance::footer(&sheet.notes),
    }
}

/// What the panels show of the table.
struct Shown<'a> {
    sheet: &'a Sheet,
    /// The middle one of the radii.
    radius: String,
    /// The greatest number of electrons.
    most: String,
}

impl<'a> Shown<'a> {
    fn new(sheet: &'a Sheet) -> Shown<'a> {
        let (radii, counts) = (distinct(sheet, "radius_km"), distinct(sheet, "electrons"));
        Shown { sheet, radius: radii.get(radii.len() / 2).cloned().unwrap_or_default(), most: counts.last().cloned().unwrap_or_default() }
    }

    /// The rows of a view at the radius shown.
    fn rows(&self, view: &str) -> impl Iterator<Item = &'a Vec<String>> {
        let sheet = self.sheet;
        sheet.rows.iter().filter(move |row| sheet.text(row, "view") == view && sheet.text(row, "radius_km") == self.radius)
    }

    /// A column of a method in a view with the most electrons; NaN where it was not measured.
    fn of(&self, view: &str, method: &str, column: &str) -> f64 {
        let found = self.rows(view).find(|row| self.sheet.text(row, "method") == method && self.sheet.text(row, "electrons") == self.most);
        found.map_or(f64::NAN, |row| self.sheet.number(row, column))
    }

    /// How many times less the exact walk alone takes, over the views.
    fn verdict(&self, views: &[&str]) -> String {
        let range = |(_, slow, fast, column): (&str, &str, &str, &str)| {
            let factors = views.iter().map(|view| self.of(view, slow, column) / self.of(view, fast, column)).filter(|f| f.is_finite());
            factors.fold([f64::INFINITY, 0.0], |[least, most], f| [least.min(f), most.max(f)])
        };
        let ([low, high], [least, most]) = (range(FACTORS[0]), range(FACTORS[2]));
        let worse = views.iter().map(|view| self.of(view, "exact", "error") / self.of(view, "particles", "error") - 1.0);
        let worse = 100.0 * worse.filter(|share| share.is_finite()).fold(0.0, f64::max);
        let error = if worse < 0.05 { "at the same error".to_owned() } else { format!("at an error up to {worse:.1} % greater") };
        format!(
            "The exact walk takes {low:.0} to {high:.0} times less time than particles, a whole pass with a pyramid {least:.1} to {most:.1} times \
             less, {error}"
        )
    }

    /// Time against electrons, a line for each method.
    fn times(&self, view: &str) -> Panel {
        let lines = SHOWN.iter().map(|(method, name)| Line {
            name: (*name).into(),
            points: self
                .rows(view)
                .filter(|row| self.sheet.text(row, "method") == *method)
                .map(|row| [self.sheet.number(row, "electrons"), self.sheet.number(row, "total_ms")])
                .collect(),
            dots: true,
            ..Line::default()
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
        let point = |(family, (method, name)): (usize, &(&str, &str))| Point {
            x: self.of(view, method, "total_ms"),
            y: self.of(view, method, column),
            label: (*name).into(),
            family,
            failed: false,
            chosen: false,
        };
        SHOWN.iter().enumerate().map(point).filter(|point| point.x > 0.0).collect()
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
        // The particle method itself is no point: it differs by nothing.
        let mut points = self.points(view, "difference");
        points.retain(|point| point.y > 0.0);
        points.iter_mut().for_each(|point| point.y = point.y.max(LEAST_DIFFERENCE));
        Panel::Scatter(Scatter {
            title: format!("{view}: the same random numbers"),
            x: Axis::log("time of a frame, ms"),
            y: Axis::log("difference from particles"),
            points,
            ..Scatter::default()
        })
    }

    fn factors(&self, view: &str) -> Panel {
        let factor = |(_, slow, fast, column): (&str, &str, &str, &str)| self.of(view, slow, column) / self.of(view, fast, column);
        Panel::Bars(Bars {
            title: format!("{view}: particles over exact walk"),
            y: Axis::linear("times as fast"),
            groups: FACTORS.iter().map(|(name, ..)| (*name).to_owned()).collect(),
            series: vec![Series { name: String::new(), values: FACTORS.map(|f| Some(factor(f))).to_vec() }],
            values: true,
            guides: vec![Guide { at: 1.0, label: String::new() }],
        })
    }
}

/// The ratios that the experiment is about, a line for each view at the greatest number of electrons and the middle radius, as a Markdown
/// table: milliseconds of the particle method and of the exact walk, and how many times less the walk takes.
pub fn ratios(sheet: &Sheet) -> String {
    let shown = Shown::new(sheet);
    let mut text = String::from(
        "| view | walk | walk, the fall tabulated for both | whole pass, table | whole pass, pyramid | the same on all threads | the paper's baseline → exact, pyramid | walk on the adapter | whole pass on the adapter | error: exact, with pyramid, linear | difference from the particle method: exact, with pyramid, linear |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for view in distinct(sheet, "view") {
        let of = |method: &str, column: &str| shown.of(&view, method, column);
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
