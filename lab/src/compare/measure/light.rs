//! The light that each image of each object adds to the picture, to the judge and as it is shown.
//!
//! Where an image is wide both look through the centres of pixels, so their sums are set side by side as they are; if they differ too much,
//! a texture may be finer than the pixels. There, and where an image is narrow, a single ray tells nothing: the judge looks through places
//! drawn at random, in rounds that do not know of each other, and the scatter of the rounds is its noise. It goes on for as long as that
//! leaves a doubt.

use std::collections::{BTreeMap, BTreeSet, HashSet};

use glam::DVec3;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

use super::drawn::{drawn_by_centres, drawn_by_coverage};
use super::grid::Grid;
use super::probe::LightProbe;
use crate::compare::ContestantFrame;
use crate::compare::deadline::Deadline;
use crate::compare::fault::{Fault, Kind, Limits};
use lensrunner::judge::picture::TracedPicture;

/// An image: the number of the thing, from 1, and the order.
type Image = (u32, u32);

/// The light of one image of one object.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// The object's number, from 1, and the image order, or [`TOGETHER`].
    pub image: (u32, u32),
    /// The object's name.
    pub name: String,
    /// Linear RGB, summed over pixels: to the judge.
    pub judge: DVec3,
    /// The same, but by the judge's rays through pixels' centres wherever the image may be drawn by these.
    pub by_centres: DVec3,
    /// The same as it is shown.
    pub shown: DVec3,
    /// Standard deviation of the judge's sums.
    pub noise: DVec3,
    /// What of it is shown in pixels with thin images of the same object of other orders: how that is shared is not known.
    pub mixed: DVec3,
    /// Standard deviation of a right picture's sums that shows by one ray a pixel what may be drawn so.
    pub one_ray: DVec3,
    /// The light of the whole picture.
    pub picture: DVec3,
}

/// Stands for all orders of an object together, where some are mixed.
pub const TOGETHER: u32 = 0;
/// How much of what is mixed may be shared otherwise: thin images are drawn a pixel wide.
const MIXED: f64 = 0.1;

/// An image that adds less than this part of the picture's light is not judged by its light.
const LEAST_PART: f64 = 0.01;
/// A channel counts as if it had at least this part of the strongest one: what a red-shifted image has of blue is nothing to be seen.
const LEAST_CHANNEL: f64 = 0.1;

impl Light {
    /// By how much the sums may differ.
    fn allowed(&self, limits: &Limits) -> DVec3 {
        let strongest = self.judge.max_element();
        let sum = self.judge.max(DVec3::splat(LEAST_CHANNEL * strongest));
        (sum * limits.light).max(limits.thin * root(self.noise, self.one_ray)) + self.mixed * MIXED
    }

    /// How far it is off, in units of what is allowed. The judge's own rays through pixels' centres meet the same parts as a picture that is
    /// drawn by these: against them no chance is allowed.
    fn excess(&self, limits: &Limits) -> f64 {
        let off = |judge: &Light| {
            let allowed = judge.allowed(limits).max(DVec3::splat(1e-12));
            ((self.shown - judge.judge).abs() / allowed).max_element()
        };
        off(self).min(off(&Light { judge: self.by_centres, one_ray: DVec3::ZERO, ..self.clone() }))
    }

    /// Whether it is a part of the picture's light that counts.
    fn counts(&self) -> bool {
        self.judge.max(self.shown).element_sum() > LEAST_PART * self.picture.element_sum()
    }

    /// Its name in words.
    pub fn who(&self) -> String {
        let Light { name, image: (_, order), .. } = self;
        if *order == TOGETHER { format!("{name}, all orders") } else { format!("{name} order {order}") }
    }

