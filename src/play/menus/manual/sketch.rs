//! What the drawings are made of: lines, arrows, discs and labels on a sheet of 420 × 200 points, and plots of the plane around the hole on
//! it.

use bevy_egui::egui::{Align2, Color32, Painter, Pos2, Rect, Shape, Stroke, vec2};
use glam::{DVec2, dvec2};

use crate::play::hud::paint::{FAINT, OWN, text};

/// Width and height of the sheet, in points before it is scaled.
pub const SHEET: DVec2 = dvec2(420.0, 200.0);
/// Size of the labels, in points before they are scaled.
const LETTERS: f32 = 11.5;
/// Length of an arrow's head, in points before it is scaled.
const HEAD: f64 = 6.0;

/// The sheet that a card is drawn on. Places are in points, x to the right and y down from the upper left corner, before they are scaled.
pub struct Sketch<'a> {
    painter: &'a Painter,
    corner: Pos2,
    scale: f32,
    words: &'a dyn Fn(&str) -> String,
}

impl<'a> Sketch<'a> {
    /// The sheet in the middle of `rect`; `words` gives the label of a short key, such as `hole`.
    pub fn new(painter: &'a Painter, rect: Rect, words: &'a dyn Fn(&str) -> String) -> Sketch<'a> {
        let scale = (rect.width() / SHEET.x as f32).min(rect.height() / SHEET.y as f32).max(0.0);
        let corner = rect.center() - 0.5 * scale * vec2(SHEET.x as f32, SHEET.y as f32);
        Sketch { painter, corner, scale, words }
    }

    /// The place on the screen, in points.
    pub fn at(&self, place: DVec2) -> Pos2 {
        self.corner + self.scale * vec2(place.x as f32, place.y as f32)
    }

    /// A length on the screen, in points.
    pub fn long(&self, length: f64) -> f32 {
        self.scale * length as f32
    }

    /// A shape in places of the screen.
    pub fn add(&self, shape: Shape) {
        self.painter.add(shape);
    }

    fn stroke(&self, width: f64, colour: Color32) -> Stroke {
        Stroke::new(self.long(width), colour)
    }

    fn on_screen(&self, line: &[DVec2]) -> Vec<Pos2> {
        line.iter().map(|&place| self.at(place)).collect()
    }

    /// A line through all the places.
    pub fn line(&self, line: &[DVec2], width: f64, colour: Color32) {
        if line.len() > 1 {
            self.add(Shape::line(self.on_screen(line), self.stroke(width, colour)));
        }
    }

    /// A dashed line through all the places.
    pub fn dashes(&self, line: &[DVec2], width: f64, colour: Color32) {
        if line.len() > 1 {
            let dashes = Shape::dashed_line(&self.on_screen(line), self.stroke(width, colour), self.long(4.0), self.long(3.5));
            self.painter.extend(dashes);
        }
    }

    /// The head of an arrow whose tip is at `tip`, in the direction `along` (of any length).
    pub fn head(&self, tip: DVec2, along: DVec2, colour: Color32) {
        let along = along.normalize_or_zero();
        let back = tip - HEAD * along;
        self.wedge([tip, back + 0.45 * HEAD * along.perp(), back - 0.45 * HEAD * along.perp()], colour);
    }

    /// A straight arrow.
    pub fn arrow(&self, from: DVec2, to: DVec2, width: f64, colour: Color32) {
        self.line(&[from, to - 0.8 * HEAD * (to - from).normalize_or_zero()], width, colour);
        self.head(to, to - from, colour);
    }

    /// A filled circle with a rim; either colour may be transparent.
    pub fn disc(&self, centre: DVec2, radius: f64, fill: Color32, rim: Color32) {
        self.painter.circle(self.at(centre), self.long(radius), fill, self.stroke(1.2, rim));
    }

    /// A filled triangle.
    pub fn wedge(&self, corners: [DVec2; 3], colour: Color32) {
        self.add(Shape::convex_polygon(self.on_screen(&corners), colour, Stroke::NONE));
    }

    /// A small ship with its nose in the direction `nose` (of any length, y down).
    pub fn ship(&self, centre: DVec2, nose: DVec2, colour: Color32) {
        let along = nose.normalize_or_zero();
        let tail = centre - 5.0 * along;
        self.wedge([centre + 7.0 * along, tail + 4.0 * along.perp(), tail - 4.0 * along.perp()], colour);
    }

    /// The eye of whoever looks.
    pub fn eye(&self, centre: DVec2) {
        self.disc(centre, 4.0, OWN, OWN);
        self.disc(centre, 1.6, Color32::BLACK, Color32::BLACK);
    }

    /// The label of `key` on a dark ground, its `anchor` at `place`.
    pub fn label(&self, place: DVec2, anchor: Align2, key: &str, colour: Color32) {
        self.write(place, anchor, &(self.words)(key), colour);
    }

    /// Words that are the same in every language, such as numbers with their unit.
    pub fn write(&self, place: DVec2, anchor: Align2, words: &str, colour: Color32) {
        text(self.painter, self.at(place), anchor, words, self.long(1.0) * LETTERS, colour);
    }

    /// A label beside what it names, with a thin line from there: it begins (or ends, by `anchor`) at `place`.
    pub fn pointer(&self, named: DVec2, place: DVec2, anchor: Align2, key: &str, colour: Color32) {
        self.line(&[named, place], 0.8, FAINT.gamma_multiply(0.7));
        self.disc(named, 1.6, colour, colour);
        self.label(place, anchor, key, colour);
    }
}

