//! Narrow images seen again with more rays: one ray a pixel cannot tell how much of a pixel an image covers that is narrower than that.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::displacement::Probe;
use super::grid::Grid;
use crate::compare::ContestantFrame;
use crate::compare::deadline::Deadline;
use lensrunner::judge::picture::TracedPicture;

/// Rays along each side of a pixel in which a narrow image lies.
pub const SIDE: u32 = 3;

/// Replaces the judge's shares, of a single ray a pixel, by those of [`SIDE`]² rays in all pixels that a narrow image touches or may touch:
/// one that nowhere shows all around a pixel that shows it, so that it is less than three pixels wide; or that the contestant draws by
/// coverage. From the pixels in which either picture shows it the search goes on to their neighbours as long as the judge meets it there.
pub fn see_again(judge: &mut TracedPicture, frame: &ContestantFrame, probe: &dyn Probe) {
    see_again_but(judge, frame, probe, &BTreeSet::new(), &Deadline::never());
}

/// The same but for these images, object and order; ends at the deadline, with the single rays where no more were sent.
pub fn see_again_but(
    judge: &mut TracedPicture,
    frame: &ContestantFrame,
    probe: &dyn Probe,
    but: &BTreeSet<(u32, u32)>,
    deadline: &Deadline,
) {
    let grid = Grid::of(judge.size);
    let mut narrow = narrow_images(judge, frame, &grid);
    narrow.retain(|image| !but.contains(image));
    let shows = |i: usize| {
        let (layer, shown) = (&judge.layers[i], &frame.shown[i]);
        narrow.contains(&(layer.object, layer.order)) || narrow.contains(&(shown.object, shown.order))
    };
    let mut next: BTreeSet<usize> = (0..judge.layers.len()).filter(|&i| shows(i)).flat_map(|i| grid.around(i)).collect();
    let mut found: BTreeMap<usize, Vec<(u32, u32, f32)>> = BTreeMap::new();
    while !next.is_empty() {
        let looked: Vec<_> = next.into_par_iter().filter(|_| !deadline.is_over()).map(|i| (i, shares(probe, grid.place(i)))).collect();
        let met = looked.iter().filter(|(_, shares)| shares.iter().any(|share| narrow.contains(&(share.0, share.1))));
        next = met.flat_map(|(i, _)| grid.around(*i)).collect();
        found.extend(looked);
        next.retain(|i| !found.contains_key(i));
    }
    for (i, shares) in found {
        judge.shares[i] = shares;
    }
}

/// Images of which so much too much is shown, or too little, that a single ray a pixel tells: more rays would only take their time. Of an
/// image that is right each pixel that is touched adds 1/4 at most to the variance of what single rays count; here it is off by six
/// standard deviations, over many pixels.
pub fn grossly_wrong(judge: &TracedPicture, frame: &ContestantFrame) -> BTreeSet<(u32, u32)> {
    let mut counts: BTreeMap<(u32, u32), [f64; 3]> = BTreeMap::new();
    for (layer, shown) in judge.layers.iter().zip(&frame.shown) {
        if layer.object > 0 {
            counts.entry((layer.object, layer.order)).or_default()[0] += 1.0;
        }
        if shown.object > 0 {
            let count = counts.entry((shown.object, shown.order)).or_default();
            count[1] += f64::from(shown.coverage);
            count[2] += 1.0;
        }
    }
    let gross =
        |[judge, shown, touched]: [f64; 3]| touched.max(judge) > MANY && (shown - judge).abs() > 0.5 * SURELY * (touched + judge).sqrt();
    counts.into_iter().filter(|(_, count)| gross(*count)).map(|(image, _)| image).collect()
}

/// Standard deviations beyond which nothing is left to chance.
const SURELY: f64 = 6.0;
/// Pixels from which on it is worth leaving an image out.
const MANY: f64 = 300.0;

/// Objects and orders of which no pixel has only its own around it, or that the contestant draws by coverage.
fn narrow_images(judge: &TracedPicture, frame: &ContestantFrame, grid: &Grid) -> BTreeSet<(u32, u32)> {
    let key = |i: usize| (judge.layers[i].object, judge.layers[i].order);
    let wide: BTreeSet<_> = (0..judge.layers.len()).filter(|&i| grid.around(i).iter().all(|&j| key(j) == key(i))).map(key).collect();
    let all =
        judge.layers.iter().map(|layer| (layer.object, layer.order)).chain(frame.shown.iter().map(|shown| (shown.object, shown.order)));
    let by_coverage = frame.shown.iter().filter(|shown| shown.coverage < 1.0).map(|shown| (shown.object, shown.order));
    all.filter(|image| !wide.contains(image)).chain(by_coverage).filter(|image| image.0 > 0).collect()
}

/// The part of a pixel that each thing covers in each order: (object, order, part), in that order.
fn shares(probe: &dyn Probe, [x, y]: [f64; 2]) -> Vec<(u32, u32, f32)> {
    let mut counts: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    for k in 0..SIDE * SIDE {
        let [across, down] = [k % SIDE, k / SIDE].map(|step| (f64::from(step) + 0.5) / f64::from(SIDE));
        if let Some(point) = probe.at(x + across, y + down) {
            *counts.entry((point.object, point.order)).or_default() += 1;
        }
    }
    counts.into_iter().map(|((object, order), count)| (object, order, count as f32 / (SIDE * SIDE) as f32)).collect()
}
