//! Card 5: a ship on a circle, where it is seen and where it is now, and the light between.

use bevy_egui::egui::Align2;
use glam::{DVec2, dvec2};

use super::rays::{Sight, sight};
use super::sketch::{Plot, Sketch, arc};
use crate::play::hud::paint::{FAINT, OWN, SEEN, TRUE};
use crate::spacetime::light::Order;
use crate::spacetime::orbit::orbital_frequency;

/// The ship's circle, in r_s.
const RADIUS: f64 = 5.6;
/// The ship's azimuth now, in radians, counter-clockwise; so it flies.
const NOW: f64 = 2.5;
/// The camera, in r_s.
const CAMERA: DVec2 = dvec2(18.0, -2.6);

/// The light of the ship that is at [`NOW`] that reaches the camera now, and the azimuth where it left the ship: its travel time is the
/// time since.
fn seen_now() -> Option<(Sight, f64)> {
    let order = Order::new(1)?;
    let mut azimuth = NOW;
    // The ship is slower than light, so each round is nearer by its speed: 40 leave 1e-9.
    for _ in 0..40 {
        let seen = sight(CAMERA, RADIUS * DVec2::from_angle(azimuth), order)?;
        azimuth = NOW - orbital_frequency(RADIUS) * seen.ray.delay;
    }
    Some((sight(CAMERA, RADIUS * DVec2::from_angle(azimuth), order)?, azimuth))
}

/// Paints the card.
pub fn draw(sketch: &Sketch) {
    let plot = Plot { sketch, hole: dvec2(124.0, 108.0), unit: 14.5, low: DVec2::ZERO, high: dvec2(420.0, 200.0) };
    plot.line(&arc(RADIUS, 0.0, std::f64::consts::TAU), 0.8, FAINT.gamma_multiply(0.6));
    plot.black();
    let now = RADIUS * DVec2::from_angle(NOW);
    if let Some((seen, azimuth)) = seen_now() {
        let way = arc(RADIUS, azimuth, NOW);
        plot.line(&way, 1.6, TRUE);
        plot.head(&way, 0.5, TRUE);
        plot.line(&seen.line, 1.3, SEEN);
        let light: Vec<DVec2> = seen.line.iter().rev().copied().collect();
        plot.head(&light, 0.55, SEEN);
        let from = plot.at(light[0]);
        sketch.ship(from, dvec2(-azimuth.sin(), -azimuth.cos()), SEEN);
        sketch.label(from + dvec2(10.0, -8.0), Align2::LEFT_BOTTOM, "seen", SEEN);
        let middle = plot.at(dvec2(11.5, 1.8));
        sketch.label(middle + dvec2(0.0, -2.0), Align2::LEFT_BOTTOM, "light", SEEN);
        sketch.write(middle, Align2::LEFT_TOP, &format!("{:.0} r_s/c", seen.ray.delay), SEEN);
    }
    let place = plot.at(now);
    sketch.ship(place, dvec2(-NOW.sin(), -NOW.cos()), TRUE);
    let ring: Vec<DVec2> = arc(11.0, 0.0, std::f64::consts::TAU).into_iter().map(|point| place + point).collect();
    sketch.dashes(&ring, 1.2, TRUE);
    sketch.label(place + dvec2(0.0, -14.0), Align2::CENTER_BOTTOM, "now", TRUE);
    sketch.eye(plot.at(CAMERA));
    sketch.label(plot.at(CAMERA) + dvec2(0.0, 9.0), Align2::CENTER_TOP, "you", OWN);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ship_has_flown_on_for_as_long_as_its_light() {
        let (seen, azimuth) = seen_now().expect("light");
        assert!(((NOW - azimuth) / orbital_frequency(RADIUS) - seen.ray.delay).abs() < 1e-6, "{azimuth}");
        // Not before light could come straight.
        assert!(seen.ray.delay > seen.line[0].distance(seen.line[seen.line.len() - 1]), "{}", seen.ray.delay);
    }
}
