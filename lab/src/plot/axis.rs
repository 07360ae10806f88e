//! Axes: ranges, ticks, and the frame of a panel with its grid.

use super::Guide;
use super::paint::{Anchor, Shape, width};
use super::style::{FAINT, GREY, HEADING, INK, SMALL, TEXT};

/// A rectangle on the page.
#[derive(Clone, Copy, Debug)]
pub struct Area {
    /// Left and right.
    pub x: [f64; 2],
    /// Top and bottom.
    pub y: [f64; 2],
}

/// An axis: what it says, how far it goes, whether it is logarithmic.
#[derive(Clone, Debug, Default)]
pub struct Axis {
    /// The quantity with its unit.
    pub label: String,
    /// Its ends; None takes what the values need.
    pub range: Option<[f64; 2]>,
    /// Logarithmic: values ≤ 0 are put at the lower end.
    pub log: bool,
}

impl Axis {
    /// A linear axis as long as its values need.
    pub fn linear(label: impl Into<String>) -> Axis {
        Axis { label: label.into(), range: None, log: false }
    }

    /// A logarithmic axis as long as its values need.
    pub fn log(label: impl Into<String>) -> Axis {
        Axis { label: label.into(), range: None, log: true }
    }

    /// The same axis from `low` to `high`.
    pub fn between(self, low: f64, high: f64) -> Axis {
        Axis { range: Some([low, high]), ..self }
    }

    /// The axis with its ends settled over `values` (those that are finite, on a logarithmic axis positive).
    pub(super) fn fitted(&self, values: impl Iterator<Item = f64>) -> Scale {
        let usable = |v: &f64| v.is_finite() && (!self.log || *v > 0.0);
        let [mut low, mut high] = self.range.unwrap_or_else(|| {
            let ends = values.filter(usable).fold([f64::INFINITY, f64::NEG_INFINITY], |e, v| [e[0].min(v), e[1].max(v)]);
            match (ends[0] <= ends[1], self.log) {
                (false, _) => [1.0, 10.0],
                (true, true) => [ends[0] / 2.0, ends[1] * 2.0],
                (true, false) => [ends[0].min(0.0), ends[1] + 0.06 * (ends[1] - ends[0].min(0.0))],
            }
        });
        if self.log {
            low = low.max(1e-300);
            high = high.max(low * 1.01);
        } else if high.is_nan() || high <= low {
            high = low + 1.0;
        }
        Scale { log: self.log, low, high }
    }
}

/// An axis with its ends settled.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    log: bool,
    low: f64,
    high: f64,
}

impl Scale {
    /// The lower end.
    pub fn low(&self) -> f64 {
        self.low
    }

    /// Where a value lies, 0 at the lower end and 1 at the upper; outside where it is outside; 0 for what has no logarithm.
    pub fn share(&self, value: f64) -> f64 {
        match (self.log, value > 0.0) {
            (true, true) => (value / self.low).ln() / (self.high / self.low).ln(),
            (true, false) => 0.0,
            (false, _) => (value - self.low) / (self.high - self.low),
        }
    }

    /// Whether the value lies on the axis.
    pub fn holds(&self, value: f64) -> bool {
        (-1e-9..=1.0 + 1e-9).contains(&self.share(value)) && (!self.log || value > 0.0)
    }

    /// The values that get a tick, at most about `most`.
    pub fn ticks(&self, most: usize) -> Vec<f64> {
        let most = most.max(2) as f64;
        if self.log {
            let decades = (self.high / self.low).log10();
            let steps: &[f64] = if decades < 0.35 * most { &[1.0, 2.0, 5.0] } else { &[1.0] };
            let jump = (decades / most).ceil().max(1.0) as i32;
            let first = self.low.log10().floor() as i32;
            let last = self.high.log10().ceil() as i32;
            return (first..=last)
                .filter(|decade| decade.rem_euclid(jump) == 0)
                .flat_map(|decade| steps.iter().map(move |step| step * 10f64.powi(decade)))
                .filter(|v| self.holds(*v))
                .collect();
        }
        let rough = (self.high - self.low) / most;
        let power = 10f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|s| s * power).find(|s| *s >= rough * 0.999).unwrap_or(10.0 * power);
        let first = (self.low / step).ceil() as i64;
        let last = (self.high / step + 1e-9).floor() as i64;
        (first..=last).map(|i| i as f64 * step).collect()
    }
}

