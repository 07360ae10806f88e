//! How far a picture is from the judge's.

use super::grid::{FULL, Grid};
use std::collections::{BTreeMap, BTreeSet, HashSet};

use rayon::prelude::*;

use super::area::{Area, areas};
use super::displacement::{Effort, Measured, Probe, displacements};
use super::drawn::{drawn_by_centres, drawn_by_coverage};
use super::light::Light;
pub use crate::compare::fault::Limits;
use crate::compare::{ContestantFrame, Shown};
use lensrunner::judge::picture::TracedPicture;

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
    /// Thin images: their area in pixels to the judge and to the contestant; or at how many pixels' centres they are, if
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
    /// How bright, where that is judged.
    pub lights: Vec<Light>,
}

/// Compares. `probe` asks the judge between the pixels; `names` has the name of each object by number, from 1; `difference` is the ꟻLIP of
/// each pixel.
pub fn compare(judge: &TracedPicture, frame: &ContestantFrame, probe: &dyn Probe, names: &[String], difference: &[f32]) -> Verdict {
    compare_with(judge, frame, probe, names, difference, &Effort::default())
}

/// The same with no more effort for displacements than this.
pub fn compare_with(
    judge: &TracedPicture,
    frame: &ContestantFrame,
    probe: &dyn Probe,
    names: &[String],
    difference: &[f32],
    effort: &Effort,
) -> Verdict {
    let [width, height] = judge.size.map(|side| side as usize);
    let pair = Pair::new(judge, frame, names);
    let measured = displacements(judge, frame, probe, effort);
    let mut found = Found { displaced: vec![f32::NAN; width * height], ..Found::default() };
    for i in 0..width * height {
        let pixel = pair.pixel(i);
        found.count_wrong_order(&pair, &pixel);
        found.count_wrong_light(&pair, &pixel);
        found.count_rims(&pair, &pixel);
        found.count_thin(&pair, &pixel);
        found.count_misplaced(&pair, &pixel);
        found.count_judged(&pair, &pixel, difference, &measured);
        found.count_shown(&pair, &pixel);
    }
    // What is narrower than the way between two rays is drawn a pixel wide and more, around rays that all missed it.
    let lit = confirmed(&found.lit, |i| all_around(pair.grid.place(i), |x, y| probe.is_dark(x, y))).len();
    let wrong_beyond_rim = confirmed(&found.wrong_beyond_rim, |i| {
        let shown = frame.shown[i].image();
        all_around(pair.grid.place(i), |x, y| probe.at(x, y).is_none_or(|point| (point.object, point.order) != shown))
    })
    .len();
    for i in confirmed(&found.misplaced, |i| {
        let shown = frame.shown[i].image();
        all_around(pair.grid.place(i), |x, y| probe.at(x, y).is_none_or(|point| (point.object, point.order) != shown))
    }) {
        found.tally(&pair, frame.shown[i].image()).mismatch(false);
    }
    let groups = found.tallies.into_iter().map(|((name, order), tally)| tally.group(name, order, width)).collect();
    let flip = difference.iter().map(|d| f64::from(*d)).sum::<f64>() / difference.len().max(1) as f64;
    let areas = areas(judge, frame, names, &|object, order| pair.is_thin((object, order)) && !pair.by_centres.contains(&(object, order)));
    let lights = Vec::new();
    Verdict {
        groups,
        wrong_order: found.wrong_order,
        wrong_beyond_rim,
        holes: found.holes,
        lit,
        flip,
        displaced: found.displaced,
        areas,
        lights,
    }
}

/// One image of an object: the object's number, from 1, or 0 for none, and the image order.
type Image = (u32, u32);

/// Both pictures, and how their images are compared.
struct Pair<'a> {
    judge: &'a TracedPicture,
    frame: &'a ContestantFrame,
    names: &'a [String],
    grid: Grid,
    /// Images that are compared by the area they cover.
    thin: HashSet<Image>,
    /// Images that the contestant draws by pixels' centres.
    by_centres: HashSet<Image>,
}

/// A pixel of both pictures.
struct Pixel<'a> {
    i: usize,
    /// The pixel and those around it.
    around: Vec<usize>,
    /// What the judge sees at its centre.
    judged: Image,
    /// What the contestant shows.
    shown: &'a Shown,
    /// Whether both show the same.
    agree: bool,
    /// Whether it shows a thin image that is there, or what is behind or beside one: that is a matter of how much the image covers, and
    /// compared so.
    beside_thin: bool,
}

impl<'a> Pair<'a> {
    fn new(judge: &'a TracedPicture, frame: &'a ContestantFrame, names: &'a [String]) -> Pair<'a> {
        let grid = Grid::of(judge.size);
        let (thin, by_centres) = (thin_images(judge, frame, &grid), drawn_by_centres(frame));
        Pair { judge, frame, names, grid, thin, by_centres }
    }

    fn pixel(&self, i: usize) -> Pixel<'a> {
        let around = self.grid.around(i);
        let (judged, shown) = (self.judged(i), &self.frame.shown[i]);
        let beside_thin = if self.is_thin(shown.image()) {
            shown.coverage < 1.0 || around.iter().any(|&j| self.has_share(j, shown.image()))
        } else {
            self.is_thin(judged) && self.has_share(i, shown.image())
        };
        Pixel { i, around, judged, shown, agree: judged == shown.image(), beside_thin }
    }

