//! The auroras of a planet, as curves in the plane across the field.

use std::f64::consts::TAU;

use glam::DVec2;

use super::curve::Curve;
use super::dipole::{PLANET_RADIUS, REFERENCE_HEIGHT};
use super::random::uniform;
use crate::scene::planet::AuroraShape;

/// Colatitude of the auroral oval, radians: 21°.
const OVAL: f64 = 0.367;
/// Of the middle of the arcs: magnetic latitude 67.9°.
const ARCS: f64 = 0.3857;
/// Parts of an oval, each with waves of its own.
const PARTS: u32 = 12;

// What follows was chosen by hand, for curtains that look as auroras do: a few km wide, waved over tens of km.

/// A ring of curtains: its colatitude in radians; its width, the height of its waves and, for each part, their number about which chance
/// draws. Lengths in km.
struct CurtainRing {
    colatitude: f64,
    width: f64,
    amplitude: f64,
    waves: f64,
}

/// The ring of an oval, and a second curtain poleward of it.
const RINGS: [CurtainRing; 2] = [
    CurtainRing { colatitude: OVAL, width: 12.0, amplitude: 20.0, waves: 4.0 },
    CurtainRing { colatitude: 0.83 * OVAL, width: 8.0, amplitude: 15.0, waves: 3.0 },
];
/// Seed of the second ring beyond that of the first.
const OTHER_WAVES: u32 = 50;

/// An arc: how far poleward of the middle, its width, and how far it goes to either side, km.
struct Arc {
    north: f64,
    width: f64,
    half: f64,
}

/// The arcs of an aurora of arcs.
const THREE_ARCS: [Arc; 3] = [
    Arc { north: -75.0, width: 2.0, half: 380.0 },
    Arc { north: 0.0, width: 3.0, half: 520.0 },
    Arc { north: 55.0, width: 1.5, half: 300.0 },
];
/// How far (km) chance puts the control points of an arc, and about which height (km) and number of waves, by how much, it draws: in all,
/// half to either side.
const ASIDE: f64 = 90.0;
const ARC_AMPLITUDE: [f64; 2] = [14.0, 16.0];
const ARC_WAVES: [f64; 2] = [5.0, 4.0];

/// The curves of an aurora of this shape.
pub fn curtains(shape: AuroraShape, seed: u32) -> Vec<Curve> {
    match shape {
        AuroraShape::None => Vec::new(),
        AuroraShape::Oval => {
            let mut curves = ring(&RINGS[0], seed);
            // The second one goes over half of the circle; it turns with the planet.
            curves.extend(ring(&RINGS[1], seed.wrapping_add(OTHER_WAVES)).into_iter().take(PARTS as usize / 2));
            curves
        }
        AuroraShape::Arcs => THREE_ARCS.iter().map(|arc| self::arc(arc, seed)).collect(),
    }
}

/// A closed curve of [`PARTS`] arcs round the pole.
fn ring(ring: &CurtainRing, seed: u32) -> Vec<Curve> {
    let radius = ring.colatitude * (PLANET_RADIUS + REFERENCE_HEIGHT);
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
                amplitude: ring.amplitude * (0.2 + 1.2 * random(0)),
                waves: (ring.waves * (0.5 + random(1))).round(),
                phase: 0.0,
                width: ring.width,
            }
        })
        .collect()
}

/// An arc from west to east.
fn arc(&Arc { north, width, half }: &Arc, seed: u32) -> Curve {
    let random = |k: u32| f64::from(uniform(seed, north as i32 as u32, k)) - 0.5;
    let middle = ARCS * (PLANET_RADIUS + REFERENCE_HEIGHT);
    let at = |east: f64, k: u32| DVec2::new(middle - north + ASIDE * random(k), half * east);
    Curve {
        control: [at(-1.0, 0), at(-0.4, 1), at(0.4, 2), at(1.0, 3)],
        amplitude: ARC_AMPLITUDE[0] + ARC_AMPLITUDE[1] * random(4),
        waves: (ARC_WAVES[0] + ARC_WAVES[1] * random(5)).round(),
        phase: TAU * random(6),
        width,
    }
}
