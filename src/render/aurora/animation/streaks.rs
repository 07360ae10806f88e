//! How many streaks are drawn where: parts of the curtains, and how finely each streak is drawn.

use glam::DVec3;

use super::planet_view::PlanetView;
use crate::render::aurora::levels::PYRAMID;
use crate::render::aurora::node_history::place as node_position;
use crate::render::aurora::{CurtainNode, Segment};
use crate::scene::aurora::curve::Curve;
use crate::scene::aurora::dipole::{PLANET_RADIUS, REFERENCE_HEIGHT, on_field_line};
use crate::scene::aurora::motion::NodeLayout;
use crate::scene::aurora::quantiles::HEIGHTS;
use crate::scene::config::AuroraConfig;

/// Parts of curtains that are drawn at most, about. If there are more pairs of nodes, several make one part.
const MOST_SEGMENTS: usize = 1024;
/// Pairs of nodes that one part takes together at most.
const MOST_PAIRS: usize = 64;
/// The least distance of a curtain from the camera that counts, in km of the planet.
const NEAREST: f64 = 100.0;
/// Streaks per pixel of a curtain's length where the image of the planet is so many pixels wide; fewer where it is narrower, down to a
/// quarter.
const PER_PIXEL: f64 = 1.5;
const FULL_PIXELS: f64 = 300.0;
/// Distance between two streaks over their standard deviation along the curtain, at most; as in streaks.wgsl.
pub const SMOOTH: f64 = 1.6;
/// One streak in so many is red; the others have all other lines. As in streaks.wgsl.
pub const RED_EVERY: u32 = 5;
/// Streaks with a standard deviation above this, in pixels, overlap more and more. They become fewer as they become wider: always 1.8 per
/// standard deviation of the curtain's length. So the number of pixels that are filled is bounded by the picture's size.
const WIDE: f64 = 1.2;
/// Parts of a streak per pixel of its length: the blur is at least half a pixel. Below it: the least number of parts.
const PARTS_PER_PIXEL: f64 = 1.2;
const LEAST_PARTS: u32 = 2;
/// Heights that a streak goes through at most, km.
const LONGEST: f64 = HEIGHTS[0] - HEIGHTS[1];
/// If no point is wider than this (one standard deviation in pixels, as if space were flat), only the finest level of the pyramid is used;
/// if none is wider than twice of it, the two finest, and so on.
/// The walk uses coarser levels from 1.5 on.
const NARROW: f64 = 1.0;

/// Where the nodes of a row are.
#[derive(Clone, Debug, Default)]
pub struct RowPlaces {
    /// Each at the reference height, in km from the planet's centre, in the dipole's axes.
    pub points: Vec<DVec3>,
    /// Of each from the next, km in the plane across the field.
    pub apart: Vec<f64>,
}

impl RowPlaces {
    /// Of this row.
    pub fn of(row: &[CurtainNode]) -> RowPlaces {
        let at = |k: usize| node_position(row, k);
        RowPlaces {
            points: (0..row.len()).map(|k| on_field_line(at(k), REFERENCE_HEIGHT)).collect(),
            apart: (0..row.len()).map(|k| at(k).distance(at(k + 1))).collect(),
        }
    }
}

/// The curtains of a planet as they are drawn now.
pub struct Curtains<'a> {
    /// What `game.toml` says of them.
    pub config: &'a AuroraConfig,
    /// At rest.
    pub curves: &'a [Curve],
    /// Their nodes.
    pub layout: &'a NodeLayout,
    /// Where those are.
    pub places: &'a RowPlaces,
    /// Whether they are at both poles.
    pub both: bool,
    /// The part of their streaks that they are drawn with.
    pub ration: f64,
    /// Collisions of 35 eV in a curtain, in kR for each km that it is wide.
    pub collisions: f64,
}