    fn is_thin(&self, image: Image) -> bool {
        self.thin.contains(&image)
    }

    /// Whether the image is thin and drawn by pixels' centres.
    fn is_thin_by_centres(&self, image: Image) -> bool {
        self.by_centres.contains(&image) && self.is_thin(image)
    }

    /// What the judge sees at the centre of a pixel.
    fn judged(&self, i: usize) -> Image {
        (self.judge.layers[i].object, self.judge.layers[i].order)
    }

    /// Whether the judge sees the image in a part of a pixel.
    fn has_share(&self, i: usize, image: Image) -> bool {
        self.judge.shares[i].iter().any(|share| (share.0, share.1) == image)
    }

    /// Whether the judge sees things in all of a pixel. It does not in a slit narrower than a pixel, which some of its rays go through.
    fn is_filled(&self, i: usize) -> bool {
        self.judge.shares[i].iter().map(|share| share.2).sum::<f32>() >= FULL
    }

    /// Whether an edge of the judge's image is at a pixel: it sees the image at some of the pixels around, but not at all.
    fn is_at_rim(&self, pixel: &Pixel, image: Image) -> bool {
        let count = pixel.around.iter().filter(|&&j| self.judged(j) == image).count();
        count > 0 && count < pixel.around.len()
    }

    /// What a tally is kept under: the object's name and the image order.
    fn key(&self, (object, order): Image) -> (&'a str, u32) {
        (self.names.get(object as usize - 1).map_or("?", String::as_str), order)
    }
}

/// What is found pixel by pixel.
#[derive(Default)]
struct Found<'a> {
    tallies: BTreeMap<(&'a str, u32), Tally>,
    wrong_order: usize,
    /// Pixels with an order that the judge does not seem to see within a pixel.
    wrong_beyond_rim: Vec<usize>,
    holes: usize,
    /// Pixels with light where the judge seems to see the shadow all around.
    lit: Vec<usize>,
    /// Pixels that a thin image covers to a good part, and that the judge does not seem to see it near.
    misplaced: Vec<usize>,
    displaced: Vec<f32>,
}

impl<'a> Found<'a> {
    fn tally(&mut self, pair: &Pair<'a>, image: Image) -> &mut Tally {
        self.tallies.entry(pair.key(image)).or_default()
    }

    /// Counts the right object in a wrong order.
    fn count_wrong_order(&mut self, pair: &Pair<'a>, pixel: &Pixel) {
        let (object, order) = pixel.judged;
        if object == 0 || object != pixel.shown.object || order == pixel.shown.order {
            return;
        }
        self.wrong_order += 1;
        let near = pixel.around.iter().any(|&j| pair.has_share(j, pixel.shown.image()));
        if !near && !pixel.beside_thin {
            self.wrong_beyond_rim.push(pixel.i);
        }
    }

    /// Counts holes in things, and light in the shadow.
    fn count_wrong_light(&mut self, pair: &Pair<'a>, pixel: &Pixel) {
        let is_hole = pixel.shown.object == 0 && pixel.around.iter().all(|&j| pair.judge.layers[j].object > 0 && pair.is_filled(j));
        self.holes += usize::from(is_hole);
        if pair.frame.bare[pixel.i].iter().any(|c| *c > 0.0) && pixel.around.iter().all(|&j| pair.judge.dark[j]) {
            self.lit.push(pixel.i);
        }
    }

    /// Counts the pixel to the rim of each image that touches it.
    fn count_rims(&mut self, pair: &Pair<'a>, pixel: &Pixel) {
        let touching = pixel.around.iter().map(|&j| pair.judged(j)).filter(|&image| image.0 > 0 && image != pixel.judged);
        for image in touching.collect::<BTreeSet<Image>>() {
            if !pair.is_thin(image) {
                self.tally(pair, image).rim += 1;
            }
        }
    }

    /// Adds up the areas of thin images.
    fn count_thin(&mut self, pair: &Pair<'a>, pixel: &Pixel) {
        for &(object, order, share) in &pair.judge.shares[pixel.i] {
            let image = (object, order);
            if pair.is_thin(image) {
                let tally = self.tally(pair, image);
                let is_at_centre = || f64::from(u8::from(pixel.judged == image));
                tally.thin[0] += if pair.is_thin_by_centres(image) { is_at_centre() } else { f64::from(share) };
                tally.touched += 1;
            }
        }
        let shown = pixel.shown.image();
        if pair.is_thin_by_centres(shown) {
            self.tally(pair, shown).thin[1] += 1.0;
        } else if pixel.shown.object > 0 && pair.is_thin(shown) {
            let is_thin = |object: u32, order: u32| pair.is_thin((object, order)) && !pair.by_centres.contains(&(object, order));
            for (image, part) in pair.grid.thin_parts(&pair.judge.shares, pixel.i, shown, &is_thin) {
                self.tally(pair, image).thin[1] += f64::from(pixel.shown.coverage) * part;
            }
        }
    }

