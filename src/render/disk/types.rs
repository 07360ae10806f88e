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

/// `RadialGas` in WGSL.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/disk/types.wgsl")]
pub struct RadialGas {
    pub radius: f32,
    pub lead: f32,
    pub ln_temperature: f32,
    pub depth: f32,
    pub outward: f32,
    pub along: f32,
    pub half_height: f32,
    pub pattern_height: f32,
}

/// `Circle` in WGSL.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/disk/types.wgsl")]
pub struct Circle {
    pub gas: RadialGas,
    pub beyond: f32,
    pub gap_radius: f32,
    pub gap: f32,
    pub gap_sides: f32,
    pub order: u32,
    pub first_row: u32,
    pub last_row: u32,
    pub first_sample: u32,
    pub nearer_depth: f32,
    pub nearer_outward: f32,
    pub nearer_along: f32,
    pub nearer_radius: f32,
}

/// `DiskVertex` in WGSL.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/disk/types.wgsl")]
pub struct DiskVertex {
    pub apparent: [f32; 3],
    pub path: f32,
    pub turns: f32,
    pub pattern_height: f32,
    pub ln_temperature: f32,
    pub depth: f32,
    pub ln_g: f32,
    pub cosine: f32,
    pub filled: f32,
    pub from_middle: f32,
    pub half_width: f32,
    pub bend_height: f32,
    pub bend_light: f32,
    pub bend_depth: f32,
    pub side: f32,
    pub unused: [f32; 3],
}

/// `Ring` of shaders/disk/arcs/bindings.wgsl.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/disk/arcs/bindings.wgsl")]
pub struct Ring {
    pub inner: u32,
    pub outer: u32,
    pub order: u32,
    pub unused: u32,
}

/// `Bend` of shaders/disk/arcs/bindings.wgsl.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/disk/arcs/bindings.wgsl")]
pub struct Bend {
    pub height: f32,
    pub light: f32,
    pub other_light: f32,
    pub depth: f32,
}

/// `Turning` of shaders/disk/polygons.wgsl.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/disk/polygons.wgsl")]
pub struct Turning {
    pub rate: f32,
    pub azimuth: f32,
}

/// `Sprite` of shaders/disk/sprites.wgsl.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/disk/sprites.wgsl")]
pub struct Sprite {
    pub radius: f32,
    pub sigma: f32,
    pub step: f32,
}

/// `SpriteImage` of shaders/disk/sprites.wgsl.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/disk/sprites.wgsl")]
pub struct SpriteImage {
    pub order: u32,
    pub ring_width: f32,
    pub count: u32,
    pub end: f32,
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

/// Bytes of `Segments` and `Job` in WGSL.
pub const SEGMENTS_BYTES: u64 = 16;
/// See [`SEGMENTS_BYTES`].
pub const JOB_BYTES: u64 = 12;
/// Bytes of `DiskArguments` in WGSL.
pub const ARGUMENTS_BYTES: u64 = 144;
/// Offset of the first list's draw; each takes [`ARGUMENTS_DRAW_STEP`].
pub const ARGUMENTS_DRAW: u64 = 16;
/// Bytes between the draws of two lists.
pub const ARGUMENTS_DRAW_STEP: u64 = 32;
/// Bytes of `SeenSprite` in WGSL.
pub const SEEN_SPRITE_BYTES: u64 = 64;
