//! The validator: walks a whole tree and says what is wrong with it.

use lensrunner_lab::straight::{Bounds, MAX_DEPTH, Scalar, Tree};

/// What a tree may have wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// A node names one that is not there,
    NoSuchNode,
    /// or one that has another parent,
    TwoParents,
    /// or one that stands before it.
    BeforeParent,
    /// Nodes cannot be reached from the root.
    Unreachable,
    TooDeep,
    NoSuchRun,
    NoSuchPrimitive,
    HeldTwice,
    /// Not as many primitives are held and left out as there are.
    Missing,
    /// A box is not the smallest around what it holds.
    WrongBox,
}

/// What the walk has seen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Census {
    /// The deepest leaf; the root lies at 0.
    pub depth: usize,
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
        census.depth = census.depth.max(depth);
        if depth > MAX_DEPTH {
            return Err(Fault::TooDeep);
        }
        let mut union = Bounds::EMPTY;
        if node.is_leaf() {
            let (start, end) = (node.first as usize, node.first as usize + node.count as usize);
            let run = tree.order.get(start..end).ok_or(Fault::NoSuchRun)?;
            for &primitive in run {
                let primitive = primitive as usize;
                let bounds = boxes.get(primitive).ok_or(Fault::NoSuchPrimitive)?;
                if std::mem::replace(&mut held[primitive], true) {
                    return Err(Fault::HeldTwice);
                }
                union = union.union(bounds);
            }
            census.fullest = census.fullest.max(run.len());
        } else {
            for child in node.children() {
                let bounds = tree.nodes.get(child).ok_or(Fault::NoSuchNode)?.bounds;
                if child <= at {
                    return Err(Fault::BeforeParent);
                }
                if std::mem::replace(&mut reached[child], true) {
                    return Err(Fault::TwoParents);
                }
                union = union.union(&bounds);
                stack.push((child, depth + 1));
            }
        }
        if union != node.bounds {
            return Err(Fault::WrongBox);
        }
    }
    if !reached.iter().all(|&reached| reached) {
        return Err(Fault::Unreachable);
    }
    let number = held.iter().filter(|&&h| h).count();
    let improper = boxes.iter().filter(|b| !b.is_proper()).count();
    if number + improper != boxes.len() || improper != tree.left_out || number != tree.order.len() {
        return Err(Fault::Missing);
    }
    Ok(census)
}
