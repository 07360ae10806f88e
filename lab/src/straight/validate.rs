//! The validator: walks a whole tree and says what is wrong with it.

use lensrunner::judge::bvh::{Bounds, MAX_DEPTH, Scalar, Tree};

/// What a tree may have wrong. Numbers are indices of nodes and primitives.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)]
pub enum Fault {
    #[error("node {node} names node {child}, but there are {nodes} nodes")]
    NoSuchNode { node: usize, child: usize, nodes: usize },
    #[error("node {0} has two parents")]
    TwoParents(usize),
    #[error("node {node} stands before its parent {parent}")]
    BeforeParent { node: usize, parent: usize },
    #[error("{0} nodes cannot be reached from the root")]
    Unreachable(usize),
    #[error("node {node} lies {depth} below the root; {MAX_DEPTH} is the most")]
    TooDeep { node: usize, depth: usize },
    #[error("leaf {leaf} has the run {start}..{end} of {primitives} primitives")]
    NoSuchRun { leaf: usize, start: usize, end: usize, primitives: usize },
    #[error("leaf {leaf} holds primitive {primitive}, but there are {primitives}")]
    NoSuchPrimitive { leaf: usize, primitive: usize, primitives: usize },
    #[error("primitive {0} is held twice")]
    HeldTwice(usize),
    #[error("{held} primitives are held and {left_out} left out of {primitives}")]
    Missing { held: usize, left_out: usize, primitives: usize },
    #[error("the box of node {0} is not the smallest around what it holds")]
    WrongBox(usize),
}

/// What the walk has counted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Census {
    /// Nodes of either kind.
    pub nodes: usize,
    /// Leaves among them.
    pub leaves: usize,
    /// The deepest leaf; the root lies at 0.
    pub depth: usize,
    /// The mean depth of leaves.
    pub mean_depth: f64,
    /// Primitives in the fullest leaf.
    pub fullest: usize,
}

/// Checks that every node is reached exactly once, that every proper box is held by exactly one leaf, and that each node's box is the union
/// of what it holds, to the bit. `boxes` are those that the tree was built or refitted with.
pub fn validate<T: Scalar>(tree: &Tree<T>, boxes: &[Bounds<T>]) -> Result<Census, Fault> {
    let mut census = Census::default();
    let mut reached = vec![false; tree.nodes.len()];
    let mut held = vec![false; boxes.len()];
    let mut stack = Vec::new();
    if let Some(root) = reached.first_mut() {
        *root = true;
        stack.push((0, 0));
    }
    while let Some((at, depth)) = stack.pop() {
        let node = &tree.nodes[at];
        census.nodes += 1;
        census.depth = census.depth.max(depth);
        if depth > MAX_DEPTH {
            return Err(Fault::TooDeep { node: at, depth });
        }
        let mut union = Bounds::EMPTY;
        if node.is_leaf() {
            let (start, end) = (node.first as usize, node.first as usize + node.count as usize);
            let run = tree.order.get(start..end).ok_or(Fault::NoSuchRun { leaf: at, start, end, primitives: tree.order.len() })?;
            for &primitive in run {
                let primitive = primitive as usize;
                let bounds = boxes.get(primitive).ok_or(Fault::NoSuchPrimitive { leaf: at, primitive, primitives: boxes.len() })?;
                if std::mem::replace(&mut held[primitive], true) {
                    return Err(Fault::HeldTwice(primitive));
                }
                union = union.union(bounds);
            }
            census.leaves += 1;
            census.mean_depth += depth as f64;
            census.fullest = census.fullest.max(run.len());
        } else {
            for child in node.children() {
                let nodes = tree.nodes.len();
                let bounds = tree.nodes.get(child).ok_or(Fault::NoSuchNode { node: at, child, nodes })?.bounds;
                if child <= at {
                    return Err(Fault::BeforeParent { node: child, parent: at });
                }
                if std::mem::replace(&mut reached[child], true) {
                    return Err(Fault::TwoParents(child));
                }
                union = union.union(&bounds);
                stack.push((child, depth + 1));
            }
        }
        if union != node.bounds {
            return Err(Fault::WrongBox(at));
        }
    }
    if census.nodes < tree.nodes.len() {
        return Err(Fault::Unreachable(tree.nodes.len() - census.nodes));
    }
    let number = held.iter().filter(|&&h| h).count();
    let improper = boxes.iter().filter(|b| !b.is_proper()).count();
    if number + improper != boxes.len() || improper != tree.left_out || number != tree.order.len() {
        return Err(Fault::Missing { held: number, left_out: tree.left_out, primitives: boxes.len() });
    }
    census.mean_depth /= census.leaves.max(1) as f64;
    Ok(census)
}