/// A part of the sheet that shows the plane around the hole: x to the right, y up, the hole at the origin, lengths in r_s.
pub struct Plot<'a> {
    /// The sheet.
    pub sketch: &'a Sketch<'a>,
    /// Where the hole is on the sheet, in points.
    pub hole: DVec2,
    /// Points to the r_s.
    pub unit: f64,
    /// Upper left corner of the part, in points.
    pub low: DVec2,
    /// Its lower right corner, in points.
    pub high: DVec2,
}

impl Plot<'_> {
    /// The place on the sheet, in points, of a point of the plane, in r_s.
    pub fn at(&self, point: DVec2) -> DVec2 {
        self.hole + self.unit * dvec2(point.x, -point.y)
    }

    /// What of a line in the plane (r_s) lies on this part of the sheet, in points.
    pub fn cut(&self, line: &[DVec2]) -> Vec<Vec<DVec2>> {
        let mut pieces: Vec<Vec<DVec2>> = Vec::new();
        let mut goes_on = false;
        for pair in line.windows(2) {
            let (from, to) = (self.at(pair[0]), self.at(pair[1]));
            let Some((enter, leave)) = self.inside(from, to) else {
                goes_on = false;
                continue;
            };
            match pieces.last_mut() {
                Some(piece) if goes_on && enter == 0.0 => piece.push(from.lerp(to, leave)),
                _ => pieces.push(vec![from.lerp(to, enter), from.lerp(to, leave)]),
            }
            goes_on = leave == 1.0;
        }
        pieces
    }

    /// The share of the way from `from` to `to` at which this part of the sheet is entered and left (Liang & Barsky).
    fn inside(&self, from: DVec2, to: DVec2) -> Option<(f64, f64)> {
        let way = to - from;
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        let edges =
            [(-way.x, from.x - self.low.x), (way.x, self.high.x - from.x), (-way.y, from.y - self.low.y), (way.y, self.high.y - from.y)];
        for (rate, room) in edges {
            if rate == 0.0 && room < 0.0 {
                return None;
            }
            if rate < 0.0 {
                enter = enter.max(room / rate);
            } else if rate > 0.0 {
                leave = leave.min(room / rate);
            }
        }
        (enter < leave).then_some((enter, leave))
    }

    /// A line in the plane, in r_s.
    pub fn line(&self, line: &[DVec2], width: f64, colour: Color32) {
        for piece in self.cut(line) {
            self.sketch.line(&piece, width, colour);
        }
    }

    /// A dashed line in the plane, in r_s.
    pub fn dashes(&self, line: &[DVec2], width: f64, colour: Color32) {
        for piece in self.cut(line) {
            self.sketch.dashes(&piece, width, colour);
        }
    }

    /// The head of an arrow on a line in the plane, `share` of its length on the sheet from its beginning.
    pub fn head(&self, line: &[DVec2], share: f64, colour: Color32) {
        let Some(piece) = self.cut(line).into_iter().next() else { return };
        let whole: f64 = piece.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let mut left = share * whole;
        for pair in piece.windows(2) {
            let length = pair[0].distance(pair[1]);
            if left <= length {
                let tip = pair[0].lerp(pair[1], left / length.max(1e-9));
                self.sketch.head(tip + 0.5 * HEAD * (pair[1] - pair[0]).normalize_or_zero(), pair[1] - pair[0], colour);
                return;
            }
            left -= length;
        }
    }

    /// The hole: black up to its horizon.
    pub fn black(&self) {
        self.sketch.disc(self.hole, self.unit, Color32::BLACK, FAINT);
    }
}

/// A part of a circle about the origin, of `radius`, from one azimuth to another (radians, counter-clockwise if `to` is greater).
pub fn arc(radius: f64, from: f64, to: f64) -> Vec<DVec2> {
    let steps = ((to - from).abs() * 24.0).ceil().max(2.0) as usize;
    (0..=steps).map(|step| radius * DVec2::from_angle(from + (to - from) * step as f64 / steps as f64)).collect()
}