    /// Counts thin images that are not near where the judge sees them. What they cover of a pixel is compared over the whole picture alone.
    fn count_misplaced(&mut self, pair: &Pair<'a>, pixel: &Pixel) {
        let shown = pixel.shown.image();
        let is_there = pixel.shown.object > 0 && pair.is_thin(shown) && pixel.shown.coverage > FAINT;
        if is_there && !pixel.around.iter().any(|&j| pair.has_share(j, shown)) {
            self.misplaced.push(pixel.i);
        }
    }

    /// Compares what the judge sees, given ꟻLIP and displacement of all pixels.
    fn count_judged(&mut self, pair: &Pair<'a>, pixel: &Pixel, difference: &[f32], measured: &[Option<Measured>]) {
        if pixel.judged.0 == 0 || pair.is_thin(pixel.judged) {
            return;
        }
        let tally = self.tally(pair, pixel.judged);
        tally.pixels += 1;
        tally.flip += f64::from(difference[pixel.i]);
        if pixel.agree {
            match measured[pixel.i] {
                Some(Measured::Pixels(d)) => {
                    tally.displacements.push((d, pixel.i));
                    self.displaced[pixel.i] = d as f32;
                }
                Some(Measured::Apart) => tally.apart += 1,
                Some(Measured::Nowhere) => tally.mismatched += 1,
                None => {}
            }
        } else if !pixel.beside_thin {
            tally.mismatch(pair.is_at_rim(pixel, pixel.judged));
        }
    }

    /// Counts what is shown and should not be.
    fn count_shown(&mut self, pair: &Pair<'a>, pixel: &Pixel) {
        let shown = pixel.shown.image();
        if pixel.shown.object > 0 && !pixel.agree && !pixel.beside_thin && !pair.is_thin(shown) {
            self.tally(pair, shown).mismatch(pair.is_at_rim(pixel, shown));
        }
    }
}

/// Doubtful pixels that are looked at again; there are more only where a picture is wrong anyway.
const MOST_DOUBTED: usize = 32;
/// Rays along each side of a pixel then: an image a hundredth of a pixel wide that crosses three of them is met by seven in the mean.
const DOUBT: u32 = 15;

/// Those of these pixels that are as wrong as they seem when they are looked at again.
fn confirmed(pixels: &[usize], is_wrong: impl Fn(usize) -> bool + Sync) -> Vec<usize> {
    let (again, others) = pixels.split_at(pixels.len().min(MOST_DOUBTED));
    again.par_iter().copied().filter(|&i| is_wrong(i)).chain(others.par_iter().copied()).collect()
}

/// Whether this holds for many rays through a pixel, of which the upper left corner is given, and those around it.
fn all_around([x, y]: [f64; 2], holds: impl Fn(f64, f64) -> bool) -> bool {
    let step = |k: u32| (f64::from(k) + 0.5) / f64::from(DOUBT) - 1.0;
    (0..3 * DOUBT).all(|row| (0..3 * DOUBT).all(|column| holds(x + step(column), y + step(row))))
}

/// Objects and orders that are compared by the area they cover: those that nowhere fill a pixel to the judge; and those that the contestant
/// draws by coverage, if they hardly do: they fill a single pixel, or, drawn out along the ring, an image may be narrow and yet fill a
/// pixel here and there, but not those around it too.
fn thin_images(judge: &TracedPicture, frame: &ContestantFrame, grid: &Grid) -> HashSet<Image> {
    // Pixels touched and pixels filled.
    let mut counts: BTreeMap<Image, [usize; 2]> = BTreeMap::new();
    let mut wide: HashSet<Image> = HashSet::new();
    for (i, shares) in judge.shares.iter().enumerate() {
        for &(object, order, share) in shares {
            let image = (object, order);
            let [touched, filled] = counts.entry(image).or_default();
            *touched += 1;
            *filled += usize::from(share >= FULL);
            let fills = |j: usize| judge.shares[j].iter().any(|share| (share.0, share.1) == image && share.2 >= FULL);
            if share >= FULL && !wide.contains(&image) && grid.around(i).into_iter().all(fills) {
                wide.insert(image);
            }
        }
    }
    let nowhere = counts.iter().filter(|(_, [_, filled])| *filled == 0).map(|(key, _)| *key);
    // What not one sample of the judge has met is narrow for sure.
    let is_rare = |[touched, filled]: &[usize; 2]| *filled <= FEW || MOSTLY * filled < *touched;
    let hardly = drawn_by_coverage(frame).into_iter().filter(|key| !wide.contains(key) || counts.get(key).is_none_or(is_rare));
    nowhere.chain(hardly).collect()
}

/// A thin image may be anywhere in the pixels that it covers less of than this: what is so narrow may lie between the judge's rays.
const FAINT: f32 = 0.1;
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
    /// One shows the image at a pixel and the other does not.
    fn mismatch(&mut self, is_at_rim: bool) {
        self.mismatched += 1;
        self.beyond_rim += usize::from(!is_at_rim);
    }

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
