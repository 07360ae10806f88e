//! Where a flying body may be over windows of delay: boxes in a binary tree over time, so that for light far from the body its history need
//! not be read.

use glam::DVec3;

use super::tree::Chord;
use super::worldline::Worldline;
use crate::judge::bvh::Bounds;

/// A window is halved until the body moves in it by less than this share of its reach and the bound on its speed holds.
const SHARE: f64 = 1.0;
/// Or until it is this short, in r_s/c: for a body that reaches the singularity the first condition is never met.
const SHORTEST: f64 = 1.0 / 64.0;
/// Width of the windows that are halved, in r_s/c, and their greatest number: for older light the history itself is read.
const WINDOW: f64 = 4.0;
const MOST_WINDOWS: usize = 256;

/// The boxes of one body.
#[derive(Clone, Debug)]
pub(in crate::judge::picture) struct Sweep {
    /// Children after their parents; the first `windows` are the windows from delay 0 on.
    nodes: Vec<SweepNode>,
    windows: usize,
}

#[derive(Clone, Copy, Debug)]
struct SweepNode {
    bounds: Bounds<f64>,
    /// Index of the first of its two halves, 0 if there are none.
    halves: usize,
}

impl Sweep {
    /// For a body that reaches `reach` (r_s) from its centre, seen at T = `time` from delay 0 back to `oldest` (r_s/c).
    pub fn new(line: &dyn Worldline, time: f64, oldest: f64, reach: f64) -> Sweep {
        let windows = ((oldest / WINDOW).ceil() as usize).clamp(1, MOST_WINDOWS);
        let nothing = SweepNode { bounds: Bounds::EMPTY, halves: 0 };
        let mut sweep = Sweep { nodes: vec![nothing; windows], windows };
        for window in 0..windows {
            let from = WINDOW * window as f64;
            sweep.fill(window, line, time, [from, from + WINDOW], reach);
        }
        sweep
    }

    fn fill(&mut self, index: usize, line: &dyn Worldline, time: f64, [from, to]: [f64; 2], reach: f64) {
        let half = 0.5 * (to - from);
        let centre = line.at(time - from - half).position;
        let sway = line.sway(time - to, time - from);
        let strays = half * fastest(centre.length());
        let sure = is_short(half, centre.length());
        // Inside the horizon r only falls with T: at the late end it is least.
        let late = if sure { f64::INFINITY } else { line.at(time - from).position.length() };
        let (sure, strays) = if late < 1.0 { (true, half * fastest_since(late)) } else { (sure, strays) };
        // The bounds of the body's own history are tighter: next to the horizon a body that would have come out of the hole hardly moves.
        let (sure, strays) = match sway.map(|sway| half * sway.velocity) {
            Some(known) if known.is_finite() => (true, if sure { strays.min(known) } else { known }),
            _ => (sure, strays),
        };
        if sure && strays <= SHARE * reach || half <= SHORTEST {
            // A length is never longer on the slice than at rest.
            let grow = DVec3::splat(if sure { strays + reach } else { f64::INFINITY });
            let (min, max) = (centre - grow, centre + grow);
            // Where nothing is known the body may be anywhere.
            let known = min.is_finite() && max.is_finite();
            let [min, max] = if known { [min, max] } else { [DVec3::NEG_INFINITY, DVec3::INFINITY] };
            self.nodes[index].bounds = Bounds { min: min.to_array(), max: max.to_array() };
            return;
        }
        let first = self.nodes.len();
        let nothing = SweepNode { bounds: Bounds::EMPTY, halves: 0 };
        self.nodes.extend([nothing; 2]);
        self.fill(first, line, time, [from, from + half], reach);
        self.fill(first + 1, line, time, [from + half, to], reach);
        self.nodes[index] = SweepNode { bounds: self.nodes[first].bounds.union(&self.nodes[first + 1].bounds), halves: first };
    }

    /// Whether the body may be met by the chord at some delay from `from` to `to` (r_s/c).
    pub fn touches(&self, chord: &Chord, from: f64, to: f64) -> bool {
        let first = (from / WINDOW) as usize;
        let last = (to / WINDOW) as usize;
        last >= self.windows || (first..=last).any(|window| self.touches_node(window, [WINDOW * window as f64, WINDOW], chord, [from, to]))
    }

    fn touches_node(&self, index: usize, [start, width]: [f64; 2], chord: &Chord, [from, to]: [f64; 2]) -> bool {
        let node = &self.nodes[index];
        if start > to || start + width < from || chord.enters(&node.bounds, 1.0).is_none() {
            return false;
        }
        let half = 0.5 * width;
        node.halves == 0
            || self.touches_node(node.halves, [start, half], chord, [from, to])
            || self.touches_node(node.halves + 1, [start + half, half], chord, [from, to])
    }
}

/// Bound on the speed |dx/dT| ≤ 1 + β of anything at r (r_s), in c, that holds while r stays above 0.4 of its value here (1/√0.4 < 1.6).
pub(in crate::judge::picture) fn fastest(r: f64) -> f64 {
    1.0 + 1.6 / r.sqrt()
}

/// The same bound for every earlier time: inside the horizon r only falls with T, and what is outside now was never inside.
pub(in crate::judge::picture) fn fastest_since(r: f64) -> f64 {
    1.0 + 1.0 / r.min(1.0).sqrt()
}

/// Whether r stays above 0.4 of itself for a delay of `half` to either side.
pub(in crate::judge::picture) fn is_short(half: f64, r: f64) -> bool {
    half * fastest(r) <= 0.25 * r
}
