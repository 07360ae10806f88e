//! A map of a lost flight: the ways of ship and target round the hole, and the moment that the lesson speaks of.

use bevy_egui::egui::{Align2, Color32, Sense, Ui, vec2};
use glam::{DVec2, DVec3, dvec2};

use super::manual::sketch::{Plot, SHEET, Sketch, arc};
use crate::play::coach::review::Mark;
use crate::play::hud::paint::{ALARM, FAINT, OWN, TRUE};
use crate::play::hud::palette::Palette;
use crate::play::words::Language;
use crate::scene::disk::radial::LAST_ORBIT;

/// Height of the map, in points.
const HEIGHT: f32 = 170.0;
/// Free room about the ways, of the half height.
const ROOM: f64 = 0.94;

/// Paints the map.
pub(super) fn show(ui: &mut Ui, language: Language, ways: &[Mark], moment: Mark) {
    let (frame, _) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    let (palette, painter) = (Palette::in_use(ui.ctx()), ui.painter_at(frame));
    let [own_colour, target_colour, faint, alarm] = [OWN, TRUE, FAINT, ALARM].map(|colour| palette.shown(colour));
    let words = |key: &str| language.say(key);
    let sketch = Sketch::new(&painter, frame, &words);
    let plane = Plane::of(ways);
    let own: Vec<DVec2> = ways.iter().map(|mark| plane.place(mark.own)).collect();
    let target: Vec<DVec2> = ways.iter().filter_map(|mark| mark.target).map(|place| plane.place(place)).collect();
    let widest = own.iter().chain(&target).map(|place| place.abs().max_element()).fold(LAST_ORBIT, f64::max);
    let plot = Plot { sketch: &sketch, hole: 0.5 * SHEET, unit: ROOM * 0.5 * SHEET.y / widest, low: DVec2::ZERO, high: SHEET };
    plot.line(&arc(LAST_ORBIT, 0.0, std::f64::consts::TAU), 0.8, faint);
    plot.black();
    for (way, colour) in [(&target, target_colour), (&own, own_colour)] {
        plot.line(way, 1.6, colour);
        if let Some(&start) = way.first() {
            sketch.disc(plot.at(start), 3.0, colour, colour);
        }
    }
    let here = plane.place(moment.own);
    if let Some(there) = moment.target {
        plot.dashes(&[here, plane.place(there)], 1.4, alarm);
    }
    sketch.disc(plot.at(here), 6.0, Color32::TRANSPARENT, alarm);
    for (row, (key, colour)) in [("map-own", own_colour), ("map-target", target_colour), ("map-circle", faint)].into_iter().enumerate() {
        sketch.label(dvec2(4.0, 10.0 + 17.0 * row as f64), Align2::LEFT_CENTER, key, colour);
    }
    sketch.write(SHEET - dvec2(4.0, 10.0), Align2::RIGHT_CENTER, &format!("T = {:.1}", moment.time), alarm);
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
}
