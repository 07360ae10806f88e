//! The chart `aurora`: time against the number of electrons (figure 5 of Sekiguchi et al.), and error against time, for each view.

use crate::say::say;
use std::path::PathBuf;

use super::experiment::{self, ExperimentRequest, Row, Viewpoint};
use crate::chart::{ChartError, Output, Provenance, Sheet};
use crate::plot::{Axis, Bars, Figure, Guide, Line, Lines, Panel, Point, Scatter, Series};

const COLUMNS: [&str; 9] = ["view", "method", "electrons", "radius_km", "walk_ms", "splat_ms", "total_ms", "error", "difference"];

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

/// Measures (or reads) and draws; returns the files written.
pub fn run(output: &Output, request: &ExperimentRequest) -> Result<Vec<PathBuf>, ChartError> {
    let sheet = output.sheet("aurora", || -> Result<Sheet, ChartError> {
        let table = lensrunner::lensing::default_table();
        let bar = indicatif::ProgressBar::new_spinner();
        let rows = experiment::run(request, &table, |what| {
            bar.set_message(what.to_owned());
            bar.tick();
        });
        bar.finish_and_clear();
        Ok(to_sheet(&rows))
    })?;
    say(ratios(&sheet));
    let figure = draw(&sheet);
    Ok(figure.save(&output.folder, "aurora")?.into_iter().chain([output.csv("aurora")]).collect())
}

/// The table of the rows.
fn to_sheet(rows: &[Row]) -> Sheet {
    let mut sheet = Sheet::new(&COLUMNS);
    sheet.notes = Provenance::now("").notes();
    for row in rows {
        let number = |x: f64| format!("{x:.4}");
        sheet.push([
            row.view.to_owned(),
            row.method.to_owned(),
            row.count.to_string(),
            row.radius.to_string(),
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
const SHOWN: [(&str, &str); 4] =
    [("particles", "particles"), ("particles-tabled", "particles, fall tabulated"), ("linear", "linear walk"), ("exact", "exact walk")];

/// What is set against what: a name, the slower method, the faster, and the column.
type Factor = (&'static str, &'static str, &'static str, &'static str);

const FACTORS: [Factor; 3] = [
    ("walk", "particles", "exact", "walk_ms"),
    ("walk, the fall\ntabulated for both", "particles-tabled", "exact", "walk_ms"),
    ("whole pass", "particles", "exact", "total_ms"),
];

/// Differences are drawn no lower: those of rounding.
const LEAST_DIFFERENCE: f64 = 1e-7;

/// A row of panels for each view: time of the walk against electrons at the middle radius, error against it, the difference from the
/// particle method with the same random numbers, and how many times as fast the exact walk is.
pub fn draw(sheet: &Sheet) -> Figure {
    let shown = Shown::new(sheet);
    let measured = distinct(sheet, "view");
    let views: Vec<&str> = Viewpoint::ALL.iter().map(|(_, name)| *name).filter(|name| measured.iter().any(|view| view == name)).collect();
    let panels = views.iter().flat_map(|view| [shown.times(view), shown.errors(view), shown.differences(view), shown.factors(view)]);
    Figure {
        verdict: verdict(sheet),
        title: "Aurora: walks on the screen against particles in space".into(),
        subtitle: "Means over the auroras; the same electrons and random numbers in every method, one thread. “bent” is seen through the \
                   lensing of a hole. Left of and below the others is better."
            .into(),
        panels: panels.collect(),
        columns: 4,
        size: [1900, 150 + 400 * views.len() as u32],
        footer: Provenance::footer(&sheet.notes),
    }
}

/// The rows of a method through bent light, or of it in all flat views.
fn rows<'a>(sheet: &'a Sheet, method: &'a str, bent: bool) -> impl Iterator<Item = &'a Vec<String>> {
    sheet.rows.iter().filter(move |row| sheet.text(row, "method") == method && (sheet.text(row, "view") == "bent") == bent)
}

/// A column of one method over that of another, for all electrons and radii.
fn quotients(sheet: &Sheet, above: &str, below: &str, column: &str, bent: bool) -> Vec<f64> {
    // A method has the same cases in the same order as the others.
    let pairs = rows(sheet, above, bent).zip(rows(sheet, below, bent));
    pairs.map(|(a, b)| sheet.number(a, column) / sheet.number(b, column)).collect()
}

fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

fn greatest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// How many times less time the exact walk takes than particles.
fn verdict(sheet: &Sheet) -> String {
    let factors = |bent| quotients(sheet, "particles", "exact", "walk_ms", bent);
    let (flat, bent) = (factors(false), factors(true));
    let worse = [false, true].map(|bent| greatest(&quotients(sheet, "exact", "particles", "error", bent)));
    let worse = 100.0 * (greatest(&worse) - 1.0);
    let error = if worse < 0.05 { "at the same error".to_owned() } else { format!("at an error up to {worse:.1} % greater") };
    format!(
        "The exact walk takes {:.0} to {:.0} times less time than particles in flat views, {:.0} to {:.0} times less through bent light, {error}",
        least(&flat),
        greatest(&flat),
        least(&bent),
        greatest(&bent)
    )
}

/// What the experiment is about as a Markdown table, least and greatest over all electrons and radii: how many times less time the exact
/// walk takes, and by how much the walks' pictures differ from that of the particle method.
fn ratios(sheet: &Sheet) -> String {
    let mut text = String::from("| | flat views | bent light |\n|---|---|---|\n");
    for (name, slow, fast, column) in FACTORS {
        let range = [false, true].map(|bent| {
            let factors = quotients(sheet, slow, fast, column, bent);
            format!("{:.1} … {:.1}", least(&factors), greatest(&factors))
        });
        text += &format!("| {} | {} |\n", name.replace('\n', " "), range.join(" | "));
    }
    for method in ["exact", "linear"] {
        let most = [false, true].map(|bent| {
            format!("≤ {:.1e}", greatest(&rows(sheet, method, bent).map(|row| sheet.number(row, "difference")).collect::<Vec<_>>()))
        });
        text += &format!("| difference from particles, {method} walk | {} |\n", most.join(" | "));
    }
    text
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

    /// Time against electrons, a line for each method.
    fn times(&self, view: &str) -> Panel {
        let lines = SHOWN.iter().map(|(method, name)| Line {
            name: (*name).into(),
            points: self
                .rows(view)
                .filter(|row| self.sheet.text(row, "method") == *method)
                .map(|row| [self.sheet.number(row, "electrons"), self.sheet.number(row, "walk_ms")])
                .collect(),
            dots: true,
            ..Line::default()
        });
        Panel::Lines(Lines {
            title: view.to_owned(),
            x: Axis::log("electrons"),
            y: Axis::log("time of the walk, ms"),
            lines: lines.collect(),
            ..Lines::default()
        })
    }

    /// A column against time, a point for each method with the most electrons.
    fn points(&self, view: &str, column: &str) -> Vec<Point> {
        let point = |(family, (method, name)): (usize, &(&str, &str))| Point {
            x: self.of(view, method, "walk_ms"),
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
            title: format!("{view}: {} electrons, splats of {} km", self.most, self.radius),
            x: Axis::log("time of the walk, ms"),
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
            x: Axis::log("time of the walk, ms"),
            y: Axis::log("difference from particles"),
            points,
            ..Scatter::default()
        })
    }

    fn factors(&self, view: &str) -> Panel {
        let factor = |(_, slow, fast, column): Factor| self.of(view, slow, column) / self.of(view, fast, column);
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
