//! The aurora on the GPU. The ends of chords go through the lensing lookup; between them streaks are walked on the screen (Sekiguchi et
//! al.). Strokes are added up per spectral line, and the lines become a colour at the end.
//!
//! [`AuroraAnimation`] simulates the curtains and says for each frame what is to be drawn ([`AuroraFrame`]); [`Aurora`] holds the passes.

mod animation;
pub mod capacities;
mod colours;
pub mod ground;
mod levels;
pub mod node_history;
pub mod occlusion;
mod pass;
mod pipelines;
pub mod ration;
pub mod shift;
pub mod sight;

pub use animation::planet_view::PlanetLine;
pub use animation::streaks::{RED_EVERY, SMOOTH};
pub use animation::{AuroraAnimation, AuroraFrame, RAYS_PERIOD};
pub use colours::Colours;
pub use levels::{LEAST_DEPTH_TILE, PYRAMID};
pub use pass::{Aurora, CHORD_END_BYTES, REFERENCE_BYTES, STROKE_BYTES};
pub use shift::SHIFTS;

use bytemuck::{Pod, Zeroable};

/// `AuroraSettings` in WGSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/aurora/streaks.wgsl")]
pub struct AuroraSettings {
    pub streaks: u32,
    pub chords: u32,
    pub parts: u32,
    pub row_nodes: u32,
    pub newest_row: u32,
    pub segments: u32,
    pub capacity: u32,
    pub flags: u32,
    pub row_seconds: f32,
    pub ahead: f32,
    pub clock: f32,
    pub contrast: f32,
    pub point: f32,
    pub levels: u32,
    pub midnight: [f32; 2],
    pub green_top: f32,
    pub green_foot: f32,
    pub red_top: f32,
    pub red_foot: f32,
}

/// `Segment` in WGSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/aurora/streaks.wgsl")]
pub struct Segment {
    pub first_streak: u32,
    pub streaks: u32,
    pub first_node: u32,
    pub span: u32,
    pub collisions: f32,
    pub width: f32,
    pub length: f32,
}

/// `CurtainNode` in WGSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/aurora/streaks.wgsl")]
pub struct CurtainNode {
    pub place: [f32; 2],
    pub flux: f32,
    pub along: f32,
}

/// The walk of Sekiguchi et al.; as in shaders/aurora/streaks.wgsl.
pub const LINEAR: u32 = 1;
/// Every second streak in the south; as in shaders/aurora/streaks.wgsl.
pub const BOTH_POLES: u32 = 2;