    /// What is wrong with it; None if nothing is.
    pub fn fault(&self, limits: &Limits) -> Option<Fault> {
        let excess = self.excess(limits);
        (self.counts() && excess > 1.0).then(|| {
            let allowed = self.allowed(limits);
            let off = (self.shown - self.judge).abs() / allowed.max(DVec3::splat(1e-12));
            let channel = (0..3).max_by(|a, b| off[*a].total_cmp(&off[*b])).unwrap_or(0);
            let [shown, judge, allowed] = [self.shown, self.judge, allowed].map(|light| light[channel]);
            let percent = 100.0 * allowed / judge.max(1e-12);
            let (who, colour) = (self.who(), ["red", "green", "blue"][channel]);
            let text = format!("{who}: {colour} light of {shown:.4}, not {judge:.4} (give or take {percent:.0} %)");
            Fault::new(Kind::Light, excess, 1.0, text)
        })
    }

    /// Whether more rays might change the verdict: it is off by more than the limit, and not clearly within or beyond the judge's noise.
    fn is_doubtful(&self, limits: &Limits) -> bool {
        let sure = Light { noise: self.noise * SURE, ..self.clone() };
        let exact = Light { noise: DVec3::ZERO, ..self.clone() };
        self.counts() && exact.excess(limits) > 1.0 && sure.excess(limits) <= 1.0
    }
}

/// A picture is beyond a limit for sure that is so with so many times the noise, itself known from few rounds.
const SURE: f64 = 2.0;
/// Rays along each side of a pixel in a round, each through a place at random in its part of the pixel.
const SIDE: u32 = 2;
/// Rounds at first, at least: their scatter is the noise.
pub const LEAST_ROUNDS: u32 = 2;
/// Most rounds: 512 rays a pixel.
const MOST_ROUNDS: u32 = 128;
/// Most rays for a picture.
const MOST_RAYS: usize = 400_000;
/// An image that covers more than this of the nine pixels around may be drawn by pixels' centres: a line half a pixel wide does.
const HALF_A_PIXEL_WIDE: f64 = 1.5;

/// Adds the images' light up. `names` has the name of each object by number, from 1; narrow images are looked at in so many `rounds` at
/// first. Ends at the deadline, with the noise that is left.
pub fn lights(
    judge: &TracedPicture,
    frame: &ContestantFrame,
    probe: &dyn LightProbe,
    names: &[String],
    limits: &Limits,
    rounds: u32,
    deadline: &Deadline,
) -> Vec<Light> {
    let pair = Pair::new(judge, frame);
    let mut sampled = pair.look_closely(probe, rounds.max(LEAST_ROUNDS), deadline);
    loop {
        let lights = pair.add_up(&sampled, names);
        // The centres of pixels tell little of a texture that is finer than they.
        let faulty: BTreeSet<Image> = lights.iter().filter(|light| light.fault(limits).is_some()).map(|light| light.image).collect();
        let is_faulty = |image: Image| faulty.contains(&image) || faulty.contains(&(image.0, TOGETHER));
        let of_faulty = (0..judge.layers.len()).filter(|i| is_faulty(pair.judged(*i))).flat_map(|i| pair.grid.around(i));
        let unseen: BTreeSet<usize> = of_faulty.filter(|i| !sampled.contains_key(i)).collect();
        let spent: u32 = sampled.values().map(|pixel| pixel.rounds * SIDE * SIDE).sum();
        let first = rounds.max(LEAST_ROUNDS);
        if !unseen.is_empty() && spent as usize + unseen.len() * (first * SIDE * SIDE) as usize <= MOST_RAYS && !deadline.is_over() {
            sampled.extend(unseen.into_par_iter().map(|i| (i, pair.rounds(probe, i, 0, first))).collect::<Vec<_>>());
            continue;
        }
        let doubtful: BTreeSet<Image> = lights.iter().filter(|light| light.is_doubtful(limits)).map(|light| light.image).collect();
        let is_doubtful = |image: Image| doubtful.contains(&image) || doubtful.contains(&(image.0, TOGETHER));
        let again: Vec<usize> = sampled
            .iter()
            .filter(|(i, pixel)| pixel.rounds < MOST_ROUNDS && pair.images_at(**i, pixel).any(is_doubtful))
            .map(|(i, _)| *i)
            .collect();
        let rays: usize = sampled.values().map(|pixel| (pixel.rounds * SIDE * SIDE) as usize).sum();
        if again.is_empty() || rays > MOST_RAYS || deadline.is_over() {
            return lights;
        }
        let more: Vec<_> = again.into_par_iter().map(|i| (i, pair.rounds(probe, i, sampled[&i].rounds, sampled[&i].rounds))).collect();
        for (i, pixel) in more {
            if let Some(before) = sampled.get_mut(&i) {
                before.add(pixel);
            }
        }
    }
}

