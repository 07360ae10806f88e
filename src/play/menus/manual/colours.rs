//! Card 3: the disk from above, coloured as it is seen from far away and a little above its plane, and the waves of its light.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use bevy_egui::egui::{Align2, Color32, Mesh, Rgba, Shape};
use glam::{DVec2, dvec2};

use super::sketch::{Plot, Sketch, arc};
use crate::play::hud::paint::{OWN, SEEN, TEXT, TRUE};
use crate::scene::blackbody::{lookup, luminance, table};
use crate::scene::disk::radial::LAST_ORBIT;
use crate::spacetime::light::{Branch, join};
use crate::spacetime::orbit::orbital_frequency;

/// The disk's outer edge, in r_s.
const OUTER: f64 = 7.0;
/// Distance of the one who looks, in r_s: far.
const DISTANCE: f64 = 1000.0;
/// Temperature of all the gas, in K, so that colours differ by g alone.
const TEMPERATURE: f64 = 6400.0;
/// Coldest and hottest in the table of colours, in K.
const RANGE: (f32, f32) = (2000.0, 14_000.0);
/// Steps of the disk in radius and azimuth.
const STEPS: (usize, usize) = (5, 64);

/// Angle between the direction of the one who looks and the disk's axis, in radians.
const INCLINATION: f64 = 70.0 / 180.0 * PI;

/// g = ν_seen/ν_emitted of the gas on a circle of `radius` (r_s) at `azimuth` (radians, the one who looks is far away at 0, at
/// `inclination` radians from the disk's axis; the gas goes counter-clockwise): √(1 − 3/(2r)) / (1 − Ωλ), with λ the angular momentum of
/// the light about the disk's axis over its energy. None where no light comes.
fn frequency_ratio(radius: f64, azimuth: f64, inclination: f64) -> Option<f64> {
    let phi = (azimuth.cos() * inclination.sin()).acos();
    let ray = join(1.0 / radius, phi, 1.0 / DISTANCE, Branch::Plus)?;
    // From an azimuth below 0 the light turns counter-clockwise, as the gas does. Its plane is inclined.
    let turning = -azimuth.sin() * inclination.sin() / (phi.sin() * ray.energy);
    Some((1.0 - 1.5 / radius).sqrt() / (1.0 - orbital_frequency(radius) * turning))
}

/// Paints the card.
pub fn draw(sketch: &Sketch) {
    let plot = Plot { sketch, hole: dvec2(106.0, 100.0), unit: 13.2, low: DVec2::ZERO, high: dvec2(212.0, 200.0) };
    sketch.add(Shape::mesh(gas(&plot)));
    plot.black();
    for turn in [0.0, PI] {
        let line = arc(5.2, turn + 0.75, turn + 2.2);
        plot.line(&line, 1.6, Color32::BLACK);
        plot.head(&line, 0.98, Color32::BLACK);
    }
    sketch.arrow(dvec2(222.0, 100.0), dvec2(300.0, 100.0), 1.4, OWN);
    sketch.label(dvec2(306.0, 100.0), Align2::LEFT_CENTER, "you", OWN);
    for (side, height, said, colour) in [(1.0, 46.0, ["away", "red"], TRUE), (-1.0, 156.0, ["towards", "blue"], SEEN)] {
        let Some(g) = frequency_ratio(4.0, side * FRAC_PI_2, INCLINATION) else { continue };
        sketch.label(dvec2(220.0, height - 22.0), Align2::LEFT_CENTER, said[0], TEXT);
        wave(sketch, dvec2(224.0, height), 13.0 / g, 4.0 + 4.0 * g * g, colour);
        sketch.label(dvec2(220.0, height + 22.0), Align2::LEFT_CENTER, said[1], colour);
    }
}

/// A wave that begins at `from`, `length` long from crest to crest and `height` high, in points.
fn wave(sketch: &Sketch, from: DVec2, length: f64, height: f64, colour: Color32) {
    let line: Vec<DVec2> = (0..=300).map(f64::from).map(|x| from + dvec2(0.5 * x, 0.5 * height * (TAU * 0.5 * x / length).sin())).collect();
    sketch.line(&line, 1.4, colour);
    sketch.head(from + dvec2(156.5, 0.0), DVec2::X, colour);
}

/// The disk's gas in its colours.
fn gas(plot: &Plot) -> Mesh {
    let colours = table(24, RANGE.0, RANGE.1);
    let mut mesh = Mesh::default();
    let (rings, turns) = STEPS;
    for ring in 0..=rings {
        let radius = LAST_ORBIT + (OUTER - LAST_ORBIT) * ring as f64 / rings as f64;
        for turn in 0..=turns {
            let azimuth = TAU * turn as f64 / turns as f64;
            let g = frequency_ratio(radius, azimuth, INCLINATION).unwrap_or(1.0);
            let seen = lookup(&colours, RANGE.0, RANGE.1, (TEMPERATURE * g) as f32).map(f64::from);
            let place = plot.at(radius * DVec2::from_angle(azimuth));
            mesh.colored_vertex(plot.sketch.at(place), shown(seen));
        }
    }
    for ring in 0..rings {
        for turn in 0..turns {
            let corner = (ring * (turns + 1) + turn) as u32;
            let above = corner + turns as u32 + 1;
            mesh.add_triangle(corner, corner + 1, above);
            mesh.add_triangle(corner + 1, above + 1, above);
        }
    }
    mesh
}

/// A linear colour as it is shown: its hue as it is, its brightness pressed into what a screen can show.
fn shown(rgb: [f64; 3]) -> Color32 {
    let light = luminance(rgb);
    let bright = light.powf(0.65) / (1.0 + 0.35 * light.powf(0.65));
    let most = rgb.into_iter().fold(0.0, f64::max).max(1e-9);
    let [r, g, b] = rgb.map(|channel| (channel / most * bright.min(1.0)) as f32);
    Rgba::from_rgb(r, g, b).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without bending, light from beside the hole would have λ = ±r; with it a little more. At r = 30 that is one part in thirty.
    #[test]
    fn gas_that_comes_nearer_is_bluer() {
        let flat = |side: f64| (1.0 - 1.5f64 / 30.0).sqrt() / (1.0 - side * orbital_frequency(30.0) * 30.0);
        for side in [1.0, -1.0] {
            let g = frequency_ratio(30.0, -side * FRAC_PI_2, FRAC_PI_2).expect("light");
            assert!((g / flat(side) - 1.0).abs() < 0.01, "{g} {}", flat(side));
        }
        let [away, towards] = [FRAC_PI_2, -FRAC_PI_2].map(|azimuth| frequency_ratio(LAST_ORBIT, azimuth, FRAC_PI_2).expect("light"));
        assert!(away < 0.6 && towards > 1.2, "{away} {towards}");
        // From above nothing comes nearer, nor straight in front: gravity and the gas's clock alone.
        for (azimuth, inclination) in [(1e-7, FRAC_PI_2), (1.0, 1e-7), (PI, INCLINATION)] {
            let g = frequency_ratio(4.0, azimuth, inclination).expect("light");
            assert!((g - (1.0 - 1.5f64 / 4.0).sqrt()).abs() < 1e-5, "{azimuth} {inclination}: {g}");
        }
    }
}
