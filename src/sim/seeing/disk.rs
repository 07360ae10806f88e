//! What can be pointed at in the disk.

use std::f64::consts::PI;

use super::field::{Field, best, point};
use super::kind::{Phenomenon, Pointer};
use super::look::{GasCrossing, Look};
use crate::scene::disk::radial::LAST_ORBIT;

/// g must differ from 1 by so much for a side to be called blue or red.
const NOTICED: f64 = 0.02;
/// Sine of the camera's height over the disk up to which the far side is seen to be lifted.
const LOW: f64 = 0.87;
/// Sine of the least height at which one face of the disk is before the other.
const LOWEST: f64 = 1e-3;
/// Cosine of the azimuth from the camera's up to which gas is behind the hole.
const BEHIND: f64 = -0.5;
/// What a step away from the edge of the image is worth; more than any g. By hand.
const INWARDS: f64 = 10.0;
/// So many radii at which the disk is looked for where the grid is too coarse for it.
const RADII: usize = 6;

/// The disk's sights on the screen.
pub fn disk(field: &Field) -> Vec<Pointer> {
    let Some(gas) = field.eye.gas() else { return Vec::new() };
    let [start, end] = gas.extent();
    // Where the disk is thick: neither thin falling gas nor its outer edge.
    let inner = start.max(LAST_ORBIT) * 1.05;
    let radii: Vec<f64> = (0..RADII).map(|k| inner * libm::pow(0.8 * end / inner, k as f64 / (RADII - 1) as f64)).collect();
    let seen = [1, 2].map(|order| looks(field, order, &radii));
    let has_faces = field.eye.outward.z.abs() > LOWEST;
    let middle = radii[RADII / 2];
    let off_middle = |spot: &Spot| 0.3 * libm::log(spot.gas.position.length() / middle).abs();
    let all = || seen.iter().flatten();
    let bluest = best(all().filter(|spot| spot.gas.g > 1.0 + NOTICED), |spot| spot.gas.g + spot.inwards());
    let reddest = best(all().filter(|spot| spot.gas.g < 1.0 - NOTICED), |spot| spot.inwards() - spot.gas.g);
    let far_side = best(seen[0].iter().filter(|spot| has_faces && spot.is_far(field)), |spot| {
        spot.inwards() - 3.0 * spot.facing(field) - off_middle(spot)
    });
    let underside = best(seen[1].iter().filter(|_| has_faces), |spot| spot.inwards() - spot.facing(field) - off_middle(spot));
    [
        far_side.map(|spot| point(Phenomenon::DiskFarSide, &spot.look, spot.gas.position.length())),
        underside.map(|spot| point(Phenomenon::DiskUnderside, &spot.look, spot.gas.position.length())),
        bluest.map(|spot| point(Phenomenon::BlueSide, &spot.look, spot.gas.g)),
        reddest.map(|spot| point(Phenomenon::RedSide, &spot.look, spot.gas.g)),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Gas that is seen.
struct Spot {
    look: Look,
    gas: GasCrossing,
    depth: u16,
}

impl Spot {
    /// A place with others like it around is better pointed at.
    fn inwards(&self) -> f64 {
        f64::from(self.depth.min(2)) * INWARDS
    }

    /// Cosine of its azimuth from the camera's: −1 right behind the hole.
    fn facing(&self, field: &Field) -> f64 {
        let towards = field.eye.outward.truncate().normalize_or_zero();
        self.gas.position.truncate().normalize_or_zero().dot(towards)
    }

    fn is_far(&self, field: &Field) -> bool {
        field.eye.outward.z.abs() < LOW && self.facing(field) < BEHIND
    }
}

/// The places where the screen shows the disk's image of this order: cells of the grid, and where these are few, gas at `radii` (r_s).
fn looks(field: &Field, order: u8, radii: &[f64]) -> Vec<Spot> {
    let shown = |look: &Look| look.shown().filter(|gas| gas.order == order && look.is_clear(gas.swept)).copied();
    let depths = field.depths(|look| shown(look).is_some());
    let mut spots: Vec<Spot> =
        field.cells(&depths).filter_map(|(depth, look)| Some(Spot { look: *look, gas: shown(look)?, depth })).collect();
    if spots.iter().any(|spot| spot.depth > 1) {
        return spots;
    }
    for side in field.sides() {
        let swept = field.eye.first_crossing(side) + PI * f64::from(order - 1);
        let found = radii.iter().filter_map(|&r| {
            let look = field.look(field.eye.seen_ray(r, swept, side)?)?;
            Some(Spot { look, gas: shown(&look)?, depth: 1 })
        });
        spots.extend(found);
    }
    spots
}
