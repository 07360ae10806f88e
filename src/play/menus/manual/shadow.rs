//! Card 1: light that comes from the left past the hole; what would pass within 3√3/2 r_s ends in it.

use bevy_egui::egui::Align2;
use glam::{DVec2, dvec2};

use super::rays::{End, from_afar};
use super::sketch::{Plot, SHEET, Sketch};
use crate::play::hud::paint::{ALARM, FAINT, SEEN, TEXT};
use crate::spacetime::metric::CRITICAL_IMPACT;

/// Impact parameters of the rays over the critical one, on either side.
const SHARES: [f64; 8] = [0.2, 0.45, 0.7, 0.95, 1.05, 1.3, 1.55, 1.8];

/// Paints the card.
pub fn draw(sketch: &Sketch) {
    let plot = Plot { sketch, hole: dvec2(240.0, 100.0), unit: 19.0, low: DVec2::ZERO, high: SHEET };
    let edge = CRITICAL_IMPACT;
    for share in SHARES.iter().flat_map(|&share| [share, -share]) {
        let Some((line, end)) = from_afar(share * edge, 16.0) else { continue };
        let colour = if end == End::Caught { ALARM } else { SEEN };
        plot.line(&line, 1.1, colour.gamma_multiply(0.9));
        plot.head(&line, 0.2, colour);
    }
    plot.black();
    for height in [edge, -edge] {
        plot.dashes(&[dvec2(-11.6, height), dvec2(0.0, height)], 1.0, FAINT);
    }
    let [top, bottom, middle] = [edge, -edge, 0.0].map(|height| plot.at(dvec2(-11.3, height)));
    sketch.arrow(middle, top, 1.2, TEXT);
    sketch.arrow(middle, bottom, 1.2, TEXT);
    sketch.label(middle + dvec2(-4.0, 0.0), Align2::LEFT_CENTER, "shadow", TEXT);
    sketch.label(dvec2(6.0, 12.0), Align2::LEFT_CENTER, "light", SEEN);
    sketch.label(plot.at(dvec2(-3.6, 1.2)), Align2::CENTER_CENTER, "caught", ALARM);
    sketch.label(dvec2(410.0, 188.0), Align2::RIGHT_CENTER, "bent", SEEN);
    sketch.pointer(plot.at(DVec2::ZERO), plot.at(dvec2(3.2, 0.0)), Align2::LEFT_CENTER, "hole", TEXT);
    sketch.write(plot.at(dvec2(-9.9, 0.5 * edge + 0.2)), Align2::LEFT_CENTER, "2 × 2.6 r_s", TEXT);
}
