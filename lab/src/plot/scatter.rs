//! Labelled points over two axes, with the line of those that nothing beats.

use super::axis::{self, Area, Axis, Bounds, Plane, Titles, overlap};
use super::paint::{Anchor, Shape, cross, width};
use super::style::{FAILED, GOOD, GREY, HEADING, INK, SMALL, color, fade};
use super::{Guide, pareto};

/// A panel of labelled points.
#[derive(Clone, Debug, Default)]
pub struct Scatter {
    /// Above the panel.
    pub title: String,
    /// The axis across.
    pub x: Axis,
    /// The axis upward.
    pub y: Axis,
    /// The points.
    pub points: Vec<Point>,
    /// Names of the families that points belong to, in the order of their colours.
    pub families: Vec<String>,
    /// Joins the points that none beats on both axes (less is better, failures take no part); the others become faint.
    pub pareto: bool,
    /// Values of the axis upward to mark.
    pub guides: Vec<Guide>,
    /// Values of the axis across to mark.
    pub guides_x: Vec<Guide>,
    /// Shades what lies below this value of the axis upward: good enough.
    pub good_below: Option<f64>,
}

/// A point with its name.
#[derive(Clone, Debug)]
pub struct Point {
    /// Across.
    pub x: f64,
    /// Upward.
    pub y: f64,
    /// Its name; an empty one is not written.
    pub label: String,
    /// The family it belongs to, which gives its colour.
    pub family: usize,
    /// Drawn as a red cross.
    pub failed: bool,
    /// Drawn as one of the best and ringed: what a reader should take.
    pub chosen: bool,
}

/// Half the size of a point, pixels.
const RADIUS: f64 = 5.0;
/// The height of a label, pixels.
const HEIGHT: f64 = 14.0;
/// Letters of the chosen point's name.
const CHOSEN: f64 = HEADING;

pub(super) fn draw(panel: &Scatter, area: Area, shapes: &mut Vec<Shape>) {
    let entries: Vec<_> = panel.families.iter().enumerate().map(|(i, name)| (name.as_str(), color(i))).collect();
    let area = axis::legend(&entries, area, shapes);
    let x = panel.x.fitted(panel.points.iter().map(|p| p.x).chain(panel.guides_x.iter().map(|g| g.at)));
    let y = panel.y.fitted(panel.points.iter().map(|p| p.y).chain(panel.guides.iter().map(|g| g.at)));
    let under = shapes.len();
    let plane = axis::frame(area, &Titles { title: &panel.title, x: &panel.x.label, y: &panel.y.label }, [x, y], true, shapes);
    if let Some(limit) = panel.good_below {
        let Area { x: [left, right], y: [_, bottom] } = plane.inner;
        // Under the grid.
        shapes.insert(under, Shape::Rect { from: [left, plane.clamped(plane.x.low(), limit)[1]], to: [right, bottom], color: GOOD });
    }
    let places: Vec<_> = panel.points.iter().filter(|p| p.y.is_finite()).map(|p| plane.clamped(p.x, p.y)).collect();
    let mut taken = Vec::new();
    axis::guides(&plane, &panel.guides, true, &places, &mut taken, shapes);
    axis::guides(&plane, &panel.guides_x, false, &places, &mut taken, shapes);
    let guides = taken.len();

    let pairs: Vec<[f64; 2]> = panel.points.iter().map(|p| if p.failed { [f64::NAN; 2] } else { [p.x, p.y] }).collect();
    let best = if panel.pareto { pareto(&pairs) } else { (0..pairs.len()).collect() };
    if panel.pareto && best.len() > 1 {
        // Down and right: what lies between two of the best is beaten by the left one.
        let mut line: Vec<[f64; 2]> = Vec::new();
        for &i in &best {
            let at = plane.clamped(pairs[i][0], pairs[i][1]);
            line.extend(line.last().map(|last| [at[0], last[1]]));
            line.push(at);
        }
        taken.extend(line.windows(2).map(|pair| {
            let [a, b] = [pair[0], pair[1]];
            [a[0].min(b[0]) - 2.0, a[1].min(b[1]) - 2.0, a[0].max(b[0]) + 2.0, a[1].max(b[1]) + 2.0]
        }));
        shapes.push(Shape::Path { points: line, color: INK, width: 2.0, dash: 0.0 });
    }
    let mut marks: Vec<([f64; 2], usize)> = Vec::new();
    for (i, point) in panel.points.iter().enumerate() {
        let at = plane.clamped(point.x, if point.y.is_finite() { point.y } else { f64::MAX });
        marks.push((at, i));
        mark(point, at, best.contains(&i), shapes);
    }
    labels(panel, &plane, &marks, &best, (taken, guides), shapes);
}

