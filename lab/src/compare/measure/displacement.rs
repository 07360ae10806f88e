//! Where the judge sees the surface point that the contestant shows at a pixel: Newton on the judge's own map from the screen to the
//! surface.
//!
//! Points are compared as points of the body, three coordinates in its own axes: texture coordinates have seams and poles.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use glam::{DVec2, DVec3};
use rayon::prelude::*;

pub use super::probe::{Point, Probe};
use crate::compare::ContestantFrame;
use crate::compare::deadline::Deadline;
use lensrunner::judge::picture::TracedPicture;

/// What came of measuring at a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measured {
    /// A distance in pixels.
    Pixels(f64),
    /// A pixel's footprint on the surface is below the resolution of f32.
    Apart,
    /// The pixel shows no point of the body. A triangle narrower than the rasteriser's grid (1/256 px) may cover a pixel's centre although
    /// its own edges miss it; what is interpolated there lies outside of the triangle.
    Nowhere,
}

/// A footprint narrower than this part of the body's radius cannot be measured: the coordinates of a surface point, each a rounded sum of
/// three rounded products, are right to about 4e-7 of the radius in f32, a tenth of this.
const RESOLUTION: f64 = 4e-6;

/// How much is asked of the judge between the pixels.
#[derive(Clone, Debug)]
pub struct Effort {
    /// The most pixels of one image at which displacements are measured, evenly spread over it.
    pub pixels: usize,
    /// The most pixels of one image at which a doubtful displacement is measured from several starts.
    pub doubtful: usize,
    /// When it ends; what has not been measured by then is left out.
    pub deadline: Deadline,
}

impl Default for Effort {
    fn default() -> Effort {
        Effort { pixels: usize::MAX, doubtful: usize::MAX, deadline: Deadline::never() }
    }
}

