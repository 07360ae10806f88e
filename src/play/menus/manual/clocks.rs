//! Card 6: the rate of clocks over r, of those that stay in place and of those in orbit, and three clocks after the same time.

use std::f64::consts::TAU;

use bevy_egui::egui::{Align2, Color32};
use glam::{DVec2, dvec2};

use super::sketch::Sketch;
use crate::play::hud::paint::{FAINT, OWN, SEEN, TEXT, TRUE};

/// Left end of the axis r = 0, and the rate 0, in points.
const ORIGIN: DVec2 = dvec2(40.0, 172.0);
/// Points to the r_s.
const ALONG: f64 = 36.0;
/// Points to the rate 1.
const UP: f64 = 78.0;
/// Right end of the axis, in r_s.
const LAST: f64 = 10.2;
/// The two clocks near the hole, in r_s: one that stays, one in orbit.
const NEAR: [f64; 2] = [2.0, 4.5];

/// dτ/dt of a clock that stays at r (in r_s) over one far away: √(1 − 1/r).
fn staying(r: f64) -> f64 {
    (1.0 - 1.0 / r).max(0.0).sqrt()
}

/// The same of a clock on a circular free orbit: √(1 − 3/(2r)).
fn orbiting(r: f64) -> f64 {
    (1.0 - 1.5 / r).max(0.0).sqrt()
}

fn place(r: f64, rate: f64) -> DVec2 {
    ORIGIN + dvec2(ALONG * r, -UP * rate)
}

fn curve(from: f64, to: f64, rate: impl Fn(f64) -> f64) -> Vec<DVec2> {
    // Denser where it is steep.
    (0..=60).map(|step| from + (to - from) * (f64::from(step) / 60.0).powi(2)).map(|r| place(r, rate(r))).collect()
}

/// Paints the card.
pub fn draw(sketch: &Sketch) {
    let end = place(LAST, 0.0);
    sketch.line(&[place(0.0, 1.0), place(LAST, 1.0)], 0.6, FAINT.gamma_multiply(0.5));
    sketch.arrow(ORIGIN, end, 1.0, FAINT);
    sketch.arrow(ORIGIN, ORIGIN + dvec2(0.0, -UP - 10.0), 1.0, FAINT);
    for rate in [0.0, 1.0] {
        sketch.write(place(0.0, rate) - dvec2(4.0, 0.0), Align2::RIGHT_CENTER, &format!("{rate}"), FAINT);
    }
    for r in [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0] {
        sketch.line(&[place(r, 0.0), place(r, 0.0) + dvec2(0.0, 3.0)], 1.0, FAINT);
        if r == 1.0 || r % 2.0 == 0.0 {
            sketch.write(place(r, 0.0) + dvec2(0.0, 4.0), Align2::CENTER_TOP, &format!("{r}"), FAINT);
        }
    }
    sketch.write(end + dvec2(2.0, 4.0), Align2::RIGHT_TOP, "r_s", FAINT);
    // The hole: no clock stays there, nor goes round.
    let [top, foot] = [place(0.0, 1.0), place(1.0, 0.0)];
    for corner in [ORIGIN, place(1.0, 1.0)] {
        sketch.wedge([top, foot, corner], FAINT.gamma_multiply(0.25));
    }
    sketch.line(&curve(1.0, LAST, staying), 1.6, SEEN);
    sketch.line(&curve(1.5, LAST, orbiting), 1.6, TRUE);
    let [stays, orbits] = NEAR;
    for (at, r, rate, key, colour) in [
        (place(stays, 0.0).x, stays, staying(stays), "stays", SEEN),
        (place(orbits, 0.0).x, orbits, orbiting(orbits), "orbits", TRUE),
        (place(LAST, 0.0).x - 64.0, f64::INFINITY, 1.0, "far", OWN),
    ] {
        let dial = dvec2(at, 26.0);
        if r.is_finite() {
            sketch.line(&[dial + dvec2(0.0, 19.0), place(r, rate)], 0.8, colour.gamma_multiply(0.6));
            sketch.disc(place(r, rate), 2.4, colour, colour);
        }
        clock(sketch, dial, rate, colour);
        // The first has its name on the left, where there is room.
        let (side, anchor) = if key == "stays" { (-24.0, Align2::RIGHT_CENTER) } else { (24.0, Align2::LEFT_CENTER) };
        sketch.write(dial + dvec2(side, -8.0), anchor, &format!("{rate:.2}"), colour);
        sketch.label(dial + dvec2(side, 8.0), anchor, key, colour);
    }
    sketch.label(ORIGIN + dvec2(-34.0, -UP - 11.0), Align2::LEFT_BOTTOM, "rate", TEXT);
}

/// A dial whose hand has gone round by `turn` since it stood at the top, that part filled.
fn clock(sketch: &Sketch, centre: DVec2, turn: f64, colour: Color32) {
    const RADIUS: f64 = 19.0;
    let hand = |turn: f64| DVec2::from_angle(TAU * (turn - 0.25));
    sketch.disc(centre, RADIUS, Color32::BLACK, TEXT);
    let steps = 48;
    for step in 0..steps {
        let [from, to] = [step, step + 1].map(|step| turn * f64::from(step) / f64::from(steps));
        sketch.wedge([centre, centre + 0.86 * RADIUS * hand(from), centre + 0.86 * RADIUS * hand(to)], colour.gamma_multiply(0.35));
    }
    for mark in 0..12 {
        let way = hand(f64::from(mark) / 12.0);
        sketch.line(&[centre + 0.86 * RADIUS * way, centre + 0.97 * RADIUS * way], 1.0, TEXT);
    }
    sketch.line(&[centre, centre + 0.8 * RADIUS * hand(turn)], 1.8, colour);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spacetime::matter::gamma;
    use crate::spacetime::orbit::{Elements, static_momentum};
    use glam::DVec3;

    /// By the ship's own equation of motion: dτ/dT = 1/γ; T runs as t for what goes round or stays.
    #[test]
    fn clocks_run_as_those_of_ships() {
        for r in [2.0, 3.0, 7.0] {
            let stays = static_momentum(DVec3::X * r).expect("outside");
            assert!((1.0 / gamma(stays) - staying(r)).abs() < 1e-12, "{r}");
            let orbits = Elements::circle(r, 0.0).state().expect("an orbit").momentum;
            assert!((1.0 / gamma(orbits) - orbiting(r)).abs() < 1e-12, "{r}");
        }
        // As the card says.
        assert_eq!((100.0 * staying(2.0)).round(), 71.0);
    }
}
