//! How far a picture is from the judge's.

use super::grid::{FULL, Grid, thin_parts};
use std::collections::{BTreeMap, BTreeSet, HashSet};

use rayon::prelude::*;

use super::area::{Area, areas};
use super::displacement::{Effort, Measured, Probe, displacements};
use crate::compare::Frame;
pub use crate::compare::fault::Limits;
use lensrunner::judge::picture::Picture;

/// Displacements between the same surface points in the two pictures, in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Displacement {
    /// Pixels it was measured at.
    pub pixels: usize,
    /// Their mean.
    pub mean: f64,
    /// 99 of 100 are less.
    pub most: f64,
    /// The greatest.
    pub max: f64,
    /// The pixel of the greatest, column and row.
    pub worst: [u32; 2],
    /// Pixels counted apart: what they show is magnified so far that f32 cannot tell neighbours.
    pub apart: usize,
}

/// One object (all copies of a name) in one image order.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// The name.
    pub name: String,
    /// The image order.
    pub order: u32,
    /// Pixels whose centre shows it to the judge.
    pub pixels: usize,
    /// Pixels just outside of the judge's image of an object: those around it that touch it, at a side or a corner.
    pub rim: usize,
    /// Pixels in which one shows it and the other does not.
    pub mismatched: usize,
    /// Of those, the ones that are no rim: at least one pixel away from any edge.
    pub beyond_rim: usize,
    /// Where the surface points are.
    pub displacement: Displacement,
    /// Images narrower than a pixel: their area in pixels to the judge and to the contestant; or at how many pixels' centres they are, if
    /// the contestant draws them by these.
    pub thin: [f64; 2],
    /// Pixels of which they cover a part to the judge.
    pub touched: usize,
    /// Mean ꟻLIP over the judge's pixels of it.
    pub flip: f64,
}

/// All that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// By name and order.
    pub groups: Vec<Group>,
    /// Pixels that show the right object in a wrong order.
    pub wrong_order: usize,
    /// Of those, the ones where the judge sees that order nowhere within a pixel.
    pub wrong_beyond_rim: usize,
    /// Pixels without light, in the midst of others, where the judge sees a thing all around with every ray.
    pub holes: usize,
    /// Pixels with light of a thing where the judge sees the shadow all around.
    pub lit: usize,
    /// Mean ꟻLIP of the whole picture.
    pub flip: f64,
    /// Displacement at each pixel, in pixels; not a number where it was not measured.
    pub displaced: Vec<f32>,
    /// How large each image of each object is, by number and order.
    pub areas: Vec<Area>,
}

/// Compares. `probe` asks the judge between the pixels; `names` has the name of each object by number, from 1; `difference` is the ꟻLIP of
/// each pixel.
pub fn compare(judge: &Picture, frame: &Frame, probe: &dyn Probe, names: &[String], difference: &[f32]) -> Verdict {
    compare_with(judge, frame, probe, names, difference, &Effort::default())
}

