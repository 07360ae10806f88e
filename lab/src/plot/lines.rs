//! Curves over two axes.

use super::Guide;
use super::axis::{self, Area, Axis, Titles};
use super::paint::{Shape, cross};
use super::style::color;

/// A panel of curves.
#[derive(Clone, Debug, Default)]
pub struct Lines {
    /// Above the panel.
    pub title: String,
    /// The axis across.
    pub x: Axis,
    /// The axis upward.
    pub y: Axis,
    /// The curves, each with a colour of its own.
    pub lines: Vec<Line>,
    /// Values of the axis upward to mark.
    pub guides: Vec<Guide>,
    /// Values of the axis across to mark.
    pub guides_x: Vec<Guide>,
}

/// A curve.
#[derive(Clone, Debug, Default)]
pub struct Line {
    /// Its name in the legend.
    pub name: String,
    /// Its points, in the order drawn; where one is not finite the curve is broken.
    pub points: Vec<[f64; 2]>,
    /// A disc at each point.
    pub dots: bool,
    /// Where it fails: red crosses.
    pub failed: Vec<[f64; 2]>,
}

pub(super) fn draw(panel: &Lines, area: Area, shapes: &mut Vec<Shape>) {
    let entries: Vec<_> = panel.lines.iter().enumerate().map(|(i, line)| (line.name.as_str(), color(i))).collect();
    let area = axis::legend(&entries, area, shapes);
    let all = || panel.lines.iter().flat_map(|line| line.points.iter().chain(&line.failed));
    let x = panel.x.fitted(all().map(|p| p[0]).chain(panel.guides_x.iter().map(|g| g.at)));
    let y = panel.y.fitted(all().map(|p| p[1]).chain(panel.guides.iter().map(|g| g.at)));
    let plane = axis::frame(area, &Titles { title: &panel.title, x: &panel.x.label, y: &panel.y.label }, [x, y], true, shapes);
    let (curves, mut taken) = (curves(panel, &plane), Vec::new());
    axis::guides(&plane, &panel.guides, true, &curves, &mut taken, shapes);
    axis::guides(&plane, &panel.guides_x, false, &curves, &mut taken, shapes);
    for (i, line) in panel.lines.iter().enumerate() {
        for piece in line.points.split(|p| !p.iter().all(|v| v.is_finite())).filter(|piece| !piece.is_empty()) {
            let points: Vec<_> = piece.iter().map(|p| plane.clamped(p[0], p[1])).collect();
            if line.dots {
                shapes.extend(points.iter().map(|at| Shape::Disc { at: *at, radius: 3.0, color: color(i), filled: true }));
            }
            shapes.push(Shape::Path { points, color: color(i), width: 2.0, dash: 0.0 });
        }
    }
    for at in panel.lines.iter().flat_map(|line| &line.failed).map(|p| plane.clamped(p[0], p[1])) {
        cross(at, 5.0, shapes);
    }
}

/// Points along the curves, a few pixels apart: where words should not be.
fn curves(panel: &Lines, plane: &axis::Plane) -> Vec<[f64; 2]> {
    const STEPS: u32 = 24;
    let mut all = Vec::new();
    for pair in panel.lines.iter().flat_map(|line| line.points.windows(2)) {
        if !pair.iter().flatten().all(|v| v.is_finite()) {
            continue;
        }
        let [a, b] = [pair[0], pair[1]].map(|p| plane.clamped(p[0], p[1]));
        all.extend((0..=STEPS).map(|k| f64::from(k) / f64::from(STEPS)).map(|t| [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]));
    }
    all
}