/// The pixels where both show the same object in the same order, for each image so many as are measured. They are in an order in which any
/// first part is spread over the picture, so that little is lost where time runs out.
fn measurable(judge: &TracedPicture, frame: &ContestantFrame, most: usize) -> Vec<usize> {
    let mut images: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
    for (i, (layer, shown)) in judge.layers.iter().zip(&frame.shown).enumerate() {
        if layer.object > 0 && (layer.object, layer.order) == (shown.object, shown.order) {
            images.entry((layer.object, layer.order)).or_default().push(i);
        }
    }
    let mut measured: Vec<usize> = Vec::new();
    for pixels in images.values() {
        let count = pixels.len().min(most);
        measured.extend((0..count).map(|k| pixels[k * pixels.len() / count]));
    }
    // Fibonacci's hash: neighbours come far apart.
    measured.sort_by_key(|&i| (i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    measured
}

/// The displacement at each pixel where both show the same object in the same order; None elsewhere, and where `effort` ends before.
pub fn displacements(judge: &TracedPicture, frame: &ContestantFrame, probe: &dyn Probe, effort: &Effort) -> Vec<Option<Measured>> {
    let width = judge.size[0] as usize;
    let measured = measurable(judge, frame, effort.pixels);
    let doubted: Mutex<BTreeMap<(u32, u32), usize>> = Mutex::default();
    let found: Vec<Option<Measured>> = measured
        .par_iter()
        .map(|&i| {
            let (layer, shown) = (&judge.layers[i], &frame.shown[i]);
            if effort.deadline.is_over() {
                return None;
            }
            let wanted = DVec3::from(shown.body.map(f64::from));
            let centre = DVec2::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
            let here = Point { object: layer.object, order: layer.order, body: probe.body(layer) };
            let there = measure(probe, here, centre, centre, wanted);
            if !matches!(there, Some(Measured::Pixels(d)) if d > DOUBTFUL) {
                return there;
            }
            if effort.doubtful < usize::MAX {
                let mut doubted = doubted.lock().unwrap_or_else(PoisonError::into_inner);
                let count = doubted.entry((layer.object, layer.order)).or_default();
                *count += 1;
                if *count > effort.doubtful {
                    return there;
                }
            }
            // Where one part of a body stands before another its map tears. The point is looked for from both sides of the tear.
            let around = |k: u32| DVec2::from_angle(std::f64::consts::FRAC_PI_4 * f64::from(k));
            let sides = SIDES_AT.into_iter().flat_map(|distance| (0..8).map(move |k| centre + around(k) * distance));
            let found = sides.filter_map(|start| {
                let point = probe.at(start.x, start.y).filter(|p| (p.object, p.order) == (here.object, here.order))?;
                match measure(probe, point, start, centre, wanted)? {
                    Measured::Pixels(d) => Some(d),
                    Measured::Apart | Measured::Nowhere => None,
                }
            });
            let Some(Measured::Pixels(d)) = there else { return there };
            let nearest = found.fold(d, f64::min);
            if nearest > DOUBTFUL && probe.off_body(here.object, wanted) > OFF_BODY * probe.radius(here.object) {
                return Some(Measured::Nowhere);
            }
            let hidden = (nearest > DOUBTFUL).then(|| hidden(probe, here, centre, wanted)).flatten();
            Some(Measured::Pixels(hidden.map_or(nearest, |d| d.min(nearest))))
        })
        .collect();
    let mut all = vec![None; judge.layers.len()];
    measured.into_iter().zip(found).for_each(|(i, found)| all[i] = found);
    all
}

/// How far from `centre`, in pixels, the judge would see the point `wanted` if nothing hid it. Only where it sees a part of the body beside
/// it there: what is hidden by a part far from it should not be shown at all.
fn hidden(probe: &dyn Probe, here: Point, centre: DVec2, wanted: DVec3) -> Option<f64> {
    let place = probe.place(&Point { body: wanted, ..here })?;
    let near = HIDDEN_BESIDE * probe.radius(here.object);
    let corners = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y].map(|v| place + v);
    let seen = corners.into_iter().filter_map(|p| probe.at(p.x, p.y)).filter(|p| (p.object, p.order) == (here.object, here.order));
    seen.map(|p| p.body).chain([here.body]).any(|body| body.distance(wanted) < near).then(|| place.distance(centre))
}

/// What is farther from a body's surface, as a share of its radius, is no point of it: f32 rounds to 4e-7 of it.
const OFF_BODY: f64 = 1e-4;
/// A point just behind an outline may be shown in the place of the outline, which is off by less than a pixel. Seen under a tangent, a
/// sphere of 100 pixels hides a tenth of its radius behind its last pixel.
const HIDDEN_BESIDE: f64 = 0.1;
/// From this many pixels on a displacement is measured from several starts.
const DOUBTFUL: f64 = 0.5;
/// How far from the pixel's centre those are, in pixels. Parts of a body may be narrower than a pixel.
const SIDES_AT: [f64; 3] = [0.25, 0.5, 0.75];
/// Steps of Newton: the map is smooth but for the edges of triangles, where its slope jumps.
const STEPS: usize = 12;
/// The longest step, in pixels: beyond it the slope says little.
const LONGEST: f64 = 4.0;
/// Half the span over which the slope is taken, in pixels: the judge's rays are right to 1e-9 of that.
const SPAN: f64 = 1.0 / 64.0;

/// How far from `centre`, in pixels, the judge sees the point `wanted`, looked for from `start`, which shows `here`. Where the image ends
/// before it is reached the slope at its end extends it.
fn measure(probe: &dyn Probe, here: Point, start: DVec2, centre: DVec2, wanted: DVec3) -> Option<Measured> {
    let same = |place: DVec2| probe.at(place.x, place.y).filter(|p| (p.object, p.order) == (here.object, here.order)).map(|p| p.body);
    let resolution = RESOLUTION * probe.radius(here.object);
    let (mut place, mut body) = (start, here.body);
    let mut best = f64::INFINITY;
    for _ in 0..STEPS {
        let slope = |axis: DVec2| {
            let (before, after) = (same(place - axis * SPAN), same(place + axis * SPAN));
            match (before, after) {
                (Some(a), Some(b)) => Some((b - a) / (2.0 * SPAN)),
                (Some(a), None) => Some((body - a) / SPAN),
                (None, Some(b)) => Some((b - body) / SPAN),
                (None, None) => None,
            }
        };
        // An image thinner than this has no inside to be displaced in.
        let (Some(across), Some(down)) = (slope(DVec2::X), slope(DVec2::Y)) else { break };
        let Some(step) = solve(across, down, wanted - body, resolution) else { return Some(Measured::Apart) };
        best = (place + step).distance(centre);
        if step.length() < 2e-3 {
            break;
        }
        let mut step = step.clamp_length_max(LONGEST);
        let next = (0..4).find_map(|_| {
            let found = same(place + step);
            step *= if found.is_none() { 0.5 } else { 1.0 };
            found
        });
        let Some(found) = next else { break };
        (place, body) = (place + step, found);
    }
    best.is_finite().then_some(Measured::Pixels(best))
}

/// The step on the screen that brings the surface point nearest to `off` away; None where a direction of the screen is magnified so far
/// that a pixel covers less than `resolution`.
fn solve(across: DVec3, down: DVec3, off: DVec3, resolution: f64) -> Option<DVec2> {
    let (a, b, c) = (across.length_squared(), across.dot(down), down.length_squared());
    let angle = 0.5 * (2.0 * b).atan2(a - c);
    let mut step = DVec2::ZERO;
    for turn in [angle, angle + std::f64::consts::FRAC_PI_2] {
        let direction = DVec2::from_angle(turn);
        let image = across * direction.x + down * direction.y;
        let stretch = image.length_squared();
        if stretch < resolution * resolution {
            return None;
        }
        step += direction * (off.dot(image) / stretch);
    }
    Some(step)
}
