//! Card 7: circles around the hole, and the free fall from a high one to a low one.

use std::f64::consts::{PI, TAU};

use bevy_egui::egui::Align2;
use glam::{DVec2, dvec2};

use super::sketch::{Plot, Sketch, arc};
use crate::play::hud::paint::{ALARM, FAINT, OWN, SEEN, TEXT, TRUE};
use crate::scene::disk::radial::LAST_ORBIT;
use crate::spacetime::orbit::orbital_frequency;

/// The circle of light, in r_s.
const LIGHT: f64 = 1.5;
/// The low circle and the high one, in r_s.
const CIRCLES: [f64; 2] = [4.2, 7.0];
/// Azimuth of the brake on the high circle, in radians.
const BRAKE: f64 = 0.9;
/// Length of a circle's arrow, in r_s, over the speed Ωr in c.
const ARROW: f64 = 9.0;

/// The free fall from the apoapsis `high` (r_s) at azimuth `from` (radians, counter-clockwise) to the periapsis `low`: half a turn and a
/// little more. dφ/dχ = (1 − (3 + e cos χ)/p)^−½ (Chandrasekhar, section 19, with M = 1/2).
fn transfer(low: f64, high: f64, from: f64) -> Vec<DVec2> {
    const STEPS: u32 = 96;
    let eccentricity = (high - low) / (high + low);
    let latus = low * (1.0 + eccentricity);
    let step = PI / f64::from(STEPS);
    let mut azimuth = from;
    let mut line = Vec::new();
    for index in 0..=STEPS {
        let anomaly = PI + step * f64::from(index);
        line.push(latus / (1.0 + eccentricity * anomaly.cos()) * DVec2::from_angle(azimuth));
        azimuth += step / (1.0 - (3.0 + eccentricity * (anomaly + 0.5 * step).cos()) / latus).sqrt();
    }
    line
}

/// Paints the card.
pub fn draw(sketch: &Sketch) {
    let plot = Plot { sketch, hole: dvec2(112.0, 101.0), unit: 13.2, low: DVec2::ZERO, high: dvec2(230.0, 200.0) };
    let [low, high] = CIRCLES;
    let circle = |radius: f64| arc(radius, 0.0, TAU);
    plot.line(&circle(high), 1.0, FAINT);
    plot.line(&circle(low), 1.0, FAINT);
    plot.line(&circle(LAST_ORBIT), 1.2, OWN);
    plot.dashes(&circle(LIGHT), 1.2, SEEN);
    plot.black();
    let fall = transfer(low, high, BRAKE);
    plot.line(&fall, 1.5, TRUE);
    plot.head(&fall, 0.5, TRUE);
    for (radius, azimuth) in [(high, 1.75), (low, 5.1)] {
        let (place, along) = (radius * DVec2::from_angle(azimuth), DVec2::from_angle(azimuth).perp());
        let speed = orbital_frequency(radius) * radius;
        sketch.arrow(plot.at(place), plot.at(place + ARROW * speed * along), 1.6, TEXT);
        sketch.ship(plot.at(place), dvec2(along.x, -along.y), TEXT);
    }
    // Braking pushes against the motion.
    let (place, back) = (high * DVec2::from_angle(BRAKE), -DVec2::from_angle(BRAKE).perp());
    sketch.arrow(plot.at(place), plot.at(place + 1.6 * back), 2.2, ALARM);
    sketch.disc(plot.at(place), 3.0, ALARM, ALARM);

    const COLUMN: f64 = 238.0;
    let on = |radius: f64, azimuth: f64| plot.at(radius * DVec2::from_angle(azimuth));
    let side = Align2::LEFT_CENTER;
    sketch.label(dvec2(COLUMN, 16.0), side, "high", TEXT);
    sketch.line(&[on(high, 1.45), dvec2(COLUMN, 16.0)], 0.8, FAINT.gamma_multiply(0.7));
    sketch.pointer(plot.at(place + 1.6 * back), dvec2(COLUMN, 58.0), side, "brake", ALARM);
    sketch.pointer(on(LIGHT, 0.1), dvec2(COLUMN, 100.0), side, "light", SEEN);
    sketch.pointer(on(LAST_ORBIT, -0.45), dvec2(COLUMN, 136.0), side, "stable", OWN);
    sketch.pointer(on(low, -0.8), dvec2(COLUMN, 176.0), side, "low", TEXT);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fall_ends_on_the_low_circle_after_more_than_half_a_turn() {
        let [low, high] = CIRCLES;
        let line = transfer(low, high, 0.0);
        let last = line[line.len() - 1];
        assert!((line[0].length() - high).abs() < 1e-9 && (last.length() - low).abs() < 1e-9, "{last}");
        // Far out it is Kepler's ellipse, whose apsides are opposite; by 3π/(2p) more (first order of the perihelion shift, half of it).
        let swept = |line: &[DVec2]| line.windows(2).map(|pair| pair[0].angle_to(pair[1])).sum::<f64>();
        assert!(swept(&line) > PI + 0.5, "{}", swept(&line));
        let far = transfer(4000.0, 7000.0, 0.0);
        let latus = 4000.0 * (1.0 + 3.0 / 11.0);
        assert!(((swept(&far) - PI) / (1.5 * PI / latus) - 1.0).abs() < 0.01, "{}", swept(&far) - PI);
    }
}
