//! Straight rays through trees of boxes: Sei 2008, reproduced and beaten. The trees themselves are the judge's (`lensrunner::judge::bvh`).
//!
//! - [`ray`], [`triangle`]: straight rays, and one of them against one triangle.
//! - [`single`]: a ray through the binary tree, the plain method.
//! - [`packet`]: packets from one eye through it: those of Wald et al. 2007, and those of Sei 2008 that split.
//! - [`wide`]: the tree of eight boxes a node, ray by ray, and in packets of any size that split as they descend.
//! - [`scenes`]: what they are measured on.

// An axis indexes several arrays at once.
#![allow(clippy::needless_range_loop)]

mod bundle;
pub mod packet;
pub mod ray;
pub mod scenes;
pub mod single;
mod split;
pub mod triangle;
pub mod wide;

pub use bundle::EyePacket;
pub use lensrunner::judge::bvh::{Bounds, BvhSettings, Costs, MAX_DEPTH, Node, Scalar, Tree, bounds, build, order, tree};
pub use packet::EyePackets;
pub use ray::{Hit, Ray};
pub use single::Mesh;
pub use wide::{Instructions, Packets, Wide};
