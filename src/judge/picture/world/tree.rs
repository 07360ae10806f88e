//! A bounding volume hierarchy over triangles, traced along one short piece of a curve.

use glam::DVec3;

use crate::judge::bvh::{self, Bounds, BvhSettings, Costs};

/// Costs: a triangle against a curve takes the search of a root; a box against a chord takes two divisions an axis.
const SETTINGS: BvhSettings = BvhSettings { costs: Costs { node: 1.0, primitive: 4.0 }, max_leaf: 4 };

/// A binary tree of axis-aligned boxes over triangles.
#[derive(Clone, Debug)]
pub struct TriangleTree(bvh::Tree<f64>);

/// A chord against boxes that are grown on all sides.
#[derive(Clone, Copy, Debug)]
pub(in crate::judge::picture) struct Chord {
    from: DVec3,
    step: DVec3,
    grow: DVec3,
}

impl Chord {
    /// From `from` to `to`, boxes grown by `grow` on each axis, all in r_s.
    pub fn new(from: DVec3, to: DVec3, grow: DVec3) -> Chord {
        Chord { from, step: to - from, grow }
    }

    /// The fraction of the chord at which it enters the grown box, or None where it misses it before `until`. A chord that lies in a face,
    /// or starts on one, is inside.
    pub fn enters(&self, bounds: &Bounds<f64>, until: f64) -> Option<f64> {
        let (mut enter, mut leave) = (0.0f64, until);
        for axis in 0..3 {
            let (low, high) = (bounds.min[axis] - self.grow[axis] - self.from[axis], bounds.max[axis] + self.grow[axis] - self.from[axis]);
            let step = self.step[axis];
            if step == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return None;
                }
                continue;
            }
            let (a, b) = (low / step, high / step);
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        // Two roundings of the quotient: a hair of slack keeps the test conservative.
        (enter <= leave + 4.0 * f64::EPSILON).then_some(enter)
    }
}

impl TriangleTree {
    /// Builds it over `triangles` with corners among `vertices`.
    pub fn new(vertices: &[DVec3], triangles: &[[u32; 3]]) -> TriangleTree {
        let boxes: Vec<Bounds<f64>> =
            triangles.iter().map(|corners| Bounds::around(corners.map(|i| vertices[i as usize].to_array()))).collect();
        TriangleTree(bvh::build(&boxes, &SETTINGS))
    }

    /// Calls `meet` for each triangle whose box, grown by `grow`, the chord from `from` to `to` passes; nearer boxes first. `meet` answers
    /// with the fraction of the chord beyond which nothing is of interest any more.
    pub fn along(&self, from: DVec3, to: DVec3, grow: f64, mut until: f64, mut meet: impl FnMut(u32, f64) -> f64) {
        let Some(root) = self.0.nodes.first() else { return };
        let chord = Chord::new(from, to, DVec3::splat(grow));
        let mut stack = [(0.0, 0); bvh::MAX_DEPTH + 1];
        let mut depth = 0;
        if let Some(enter) = chord.enters(&root.bounds, until) {
            stack[0] = (enter, 0);
            depth = 1;
        }
        while depth > 0 {
            depth -= 1;
            let (enter, index) = stack[depth];
            if enter > until {
                continue;
            }
            let node = &self.0.nodes[index];
            if node.is_leaf() {
                for &item in &self.0.order[node.run()] {
                    until = until.min(meet(item, until));
                }
                continue;
            }
            let children = node.children().map(|i| (chord.enters(&self.0.nodes[i].bounds, until), i));
            let second_first = children[1].0.unwrap_or(f64::INFINITY) < children[0].0.unwrap_or(f64::INFINITY);
            // The nearer one goes on top of the stack.
            for child in if second_first { [0, 1] } else { [1, 0] } {
                if let (Some(enter), i) = children[child] {
                    stack[depth] = (enter, i);
                    depth += 1;
                }
            }
        }
    }
    /// The same, only for those leaves that `TriangleTree::gather` found, in any order.
    pub fn along_leaves(&self, leaves: &[u32], from: DVec3, to: DVec3, grow: f64, mut meet: impl FnMut(u32, f64) -> f64) {
        let chord = Chord::new(from, to, DVec3::splat(grow));
        let mut until = 1.0;
        for &leaf in leaves {
            let node = &self.0.nodes[leaf as usize];
            if chord.enters(&node.bounds, until).is_some() {
                for &item in &self.0.order[node.run()] {
                    until = until.min(meet(item, until));
                }
            }
        }
    }

    /// Adds to `leaves` those whose boxes the chord passes. Returns false, and `leaves` is of no use, if there are more than `most`.
    pub(in crate::judge::picture) fn gather(&self, chord: &Chord, most: usize, leaves: &mut Vec<u32>) -> bool {
        if self.0.nodes.is_empty() {
            return true;
        }
        let mut stack = [0; bvh::MAX_DEPTH + 1];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let index = stack[depth];
            let node = &self.0.nodes[index];
            if chord.enters(&node.bounds, 1.0).is_none() {
                continue;
            }
            if !node.is_leaf() {
                let [first, second] = node.children();
                (stack[depth], stack[depth + 1]) = (first, second);
                depth += 2;
            } else if !leaves.contains(&(index as u32)) {
                if leaves.len() == most {
                    return false;
                }
                leaves.push(index as u32);
            }
        }
        true
    }

    /// Whether the chord passes the box of a leaf.
    pub(in crate::judge::picture) fn passes(&self, leaf: u32, chord: &Chord) -> bool {
        chord.enters(&self.0.nodes[leaf as usize].bounds, 1.0).is_some()
    }
}
