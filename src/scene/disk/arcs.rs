//! The disk as arcs (Yamashita 2025, section 2.3): circles, cut along radii. Between two circles and two cuts lies an arc.
//!
//! Arcs are fixed and gas flows through them: only the pattern of the gas turns. So an arc is seen in its own place at any time, and it
//! always touches its neighbours.

use std::f64::consts::TAU;

use crate::scene::config;

use super::noise::hash;
use super::radial::Radial;

/// Circles and cuts of a disk of arcs.
#[derive(Clone, Debug, PartialEq)]
pub struct Arcs {
    /// Radii of the circles, ascending, in r_s.
    pub circles: Vec<f64>,
    /// Pairs of circles with gas between them, by index.
    pub rings: Vec<[u32; 2]>,
    /// Azimuths of the cuts, ascending from 0 to 2π, both included, in rad.
    pub cuts: Vec<f64>,
}

/// How much widths and opening angles vary about their mean, in all. By hand, so that no pattern of arcs is seen.
const JITTER: f64 = 0.3;
/// Fewest cuts, so that an arc is shorter than a quarter turn.
const FEWEST_CUTS: usize = 6;

impl Arcs {
    /// About `disk.arcs` arcs of about `disk.width`; a share `disk.gap` of each is left dark.
    pub fn new(disk: &config::Disk, radial: &Radial) -> Arcs {
        let [start, end] = radial.extent();
        let most = (disk.arcs as usize / FEWEST_CUTS).max(2);
        let rings = (((end - start) / disk.width).round() as usize).clamp(2, most);
        let cuts = (f64::from(disk.arcs) / rings as f64).round().max(FEWEST_CUTS as f64) as usize;
        let edges = jittered(rings, disk.seed, 0).into_iter().map(|t| start + t * (end - start));
        let (circles, rings) = if disk.gap > 0.0 {
            let edges: Vec<f64> = edges.collect();
            let circles = edges.windows(2).flat_map(|pair| [pair[0], pair[1] - disk.gap * (pair[1] - pair[0])]).collect();
            (circles, (0..rings as u32).map(|k| [2 * k, 2 * k + 1]).collect())
        } else {
            (edges.collect(), (0..rings as u32).map(|k| [k, k + 1]).collect())
        };
        Arcs { circles, rings, cuts: jittered(cuts, disk.seed, 1).into_iter().map(|t| t * TAU).collect() }
    }

    /// How many arcs there are.
    pub fn count(&self) -> usize {
        self.rings.len() * (self.cuts.len() - 1)
    }
}

/// 0, …, 1 in `count` steps of varying length.
fn jittered(count: usize, seed: u32, stream: u64) -> Vec<f64> {
    let step = 1.0 / count as f64;
    (0..=count)
        .map(|k| {
            let random = (hash(k as u64, u64::from(seed) << 8 | stream) >> 11) as f64 / (1u64 << 53) as f64;
            let moved = if k == 0 || k == count { 0.0 } else { JITTER * (random - 0.5) };
            (k as f64 + moved) * step
        })
        .collect()
}
