//! The auroras of a planet, as curves in the plane across the field.

use std::f64::consts::TAU;

use glam::DVec2;

use super::curve::Curve;
use super::dipole::{PLANET_RADIUS, REFERENCE_HEIGHT};
use super::random::uniform;
use crate::scene::planet::AuroraShape;

/// Colatitude of the auroral oval, radians (21°), and of the middle of the arcs (magnetic latitude 67.9°).
const OVAL: f64 = 0.367;
const ARCS: f64 = 0.3857;
/// Parts of an oval, each with waves of its own.
const PARTS: u32 = 12;

/// The curves of an aurora of this shape.
pub fn curtains(shape: AuroraShape, seed: u32) -> Vec<Curve> {
    match shape {
        AuroraShape::None => Vec::new(),
        AuroraShape::Oval => {
            let mut curves = ring(OVAL, 12.0, [20.0, 4.0], seed);
            // A second curtain poleward, over half of the circle; it turns with the planet.
            curves.extend(ring(0.83 * OVAL, 8.0, [15.0, 3.0], seed.wrapping_add(50)).into_iter().take(PARTS as usize / 2));
            curves
        }
        AuroraShape::Arcs => [(-75.0, 2.0, 380.0), (0.0, 3.0, 520.0), (55.0, 1.5, 300.0)].map(|arc| self::arc(arc, seed)).to_vec(),
    }
}

/// A closed curve of [`PARTS`] arcs round the pole; `sine` is height (km) and waves of each.
fn ring(colatitude: f64, width: f64, sine: [f64; 2], seed: u32) -> Vec<Curve> {
    let radius = colatitude * (PLANET_RADIUS + REFERENCE_HEIGHT);
    let part = TAU / f64::from(PARTS);
    // Length of the handles, over the radius, of a cubic Bézier curve that follows a part of a circle.
    let handle = 4.0 / 3.0 * (0.25 * part).tan();
    (0..PARTS)
        .map(|k| {
            let random = |number: u32| f64::from(uniform(seed, k, number));
            let (a, b) = (DVec2::from_angle(part * f64::from(k)), DVec2::from_angle(part * f64::from(k + 1)));
            Curve {
                control: [a, a + a.perp() * handle, b - b.perp() * handle, b].map(|point| point * radius),
                // A whole number of waves that begin and end at 0, so that the parts join.
                amplitude: sine[0] * (0.2 + 1.2 * random(0)),
                waves: (sine[1] * (0.5 + random(1))).round(),
                phase: 0.0,
                width,
            }
        })
        .collect()
}

/// An arc from west to east, `north` km poleward of the middle, `half` km to either side.
fn arc((north, width, half): (f64, f64, f64), seed: u32) -> Curve {
    let random = |k: u32| f64::from(uniform(seed, north as i32 as u32, k)) - 0.5;
    let middle = ARCS * (PLANET_RADIUS + REFERENCE_HEIGHT);
    let at = |east: f64, k: u32| DVec2::new(middle - north + 90.0 * random(k), half * east);
    Curve {
        control: [at(-1.0, 0), at(-0.4, 1), at(0.4, 2), at(1.0, 3)],
        amplitude: 14.0 + 16.0 * random(4),
        waves: (5.0 + 4.0 * random(5)).round(),
        phase: TAU * random(6),
        width,
    }
}