/// A number as short as it can be: 0.001, 20, 1e-6.
pub fn tick_text(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let exponent = value.abs().log10().floor();
    if (-3.0..=5.0).contains(&exponent) {
        let text = format!("{value:.6}");
        text.trim_end_matches('0').trim_end_matches('.').into()
    } else {
        let text = format!("{value:.2e}");
        let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
        let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.');
        format!("{mantissa}e{power}")
    }
}

/// A panel's plane: the frame with both axes.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    /// The rectangle inside the frame.
    pub inner: Area,
    /// The axis across.
    pub x: Scale,
    /// The axis upward.
    pub y: Scale,
}

impl Plane {
    /// Where a pair of values lies on the page.
    pub fn place(&self, x: f64, y: f64) -> [f64; 2] {
        let Area { x: [left, right], y: [top, bottom] } = self.inner;
        [left + (right - left) * self.x.share(x), bottom - (bottom - top) * self.y.share(y)]
    }

    /// The same, moved onto the frame where it lies outside.
    pub fn clamped(&self, x: f64, y: f64) -> [f64; 2] {
        let [px, py] = self.place(x, y);
        [px.clamp(self.inner.x[0], self.inner.x[1]), py.clamp(self.inner.y[0], self.inner.y[1])]
    }
}

/// The titles of a panel with two axes.
pub struct Titles<'a> {
    /// Above the frame.
    pub title: &'a str,
    /// Under it.
    pub x: &'a str,
    /// Left of it, upward.
    pub y: &'a str,
}

/// Draws frame, grid, ticks and titles into `area`; returns the plane within. `ticks_x` false leaves the ticks below to the caller.
pub fn frame(area: Area, titles: &Titles, [x, y]: [Scale; 2], ticks_x: bool, shapes: &mut Vec<Shape>) -> Plane {
    let ticks_y = y.ticks(((area.y[1] - area.y[0]) / 45.0) as usize);
    let room = ticks_y.iter().map(|v| width(&tick_text(*v), SMALL)).fold(20.0, f64::max);
    let left = area.x[0] + room + if titles.y.is_empty() { 12.0 } else { 34.0 };
    let top = area.y[0] + if titles.title.is_empty() { 8.0 } else { 28.0 };
    let inner = Area { x: [left, area.x[1] - 14.0], y: [top, area.y[1] - if titles.x.is_empty() { 24.0 } else { 44.0 }] };
    let plane = Plane { inner, x, y };
    let middle_x = 0.5 * (inner.x[0] + inner.x[1]);
    for value in ticks_y {
        let [_, at] = plane.place(x.low(), value);
        shapes.push(Shape::line([inner.x[0], at], [inner.x[1], at], FAINT, 1.0));
        shapes.push(Shape::text([inner.x[0] - 6.0, at], tick_text(value), SMALL, INK, Anchor::End));
    }
    if ticks_x {
        let mut free = f64::NEG_INFINITY;
        for value in x.ticks(((inner.x[1] - inner.x[0]) / 70.0) as usize) {
            let [at, _] = plane.place(value, y.low());
            shapes.push(Shape::line([at, inner.y[0]], [at, inner.y[1]], FAINT, 1.0));
            let half = 0.5 * width(&tick_text(value), SMALL);
            if at - half > free {
                shapes.push(Shape::text([at, inner.y[1] + 12.0], tick_text(value), SMALL, INK, Anchor::Middle));
                free = at + half + 6.0;
            }
        }
    }
    let Area { x: [x0, x1], y: [y0, y1] } = inner;
    let corners = vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]];
    shapes.push(Shape::Path { points: corners, color: GREY, width: 1.0, dash: 0.0 });
    shapes.push(Shape::text([middle_x, area.y[0] + 12.0], titles.title, HEADING, INK, Anchor::Middle));
    shapes.push(Shape::text([middle_x, inner.y[1] + 31.0], titles.x, TEXT, INK, Anchor::Middle));
    shapes.push(Shape::Text {
        at: [area.x[0] + 10.0, 0.5 * (inner.y[0] + inner.y[1])],
        text: titles.y.into(),
        size: TEXT,
        color: INK,
        anchor: Anchor::Middle,
        upward: true,
    });
    plane
}