impl Curtains<'_> {
    /// Poles that have them.
    fn poles(&self) -> u32 {
        if self.both { 2 } else { 1 }
    }

    /// Of each curve its first and its last node: in a row each has one more node at either end.
    fn spans(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let starts = self.layout.starts.windows(2).enumerate();
        starts.map(|(curve, window)| [window[0], window[1] - 1].map(|node| node + 2 * curve + 1))
    }

    /// Puts the length on the screen of each pair of nodes, in pixels, as if space were flat, less where strokes are wide, into `weights`,
    /// and gives all together, at all poles. Distances below 100 km, the height of the aurora, count as 100 km.
    fn weigh(&self, globe: &PlanetView, weights: &mut Vec<f64>) -> f64 {
        let scale = globe.radius / PLANET_RADIUS;
        // In km of the planet, in the dipole's axes.
        let eye = globe.attitude.inverse() * (globe.view.camera.position - globe.position) / scale;
        let nodes = self.places.points.iter().zip(&self.places.apart);
        weights.clear();
        weights.extend(nodes.map(|(point, apart)| {
            let per_pixel = (*point - eye).length().max(NEAREST) * globe.view.pixel;
            let sigma = self.config.radius / per_pixel;
            apart / per_pixel * WIDE / sigma.max(WIDE)
        }));
        self.spans().map(|[first, last]| weights[first..last].iter().sum::<f64>()).sum::<f64>() * f64::from(self.poles())
    }

    /// Puts the parts of the curtains into `segments`, each with as many streaks as its length on the screen asks for; `weights` is room.
    pub fn part(&self, globe: &PlanetView, weights: &mut Vec<f64>, segments: &mut Vec<Segment>) {
        let poles = f64::from(self.poles());
        let total = self.weigh(globe, weights);
        let per_pixel = PER_PIXEL * (globe.pixels / FULL_PIXELS).clamp(0.25, 1.0);
        let wanted = (per_pixel * total * globe.magnification()).min(f64::from(self.config.streaks)) * self.ration;
        // Where few streaks are wanted, several pairs of nodes make one part.
        let least = self.poles() * RED_EVERY;
        let nodes = weights.len();
        let stride =
            ((f64::from(least) * nodes as f64 / wanted.max(1.0)).ceil() as usize).max(nodes.div_ceil(MOST_SEGMENTS)).clamp(1, MOST_PAIRS);
        segments.clear();
        let mut first = 0;
        for (([first_of_curve, last], curve), &length) in self.spans().zip(self.curves).zip(&self.layout.lengths) {
            let pairs = last - first_of_curve;
            let length = length / pairs as f64;
            let mut k = 0;
            while k < pairs {
                let span = stride.min(pairs - k);
                let first_node = first_of_curve + k;
                let nodes = first_node..first_node + span;
                let weight: f64 = weights[nodes.clone()].iter().sum();
                let count = (poles * weight / total.max(1e-9) * wanted / f64::from(least)).round().max(1.0) as u32 * least;
                let kilometres: f64 = self.places.apart[nodes].iter().sum();
                // In kR km².
                let energy = self.collisions * length * span as f64 * curve.width * poles;
                segments.push(Segment {
                    first_streak: first,
                    streaks: count,
                    first_node: first_node as u32,
                    span: span as u32,
                    collisions: energy as f32,
                    width: curve.width as f32,
                    length: kilometres as f32,
                });
                first += count;
                k += span;
            }
        }
    }

    /// Parts that each streak is drawn in.
    pub fn parts(&self, globe: &PlanetView) -> u32 {
        // As if seen from the side; on a far planet the whole streak is a pixel or two.
        let length = 0.5 * globe.pixels * LONGEST / PLANET_RADIUS * globe.magnification();
        self.config.parts.min(((PARTS_PER_PIXEL * length).ceil() as u32).max(LEAST_PARTS))
    }

    /// Levels of the pyramid that their light is added up in; `reach` is their greatest distance from the planet's centre, in r_s.
    pub fn levels(&self, globe: &PlanetView, segments: &[Segment], reach: f64) -> u32 {
        // The largest width at which a point may be seen, where the aurora is nearest.
        let nearest = globe.distance - reach;
        let spread = segments.iter().map(|segment| spread(segment, self.poles())).fold(0.0, f64::max);
        let scale = globe.radius / PLANET_RADIUS;
        let widest = self.config.radius.hypot(spread) * scale / (nearest * globe.view.pixel) * globe.magnification();
        if nearest <= reach {
            return PYRAMID;
        }
        // Each level has strokes of up to twice the width.
        1 + (2.0 * widest / NARROW).log2().clamp(0.0, f64::from(PYRAMID - 1)) as u32
    }
}

/// Standard deviation, in km, of the light of a part's streaks across the curtain or, where streaks stand far apart, along it: the larger
/// of the two, for the red streaks, which stand farthest apart. As in streaks.wgsl.
fn spread(segment: &Segment, poles: u32) -> f64 {
    let apart = f64::from(segment.length) * f64::from(RED_EVERY * poles) / f64::from(segment.streaks.max(1));
    (f64::from(segment.width) / 12f64.sqrt()).max(apart / SMOOTH)
}
