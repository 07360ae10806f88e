//! Bounding volume hierarchies: paper 4 (Sei 2008), reproduced and beaten.
//!
//! - [`bounds`], [`build`](mod@build), [`tree`], [`validate`](mod@validate): a tree over any axis-aligned boxes, and its inspector.
//! - [`ray`], [`triangle`]: straight rays, and one of them against one triangle.
//! - [`single`]: a ray through the binary tree, the plain method.
//! - [`packet`]: packets from one eye through it: Wald's, and paper 4's that split.
//! - [`wide`]: the tree of eight, ray by ray, and in packets of any size that split as they descend (`sweep` takes a first look at a packet, `wide_packet`
//!   splits it, `wide_eye` and `wide_group` end with what is left: 64 rays from one eye, sixteen of any kind).
//! - [`order`]: which pixels make good packets.

// An axis indexes several arrays at once.
#![allow(clippy::needless_range_loop)]

pub mod bounds;
pub mod build;
mod edges;
mod hull;
mod lanes;
#[cfg(target_arch = "x86_64")]
mod lanes_x86;
pub mod order;
pub mod packet;
pub mod ray;
pub mod single;
mod split;
mod sweep;
pub mod tree;
pub mod triangle;
pub mod validate;
pub mod wide;
mod wide_best;
mod wide_eye;
mod wide_group;
mod wide_packet;
mod wide_ray;

pub use bounds::{Bounds, Scalar};
pub use build::{Costs, Settings, build};
pub use packet::{EyePacket, EyePackets};
pub use ray::{Hit, Ray};
pub use single::Mesh;
pub use tree::{MAX_DEPTH, Node, Tree};
pub use validate::{Census, Fault, validate};
pub use wide::{Instructions, Wide};
pub use wide_packet::Packets;
