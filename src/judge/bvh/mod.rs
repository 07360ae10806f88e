//! Bounding volume hierarchies over any axis-aligned boxes (Sei 2008). Their inspector, and straight rays through them, are in the
//! laboratory.
//!
//! - [`bounds`], [`build`](mod@build), [`tree`]: a tree.
//! - [`order`]: which pixels make good packets.

// An axis indexes several arrays at once.
#![allow(clippy::needless_range_loop)]

pub mod bounds;
pub mod build;
pub mod order;
pub mod tree;

pub use bounds::{Bounds, Scalar};
pub use build::{BvhSettings, build};
pub use tree::{Costs, MAX_DEPTH, Node, Tree};
