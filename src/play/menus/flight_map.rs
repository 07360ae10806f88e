//! A map of a lost flight: the ways of ship and target round the hole, and the moment that the lesson speaks of.

use bevy_egui::egui::{Color32, RichText, Sense, Ui, vec2};
use glam::{DVec2, DVec3, dvec2};

use super::manual::sketch::{Plot, SHEET, Sketch, arc};
use crate::play::coach::review::Mark;
use crate::play::hud::paint::{ALARM, FAINT, OWN, TRUE};
use crate::play::hud::palette::Palette;
use crate::play::words::Language;
use crate::scene::disk::radial::LAST_ORBIT;

/// Height of the map, in points.
const HEIGHT: f32 = 170.0;
/// Free room about the ways, in points of the sheet.
const ROOM: f64 = 8.0;

/// Paints the map.
pub(super) fn show(ui: &mut Ui, language: Language, ways: &[Mark], moment: Mark) {
    let palette = Palette::in_use(ui.ctx());
    let [own_colour, target_colour, faint, alarm] = [OWN, TRUE, FAINT, ALARM].map(|colour| palette.shown(colour));
    let time = format!("T = {:.1}", moment.time);
    ui.horizontal(|ui| {
        let names = [("map-own", own_colour), ("map-target", target_colour), ("map-circle", faint)];
        for (words, colour) in names.map(|(key, colour)| (language.say(key), colour)).into_iter().chain([(time, alarm)]) {
            ui.label(RichText::new(words).size(12.0).color(colour));
        }
    });
    let (frame, _) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    let painter = ui.painter_at(frame);
    let words = |key: &str| language.say(key);
    let sketch = Sketch::new(&painter, frame, &words);
    let plane = Plane::of(ways);
    let own: Vec<DVec2> = ways.iter().map(|mark| plane.place(mark.own)).collect();
    let target: Vec<DVec2> = ways.iter().filter_map(|mark| mark.target).map(|place| plane.place(place)).collect();
    let (unit, hole) = fitted(own.iter().chain(&target));
    let plot = Plot { sketch: &sketch, hole, unit, low: DVec2::ZERO, high: SHEET };
    plot.line(&arc(LAST_ORBIT, 0.0, std::f64::consts::TAU), 0.8, faint);
    plot.black();
    for (way, colour) in [(&target, target_colour), (&own, own_colour)] {
        plot.line(way, 1.8, colour);
        if let Some(&start) = way.first() {
            sketch.disc(plot.at(start), 4.0, colour, colour);
        }
    }
    let here = plane.place(moment.own);
    if let Some(there) = moment.target {
        plot.dashes(&[here, plane.place(there)], 1.4, alarm);
    }
    sketch.disc(plot.at(here), 7.0, Color32::TRANSPARENT, alarm);
}

/// Points to the r_s, and where the hole is on the sheet, so that all of these places and the innermost stable orbit are on it.
fn fitted<'a>(places: impl Iterator<Item = &'a DVec2>) -> (f64, DVec2) {
    let edge = DVec2::splat(LAST_ORBIT);
    let (low, high) = places.fold((-edge, edge), |(low, high), place| (low.min(*place), high.max(*place)));
    let unit = ((SHEET - 2.0 * ROOM) / (high - low)).min_element();
    let middle = 0.5 * (low + high);
    (unit, 0.5 * SHEET - unit * dvec2(middle.x, -middle.y))
}

/// The plane that a flight's way lies in, as nearly as one plane does.
struct Plane {
    right: DVec3,
    up: DVec3,
}

impl Plane {
    /// Across the mean of what the way sweeps; seen so that it turns counter-clockwise.
    fn of(ways: &[Mark]) -> Plane {
        let swept: DVec3 = ways.windows(2).map(|pair| pair[0].own.cross(pair[1].own)).sum();
        let axis = swept.try_normalize().unwrap_or(DVec3::Y);
        let start = ways.first().map_or(DVec3::X, |mark| mark.own);
        let right = start.reject_from(axis).try_normalize().unwrap_or_else(|| axis.any_orthonormal_vector());
        Plane { right, up: axis.cross(right) }
    }

    fn place(&self, x: DVec3) -> DVec2 {
        dvec2(x.dot(self.right), x.dot(self.up))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_is_a_circle_whichever_way_it_lies() {
        let turned = glam::DQuat::from_rotation_x(1.1) * glam::DQuat::from_rotation_z(0.4);
        let ways: Vec<Mark> = (0..=40)
            .map(|k| f64::from(k) * 0.1)
            .map(|time| Mark { time, own: turned * (5.0 * DVec3::new(time.cos(), time.sin(), 0.0)), target: None })
            .collect();
        let plane = Plane::of(&ways);
        for mark in &ways {
            let place = plane.place(mark.own);
            assert!((place - 5.0 * DVec2::from_angle(mark.time)).length() < 1e-9, "{place}");
        }
    }

    #[test]
    fn a_fall_straight_down_has_a_plane_too() {
        let fall = [9.0, 5.0, 2.0].map(|r| Mark { time: 0.0, own: DVec3::Z * r, target: None });
        let plane = Plane::of(&fall);
        assert!((plane.place(fall[1].own).length() - 5.0).abs() < 1e-12);
        assert!(Plane::of(&[]).right.is_finite());
    }

    #[test]
    fn all_of_the_ways_are_on_the_sheet() {
        let places = [dvec2(9.0, 1.0), dvec2(-2.0, 14.0), dvec2(6.0, -1.0)];
        let (unit, hole) = fitted(places.iter());
        for place in places.into_iter().chain([dvec2(0.0, -3.0)]) {
            let at = hole + unit * dvec2(place.x, -place.y);
            assert!(at.cmpge(DVec2::splat(ROOM - 1e-9)).all() && at.cmple(SHEET - ROOM + 1e-9).all(), "{at}");
        }
    }
}
