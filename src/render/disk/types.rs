//! What Rust and WGSL share for the disk; `shaders/disk/types.wgsl` is the other half and says what each field means.

use bytemuck::{Pod, Zeroable};

/// Generations of streaks that a frame may show.
pub const GENERATIONS: usize = 16;

/// `DiskFrame` in WGSL.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/disk/types.wgsl")]
pub struct DiskFrame {
    pub towards: [f32; 4],
    pub sideways: [f32; 4],
    pub upwards: [f32; 4],
    pub renewal: [f32; 4],
    pub gas: [f32; 4],
    pub sizes: [u32; 4],
    pub regions: [u32; 4],
    pub room: [u32; 4],
    pub sprites: [f32; 4],
    pub offsets: [[f32; 4]; GENERATIONS],
}

/// `Circle` in WGSL.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/disk/types.wgsl")]
pub struct Circle {
    pub gas: [f32; 4],
    pub motion: [f32; 4],
    pub place: [f32; 4],
    pub rows: [u32; 4],
}

/// `DiskVertex` in WGSL.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/disk/types.wgsl")]
pub struct DiskVertex {
    pub apparent: [f32; 4],
    pub gas: [f32; 4],
    pub more: [f32; 4],
}

/// `Counters` in WGSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/disk/types.wgsl")]
pub struct DiskCounters {
    pub vertices: u32,
    pub indices: [u32; 3],
    pub arcs: u32,
    pub coarse: u32,
    pub caught: u32,
    pub stage: u32,
}

/// Bytes of `DiskArguments` in WGSL.
pub const ARGUMENTS_BYTES: u64 = 112;
/// Offset of the draw of order 1; each order takes [`ARGUMENTS_DRAW_STEP`].
pub const ARGUMENTS_DRAW: u64 = 16;
/// Bytes between the draws of two orders.
pub const ARGUMENTS_DRAW_STEP: u64 = 32;
/// Bytes of `SeenSprite` in WGSL.
pub const SEEN_SPRITE_BYTES: u64 = 32;
