//! The tree of eight boxes a node, ray by ray and in packets of any size that split as they descend.
//!
//! - [`tree`]: the tree; `ray`: one ray through it.
//! - [`packet`]: packets: `sweep` takes a first look at one, `hull` is the space that it sweeps.
//! - `eye`, `group`, `best`: what is left at the end: 64 rays from one eye, sixteen of any kind, and the nearest hits so far.
//! - `edges`: planes through an eye and the edges of triangles.
//! - `lanes`, `lanes_x86`: eight and sixteen numbers at once.

mod best;
mod edges;
mod eye;
mod group;
mod hull;
mod lanes;
#[cfg(target_arch = "x86_64")]
mod lanes_x86;
pub mod packet;
mod ray;
mod sweep;
pub mod tree;

pub use packet::Packets;
pub use tree::{Instructions, Wide};
