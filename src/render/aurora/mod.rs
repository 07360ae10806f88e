//! The aurora on the GPU. The ends of chords go through the lensing lookup; between them streaks are walked on the screen (Sekiguchi et
//! al.). Strokes are added up per spectral line, and the lines become a colour at the end.
//!
//! [`AuroraAnimation`] simulates the curtains and says for each frame what is to be drawn ([`AuroraFrame`]); [`Aurora`] holds the passes.

mod animation;
mod colours;
pub mod ground;
mod levels;
pub mod node_history;
mod pass;
mod pipelines;
pub mod ration;
pub mod rooms;
pub mod shift;
pub mod sight;
pub mod veil;

pub use animation::planet_view::planet_history;
pub use animation::streaks::{RED_EVERY, SMOOTH};
pub use animation::{AuroraAnimation, AuroraFrame, RAYS_PERIOD};
pub use colours::Colours;
pub use levels::{DEPTH_TILES, LEAST_DEPTH_TILE, PYRAMID};
pub use pass::Aurora;
pub use shift::SHIFTS;

use bytemuck::{Pod, Zeroable};

/// `AuroraSettings` in WGSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/aurora/streaks.wgsl")]
pub struct AuroraSettings {
    pub counts: [u32; 4],
    pub history: [u32; 4],
    pub clock: [f32; 4],
    pub strokes: [f32; 4],
    pub heights: [f32; 4],
}

/// `Segment` in WGSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/aurora/streaks.wgsl")]
pub struct Segment {
    pub range: [u32; 4],
    pub light: [f32; 4],
}

/// The walk of Sekiguchi et al.; as in shaders/aurora/streaks.wgsl.
pub const LINEAR: u32 = 1;
/// Every second streak in the south; as in shaders/aurora/streaks.wgsl.
pub const BOTH_POLES: u32 = 2;
