//! Card 8: a fall through the horizon in Painlevé–Gullstrand coordinates, its light cones, light sent outwards, and the view ahead.

use std::f64::consts::{FRAC_PI_2, PI};

use bevy_egui::egui::{Align2, Color32};
use glam::{DVec2, dvec2};

use super::sketch::{Plot, Sketch};
use crate::play::hud::paint::{ALARM, FAINT, SEEN, TEXT, TRUE};
use crate::spacetime::light::shadow_angle;
use crate::spacetime::metric::river_speed;

/// Where the ship begins, in r_s, at T = 0; it fell from rest far away.
const START: f64 = 2.1;
/// Radii at which light cones are drawn, in r_s.
const CONES: [f64; 4] = [1.85, 1.42, 1.0, 0.66];
/// Height of a light cone, in r_s/c.
const CONE: f64 = 0.27;
/// Where light that is sent outwards begins, in r_s, at T = 0.
const OUTWARDS: [f64; 4] = [0.8, 1.0, 1.1, 1.6];
/// The last time of the diagram, in r_s/c.
const LAST: f64 = 2.2;
/// The last radius of the diagram, in r_s.
const FAR: f64 = 2.75;

/// dr/dT of light that is sent outwards (`sign` 1) or inwards (−1) at r: ±1 − √(1/r).
fn light_speed(r: f64, sign: f64) -> f64 {
    sign - river_speed(r)
}

/// When the ship is at r, in r_s/c: ⅔ (r₀^{3/2} − r^{3/2}).
fn fallen(r: f64) -> f64 {
    2.0 / 3.0 * (START.powf(1.5) - r.powf(1.5))
}

/// The light that is sent outwards at r = `from` and T = 0: (r, T) until the singularity or the diagram's end.
fn outward(from: f64) -> Vec<DVec2> {
    const STEP: f64 = 0.01;
    let mut line = vec![dvec2(from, 0.0)];
    let mut r = from;
    let mut time = 0.0;
    while time < LAST - 0.5 * STEP && r < FAR {
        let half = r + 0.5 * STEP * light_speed(r, 1.0);
        if half <= 0.02 {
            break;
        }
        r += STEP * light_speed(half, 1.0);
        time += STEP;
        if r <= 0.0 {
            break;
        }
        line.push(dvec2(r, time));
    }
    line
}

/// Paints the card.
pub fn draw(sketch: &Sketch) {
    let unit = 74.0;
    let origin = dvec2(34.0, 182.0);
    let corner = origin - dvec2(0.0, unit * LAST);
    let plot = Plot { sketch, hole: origin, unit, low: corner, high: origin + dvec2(unit * FAR, 0.0) };
    for from in OUTWARDS {
        plot.line(&outward(from), 1.0, SEEN.gamma_multiply(0.8));
    }
    sketch.dashes(&[plot.at(dvec2(1.0, 0.0)), plot.at(dvec2(1.0, LAST))], 1.2, TEXT);
    sketch.line(&[origin, corner], 3.0, ALARM);
    sketch.arrow(origin, origin + dvec2(unit * FAR + 8.0, 0.0), 1.0, FAINT);
    let fall: Vec<DVec2> = (0..=60).map(|step| START * (1.0 - f64::from(step) / 60.0)).map(|r| dvec2(r, fallen(r))).collect();
    plot.line(&fall, 1.8, TRUE);
    for r in CONES {
        let tip = dvec2(r, fallen(r));
        let [out, inwards] = [1.0, -1.0].map(|sign| tip + CONE * dvec2(light_speed(r, sign), 1.0));
        sketch.wedge([tip, out, inwards].map(|point| plot.at(point)), SEEN.gamma_multiply(0.35));
        sketch.line(&[plot.at(out), plot.at(tip), plot.at(inwards)], 1.2, SEEN);
        sketch.disc(plot.at(tip), 2.0, TRUE, TRUE);
    }
    for r in [1.0, 2.0] {
        sketch.write(plot.at(dvec2(r, 0.0)) + dvec2(0.0, 2.0), Align2::CENTER_TOP, &format!("{r} r_s"), FAINT);
    }
    sketch.arrow(dvec2(12.0, 130.0), dvec2(12.0, 70.0), 1.0, FAINT);
    sketch.label(dvec2(2.0, 146.0), Align2::LEFT_CENTER, "time", FAINT);
    sketch.label(plot.at(dvec2(0.0, LAST)) + dvec2(-30.0, -10.0), Align2::LEFT_CENTER, "singularity", ALARM);
    sketch.label(plot.at(dvec2(1.0, LAST)) + dvec2(0.0, -10.0), Align2::LEFT_CENTER, "horizon", TEXT);
    sketch.label(plot.at(dvec2(START, fallen(START))) + dvec2(4.0, -10.0), Align2::LEFT_CENTER, "ship", TRUE);
    sketch.label(plot.at(dvec2(1.75, 1.4)), Align2::LEFT_CENTER, "light", SEEN);
    view(sketch);
}

/// Points to the radian in the view.
const VIEW: f64 = 40.0;

/// What the ship that falls through the horizon sees ahead: all directions up to 90° from the hole's centre.
fn view(sketch: &Sketch) {
    let centre = dvec2(346.0, 108.0);
    sketch.disc(centre, VIEW * FRAC_PI_2, Color32::from_rgb(16, 24, 40), FAINT);
    let shadow = PI - shadow_angle(1.0);
    // Stars by the golden angle: evenly strewn, and the same on each picture.
    for star in 0..90 {
        let off = FRAC_PI_2 * (f64::from(star) / 90.0).sqrt();
        let place = centre + VIEW * off * DVec2::from_angle(2.399_963 * f64::from(star));
        if off > shadow + 0.03 && off < FRAC_PI_2 - 0.04 {
            sketch.disc(place, 0.5 + 0.3 * f64::from(star % 3), TEXT, Color32::TRANSPARENT);
        }
    }
    sketch.disc(centre, VIEW * shadow, Color32::BLACK, FAINT);
    sketch.label(centre, Align2::CENTER_CENTER, "shadow", TEXT);
    sketch.label(dvec2(346.0, 16.0), Align2::CENTER_CENTER, "view", TEXT);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_sent_outwards_leaves_from_outside_alone() {
        let end = |from: f64| outward(from).last().copied().unwrap_or(DVec2::ZERO);
        assert_eq!(end(1.0).x, 1.0);
        assert!(end(1.1).x > 1.1 && end(1.6).x > 2.1, "{} {}", end(1.1), end(1.6));
        assert!(end(0.8).x < 0.1 && end(0.8).y < LAST, "{}", end(0.8));
    }

    /// ∫ dr/(1 − r^−½) = r + 2√r + 2 ln(√r − 1).
    #[test]
    fn light_sent_outwards_keeps_its_closed_form() {
        let t = |r: f64| r + 2.0 * r.sqrt() + 2.0 * (r.sqrt() - 1.0).ln();
        let last = *outward(1.6).last().expect("points");
        assert!((t(last.x) - t(1.6) - last.y).abs() < 1e-3, "{last}");
    }

    /// The ship is on the slices of those who fall from rest: dr/dT = −√(1/r), midway between the cone's legs.
    #[test]
    fn the_fall_is_in_the_middle_of_its_light_cones() {
        for r in CONES {
            let slope = 2e-6 / (fallen(r + 1e-6) - fallen(r - 1e-6));
            assert!((slope - 0.5 * (light_speed(r, 1.0) + light_speed(r, -1.0))).abs() < 1e-6, "{r}: {slope}");
        }
    }
}