/// What rounds of rays through a pixel have met.
#[derive(Clone, Debug, Default)]
struct Sampled {
    rounds: u32,
    met: BTreeMap<Image, Met>,
}

/// An image in a pixel: sums over rounds.
#[derive(Clone, Copy, Debug, Default)]
struct Met {
    /// The part of the rays that meet it.
    part: f64,
    /// The light that it adds, of all rays.
    light: DVec3,
    /// The squares of that.
    squares: DVec3,
    /// The squares of the light of single rays.
    ray_squares: DVec3,
}

impl Sampled {
    fn add(&mut self, more: Sampled) {
        self.rounds += more.rounds;
        for (image, met) in more.met {
            let sum = self.met.entry(image).or_default();
            (sum.part, sum.light) = (sum.part + met.part, sum.light + met.light);
            (sum.squares, sum.ray_squares) = (sum.squares + met.squares, sum.ray_squares + met.ray_squares);
        }
    }

    fn part(&self, image: Image) -> f64 {
        self.met.get(&image).map_or(0.0, |met| met.part / f64::from(self.rounds))
    }

    fn light(&self, image: Image) -> DVec3 {
        self.met.get(&image).map_or(DVec3::ZERO, |met| met.light / f64::from(self.rounds))
    }

    /// The variance of the light of one ray.
    fn ray_variance(&self, image: Image) -> DVec3 {
        let mean = self.light(image);
        self.met.get(&image).map_or(DVec3::ZERO, |met| (met.ray_squares / f64::from(self.rounds) - mean * mean).max(DVec3::ZERO))
    }

    /// The variance of the mean of all.
    fn variance(&self, image: Image) -> DVec3 {
        let rounds = f64::from(self.rounds);
        self.met.get(&image).map_or(DVec3::ZERO, |met| {
            let mean = met.light / rounds;
            ((met.squares / rounds - mean * mean) / (rounds - 1.0).max(1.0)).max(DVec3::ZERO)
        })
    }
}

/// Both pictures, and where images are wide.
struct Pair<'a> {
    judge: &'a TracedPicture,
    frame: &'a ContestantFrame,
    grid: Grid,
    /// The image that the judge sees in a pixel and all those around it.
    core: Vec<Option<Image>>,
    /// Images that are wide at most of their pixels: narrow are their tips alone, which pixels' centres may meet or miss.
    wide: BTreeSet<Image>,
    /// Images that the contestant draws by pixels' centres, and those that it draws by coverage.
    by_centres: HashSet<Image>,
    by_coverage: HashSet<Image>,
}

