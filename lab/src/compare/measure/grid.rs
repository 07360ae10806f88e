//! The pixels of a picture, and whose the parts of one are.

use std::collections::BTreeMap;

/// A part of a pixel that an image covers: object, order, part.
pub(super) type Share = (u32, u32, f32);

/// A pixel is filled from this part on: all samples of any number but for rounding.
pub(super) const FULL: f32 = 0.999;

/// The pixels of a picture.
pub(super) struct Grid {
    width: usize,
    height: usize,
}

impl Grid {
    pub(super) fn of(size: [u32; 2]) -> Grid {
        let [width, height] = size.map(|side| side as usize);
        Grid { width, height }
    }

    /// Column and row: the upper left corner, in pixels.
    pub(super) fn place(&self, i: usize) -> [f64; 2] {
        [(i % self.width) as f64, (i / self.width) as f64]
    }

    /// The pixel and those around it that exist.
    pub(super) fn around(&self, i: usize) -> Vec<usize> {
        let (x, y) = (i % self.width, i / self.width);
        let columns = x.saturating_sub(1)..=(x + 1).min(self.width - 1);
        (y.saturating_sub(1)..=(y + 1).min(self.height - 1)).flat_map(|y| columns.clone().map(move |x| y * self.width + x)).collect()
    }

    /// Whose the coverage is that a contestant shows in a pixel. Where several thin images cover one it knows their common area alone, and
    /// names the nearest, however little of it that covers. All are drawn a pixel wide, so it counts for each as the judge sees them there
    /// and in the pixels around. Each image with its part, of 1 in all.
    pub(super) fn thin_parts(
        &self,
        shares: &[Vec<Share>],
        i: usize,
        shown: (u32, u32),
        is_thin: &dyn Fn(u32, u32) -> bool,
    ) -> Vec<((u32, u32), f64)> {
        let mut there: BTreeMap<(u32, u32), f64> = BTreeMap::new();
        for share in self.around(i).into_iter().flat_map(|j| &shares[j]).filter(|share| is_thin(share.0, share.1)) {
            *there.entry((share.0, share.1)).or_default() += f64::from(share.2);
        }
        if !there.contains_key(&shown) {
            return vec![(shown, 1.0)];
        }
        let sum: f64 = there.values().sum();
        there.into_iter().map(|(image, share)| (image, share / sum)).collect()
    }
}
