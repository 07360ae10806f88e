//! The tree of eight children a node: one instruction tests eight boxes, or eight triangles.

use crate::straight::bounds::Bounds;
use crate::straight::build::{BvhSettings, build};
use crate::straight::single::bounds;
use crate::straight::tree::{Costs, MAX_DEPTH, Tree};

/// Marks a child that is a [`Block`] and not a [`Wide8`].
pub(super) const LEAF: u32 = 1 << 31;

/// Below [`LEAF`]: the number of triangles in the block less one, so that it is known before the block is.
const COUNT: u32 = 28;

/// The number of the block that a child with [`LEAF`] names, and how many triangles it holds.
#[inline(always)]
pub(super) fn leaf(child: u32) -> (usize, u32) {
    ((child & ((1 << COUNT) - 1)) as usize, (child >> COUNT & 7) + 1)
}

/// The child of nobody.
pub(super) const NOBODY: u32 = u32::MAX;

/// No more than this many entries wait on a traversal's stack: seven siblings a level.
pub(super) const STACK: usize = 7 * (MAX_DEPTH + 1) + 1;

/// A child that waits on a stack.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Waits {
    /// As in [`Wide8::children`].
    pub child: u32,
    /// Where its box begins; not negative.
    pub near: f32,
    /// Where its box is written: eight times its parent's number, and its lane there; 0 where nobody asks again.
    pub place: u32,
}

/// What a traversal keeps from ray to ray, so that it need not be cleared for each.
pub(super) type Stack = [Waits; STACK];

/// Puts a child on the stack, among those above `ground`, nearer ones above.
#[inline(always)]
pub(super) fn wait(stack: &mut Stack, ground: usize, height: &mut usize, waits: Waits) {
    let mut place = *height;
    while place > ground && stack[place - 1].near < waits.near {
        stack[place] = stack[place - 1];
        place -= 1;
    }
    stack[place] = waits;
    *height += 1;
}

/// A node: eight boxes, lane by lane. Lanes without a child hold the empty box, which no ray meets.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Wide8 {
    /// By axis: lowest, highest.
    pub bounds: [[[f32; 8]; 2]; 3],
    /// A node's number, or a block's as [`leaf`] reads it.
    pub children: [u32; 8],
    /// One bit a lane that holds a node.
    pub inner: u32,
}

/// Up to eight triangles, lane by lane. Lanes without one hold what is not a number, which no ray meets.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Block {
    /// By corner and axis.
    pub corners: [[[f32; 8]; 3]; 3],
    /// Numbers of the triangles.
    pub triangles: [u32; 8],
}

/// Triangles under a tree of eight children a node.
#[derive(Clone, Debug)]
pub struct Wide {
    pub(super) nodes: Vec<Wide8>,
    pub(super) blocks: Vec<Block>,
    pub(super) root: Bounds<f32>,
    pub(super) instructions: Instructions,
}

/// What the heuristic weighs for this tree: the 2 : 1 of Sei 2008 also measured best here, with leaves that fill a block at most.
pub const SETTINGS: BvhSettings = BvhSettings { costs: Costs { node: 2.0, primitive: 1.0 }, max_leaf: 8 };

impl Wide {
    /// Builds the tree; triangles with a corner that is not finite are left out.
    pub fn new(triangles: &[[[f32; 3]; 3]]) -> Wide {
        let boxes: Vec<Bounds<f32>> = triangles.iter().map(bounds).collect();
        let tree = build(&boxes, &SETTINGS);
        let mut wide = Wide { nodes: Vec::new(), blocks: Vec::new(), root: Bounds::EMPTY, instructions: Instructions::detected() };
        if let Some(root) = tree.nodes.first() {
            wide.root = root.bounds;
            wide.collapse(&tree, triangles);
        }
        wide
    }

    /// The same tree with these instructions, where the processor has them.
    pub fn limited(self, to: Instructions) -> Wide {
        Wide { instructions: Instructions::detected().min(to), ..self }
    }

    fn collapse(&mut self, tree: &Tree<f32>, triangles: &[[[f32; 3]; 3]]) {
        self.nodes.push(Wide8::empty());
        let mut open = vec![(0usize, 0usize)];
        while let Some((at, from)) = open.pop() {
            // Open the child of the largest surface until there are eight: it is the one most rays would have opened.
            let mut children = vec![from];
            while children.len() < 8 {
                let area = |&i: &usize| tree.nodes[children[i]].bounds.half_area();
                let inner = (0..children.len()).filter(|&i| !tree.nodes[children[i]].is_leaf());
                let Some(largest) = inner.max_by(|a, b| area(a).total_cmp(&area(b))) else { break };
                let [left, right] = tree.nodes[children.swap_remove(largest)].children();
                children.extend([left, right]);
            }
            for (lane, &child) in children.iter().enumerate() {
                let node = &tree.nodes[child];
                let target = if node.is_leaf() {
                    self.blocks.push(Block::new(&tree.order[node.run()], triangles));
                    LEAF | (node.count - 1) << COUNT | (self.blocks.len() - 1) as u32
                } else {
                    self.nodes.push(Wide8::empty());
                    open.push((self.nodes.len() - 1, child));
                    self.nodes[at].inner |= 1 << lane;
                    (self.nodes.len() - 1) as u32
                };
                let wide = &mut self.nodes[at];
                wide.children[lane] = target;
                for axis in 0..3 {
                    wide.bounds[axis][0][lane] = node.bounds.min[axis];
                    wide.bounds[axis][1][lane] = node.bounds.max[axis];
                }
            }
        }
    }
}

impl Wide8 {
    fn empty() -> Wide8 {
        Wide8 { bounds: [[[f32::INFINITY; 8], [f32::NEG_INFINITY; 8]]; 3], children: [NOBODY; 8], inner: 0 }
    }
}

impl Block {
    pub(super) fn new(held: &[u32], triangles: &[[[f32; 3]; 3]]) -> Block {
        let mut block = Block { corners: [[[f32::NAN; 8]; 3]; 3], triangles: [crate::straight::ray::Hit::NONE; 8] };
        for (lane, &i) in held.iter().enumerate() {
            block.triangles[lane] = i;
            for corner in 0..3 {
                for axis in 0..3 {
                    block.corners[corner][axis][lane] = triangles[i as usize][corner][axis];
                }
            }
        }
        block
    }

    /// The corners in one lane.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> [[f32; 3]; 3] {
        let [a, b, c] = &self.corners;
        [[a[0][lane], a[1][lane], a[2][lane]], [b[0][lane], b[1][lane], b[2][lane]], [c[0][lane], c[1][lane], c[2][lane]]]
    }
}

/// Which of the processor's instructions are used; each has those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Instructions {
    /// What every processor has.
    Portable,
    /// Eight numbers at once.
    Avx2,
    /// Sixteen.
    Avx512,
}

impl Instructions {
    /// What this processor has.
    pub fn detected() -> Instructions {
        #[cfg(target_arch = "x86_64")]
        {
            use std::arch::is_x86_feature_detected as has;
            let eight = has!("avx2") && has!("fma") && has!("bmi1") && has!("bmi2") && has!("popcnt") && has!("lzcnt");
            if eight && has!("avx512f") && has!("avx512dq") && has!("avx512vl") {
                return Instructions::Avx512;
            }
            if eight {
                return Instructions::Avx2;
            }
        }
        Instructions::Portable
    }
}
