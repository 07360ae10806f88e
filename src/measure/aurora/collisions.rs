//! At which levels an electron collides, and how often: eight levels at once, and only where there may be any.

use wide::f32x8;

use super::sheet::{Falls, LEVELS};

/// Lanes of a vector.
const LANES: usize = 8;

/// The levels of one electron that have collisions, from the top down, each in its own column.
#[derive(Clone, Debug)]
pub struct Collisions {
    /// How many levels there are.
    pub length: usize,
    /// Their numbers.
    pub level: [u32; LEVELS],
    /// Their heights, km.
    pub height: [f32; LEVELS],
    /// How far astray, km.
    pub sway: [f32; LEVELS],
    /// Collisions.
    pub count: [f32; LEVELS],
}

impl Default for Collisions {
    fn default() -> Self {
        Collisions { length: 0, level: [0; LEVELS], height: [0.0; LEVELS], sway: [0.0; LEVELS], count: [0.0; LEVELS] }
    }
}

impl Collisions {
    /// Deals out `collisions` over the levels by the random number `u`: ⌊collisions · spent + u⌋ above each level.
    #[inline(always)]
    pub fn deal(&mut self, falls: &Falls, row: usize, collisions: f32, u: f32) {
        let (spent, stop) = (&falls.spent[row], falls.stops[row]);
        // Nothing happens above the first collision.
        let mut start = 0;
        while start < stop && spent[start + LANES - 1] * collisions + u < 1.0 {
            start += LANES;
        }
        // Whole numbers as floats, exact up to 2²⁴; more than 14,286 (500 keV) are never meant.
        let mut before = u.trunc();
        let mut length = 0;
        let mut shifted = [0.0f32; LANES + 1];
        for first in (start..stop).step_by(LANES) {
            let part: [f32; LANES] = std::array::from_fn(|k| spent[first + k]);
            let now = f32x8::from_i32x8((f32x8::new(part) * f32x8::splat(collisions) + f32x8::splat(u)).fast_trunc_int());
            shifted[0] = before;
            shifted[1..].copy_from_slice(now.as_array());
            before = shifted[LANES];
            let counts = now - f32x8::new(std::array::from_fn(|k| shifted[k]));
            let counted = counts.as_array();
            let mut found = counts.simd_gt(f32x8::ZERO).to_bitmask();
            while found != 0 {
                let lane = found.trailing_zeros() as usize & (LANES - 1);
                found &= found - 1;
                let level = first + lane;
                self.level[length] = level as u32;
                self.height[length] = falls.heights[level];
                self.sway[length] = falls.sway[level];
                self.count[length] = counted[lane];
                length += 1;
            }
        }
        self.length = length;
    }
}
