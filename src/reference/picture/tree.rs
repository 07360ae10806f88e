//! A tree of boxes over triangles, asked along one short piece of a curve.

use glam::DVec3;

/// Triangles in a leaf at most.
const LEAF: usize = 4;

/// A binary tree of axis-aligned boxes.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    nodes: Vec<Node>,
    /// Triangles in the order of the leaves.
    items: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    low: DVec3,
    high: DVec3,
    /// A leaf's first item, or the first of two children that lie together.
    first: u32,
    /// Items of a leaf; 0 for an inner node.
    count: u32,
}

/// Where a chord passes boxes that are grown on all sides.
struct Chord {
    from: DVec3,
    step: DVec3,
    grow: f64,
}

impl Chord {
    /// The fraction of the chord at which it enters the grown box, or None where it misses it before `until`. A chord that lies in a face, or
    /// starts on one, is inside.
    fn enters(&self, node: &Node, until: f64) -> Option<f64> {
        let (mut enter, mut leave) = (0.0f64, until);
        for axis in 0..3 {
            let (low, high) = (node.low[axis] - self.grow - self.from[axis], node.high[axis] + self.grow - self.from[axis]);
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

impl Tree {
    /// Builds it over `triangles` with corners among `vertices`, split at the median of the longest axis of the centres.
    pub fn new(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Tree {
        let mut tree = Tree { nodes: Vec::new(), items: (0..triangles.len() as u32).collect() };
        if triangles.is_empty() {
            return tree;
        }
        let boxes: Vec<(DVec3, DVec3)> = triangles
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|i| vertices[i as usize]);
                (a.min(b).min(c), a.max(b).max(c))
            })
            .collect();
        tree.nodes.push(Node { low: DVec3::ZERO, high: DVec3::ZERO, first: 0, count: 0 });
        tree.split(0, 0, triangles.len(), &boxes);
        tree
    }

    fn split(&mut self, node: usize, first: usize, end: usize, boxes: &[(DVec3, DVec3)]) {
        let items = &mut self.items[first..end];
        let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = items.iter().fold(nothing, |(low, high), &i| {
            let (a, b) = boxes[i as usize];
            (low.min(a), high.max(b))
        });
        if items.len() <= LEAF {
            self.nodes[node] = Node { low, high, first: first as u32, count: items.len() as u32 };
            return;
        }
        let centre = |i: u32| boxes[i as usize].0 + boxes[i as usize].1;
        let (least, most) = items.iter().fold(nothing, |(low, high), &i| (low.min(centre(i)), high.max(centre(i))));
        let extent = most - least;
        let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
        let half = items.len() / 2;
        items.select_nth_unstable_by(half, |&a, &b| centre(a)[axis].total_cmp(&centre(b)[axis]));
        let child = self.nodes.len();
        let unset = Node { low, high, first: 0, count: 0 };
        self.nodes.extend([unset, unset]);
        self.nodes[node] = Node { low, high, first: child as u32, count: 0 };
        self.split(child, first, first + half, boxes);
        self.split(child + 1, first + half, end, boxes);
    }

    /// Calls `meet` for each triangle whose box, grown by `grow`, the chord from `from` to `to` passes; nearer boxes first. `meet` answers with
    /// the fraction of the chord beyond which nothing is of interest any more.
    pub fn along(&self, from: DVec3, to: DVec3, grow: f64, mut until: f64, mut meet: impl FnMut(u32, f64) -> f64) {
        if self.nodes.is_empty() {
            return;
        }
        let chord = Chord { from, step: to - from, grow };
        // Twice the depth of a balanced tree over 2^32 triangles.
        let mut stack = [(0.0, 0u32); 64];
        let mut depth = 0;
        if let Some(enter) = chord.enters(&self.nodes[0], until) {
            stack[0] = (enter, 0);
            depth = 1;
        }
        while depth > 0 {
            depth -= 1;
            let (enter, index) = stack[depth];
            if enter > until {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count > 0 {
                for &item in &self.items[node.first as usize..(node.first + node.count) as usize] {
                    until = until.min(meet(item, until));
                }
                continue;
            }
            let children = [node.first, node.first + 1].map(|i| (chord.enters(&self.nodes[i as usize], until), i));
            let (near, far) =
                if children[1].0.unwrap_or(f64::INFINITY) < children[0].0.unwrap_or(f64::INFINITY) { (1, 0) } else { (0, 1) };
            for child in [far, near] {
                if let (Some(enter), i) = children[child] {
                    stack[depth] = (enter, i);
                    depth += 1;
                }
            }
        }
    }
}
