//! Bounding volume hierarchies: paper 4 (Sei 2008), reproduced and beaten.
//!
//! - [`bounds`], [`build`](mod@build), [`tree`], [`validate`](mod@validate): a tree over any axis-aligned boxes, and its inspector.

pub mod bounds;
pub mod build;
pub mod tree;
pub mod validate;

pub use bounds::{Bounds, Scalar};
pub use build::{Costs, Settings, build};
pub use tree::{MAX_DEPTH, Node, Tree};
pub use validate::{Census, Fault, validate};