/// The same with no more effort for displacements than this.
pub fn compare_with(judge: &Picture, frame: &Frame, probe: &dyn Probe, names: &[String], difference: &[f32], effort: &Effort) -> Verdict {
    let [width, height] = judge.size.map(|side| side as usize);
    let grid = Grid::of(judge.size);
    let thin = thin_images(judge, frame);
    let is_thin = |object: u32, order: u32| thin.contains(&(object, order));
    let by_centres = drawn_by_centres(frame);
    let at_centres = |object: u32, order: u32| by_centres.contains(&(object, order));
    let name = |object: u32| names.get(object as usize - 1).map_or("?", String::as_str);
    let mut tallies: BTreeMap<(&str, u32), Tally> = BTreeMap::new();
    let (mut wrong_order, mut holes) = (0, 0);
    let (mut wrong_beyond_rim, mut lit) = (Vec::new(), Vec::new());
    let mut displaced = vec![f32::NAN; width * height];
    let measured = displacements(judge, frame, probe, effort);
    for i in 0..width * height {
        let (layer, shown) = (&judge.layers[i], &frame.shown[i]);
        let around = grid.around(i);
        let at_rim = |object: u32, order: u32| {
            let same = |j: &usize| (judge.layers[*j].object, judge.layers[*j].order) == (object, order);
            let count = around.iter().filter(|j| same(j)).count();
            count > 0 && count < around.len()
        };
        let agree = layer.object == shown.object && layer.order == shown.order;
        // What a pixel shows behind or beside a thin image that is there is a matter of how much that covers, and compared so.
        let shares = |j: usize, object: u32, order: u32| judge.shares[j].iter().any(|share| (share.0, share.1) == (object, order));
        let beside_thin = if is_thin(shown.object, shown.order) {
            shown.coverage < 1.0 || around.iter().any(|&j| shares(j, shown.object, shown.order))
        } else {
            is_thin(layer.object, layer.order) && shares(i, shown.object, shown.order)
        };
        if layer.object > 0 && layer.object == shown.object && layer.order != shown.order {
            wrong_order += 1;
            let near = around.iter().any(|&j| shares(j, shown.object, shown.order));
            if !near && !beside_thin {
                wrong_beyond_rim.push(i);
            }
        }
        // Not what is seen through a slit narrower than a pixel, which some of the judge's rays go through.
        let filled = |j: usize| judge.shares[j].iter().map(|share| share.2).sum::<f32>() >= FULL;
        holes += usize::from(shown.object == 0 && around.iter().all(|&j| judge.layers[j].object > 0 && filled(j)));
        if frame.bare[i].iter().any(|c| *c > 0.0) && around.iter().all(|&j| judge.dark[j]) {
            lit.push(i);
        }
        let key = |j: usize| (judge.layers[j].object, judge.layers[j].order);
        let touched: BTreeSet<(u32, u32)> = around.iter().map(|&j| key(j)).filter(|&other| other.0 > 0 && other != key(i)).collect();
        for (object, order) in touched.into_iter().filter(|&(object, order)| !is_thin(object, order)) {
            tallies.entry((name(object), order)).or_default().rim += 1;
        }
        for &(object, order, share) in &judge.shares[i] {
            if is_thin(object, order) {
                let tally = tallies.entry((name(object), order)).or_default();
                tally.thin[0] += if at_centres(object, order) { f64::from(u8::from(key(i) == (object, order))) } else { f64::from(share) };
                tally.touched += 1;
            }
        }
        if at_centres(shown.object, shown.order) && is_thin(shown.object, shown.order) {
            tallies.entry((name(shown.object), shown.order)).or_default().thin[1] += 1.0;
        } else if shown.object > 0 && is_thin(shown.object, shown.order) {
            for ((object, order), part) in thin_parts(&judge.shares[i], (shown.object, shown.order), &is_thin) {
                tallies.entry((name(object), order)).or_default().thin[1] += f64::from(shown.coverage) * part;
            }
        }
        if layer.object > 0 && !is_thin(layer.object, layer.order) {
            let tally = tallies.entry((name(layer.object), layer.order)).or_default();
            tally.pixels += 1;
            tally.flip += f64::from(difference[i]);
            if !agree && !beside_thin {
                tally.mismatched += 1;
                tally.beyond_rim += usize::from(!at_rim(layer.object, layer.order));
            } else if agree {
                match measured[i] {
                    Some(Measured::Pixels(d)) => {
                        tally.displacements.push((d, i));
                        displaced[i] = d as f32;
                    }
                    Some(Measured::Apart) => tally.apart += 1,
                    Some(Measured::Nowhere) => tally.mismatched += 1,
                    None => {}
                }
            }
        }
        if shown.object > 0 && !agree && !beside_thin && !is_thin(shown.object, shown.order) {
            let tally = tallies.entry((name(shown.object), shown.order)).or_default();
            tally.mismatched += 1;
            tally.beyond_rim += usize::from(!at_rim(shown.object, shown.order));
        }
    }
    // What is narrower than the way between two rays is drawn a pixel wide and more, around rays that all missed it.
    let lit = confirmed(&lit, |i| all_around(grid.place(i), |x, y| probe.is_dark(x, y)));
    let wrong_beyond_rim = confirmed(&wrong_beyond_rim, |i| {
        let shown = &frame.shown[i];
        all_around(grid.place(i), |x, y| probe.at(x, y).is_none_or(|point| (point.object, point.order) != (shown.object, shown.order)))
    });
    let groups = tallies.into_iter().map(|((name, order), tally)| tally.group(name, order, width)).collect();
    let flip = difference.iter().map(|d| f64::from(*d)).sum::<f64>() / difference.len().max(1) as f64;
    let areas = areas(judge, frame, names, &is_thin);
    Verdict { groups, wrong_order, wrong_beyond_rim, holes, lit, flip, displaced, areas }
}

/// Doubtful pixels that are looked at again; there are more only where a picture is wrong anyway.
const MOST_DOUBTED: usize = 32;
/// Rays along each side of a pixel then: an image a hundredth of a pixel wide that crosses three of them is met by seven in the mean.
const DOUBT: u32 = 15;

