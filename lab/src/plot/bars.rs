//! Bars in groups.

use super::Guide;
use super::axis::{self, Area, Axis, Titles, tick_text};
use super::paint::{Anchor, Shape, cross, width};
use super::style::{INK, SMALL, color};

/// A panel of bars: groups beside each other, in each one bar for every series.
#[derive(Clone, Debug, Default)]
pub struct Bars {
    /// Above the panel.
    pub title: String,
    /// The axis upward.
    pub y: Axis,
    /// Names of the groups; lines split at `\n`.
    pub groups: Vec<String>,
    /// The series, each with a colour of its own.
    pub series: Vec<Series>,
    /// Values to mark.
    pub guides: Vec<Guide>,
    /// Writes each value above its bar.
    pub values: bool,
}

/// The bars of one colour.
#[derive(Clone, Debug, Default)]
pub struct Series {
    /// Its name in the legend.
    pub name: String,
    /// A value for each group; None is a failure (a red cross), NaN an empty place.
    pub values: Vec<Option<f64>>,
}

pub(super) fn draw(panel: &Bars, area: Area, shapes: &mut Vec<Shape>) {
    let entries: Vec<_> = panel.series.iter().enumerate().map(|(i, s)| (s.name.as_str(), color(i))).collect();
    let mut area = axis::legend(&entries, area, shapes);
    let lines = panel.groups.iter().map(|name| name.lines().count()).max().unwrap_or(1).max(1);
    area.y[1] -= 15.0 * (lines as f64 - 1.0);
    let values = panel.series.iter().flat_map(|s| &s.values).filter_map(|v| *v);
    let y = panel.y.fitted(values.chain(panel.guides.iter().map(|g| g.at)));
    let x = Axis::linear("").between(0.0, panel.groups.len().max(1) as f64).fitted(std::iter::empty());
    let plane = axis::frame(area, &Titles { title: &panel.title, x: "", y: &panel.y.label }, [x, y], false, shapes);
    let bottom = plane.inner.y[1];
    let count = panel.series.len().max(1) as f64;
    for (group, name) in panel.groups.iter().enumerate() {
        for (s, series) in panel.series.iter().enumerate() {
            let side = |k: f64| group as f64 + 0.1 + 0.8 * (s as f64 + k) / count;
            match series.values.get(group).copied().flatten() {
                Some(value) if value.is_finite() => {
                    let (from, to) = (plane.clamped(side(0.04), value), [plane.place(side(0.96), y.low())[0], bottom]);
                    shapes.push(Shape::Rect { from, to, color: color(s) });
                    let text = short(value);
                    if panel.values && width(&text, SMALL) < 1.25 * (to[0] - from[0]).max(24.0) {
                        shapes.push(Shape::text([0.5 * (from[0] + to[0]), from[1] - 8.0], text, SMALL, INK, Anchor::Middle));
                    }
                }
                Some(_) => {}
                None if group < series.values.len() => {
                    let at = [plane.place(side(0.5), y.low())[0], bottom - 10.0];
                    cross(at, 5.0, shapes);
                }
                None => {}
            }
        }
        let middle = plane.place(group as f64 + 0.5, y.low())[0];
        for (i, line) in name.lines().enumerate() {
            shapes.push(Shape::text([middle, bottom + 13.0 + 15.0 * i as f64], line, SMALL, INK, Anchor::Middle));
        }
    }
    axis::guides(&plane, &panel.guides, true, &[], &mut Vec::new(), shapes);
}

/// Three significant digits.
fn short(value: f64) -> String {
    if value == 0.0 || !(1e-4..1e6).contains(&value.abs()) {
        return tick_text(value);
    }
    let decimals = (2 - value.abs().log10().floor() as i32).max(0) as usize;
    format!("{value:.decimals$}")
}
