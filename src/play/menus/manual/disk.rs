//! Card 2: the disk from its edge, rays from its far side over and under the hole, and what the camera sees.

use std::f64::consts::PI;

use bevy_egui::egui::{Align2, Color32};
use glam::{DVec2, DVec3, dvec2, dvec3};

use super::rays::sight;
use super::sketch::{Plot, Sketch};
use crate::play::hud::paint::{FAINT, OWN, SEEN, TEXT, TRUE};
use crate::scene::disk::radial::LAST_ORBIT;
use crate::spacetime::light::{Branch, Order, join, static_angle};
use crate::spacetime::metric::CRITICAL_IMPACT;

/// The disk's outer edge, in r_s.
const OUTER: f64 = 6.0;
/// The camera, in r_s: x in the disk's plane, y above it.
const CAMERA: DVec2 = dvec2(11.0, 1.2);
/// The ring of gas whose rays are shown, in r_s.
const SHOWN: f64 = 4.5;

/// Paints the card.
pub fn draw(sketch: &Sketch) {
    side(sketch);
    view(sketch);
}

/// The disk from its edge.
fn side(sketch: &Sketch) {
    let plot = Plot { sketch, hole: dvec2(100.0, 104.0), unit: 14.5, low: DVec2::ZERO, high: dvec2(278.0, 200.0) };
    for side in [1.0, -1.0] {
        plot.line(&[dvec2(side * LAST_ORBIT, 0.0), dvec2(side * OUTER, 0.0)], 4.0, TRUE);
    }
    for (order, colour, key, anchor) in [(1, SEEN, "top", Align2::CENTER_BOTTOM), (2, OWN, "underside", Align2::CENTER_TOP)] {
        let Some(seen) = Order::new(order).and_then(|order| sight(CAMERA, dvec2(-SHOWN, 0.0), order)) else { continue };
        plot.line(&seen.line, 1.3, colour);
        plot.head(&seen.line.iter().rev().copied().collect::<Vec<_>>(), 0.5, colour);
        // Where it seems to come from.
        let behind = CAMERA + seen.look * (CAMERA.x / -seen.look.x);
        plot.dashes(&[CAMERA, behind], 1.0, colour.gamma_multiply(0.8));
        let label = plot.at(behind);
        sketch.disc(label, 2.2, colour, colour);
        let away = if order == 1 { -6.0 } else { 6.0 };
        sketch.label(label + dvec2(0.0, away), anchor, key, colour);
    }
    if let Some(seen) = Order::new(1).and_then(|order| sight(CAMERA, dvec2(SHOWN, 0.0), order)) {
        plot.line(&seen.line, 1.0, TRUE);
    }
    plot.black();
    sketch.eye(plot.at(CAMERA));
    sketch.label(plot.at(CAMERA) + dvec2(0.0, -8.0), Align2::CENTER_BOTTOM, "you", OWN);
    sketch.label(dvec2(3.0, plot.hole.y + 6.0), Align2::LEFT_TOP, "far", TRUE);
    sketch.label(plot.at(dvec2(3.7, 0.0)) + dvec2(0.0, -5.0), Align2::CENTER_BOTTOM, "near", TRUE);
}

/// Points to the radian in the view.
const VIEW: f64 = 104.0;

/// What the camera sees.
fn view(sketch: &Sketch) {
    let centre = dvec2(352.0, 106.0);
    sketch.label(dvec2(352.0, 14.0), Align2::CENTER_CENTER, "view", TEXT);
    let u = 1.0 / CAMERA.length();
    sketch.disc(centre, VIEW * (CRITICAL_IMPACT * u * (1.0 - u).sqrt()).asin(), Color32::BLACK, FAINT.gamma_multiply(0.5));
    for radius in [LAST_ORBIT, 0.5 * (LAST_ORBIT + OUTER), OUTER] {
        for (order, colour) in [(2, OWN), (1, TRUE)] {
            let Some(order) = Order::new(order) else { continue };
            // Denser behind the hole and before it, where the image turns fastest.
            let azimuths = (-60..=60).map(|step| PI * f64::from(step) / 60.0).map(|turn| PI + turn - 0.45 * (2.0 * turn).sin());
            let ring: Vec<DVec2> =
                azimuths.filter_map(|azimuth| seen_at(radius, azimuth, order)).map(|place| centre + VIEW * place).collect();
            sketch.line(&ring, 1.2, colour);
        }
    }
}

/// Where the camera sees the gas at `radius` and `azimuth`: radians to the right of the hole's centre and below it.
fn seen_at(radius: f64, azimuth: f64, order: Order) -> Option<DVec2> {
    let camera = dvec3(CAMERA.x, 0.0, CAMERA.y);
    let gas = radius * dvec3(azimuth.cos(), azimuth.sin(), 0.0);
    let ray = join(1.0 / radius, order.swept(camera.angle_between(gas)), 1.0 / camera.length(), Branch::Plus)?;
    let off = PI - static_angle(ray.slope, ray.energy, 1.0 / camera.length())?;
    let outward = camera.normalize();
    let up = (DVec3::Z - outward * outward.z).normalize();
    let across = gas - outward * outward.dot(gas);
    let place = dvec2(across.dot(up.cross(outward)), -across.dot(up)).normalize_or_zero();
    Some(off * if order.flips() { -place } else { place })
}