/// How many of these pixels are as wrong as they seem when they are looked at again.
fn confirmed(pixels: &[usize], is_wrong: impl Fn(usize) -> bool + Sync) -> usize {
    let again = pixels.len().min(MOST_DOUBTED);
    pixels.len() - again + pixels[..again].par_iter().filter(|&&i| is_wrong(i)).count()
}

/// Whether this holds for many rays through a pixel, of which the upper left corner is given, and those around it.
fn all_around([x, y]: [f64; 2], holds: impl Fn(f64, f64) -> bool) -> bool {
    let step = |k: u32| (f64::from(k) + 0.5) / f64::from(DOUBT) - 1.0;
    (0..3 * DOUBT).all(|row| (0..3 * DOUBT).all(|column| holds(x + step(column), y + step(row))))
}

/// Objects and orders that are compared by the area they cover: those that nowhere fill a pixel to the judge; and those that the contestant
/// draws by coverage, if they hardly do: they fill a single pixel, or, drawn out along the ring, an image may be narrow and yet fill a
/// pixel here and there.
fn thin_images(judge: &Picture, frame: &Frame) -> HashSet<(u32, u32)> {
    // Pixels touched and pixels filled.
    let mut counts: BTreeMap<(u32, u32), [usize; 2]> = BTreeMap::new();
    for &(object, order, share) in judge.shares.iter().flatten() {
        let [touched, filled] = counts.entry((object, order)).or_default();
        *touched += 1;
        *filled += usize::from(share >= FULL);
    }
    let nowhere = counts.iter().filter(|(_, [_, filled])| *filled == 0).map(|(key, _)| *key);
    let by_coverage = frame.shown.iter().filter(|shown| shown.object > 0 && shown.coverage < 1.0).map(|shown| (shown.object, shown.order));
    // What not one sample of the judge has met is narrow for sure.
    let hardly = by_coverage.filter(|key| counts.get(key).is_none_or(|[touched, filled]| *filled <= FEW || MOSTLY * filled < *touched));
    nowhere.chain(hardly).collect()
}

/// Objects and orders that the contestant shows, and nowhere by coverage. It shows what it meets at the centre of each pixel, so that a
/// line along a row of pixels is there in all of them or in none: the judge's single rays tell whether it is right, and more rays do not.
fn drawn_by_centres(frame: &Frame) -> HashSet<(u32, u32)> {
    let images = |by_coverage: bool| {
        let drawn = move |coverage: f32| (coverage < 1.0) == by_coverage;
        frame.shown.iter().filter(move |shown| shown.object > 0 && drawn(shown.coverage)).map(|shown| (shown.object, shown.order))
    };
    let by_coverage: HashSet<_> = images(true).collect();
    images(false).filter(|image| !by_coverage.contains(image)).collect()
}

/// What fills no more pixels than this is nowhere two pixels wide.
const FEW: usize = 1;
/// One in so many pixels filled is still narrow: of a line one pixel wide, across any grid, none to a third is.
const MOSTLY: usize = 3;

#[derive(Default)]
struct Tally {
    pixels: usize,
    rim: usize,
    mismatched: usize,
    beyond_rim: usize,
    /// Each with its pixel.
    displacements: Vec<(f64, usize)>,
    apart: usize,
    thin: [f64; 2],
    touched: usize,
    flip: f64,
}

impl Tally {
    fn group(mut self, name: &str, order: u32, width: usize) -> Group {
        self.displacements.sort_by(|a, b| a.0.total_cmp(&b.0));
        let d = &self.displacements;
        let count = d.len();
        let displacement = Displacement {
            pixels: count,
            // The sum of nothing is −0.
            mean: (d.iter().map(|d| d.0).sum::<f64>() + 0.0) / count.max(1) as f64,
            most: d.get((count * 99 / 100).min(count.saturating_sub(1))).map_or(0.0, |d| d.0),
            max: d.last().map_or(0.0, |d| d.0),
            worst: d.last().map_or([0; 2], |d| [(d.1 % width) as u32, (d.1 / width) as u32]),
            apart: self.apart,
        };
        Group {
            name: name.into(),
            order,
            pixels: self.pixels,
            rim: self.rim,
            mismatched: self.mismatched,
            beyond_rim: self.beyond_rim,
            displacement,
            thin: self.thin,
            touched: self.touched,
            flip: self.flip / self.pixels.max(1) as f64,
        }
    }
}
