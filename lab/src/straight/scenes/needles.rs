//! Long thin triangles in all directions, which no boxes hold well: what a builder and a traversal make of the worst. Not of Sei 2008.

use glam::DVec3;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use super::{Triangle, View, rounded};

/// How many the chart draws.
pub const COUNT: usize = 200_000;

/// From in front of the cube, which fills the picture's height.
pub const VIEW: View = View::new([3.5, -2.0, 1.2], [0.0, 0.0, 0.0]);

/// How thick a needle is where it is thickest; the cube's edge is 2.
const THICK: f64 = 2e-4;

/// So many needles through a cube from −1 to 1, each from one point of it to another, evenly at random and always the same.
pub fn needles(count: usize) -> Vec<Triangle> {
    let random = &mut StdRng::seed_from_u64(8);
    let mut anywhere = || DVec3::from_array(std::array::from_fn(|_| random.random_range(-1.0..1.0)));
    let mut needle = || {
        let (from, to, aside) = (anywhere(), anywhere(), anywhere());
        rounded([from, from + (to - from).cross(aside).normalize_or(DVec3::Z) * THICK, to])
    };
    (0..count).map(|_| needle()).collect()
}
