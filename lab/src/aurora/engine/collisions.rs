//! At which levels an electron collides, and how often: eight levels at once, and only where there may be any.

#[cfg(target_arch = "x86_64")]
use bytemuck::cast;

use super::points::{LANES, eight};
use crate::aurora::sheet::{Falls, LEVELS};

/// Room for every level and a vector beyond, a power of two.
pub const ROOM: usize = 256;

/// For each set of lanes, as bits, its lanes in order; the others are no lanes of it.
#[cfg(target_arch = "x86_64")]
pub(super) static ORDERS: [[u32; LANES]; 256] = {
    let mut orders = [[0; LANES]; 256];
    let mut set = 0;
    while set < 256 {
        let (mut lane, mut length) = (0, 0);
        while lane < LANES {
            if set >> lane & 1 == 1 {
                orders[set][length] = lane as u32;
                length += 1;
            }
            lane += 1;
        }
        set += 1;
    }
    orders
};

/// The levels of one electron that have collisions, from the top down, each in its own column. What lies behind `length` has no meaning,
/// but every number there is a level. Heights and ways astray are dealt with the levels, as to look them up for each level afterwards takes
/// longer.
#[derive(Clone, Debug)]
pub struct Collisions {
    /// How many levels there are.
    pub length: usize,
    /// Their numbers.
    pub level: [u32; ROOM],
    /// Collisions.
    pub count: [f32; ROOM],
    /// Heights of the levels, km.
    pub height: [f32; ROOM],
    /// How far astray the electron is there, km.
    pub sway: [f32; ROOM],
}

impl Default for Collisions {
    fn default() -> Self {
        Collisions { length: 0, level: [0; ROOM], count: [0.0; ROOM], height: [0.0; ROOM], sway: [0.0; ROOM] }
    }
}

impl Collisions {
    /// Deals out `collisions` over the levels by the random number `u`: ⌊collisions · spent + u⌋ above each level. `AVX` may be said only
    /// where the processor has AVX2 and POPCNT; it changes no bit.
    #[inline(always)]
    pub(super) fn deal<const AVX: bool>(&mut self, falls: &Falls, row: usize, collisions: f32, u: f32) {
        let (spent, stop) = (&falls.spent[row], falls.stops[row]);
        // Nothing happens above the first collision.
        let mut start = 0;
        while start < stop && spent[start + LANES] * collisions + u < 1.0 {
            start += LANES;
        }
        let mut length = 0;
        for first in (start..stop).step_by(LANES) {
            #[cfg(target_arch = "x86_64")]
            if AVX {
                #[allow(unsafe_code)]
                // SAFETY: the caller says that the processor has AVX2 and POPCNT.
                unsafe {
                    self.deal_avx(falls, spent, first, collisions, u, &mut length)
                };
                continue;
            }
            // Whole numbers as floats, exact up to 2²⁴; more than 14,286 (500 keV) are never meant. Those above a level are found once more
            // for the level below: cheaper than to hand them from lane to lane.
            let dealt = |level: usize| (spent[level] * collisions + u) as i32 as f32;
            // Every lane is written, and those without a collision are written over: which have one cannot be foretold.
            for level in first..first + LANES {
                let count = dealt(level + 1) - dealt(level);
                let at = length & (ROOM - 1);
                (self.level[at], self.count[at], self.height[at], self.sway[at]) =
                    (level as u32, count, falls.heights[level], falls.sway[level]);
                length += usize::from(count > 0.0);
            }
        }
        self.length = length;
    }

    /// The same for eight levels from `first` on, all at once.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,popcnt")]
    #[inline]
    fn deal_avx(&mut self, falls: &Falls, spent: &[f32; LEVELS + 1], first: usize, collisions: f32, u: f32, length: &mut usize) {
        use std::arch::x86_64::*;
        let (all, more) = (_mm256_set1_ps(collisions), _mm256_set1_ps(u));
        let [above, below]: [__m256; 2] = [cast(eight(spent, first)), cast(eight(spent, first + 1))];
        let above = _mm256_cvtepi32_ps(_mm256_cvttps_epi32(_mm256_add_ps(_mm256_mul_ps(above, all), more)));
        let below = _mm256_cvtepi32_ps(_mm256_cvttps_epi32(_mm256_add_ps(_mm256_mul_ps(below, all), more)));
        let counts = _mm256_sub_ps(below, above);
        let found = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_GT_OQ>(counts, _mm256_setzero_ps()));
        let order: __m256i = cast(ORDERS[found as usize & 255]);
        let levels = _mm256_add_epi32(_mm256_set1_epi32(first as i32), order);
        let room = self.level.len() - LANES;
        let at = (*length).min(room);
        self.level[at..at + LANES].copy_from_slice(&cast::<__m256i, [u32; LANES]>(levels));
        let columns = [
            (&mut self.count, counts),
            (&mut self.height, cast(eight(&falls.heights, first))),
            (&mut self.sway, cast(eight(&falls.sway, first))),
        ];
        for (column, numbers) in columns {
            column[at..at + LANES].copy_from_slice(&cast::<__m256, [f32; LANES]>(_mm256_permutevar8x32_ps(numbers, order)));
        }
        *length += found.count_ones() as usize;
    }

    /// The numbers of eight of the levels.
    #[inline(always)]
    pub fn level_of(&self, first: usize) -> [u32; LANES] {
        eight(&self.level, first)
    }

    /// The heights of eight of the levels, and how far astray the electron is there, km.
    #[inline(always)]
    pub fn places_of(&self, first: usize) -> [[f32; LANES]; 2] {
        [eight(&self.height, first), eight(&self.sway, first)]
    }

    /// The collisions at eight of the levels.
    #[inline(always)]
    pub fn count_of(&self, first: usize) -> [f32; LANES] {
        eight(&self.count, first)
    }
}
