//! What Rust and WGSL share for the disk; `shaders/disk/types.wgsl` is the other half and says what each field means.

use bytemuck::{Pod, Zeroable};

/// `DiskFrame` in WGSL.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/disk/types.wgsl")]
pub struct DiskFrame {
    pub towards: [f32; 3],
    pub camera_sine: f32,
    pub sideways: [f32; 3],
    pub camera_cosine: f32,
    pub upwards: [f32; 3],
    pub steepness: f32,
    pub renewals: f32,
    pub renewals_per_time: f32,
    pub renewal: f32,
    pub newborn: f32,
    pub contrast: f32,
    pub filled: f32,
    pub error_budget: f32,
    pub least_width: f32,
    pub columns: u32,
    pub arcs: u32,
    pub rows: u32,
    pub rings: u32,
    pub regions: [u32; 4],
    pub vertex_room: u32,
    pub near_orders: u32,
    pub thickness: f32,
    pub regions_end: u32,
    pub unit: f32,
    pub close: f32,
    pub most_looks: f32,
    pub unused: f32,
    pub offset: [f32; 2],
    pub offset_step: [f32; 2],
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
    pub bend: [f32; 4],
}

/// `Counters` in WGSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/disk/types.wgsl")]
pub struct DiskCounters {
    pub vertices: u32,
    pub indices: [u32; 4],
    pub arcs: u32,
    pub coarse: u32,
    pub caught: u32,
    pub stage: u32,
}

impl DiskCounters {
    /// A warning about these counts, in words; None if all is well.
    pub fn complaint(&self) -> Option<String> {
        let coarse =
            (self.coarse > 0).then(|| format!("{} arcs of the disk are drawn coarser than asked: raise disk.error_budget", self.coarse));
        let caught = (self.caught > 0).then(|| format!("{} places of the disk were not finite and are left out", self.caught));
        let parts: Vec<String> = coarse.into_iter().chain(caught).collect();
        (!parts.is_empty()).then(|| parts.join("; "))
    }
}

impl std::fmt::Display for DiskCounters {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let [first, second, third, beyond] = self.indices.map(|indices| indices / 3);
        let first = first + beyond;
        write!(f, "disk: {} arcs over all orders; {first}, {second} and {third} triangles by order", self.arcs)
    }
}

/// Bytes of `DiskArguments` in WGSL.
pub const ARGUMENTS_BYTES: u64 = 144;
/// Offset of the first list's draw; each takes [`ARGUMENTS_DRAW_STEP`].
pub const ARGUMENTS_DRAW: u64 = 16;
/// Bytes between the draws of two lists.
pub const ARGUMENTS_DRAW_STEP: u64 = 32;
/// Bytes of `SeenSprite` in WGSL.
pub const SEEN_SPRITE_BYTES: u64 = 64;
