//! The tree of two children a node, flat in memory.

use super::bounds::{Bounds, Scalar};

/// No path from the root has more nodes below the root than this (the builder halves by number once it is deep), so a traversal may
/// keep its stack in an array of this size.
pub const MAX_DEPTH: usize = 96;

/// A node: a box with two children, or with a run of primitives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node<T> {
    /// Around everything below.
    pub bounds: Bounds<T>,
    /// Inner node: the index of the first child, the second follows it. Leaf: where its run starts in [`Tree::order`].
    pub first: u32,
    /// Number of primitives of a leaf; 0 for an inner node.
    pub count: u32,
}

impl<T> Node<T> {
    /// Whether it holds primitives and not nodes.
    #[inline]
    pub fn is_leaf(&self) -> bool {
        self.count > 0
    }

    /// The indices of the two children of an inner node.
    #[inline]
    pub fn children(&self) -> [usize; 2] {
        [self.first as usize, self.first as usize + 1]
    }

    /// The places of a leaf's primitives in [`Tree::order`].
    #[inline]
    pub fn run(&self) -> std::ops::Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }
}

/// A hierarchy of boxes over primitives that it knows only by index.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree<T> {
    /// The root first, every parent before its children; empty when there is nothing to hold.
    pub nodes: Vec<Node<T>>,
    /// Indices of the primitives in the order of the leaves.
    pub order: Vec<u32>,
    /// How many boxes were left out because they were not finite or were inside out: no ray can meet what lies in them.
    pub left_out: usize,
}

impl<T: Scalar> Tree<T> {
    /// The expected cost of a random ray that meets the root, by the surface area heuristic (Sei 2008, equation 3.1 over the whole tree).
    pub fn cost(&self, costs: Costs) -> f64 {
        let Some(root) = self.nodes.first() else { return 0.0 };
        let total: f64 = self
            .nodes
            .iter()
            .map(|node| {
                let work = if node.is_leaf() { f64::from(node.count) * costs.primitive } else { 2.0 * costs.node };
                work * node.bounds.half_area()
            })
            .sum();
        total / root.bounds.half_area()
    }
}

/// What the heuristic takes a test to cost, in any unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Costs {
    /// One ray against one box, T_AABB.
    pub node: f64,
    /// One ray against one primitive, T_tri.
    pub primitive: f64,
}

impl Default for Costs {
    /// 2 : 1 (Sei 2008, section 3.3, after Reshetov et al. 2005).
    fn default() -> Costs {
        Costs { node: 2.0, primitive: 1.0 }
    }
}
