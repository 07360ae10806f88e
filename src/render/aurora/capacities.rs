//! Where the strokes of an image are stored until they are drawn. Two levels of the pyramid share a part of the buffer: one fills it from
//! the beginning, the other from the end, so the split between them need not be known. The next coarser pair has half as much.

use crate::render::aurora::levels::PYRAMID;

/// Columns and rows of lit tiles, into which the screen is divided. Passes over whole pictures leave out tiles without light. As in
/// lit_tiles.wgsl.
pub const LIT_TILES: [u32; 2] = [32, 16];
/// Vectors of four numbers per image: draw arguments of each level, strokes in each pair of levels, and one bit per lit tile that tells
/// whether light may be there, first for the finest level and then for coarser ones.
pub const FOURS: usize = PYRAMID as usize + 1 + 2 * LIT_TILES[1] as usize / 4;
/// Bytes of them.
pub const DRAWS_BYTES: u64 = 16 * FOURS as u64;

/// Vertices of a stroke; as in stroke.wgsl.
pub const CORNERS: u32 = 6;

/// The capacities of all images of a frame, in strokes; as in shaders/aurora/capacities.wgsl.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StrokeCapacities {
    /// Strokes in the part of the two finest levels; a multiple of 8, so that coarser ones are whole.
    pub finest: u64,
    /// Levels in use.
    pub levels: u32,
}

impl StrokeCapacities {
    /// Number of strokes in front of the part of a pair of levels: the parts of all finer pairs.
    fn before(&self, pair: u32) -> u64 {
        2 * self.finest - ((2 * self.finest) >> pair)
    }

    /// Strokes that one image has room for.
    pub fn all(&self) -> u64 {
        self.before(self.levels.div_ceil(2))
    }

    /// These numbers for an image, from 0, without any stroke.
    pub fn empty(&self, image: u32) -> [[u32; 4]; FOURS] {
        let level = |level: u32| {
            let first = u64::from(image) * self.all() + self.before(level / 2 + level % 2);
            [0, 1, CORNERS * first as u32, 0]
        };
        std::array::from_fn(|four| if four < PYRAMID as usize { level(four as u32) } else { [0; 4] })
    }
}
