//! Straight rays through trees of boxes: Sei 2008, reproduced and beaten. The trees themselves are the judge's (`lensrunner::judge::bvh`).
//!
//! - [`ray`], [`triangle`]: straight rays, and one of them against one triangle.
//! - [`single`]: a ray through the binary tree, the plain method.
//! - [`packet`]: packets from one eye through it: those of Wald et al. 2007, and those of Sei 2008 that split.
//! - [`wide`]: the tree of eight, ray by ray, and in packets of any size that split as they descend (`sweep` takes a first look at a
//!   packet, `wide_packet` splits it, `wide_eye` and `wide_group` end with what is left: 64 rays from one eye, sixteen of any kind).
//! - [`validate`](mod@validate): says what is wrong with a tree.
//! - [`scenes`]: what they are measured on.

// An axis indexes several arrays at once.
#![allow(clippy::needless_range_loop)]

mod bundle;
mod edges;
mod hull;
mod lanes;
#[cfg(target_arch = "x86_64")]
mod lanes_x86;
pub mod packet;
pub mod ray;
pub mod scenes;
pub mod single;
mod split;
mod sweep;
pub mod triangle;
pub mod validate;
pub mod wide;
mod wide_best;
mod wide_eye;
mod wide_group;
mod wide_packet;
mod wide_ray;

pub use bundle::EyePacket;
pub use lensrunner::judge::bvh::{Bounds, Costs, MAX_DEPTH, Node, Scalar, Settings, Tree, bounds, build, order, tree};
pub use packet::EyePackets;
pub use ray::{Hit, Ray};
pub use single::Mesh;
pub use validate::{Census, Fault, validate};
pub use wide::{Instructions, Wide};
pub use wide_packet::Packets;
