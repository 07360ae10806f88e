//! Card 4: light of one ship that comes to the camera on both sides of the hole, and what is seen.

use std::f64::consts::PI;

use bevy_egui::egui::{Align2, Color32};
use glam::{DVec2, dvec2};

use super::rays::{Sight, sight};
use super::sketch::{Plot, Sketch};
use crate::play::hud::paint::{FAINT, OWN, SEEN, TEXT, TRUE};
use crate::spacetime::light::{Branch, Order, join, static_angle};
use crate::spacetime::metric::CRITICAL_IMPACT;

/// The camera, in r_s.
const CAMERA: DVec2 = dvec2(9.0, 0.0);
/// The ship, in r_s.
const SHIP: DVec2 = dvec2(-8.0, 1.6);
/// Points to the radian in the view.
const VIEW: f64 = 98.0;

/// Paints the card.
pub fn draw(sketch: &Sketch) {
    let plot = Plot { sketch, hole: dvec2(134.0, 104.0), unit: 13.5, low: DVec2::ZERO, high: dvec2(284.0, 200.0) };
    let both = [1, 2].map(|n| Order::new(n).and_then(|order| sight(CAMERA, SHIP, order)));
    let colours = [SEEN, OWN];
    for (seen, colour) in both.iter().zip(colours) {
        let Some(Sight { line, look, .. }) = seen else { continue };
        plot.line(line, 1.3, colour);
        plot.head(&line.iter().rev().copied().collect::<Vec<_>>(), 0.5, colour);
        plot.dashes(&[CAMERA, CAMERA + look * (CAMERA.x / -look.x)], 1.0, colour.gamma_multiply(0.8));
    }
    plot.black();
    sketch.ship(plot.at(SHIP), dvec2(0.4, -1.0), TRUE);
    sketch.label(plot.at(SHIP) + dvec2(-12.0, -9.0), Align2::LEFT_BOTTOM, "ship", TRUE);
    sketch.eye(plot.at(CAMERA));
    sketch.label(plot.at(CAMERA) + dvec2(10.0, 9.0), Align2::RIGHT_TOP, "you", OWN);

    let centre = dvec2(352.0, 108.0);
    sketch.label(dvec2(352.0, 14.0), Align2::CENTER_CENTER, "view", TEXT);
    let u = 1.0 / CAMERA.x;
    let shadow = (CRITICAL_IMPACT * u * (1.0 - u).sqrt()).asin();
    sketch.disc(centre, VIEW * shadow, Color32::BLACK, FAINT.gamma_multiply(0.6));
    // The ring of a ship exactly behind.
    let ring = join(1.0 / SHIP.length(), PI, u, Branch::Plus).and_then(|ray| static_angle(ray.slope, ray.energy, u));
    if let Some(psi) = ring {
        let radius = VIEW * (PI - psi);
        let circle: Vec<DVec2> = (0..=96).map(|step| centre + radius * DVec2::from_angle(PI * f64::from(step) / 48.0)).collect();
        sketch.dashes(&circle, 1.0, TEXT.gamma_multiply(0.7));
        sketch.label(centre + dvec2(0.0, 78.0), Align2::CENTER_CENTER, "ring", TEXT);
    }
    let sides = [(-1.0, "first", Align2::CENTER_BOTTOM), (1.0, "second", Align2::CENTER_TOP)];
    for ((seen, colour), (side, key, anchor)) in both.iter().zip(colours).zip(sides) {
        let Some(seen) = seen else { continue };
        let place = centre + dvec2(0.0, side * VIEW * seen.off);
        sketch.ship(place, dvec2(0.4, side), colour);
        sketch.label(place + dvec2(0.0, 9.0 * side), anchor, key, colour);
    }
}
