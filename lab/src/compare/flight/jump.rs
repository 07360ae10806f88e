//! Whether images grow and shrink smoothly from one frame of the game to the next.

use std::collections::BTreeMap;

use crate::compare::Shown;

/// An image's size may change by so many pixels from one frame to the next ...
pub const PIXELS: f64 = 6.0;
/// ... and by this part of the larger of both sizes.
const PART: f64 = 0.3;
/// And by so many standard deviations of what covers pixels in part.
const SIGMA: f64 = 3.0;

#[derive(Clone, Copy, Debug, Default)]
struct Size {
    area: f64,
    variance: f64,
    /// It touches the picture's border, so it may go out of the picture as fast as the camera turns.
    cut: bool,
}

/// An image that changes its size faster than things move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// The object's number, from 1.
    pub object: u32,
    /// The image order.
    pub order: u32,
    /// Its size in pixels, before and after.
    pub areas: [f64; 2],
}

fn sizes(shown: &[Shown], [width, height]: [u32; 2]) -> BTreeMap<(u32, u32), Size> {
    let mut sizes: BTreeMap<(u32, u32), Size> = BTreeMap::new();
    for (i, shown) in shown.iter().enumerate().filter(|(_, shown)| shown.object > 0) {
        let size = sizes.entry((shown.object, shown.order)).or_default();
        let coverage = f64::from(shown.coverage);
        size.area += coverage;
        size.variance += coverage * (1.0 - coverage);
        let (x, y) = (i as u32 % width, i as u32 / width);
        size.cut |= x == 0 || y == 0 || x + 1 == width || y + 1 == height;
    }
    sizes
}

/// The images that jump between two frames of this size. Of an image that touches the picture's border a strip two pixels wide along all of
/// the border may come or go besides, as the camera turns.
pub fn jumps(before: &[Shown], after: &[Shown], size: [u32; 2]) -> Vec<Jump> {
    let both = [sizes(before, size), sizes(after, size)];
    let keys: std::collections::BTreeSet<(u32, u32)> = both.iter().flat_map(|sizes| sizes.keys().copied()).collect();
    let found = keys.into_iter().filter_map(|(object, order)| {
        let [a, b] = [&both[0], &both[1]].map(|sizes| sizes.get(&(object, order)).copied().unwrap_or_default());
        let border = if a.cut || b.cut { 4.0 * f64::from(size[0] + size[1]) } else { 0.0 };
        let allowed = PIXELS + border + PART * a.area.max(b.area) + SIGMA * (a.variance + b.variance).sqrt();
        ((a.area - b.area).abs() > allowed).then_some(Jump { object, order, areas: [a.area, b.area] })
    });
    found.collect()
}