/// A rectangle that is taken: left, top, right, bottom.
pub type Bounds = [f64; 4];

/// How much of `b` lies on `a`, in square pixels.
pub fn overlap(a: Bounds, b: Bounds) -> f64 {
    let across = (a[2].min(b[2]) - a[0].max(b[0])).max(0.0);
    let down = (a[3].min(b[3]) - a[1].max(b[1])).max(0.0);
    across * down
}

/// Dashed lines across the plane at values of the axis upward (`upward` false: of the axis across). Their words go to the end of the line
/// where they cover least of what is `taken` and of the points to `avoid`; where they are is added to `taken`.
pub fn guides(plane: &Plane, guides: &[Guide], upward: bool, avoid: &[[f64; 2]], taken: &mut Vec<Bounds>, shapes: &mut Vec<Shape>) {
    let Area { x: [left, right], y: [top, bottom] } = plane.inner;
    for guide in guides {
        let scale = if upward { plane.y } else { plane.x };
        if !scale.holds(guide.at) {
            continue;
        }
        let [px, py] = plane.place(guide.at, guide.at);
        let (from, to) = if upward { ([left, py], [right, py]) } else { ([px, top], [px, bottom]) };
        shapes.push(Shape::Path { points: vec![from, to], color: GREY, width: 1.0, dash: 6.0 });
        if guide.label.is_empty() {
            continue;
        }
        let wide = width(&guide.label, SMALL);
        let at = |x: f64, y: f64| [x, y - 7.0, x + wide, y + 7.0];
        let places: Vec<Bounds> = if upward {
            [py - 8.0, py + 9.0].into_iter().flat_map(|y| [right - 6.0 - wide, left + 6.0].map(|x| at(x, y))).collect()
        } else {
            (0..4).map(|row| top + 10.0 + 15.0 * f64::from(row)).flat_map(|y| [px - 4.0 - wide, px + 4.0].map(|x| at(x, y))).collect()
        };
        let inside = |b: &&Bounds| b[0] >= left && b[2] <= right && b[1] >= top && b[3] <= bottom;
        let cost = |b: &Bounds| {
            let points = avoid.iter().filter(|p| p[0] > b[0] && p[0] < b[2] && p[1] > b[1] && p[1] < b[3]).count();
            taken.iter().map(|other| overlap(*b, *other)).sum::<f64>() * 10.0 + points as f64
        };
        let Some(place) = places.iter().filter(inside).min_by(|a, b| cost(a).total_cmp(&cost(b))).copied() else { continue };
        taken.push(place);
        shapes.push(Shape::text([place[0], 0.5 * (place[1] + place[3])], guide.label.clone(), SMALL, GREY, Anchor::Start));
    }
}

/// Writes names with their colours at the lower end of `area`, in rows; returns what is left above them.
pub fn legend(entries: &[(&str, super::Color)], area: Area, shapes: &mut Vec<Shape>) -> Area {
    let [left, right] = [area.x[0] + 40.0, area.x[1] - 20.0];
    let (mut x, mut row, mut placed) = (left, 0.0, Vec::new());
    for (name, color) in entries.iter().filter(|(name, _)| !name.is_empty()) {
        let whole = 30.0 + width(name, SMALL);
        if x > left && x + whole > right {
            x = left;
            row += 18.0;
        }
        placed.push(([x, row], *name, *color));
        x += whole;
    }
    if placed.is_empty() {
        return area;
    }
    let bottom = area.y[1] - row - 18.0;
    for ([x, row], name, color) in placed {
        let y = bottom + 8.0 + row;
        shapes.push(Shape::Disc { at: [x + 6.0, y], radius: 5.0, color, filled: true });
        shapes.push(Shape::text([x + 15.0, y], name, SMALL, INK, Anchor::Start));
    }
    Area { y: [area.y[0], bottom], ..area }
}