impl<'a> Pair<'a> {
    fn new(judge: &'a TracedPicture, frame: &'a ContestantFrame) -> Pair<'a> {
        let grid = Grid::of(judge.size);
        let image = |i: usize| (judge.layers[i].object, judge.layers[i].order);
        let core = (0..judge.layers.len())
            .map(|i| Some(image(i)).filter(|image_here| image_here.0 > 0 && grid.around(i).iter().all(|&j| image(j) == *image_here)))
            .collect();
        let mut pair = Pair {
            judge,
            frame,
            grid,
            core,
            wide: BTreeSet::new(),
            by_centres: drawn_by_centres(frame),
            by_coverage: drawn_by_coverage(frame),
        };
        let mut counts: BTreeMap<Image, [usize; 2]> = BTreeMap::new();
        for i in (0..judge.layers.len()).filter(|&i| image(i).0 > 0) {
            let [all, wide] = counts.entry(image(i)).or_default();
            (*all, *wide) = (*all + 1, *wide + usize::from(pair.is_wide(i, image(i))));
        }
        pair.wide = counts.into_iter().filter(|(_, [all, wide])| 2 * wide > *all).map(|(image, _)| image).collect();
        pair
    }

    fn judged(&self, i: usize) -> Image {
        (self.judge.layers[i].object, self.judge.layers[i].order)
    }

    /// Whether the image is wide at a pixel: in one beside it the judge sees it all around.
    fn is_wide(&self, i: usize, image: Image) -> bool {
        self.grid.around(i).iter().any(|&j| self.core[j] == Some(image))
    }

    /// Whether one ray tells too little of what either shows at a pixel.
    fn is_narrow(&self, i: usize) -> bool {
        let (judged, shown) = (self.judged(i), &self.frame.shown[i]);
        (judged.0 > 0 && !self.is_wide(i, judged)) || (shown.object > 0 && (shown.coverage < 1.0 || !self.is_wide(i, shown.image())))
    }

    /// Some rounds for each pixel that a narrow image touches or may touch: from those in which either picture shows one on to their
    /// neighbours as long as the judge meets it there.
    fn look_closely(&self, probe: &dyn LightProbe, rounds: u32, deadline: &Deadline) -> BTreeMap<usize, Sampled> {
        let count = self.judge.layers.len();
        let mut next: BTreeSet<usize> = (0..count).filter(|&i| self.is_narrow(i)).flat_map(|i| self.grid.around(i)).collect();
        let mut found: BTreeMap<usize, Sampled> = BTreeMap::new();
        while !next.is_empty() {
            let looked: Vec<_> =
                next.into_par_iter().filter(|_| !deadline.is_over()).map(|i| (i, self.rounds(probe, i, 0, rounds))).collect();
            let met = looked.iter().filter(|(i, pixel)| pixel.met.keys().any(|image| !self.is_wide(*i, *image)));
            next = met.flat_map(|(i, _)| self.grid.around(*i)).collect();
            found.extend(looked);
            next.retain(|i| !found.contains_key(i));
        }
        // Where only wide images are met the centre tells all.
        found.retain(|i, pixel| self.is_narrow(*i) || pixel.met.keys().any(|image| !self.is_wide(*i, *image)));
        found
    }

    /// So many rounds of rays through a pixel, of which there have been `before`.
    fn rounds(&self, probe: &dyn LightProbe, i: usize, before: u32, rounds: u32) -> Sampled {
        let [x, y] = self.grid.place(i);
        let mut sampled = Sampled { rounds, ..Sampled::default() };
        for round in before..before + rounds {
            let mut chance = StdRng::seed_from_u64((i as u64) << 32 | u64::from(round));
            let mut met: BTreeMap<Image, (f64, DVec3, DVec3)> = BTreeMap::new();
            for k in 0..SIDE * SIDE {
                let [across, down] = [k % SIDE, k / SIDE].map(|step| (f64::from(step) + chance.random::<f64>()) / f64::from(SIDE));
                if let Some(lit) = probe.lit(x + across, y + down) {
                    let (part, light, ray_squares) = met.entry(lit.image).or_default();
                    let (weight, here) = (1.0 / f64::from(SIDE * SIDE), lit.light.as_dvec3());
                    (*part, *light, *ray_squares) = (*part + weight, *light + here * weight, *ray_squares + here * here * weight);
                }
            }
            for (image, (part, light, ray_squares)) in met {
                let sum = sampled.met.entry(image).or_default();
                (sum.part, sum.light) = (sum.part + part, sum.light + light);
                (sum.squares, sum.ray_squares) = (sum.squares + light * light, sum.ray_squares + ray_squares);
            }
        }
        sampled
    }

    /// What is in a pixel to either.
    fn images_at<'s>(&self, i: usize, pixel: &'s Sampled) -> impl Iterator<Item = Image> + use<'s> {
        let shown = Some(self.frame.shown[i].image()).filter(|image| image.0 > 0);
        pixel.met.keys().copied().chain(shown)
    }

    fn add_up(&self, sampled: &BTreeMap<usize, Sampled>, names: &[String]) -> Vec<Light> {
        let picture = self.judge.light.iter().map(|rgb| vector(*rgb)).sum();
        let mut found: BTreeMap<Image, Light> = BTreeMap::new();
        let mut of = |image: Image, change: &dyn Fn(&mut Light)| {
            let name = || names.get((image.0 as usize).wrapping_sub(1)).cloned().unwrap_or_else(|| "?".into());
            let zero = DVec3::ZERO;
            let new = || Light {
                image,
                name: name(),
                judge: zero,
                by_centres: zero,
                shown: zero,
                noise: zero,
                one_ray: zero,
                mixed: zero,
                picture,
            };
            change(found.entry(image).or_insert_with(new));
        };
        let mut least: BTreeMap<Image, DVec3> = BTreeMap::new();
        for i in 0..self.judge.layers.len() {
            let layer = &self.judge.layers[i];
            let Some(pixel) = sampled.get(&i) else {
                if layer.object > 0 {
                    of((layer.object, layer.order), &|light| {
                        light.judge += vector(layer.light);
                        light.by_centres += vector(layer.light);
                    });
                }
                if self.frame.shown[i].object > 0 {
                    of(self.frame.shown[i].image(), &|light| light.shown += vector(self.frame.surfaces[i]));
                }
                continue;
            };
            let parts = self.shown_parts(i, sampled);
            let is_mixed =
                |image: Image| self.frame.shown[i].coverage < 1.0 && parts.iter().any(|(other, _)| other.0 == image.0 && *other != image);
            for &(image, part) in &parts {
                // What no ray has met may still be there: of one ray's light nothing is known.
                let one = part / f64::from(self.frame.shown[i].coverage).max(1e-3) / f64::from(pixel.rounds * SIDE * SIDE);
                let mixed = if is_mixed(image) { part } else { DVec3::ZERO };
                of(image, &|light| (light.shown, light.mixed) = (light.shown + part, light.mixed + mixed));
                let least = least.entry(image).or_default();
                *least = one.max(*least);
            }
            for image in self.images_at(i, pixel).collect::<BTreeSet<Image>>() {
                let is_by_centre = self.may_be_by_centre(i, image, sampled);
                let at_centre = if self.judged(i) == image { vector(layer.light) } else { DVec3::ZERO };
                of(image, &|light| {
                    light.judge += pixel.light(image);
                    light.by_centres += if is_by_centre { at_centre } else { pixel.light(image) };
                    // Kept as variances for now.
                    light.noise += pixel.variance(image);
                    light.one_ray += if is_by_centre { pixel.ray_variance(image) } else { DVec3::ZERO };
                });
            }
        }
        for (image, light) in &mut found {
            let least = least.get(image).copied().unwrap_or_default();
            (light.noise, light.one_ray) = ((light.noise + least * least).map(f64::sqrt), light.one_ray.map(f64::sqrt));
        }
        let together = together(found.values());
        found.into_values().chain(together).collect()
    }

    /// Whether an image may be drawn by a pixel's centre: by coverage it nowhere is, and it is at least half a pixel wide there.
    fn may_be_by_centre(&self, i: usize, image: Image, sampled: &BTreeMap<usize, Sampled>) -> bool {
        let around = || self.grid.around(i).into_iter().map(|j| self.part_at(j, image, sampled)).sum::<f64>();
        !self.by_coverage.contains(&image) && (self.wide.contains(&image) || around() > HALF_A_PIXEL_WIDE)
    }

    /// The part of a pixel that the judge sees an image in.
    fn part_at(&self, i: usize, image: Image, sampled: &BTreeMap<usize, Sampled>) -> f64 {
        sampled.get(&i).map_or(f64::from(u8::from(self.judged(i) == image)), |pixel| pixel.part(image))
    }

    /// Whose the light is that is shown in a pixel. Thin images are told by the nearest of them alone, and let a part of what is behind
    /// through: that is as the judge sees it there. The rest is shared among the thin images as he sees them in the pixels around too, for
    /// they are drawn a pixel wide.
    fn shown_parts(&self, i: usize, sampled: &BTreeMap<usize, Sampled>) -> Vec<(Image, DVec3)> {
        let (shown, light) = (&self.frame.shown[i], vector(self.frame.surfaces[i]));
        if shown.object == 0 {
            return Vec::new();
        }
        if shown.coverage >= 1.0 {
            return vec![(shown.image(), light)];
        }
        let is_thin = |image: Image| !self.by_centres.contains(&image);
        let mut parts = Vec::new();
        let mut rest = light;
        let judged = self.judged(i);
        if let Some(pixel) = sampled.get(&i).filter(|_| judged.0 > 0 && is_thin(judged)) {
            let thin: f64 = pixel.met.keys().filter(|image| is_thin(**image)).map(|image| pixel.part(*image)).sum();
            for image in pixel.met.keys().copied().filter(|image| !is_thin(*image)) {
                let free = (1.0 - thin).max(pixel.part(image));
                let behind = (pixel.light(image) * (1.0 - f64::from(shown.coverage)) / free).min(rest);
                rest -= behind;
                parts.push((image, behind));
            }
        } else if judged.0 > 0 {
            // It is shown where it is in a pixel's centre.
            let behind = (vector(self.judge.layers[i].light) * (1.0 - f64::from(shown.coverage))).min(rest);
            rest -= behind;
            parts.push((judged, behind));
        }
        let mut near: BTreeMap<Image, DVec3> = BTreeMap::new();
        for pixel in self.grid.around(i).iter().filter_map(|j| sampled.get(j)) {
            for image in pixel.met.keys().copied().filter(|image| is_thin(*image)) {
                *near.entry(image).or_default() += pixel.light(image);
            }
        }
        let sum: DVec3 = near.values().sum();
        if sum.min_element() > 0.0 && near.contains_key(&shown.image()) {
            parts.extend(near.into_iter().map(|(image, light)| (image, rest * light / sum)));
        } else {
            parts.push((shown.image(), rest));
        }
        parts
    }
}

/// All orders of each object of which some are mixed.
fn together<'l>(lights: impl Iterator<Item = &'l Light> + Clone) -> Vec<Light> {
    let mixed: BTreeSet<u32> = lights.clone().filter(|light| light.mixed != DVec3::ZERO).map(|light| light.image.0).collect();
    let sum = |object: u32| {
        lights.clone().filter(|light| light.image.0 == object).cloned().reduce(|a, b| Light {
            judge: a.judge + b.judge,
            by_centres: a.by_centres + b.by_centres,
            shown: a.shown + b.shown,
            noise: root(a.noise, b.noise),
            one_ray: root(a.one_ray, b.one_ray),
            ..a
        })
    };
    let all = mixed.into_iter().filter_map(sum);
    all.map(|light| Light { image: (light.image.0, TOGETHER), mixed: DVec3::ZERO, ..light }).collect()
}

/// The standard deviation of two that are independent, together.
fn root(a: DVec3, b: DVec3) -> DVec3 {
    (a * a + b * b).map(f64::sqrt)
}

fn vector(rgb: [f32; 3]) -> DVec3 {
    DVec3::from(rgb.map(f64::from))
}
