//! The builder: top down, every plane of every axis tried, the cheapest by the surface area heuristic taken (Sei 2008, section 3.3).
//!
//! It sees boxes only, so it serves triangles, arcs of the disk and swept boxes alike.
//!
//! ```
//! use lensrunner::judge::bvh::{Bounds, BvhSettings, build};
//! let boxes: Vec<Bounds<f64>> = (0..100).map(|i| i as f64).map(|x| Bounds { min: [x, 0.0, 0.0], max: [x + 0.5, 1.0, 1.0] }).collect();
//! let tree = build(&boxes, &BvhSettings::default());
//! // Everything that a point might lie in:
//! let mut found: Vec<u32> = Vec::new();
//! let mut stack = vec![0];
//! while let Some(at) = stack.pop() {
//!     let node = &tree.nodes[at];
//!     if !(node.bounds.min[0] <= 7.2 && 7.2 <= node.bounds.max[0]) {
//!         continue;
//!     }
//!     if node.is_leaf() {
//!         found.extend(tree.order[node.run()].iter().filter(|&&i| boxes[i as usize].min[0] <= 7.2 && 7.2 <= boxes[i as usize].max[0]));
//!     } else {
//!         stack.extend(node.children());
//!     }
//! }
//! assert_eq!(found, [7]);
//! ```

use super::bounds::{Bounds, Scalar};
use super::tree::{Costs, MAX_DEPTH, Node, Tree};

/// How a tree is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhSettings {
    /// The costs that are weighed.
    pub costs: Costs,
    /// No leaf holds more primitives than this, at least 1; the heuristic alone would put 100,000 equal boxes into one leaf.
    pub max_leaf: usize,
}

impl Default for BvhSettings {
    fn default() -> BvhSettings {
        BvhSettings { costs: Costs::default(), max_leaf: 16 }
    }
}

/// From this depth on, nodes are halved by number, so that no tree of up to 2³² primitives is deeper than [`MAX_DEPTH`].
const HALVE_FROM: usize = MAX_DEPTH - 32;

/// Builds a tree over boxes. The same boxes give the same tree. Time O(n log n), one thread.
///
/// # Panics
/// With 2³¹ boxes or more: nodes are numbered in 32 bits.
pub fn build<T: Scalar>(boxes: &[Bounds<T>], settings: &BvhSettings) -> Tree<T> {
    assert!(boxes.len() < 1 << 31, "{} boxes are more than a tree can number", boxes.len());
    let kept: Vec<u32> = (0..boxes.len() as u32).filter(|&i| boxes[i as usize].is_proper()).collect();
    let left_out = boxes.len() - kept.len();
    if kept.is_empty() {
        return Tree { nodes: Vec::new(), order: Vec::new(), left_out };
    }
    let keys: Vec<[f64; 3]> = boxes.iter().map(Bounds::key).collect();
    let sorted = std::array::from_fn(|axis| {
        let mut list = kept.clone();
        // Ties by index: the tree must not depend on how the sort works.
        list.sort_unstable_by(|&a, &b| keys[a as usize][axis].total_cmp(&keys[b as usize][axis]).then(a.cmp(&b)));
        list
    });
    let mut work =
        Work { boxes, settings, sorted, in_left: vec![false; boxes.len()], areas: vec![0.0; kept.len()], spare: vec![0; kept.len()] };
    let mut nodes = vec![Node { bounds: work.around(0..kept.len()), first: 0, count: kept.len() as u32 }];
    let mut stack = vec![(0, 0..kept.len(), 0)];
    while let Some((at, range, depth)) = stack.pop() {
        let Some((axis, left)) = work.choose(&nodes[at].bounds, range.clone(), depth) else {
            nodes[at].first = range.start as u32;
            nodes[at].count = range.len() as u32;
            continue;
        };
        work.partition(axis, left, range.clone());
        let middle = range.start + left;
        let halves = [range.start..middle, middle..range.end];
        nodes[at].first = nodes.len() as u32;
        nodes[at].count = 0;
        for half in halves {
            stack.push((nodes.len(), half.clone(), depth + 1));
            nodes.push(Node { bounds: work.around(half), first: 0, count: 0 });
        }
    }
    let [order, ..] = work.sorted;
    Tree { nodes, order, left_out }
}

struct Work<'a, T> {
    boxes: &'a [Bounds<T>],
    settings: &'a BvhSettings,
    /// The primitives by their centres along x, y, z; a node owns the same range of all three.
    sorted: [Vec<u32>; 3],
    /// By primitive: whether it goes to the first child.
    in_left: Vec<bool>,
    /// Area of everything from here to the end of the range.
    areas: Vec<f64>,
    spare: Vec<u32>,
}

impl<T: Scalar> Work<'_, T> {
    fn around(&self, range: std::ops::Range<usize>) -> Bounds<T> {
        self.sorted[0][range].iter().fold(Bounds::EMPTY, |all, &i| all.union(&self.boxes[i as usize]))
    }

    /// The axis and the number of primitives on its low side; None for a leaf.
    fn choose(&mut self, bounds: &Bounds<T>, range: std::ops::Range<usize>, depth: usize) -> Option<(usize, usize)> {
        let number = range.len();
        if number == 1 {
            return None;
        }
        let must_split = number > self.settings.max_leaf.max(1);
        if depth >= HALVE_FROM {
            return must_split.then_some((widest(bounds), number / 2));
        }
        let Costs { node, primitive } = self.settings.costs;
        // Equation 3.1, times A(S): a flat or point-like box has no area to divide by.
        let area = bounds.half_area();
        let mut best = None;
        let mut best_cost = if must_split { f64::INFINITY } else { number as f64 * primitive * area };
        for axis in 0..3 {
            let list = &self.sorted[axis][range.clone()];
            let mut right = Bounds::EMPTY;
            for (place, &i) in list.iter().enumerate().rev() {
                right = right.union(&self.boxes[i as usize]);
                self.areas[place] = right.half_area();
            }
            let mut left = Bounds::EMPTY;
            for (place, &i) in list[..number - 1].iter().enumerate() {
                left = left.union(&self.boxes[i as usize]);
                let count = place + 1;
                let halves = left.half_area() * count as f64 + self.areas[count] * (number - count) as f64;
                let cost = 2.0 * node * area + primitive * halves;
                if cost < best_cost {
                    best_cost = cost;
                    best = Some((axis, count));
                }
            }
        }
        // Costs that overflow leave no choice by cost.
        best.or_else(|| must_split.then_some((widest(bounds), number / 2)))
    }

    /// Makes the first `left` of one axis the first of all three, keeping each sorted.
    fn partition(&mut self, axis: usize, left: usize, range: std::ops::Range<usize>) {
        for (place, &i) in self.sorted[axis][range.clone()].iter().enumerate() {
            self.in_left[i as usize] = place < left;
        }
        for other in (0..3).filter(|&other| other != axis) {
            let list = &mut self.sorted[other][range.clone()];
            let (mut kept, mut moved) = (0, 0);
            for place in 0..list.len() {
                let i = list[place];
                if self.in_left[i as usize] {
                    list[kept] = i;
                    kept += 1;
                } else {
                    self.spare[moved] = i;
                    moved += 1;
                }
            }
            list[kept..].copy_from_slice(&self.spare[..moved]);
        }
    }
}

fn widest<T: Scalar>(bounds: &Bounds<T>) -> usize {
    let extent = |axis: usize| bounds.max[axis].wide() - bounds.min[axis].wide();
    (1..3).fold(0, |best, axis| if extent(axis) > extent(best) { axis } else { best })
}
