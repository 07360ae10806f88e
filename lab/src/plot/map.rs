//! Values over a plane, as colours.

use super::Guide;
use super::axis::{self, Area, Axis, Plane, Scale, Titles, tick_text};
use super::paint::{Anchor, Shape};
use super::style::{Color, FAILED, INK, SMALL, WHITE, scale};

/// A panel of coloured cells.
#[derive(Clone, Debug, Default)]
pub struct Map {
    /// Above the panel.
    pub title: String,
    /// The axis across: its range is what the columns span evenly (in the logarithm, if it is logarithmic).
    pub x: Axis,
    /// The axis upward: the same for the rows.
    pub y: Axis,
    /// Columns and rows.
    pub size: [usize; 2],
    /// One value for each cell, row by row from the lower end of y; NaN is a failure (red), −∞ an empty place (white).
    pub values: Vec<f64>,
    /// What the colours stand for.
    pub colors: Axis,
    /// Draws the colour scale beside the map.
    pub legend: bool,
    /// Values of the axis across to mark.
    pub marks: Vec<f64>,
    /// Values of the colour scale to mark; their words stand in its legend.
    pub guides: Vec<Guide>,
}

pub(super) fn draw(panel: &Map, mut area: Area, shapes: &mut Vec<Shape>) {
    let right = area.x[1];
    if panel.legend {
        area.x[1] -= 84.0;
    }
    let range = |axis: &Axis| axis.fitted(std::iter::empty());
    let titles = Titles { title: &panel.title, x: &panel.x.label, y: &panel.y.label };
    let plane = axis::frame(area, &titles, [range(&panel.x), range(&panel.y)], true, shapes);
    let colors = panel.colors.fitted(panel.values.iter().copied());
    cells(panel, &plane.inner, &colors, shapes);
    marks_across(panel, &plane, shapes);
    if panel.legend {
        legend(panel, right, plane.inner.y, &colors, shapes);
    }
}

/// The colour of a value; None for an empty place.
fn paint(value: f64, colors: &Scale) -> Option<Color> {
    match value {
        v if v.is_nan() => Some(FAILED),
        v if v == f64::NEG_INFINITY => None,
        v => Some(scale(colors.share(v))),
    }
}

/// The coloured cells, row by row.
fn cells(panel: &Map, inner: &Area, colors: &Scale, shapes: &mut Vec<Shape>) {
    let Area { x: [left, end], y: [top, bottom] } = *inner;
    let [columns, rows] = panel.size;
    for row in 0..rows {
        let y = |k: usize| bottom - (bottom - top) * k as f64 / rows as f64;
        let line = &panel.values[row * columns..(row + 1) * columns];
        let mut first = 0;
        // Neighbours of one colour are one rectangle: the SVG stays small.
        for column in 1..=columns {
            let color = paint(line[first], colors);
            if column < columns && paint(line[column], colors) == color {
                continue;
            }
            if let Some(color) = color {
                let x = |k: usize| left + (end - left) * k as f64 / columns as f64;
                shapes.push(Shape::Rect { from: [x(first), y(row + 1)], to: [x(column), y(row)], color });
            }
            first = column;
        }
    }
}

/// The marked values of the axis across.
fn marks_across(panel: &Map, plane: &Plane, shapes: &mut Vec<Shape>) {
    let [top, bottom] = plane.inner.y;
    for mark in panel.marks.iter().filter(|mark| plane.x.holds(**mark)) {
        let [at, _] = plane.place(*mark, plane.y.low());
        // White under ink: seen on every colour.
        shapes.push(Shape::line([at, top], [at, bottom], WHITE, 3.0));
        shapes.push(Shape::Path { points: vec![[at, top], [at, bottom]], color: INK, width: 1.0, dash: 4.0 });
    }
}

/// The colour scale with its ticks, marked values and title, between `right` and the map.
fn legend(panel: &Map, right: f64, [top, bottom]: [f64; 2], colors: &Scale, shapes: &mut Vec<Shape>) {
    let (x0, x1) = (right - 74.0, right - 58.0);
    let steps = 64;
    for i in 0..steps {
        let y = |k: usize| bottom - (bottom - top) * k as f64 / steps as f64;
        shapes.push(Shape::Rect { from: [x0, y(i + 1)], to: [x1, y(i)], color: scale((i as f64 + 0.5) / steps as f64) });
    }
    let height = |value: f64| bottom - (bottom - top) * colors.share(value);
    for value in colors.ticks(((bottom - top) / 30.0) as usize) {
        let at = height(value);
        if panel.guides.iter().any(|guide| (height(guide.at) - at).abs() < 10.0) {
            continue;
        }
        shapes.push(Shape::line([x1, at], [x1 + 4.0, at], INK, 1.0));
        shapes.push(Shape::text([x1 + 7.0, at], tick_text(value), SMALL, INK, Anchor::Start));
    }
    for guide in panel.guides.iter().filter(|guide| colors.holds(guide.at)) {
        let at = height(guide.at);
        shapes.push(Shape::line([x0 - 4.0, at], [x1 + 4.0, at], WHITE, 4.0));
        shapes.push(Shape::line([x0 - 4.0, at], [x1 + 4.0, at], INK, 2.0));
        shapes.push(Shape::text([x1 + 7.0, at], guide.label.clone(), SMALL, INK, Anchor::Start));
    }
    shapes.push(Shape::Text {
        at: [right - 7.0, 0.5 * (top + bottom)],
        text: panel.colors.label.clone(),
        size: SMALL,
        color: INK,
        anchor: Anchor::Middle,
        upward: true,
    });
}