fn mark(point: &Point, at: [f64; 2], best: bool, shapes: &mut Vec<Shape>) {
    if point.failed {
        cross(at, RADIUS, shapes);
        return;
    }
    let ink = color(point.family);
    shapes.push(Shape::Disc { at, radius: RADIUS, color: if best || point.chosen { ink } else { fade(ink, 0.45) }, filled: true });
    if point.chosen {
        shapes.push(Shape::Disc { at, radius: 2.0 * RADIUS, color: INK, filled: false });
    }
}

/// Writes the names where they cover neither points nor each other, the best first, as near their points as there is room; a thin
/// line leads to those that had to move away. What finds no room is not named. The first `guides` of what is `taken` are words.
fn labels(
    panel: &Scatter,
    plane: &Plane,
    marks: &[([f64; 2], usize)],
    best: &[usize],
    (mut taken, guides): (Vec<Bounds>, usize),
    shapes: &mut Vec<Shape>,
) {
    let mut written = taken[..guides].to_vec();
    let words = |place: &Bounds, written: &[Bounds]| written.iter().map(|b| overlap(*place, *b)).sum::<f64>();
    taken.extend(marks.iter().map(|(at, _)| [at[0] - 5.0, at[1] - 5.0, at[0] + 5.0, at[1] + 5.0]));
    let mut order: Vec<&([f64; 2], usize)> = marks.iter().filter(|(_, i)| !panel.points[*i].label.is_empty()).collect();
    order.sort_by_key(|(_, i)| (!panel.points[*i].chosen, !best.contains(i)));
    for (at, i) in order {
        let point = &panel.points[*i];
        let (size, around) = if point.chosen { (CHOSEN, 6.0) } else { (SMALL, 0.0) };
        let (wide, height) = (width(&point.label, size), HEIGHT * size / SMALL);
        let frame = plane.inner;
        let inside = |b: &Bounds| b[0] >= frame.x[0] && b[2] <= frame.x[1] && b[1] >= frame.y[0] && b[3] <= frame.y[1];
        let mut found: Option<(f64, Bounds, f64)> = None;
        for step in 0..12 {
            let reach = 9.0 + around + 11.0 * f64::from(step);
            for turn in 0..16 {
                // Right, left, then the rest of the circle.
                let angle = [0.0, 8.0, 4.0, 12.0, 2.0, 14.0, 6.0, 10.0, 1.0, 15.0, 7.0, 9.0, 3.0, 13.0, 5.0, 11.0][turn]
                    * std::f64::consts::PI
                    / 8.0;
                let (cos, sin) = (angle.cos(), angle.sin());
                let near = [at[0] + reach * cos, at[1] - reach * sin];
                let left = near[0] - wide * 0.5 * (1.0 - cos);
                let top = near[1] - 0.5 * height * (1.0 + sin);
                let place = [left, top, left + wide, top + height];
                if !inside(&place) {
                    continue;
                }
                // Words on words cannot be read; words on a line can.
                let covered: f64 = taken.iter().map(|b| overlap(place, *b)).sum::<f64>() + 100.0 * words(&place, &written);
                if found.is_none_or(|(least, ..)| covered < least - 1e-9) {
                    found = Some((covered, place, reach));
                }
            }
            if found.is_some_and(|(covered, ..)| covered == 0.0) {
                break;
            }
        }
        let Some((_, place, reach)) = found else { continue };
        if words(&place, &written) > 0.0 {
            continue;
        }
        written.push(place);
        if reach > 15.0 + around {
            let end = [at[0].clamp(place[0], place[2]), at[1].clamp(place[1], place[3])];
            shapes.push(Shape::line(*at, end, fade(GREY, 0.3), 1.0));
        }
        let ink = if point.failed {
            FAILED
        } else if best.contains(i) || point.chosen {
            INK
        } else {
            GREY
        };
        shapes.push(Shape::text([place[0], 0.5 * (place[1] + place[3])], point.label.clone(), size, ink, Anchor::Start));
        taken.push(place);
    }
}
