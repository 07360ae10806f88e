//! The types that Rust and WGSL share, `shaders/gpu/types.wgsl` being the other half. tests/render/gpu/types.rs holds sizes, offsets and
//! constants equal.

use std::mem::offset_of;

use bytemuck::{Pod, Zeroable};

/// What the whole frame shares: camera, size, switches. Field by field as `Frame` in WGSL, where the meaning of each is written.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/gpu/types.wgsl")]
pub struct Frame {
    pub camera_from_rain: [[f32; 4]; 4],
    pub rain_from_camera: [[f32; 4]; 4],
    pub outward: [f32; 3],
    pub camera_radius: f32,
    pub side_a: [f32; 3],
    pub least_width: f32,
    pub side_b: [f32; 3],
    pub river_speed: f32,
    pub focal: [f32; 2],
    pub near: f32,
    pub time: f32,
    pub size: [f32; 2],
    pub pixel: f32,
    pub error_budget: f32,
    pub exposure_bias: f32,
    pub star_brightness: f32,
    pub sky_brightness: f32,
    pub bloom: f32,
    pub least_exposure: f32,
    pub greatest_exposure: f32,
    pub adaptation: f32,
    pub shadow_edge: f32,
    pub flags: u32,
    pub halvings: u32,
    pub star_sigma: f32,
    pub faintest_star: f32,
    pub capacity: Capacity,
    pub least_fill: f32,
    pub greatest_fill: f32,
    pub last_exposure: f32,
    pub exposure_known: f32,
    pub unmetered_middle: [f32; 2],
    pub unmetered_radius: f32,
    pub exposure_key: f32,
    pub disk_indices: [u32; 4],
    pub exposure_key_without_disk: f32,
    pub most_rise: f32,
    pub rise_per_luminance: f32,
    pub enlargement: f32,
}

/// `Capacity` in WGSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/gpu/types.wgsl")]
pub struct Capacity {
    pub vertices: u32,
    pub indices: u32,
    pub work: u32,
    pub thin: u32,
}

/// `Adaptation` in WGSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/gpu/types.wgsl")]
pub struct Adaptation {
    pub exposure: f32,
    pub metered: f32,
    pub known: f32,
    pub steadied: f32,
}

/// Bits of `Frame::flags`, the `FLAG_*` of WGSL.
pub mod flags {
    /// Light changes its colour.
    pub const DOPPLER: u32 = 1;
    /// Light changes its strength.
    pub const BEAMING: u32 = 2;
    /// The camera is inside the horizon.
    pub const INSIDE: u32 = 16;
    /// The exposure stays as it is.
    pub const HOLD_EXPOSURE: u32 = 32;
    /// The error of an edge is that of its midpoint alone.
    pub const MIDPOINT: u32 = 64;
}

/// One object seen in one image order; `Instance` in WGSL.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/gpu/types.wgsl")]
pub struct Instance {
    pub offset: [f32; 3],
    pub delay: f32,
    pub position: [f32; 3],
    pub engines_off: f32,
    pub velocity: [f32; 3],
    pub scale: f32,
    pub acceleration: [f32; 3],
    pub across_a: f32,
    pub jerk: [f32; 3],
    pub across_b: f32,
    pub snap: [f32; 3],
    pub crossings: f32,
    pub momentum: [f32; 3],
    pub gamma: f32,
    pub contraction: [f32; 3],
    pub rounding: f32,
    pub force: [f32; 3],
    pub path_across: f32,
    pub spin: [f32; 3],
    pub spin_slack: f32,
    pub shape_x: [f32; 3],
    pub strictness: f32,
    pub shape_y: [f32; 3],
    pub first_node: f32,
    pub shape_z: [f32; 3],
    pub nodes_per_time: f32,
    pub turn_x: [f32; 3],
    pub node_intervals: f32,
    pub turn_y: [f32; 3],
    pub node_texel: u32,
    pub turn_z: [f32; 3],
    pub path_along: f32,
    pub light: [[f32; 4]; 3],
    pub bounds: [Cap; 3],
    pub order: u32,
    pub object: u32,
    pub first_seen: u32,
    pub first_state: u32,
    pub first_vertex: u32,
    pub vertex_count: u32,
    pub first_edge: u32,
    pub edge_count: u32,
    pub first_triangle: u32,
    pub triangle_count: u32,
    pub first_material: u32,
    pub flags: u32,
}

/// `Cap` in WGSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/gpu/types.wgsl")]
pub struct Cap {
    pub middle: [f32; 3],
    pub rim: f32,
}

impl Instance {
    /// Whether none of its numbers is NaN or infinite.
    pub fn is_finite(&self) -> bool {
        // Those before its order, but for the one that counts texels.
        let numbers: &[f32] = bytemuck::cast_slice(&bytemuck::bytes_of(self)[..offset_of!(Instance, order)]);
        let texel = offset_of!(Instance, node_texel) / size_of::<f32>();
        numbers.iter().enumerate().all(|(k, x)| k == texel || x.is_finite())
    }
}

/// Bits of `Instance::flags`, the `INSTANCE_*` of WGSL.
pub mod placed {
    /// The centre strays from its smooth way.
    pub const STRAYS: u32 = 64;
    /// Both sides of every triangle are drawn.
    pub const TWO_SIDED: u32 = 1;
    /// Static: held in place.
    pub const STATIC: u32 = 2;
    /// A thin image.
    pub const THIN: u32 = 4;
    /// The image by light of E < 0.
    pub const MINUS: u32 = 8;
    /// An image of a higher order of a few pixels' width, drawn out along the ring.
    pub const NARROW_RING: u32 = 16;
    /// The player's own ship.
    pub const OWN: u32 = 32;
}

/// A body that is held in place, uploaded once; `HeldBody` in WGSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/instances/held.wgsl")]
pub struct HeldBody {
    pub position: [f32; 3],
    pub reach: f32,
    pub position_rest: [f32; 3],
    pub scale: f32,
    pub attitude: [f32; 4],
    pub light: [[f32; 4]; 3],
    pub first_model: u32,
    pub model_count: u32,
    pub object: u32,
    pub flatness: f32,
}

/// A model of held bodies; `HeldModel` in WGSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/instances/held.wgsl")]
pub struct HeldModel {
    pub first_vertex: u32,
    pub vertex_count: u32,
    pub first_edge: u32,
    pub edge_count: u32,
    pub first_triangle: u32,
    pub triangle_count: u32,
    pub first_material: u32,
    pub below: f32,
}

/// What of a frame decides how held bodies are placed; `HeldFrame` in WGSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/instances/held.wgsl")]
pub struct HeldFrame {
    pub camera: [f32; 3],
    pub bodies: u32,
    pub camera_rest: [f32; 3],
    pub images: u32,
    pub orders: u32,
    pub flags: u32,
    pub bounded: u32,
    pub thin_below: f32,
    pub coarse_below: f32,
    pub least_width: f32,
    pub allowed: f32,
    pub strictness: f32,
    pub has_thin: u32,
    pub images_end: u32,
    pub vertices_end: [u32; 2],
    pub states_end: [u32; 2],
    pub unused: [u32; 2],
}

/// `ModelVertex` in WGSL.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/gpu/types.wgsl")]
pub struct ModelVertex {
    pub position: [f32; 3],
    pub u: f32,
    pub normal: [f32; 3],
    pub v: f32,
    pub material: u32,
    pub unused: [u32; 3],
}

/// `ModelTriangle` in WGSL.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/gpu/types.wgsl")]
pub struct ModelTriangle {
    pub vertices: [u32; 3],
    pub side: u32,
    pub edges: [u32; 3],
    pub unused: u32,
    pub seen_from: [u32; 4],
}

/// Threads of a workgroup of the stages, and of a chunk; `@workgroup_size` in WGSL.
pub const CHUNK: u32 = 64;

/// `Chunk` in WGSL.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/gpu/types.wgsl")]
pub struct Chunk {
    pub instance: u32,
    pub first: u32,
}

/// `SeenVertex` in WGSL, read back by tests.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/gpu/types.wgsl")]
pub struct SeenVertex {
    pub apparent: [f32; 3],
    pub path: f32,
    pub normal: [f32; 3],
    pub shift: f32,
    pub leaving: [f32; 3],
    pub radius: f32,
    pub uv: [f32; 2],
    pub instance: u32,
    pub material: u32,
    pub axis_uv: [f32; 2],
    pub from_axis: f32,
    pub height: f32,
}

/// `Material` in WGSL.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/gpu/types.wgsl")]
pub struct Material {
    pub base: [f32; 3],
    pub alpha: f32,
    pub emissive: [f32; 3],
    pub roughness: f32,
    pub metallic: f32,
    pub layer: f32,
    pub temperature: f32,
    pub nozzle: f32,
}

/// `Star` in WGSL.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/gpu/types.wgsl")]
pub struct Star {
    pub direction: [f32; 3],
    pub flux: f32,
    pub temperature: f32,
    pub luminance: f32,
    pub unused: [f32; 2],
}

/// Orders in which stars are projected; `STAR_ORDERS` of WGSL.
pub const STAR_ORDERS: u32 = 2;

/// `StarCluster` in WGSL.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/gpu/types.wgsl")]
pub struct StarCluster {
    pub middle: [f32; 3],
    pub spread: f32,
    pub sine: f32,
    pub first: f32,
    pub count: f32,
    pub unused: f32,
}

/// `Counters` in WGSL: what the stages of geometry counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/geometry/bindings.wgsl")]
pub struct Counters {
    pub vertices: u32,
    pub indices: u32,
    pub work: u32,
    pub thin: u32,
    pub pieces: [u32; 2],
    pub turn: u32,
    pub coarse: u32,
    pub cut: u32,
    pub caught: u32,
    pub model_vertices: u32,
    pub lost: u32,
    pub outside: u32,
    pub split: u32,
    pub calmed: u32,
    pub passes: u32,
    pub is_last: u32,
    pub simpler: u32,
    pub left_out: u32,
    pub images: u32,
    pub held_vertices: [u32; 2],
    pub held_states: [u32; 2],
    pub chunks: [u32; 3],
}

impl Counters {
    /// A warning about these counts, in words; None if all is well.
    pub fn complaint(&self) -> Option<String> {
        let mut parts = Vec::new();
        if self.coarse > 0 {
            parts.push(format!("{} patches are drawn coarser than asked: raise render.vertex_budget", self.coarse));
        }
        if self.lost > 0 {
            parts.push(format!("{} patches found no room at all", self.lost));
        }
        if self.caught > 0 {
            parts.push(format!("{} results were not finite and are left out", self.caught));
        }
        if self.calmed > 0 {
            parts.push(format!("{} images show a body that turned or sprang faster than any can, slower", self.calmed));
        }
        if self.simpler > 0 {
            parts.push(format!("{} small images are drawn by coarse models, for there is no room for finer ones", self.simpler));
        }
        if self.left_out > 0 {
            parts.push(format!("{} small images are left out, for there is no room for their models", self.left_out));
        }
        if self.outside > 0 {
            parts.push(format!("{} triangles lay outside of where their object's image can be and are left out", self.outside));
        }
        (!parts.is_empty()).then(|| parts.join("; "))
    }
}

impl std::fmt::Display for Counters {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let Counters { model_vertices, vertices, indices, work, thin, .. } = self;
        write!(
            f,
            "{model_vertices} vertices of models, {} of {work} blocks; {} triangles, {} thin",
            vertices.saturating_sub(*model_vertices),
            indices / 3,
            thin / 3
        )
    }
}

/// Bytes of `Piece` in WGSL.
pub const PIECE_BYTES: u64 = 64;
/// Bytes of `WorkItem` in WGSL.
pub const WORK_BYTES: u64 = 112;
/// Bytes of `ThinVertex` in WGSL.
pub const THIN_BYTES: u64 = 32;
/// Bytes of `Arguments` in WGSL, and where each part of it lies.
pub const ARGUMENTS_BYTES: u64 = 160;
/// Offset of the dispatch of the refine stage.
pub const ARGUMENTS_REFINE: u64 = 0;
/// Offset of the dispatch over the work items of the mesh stage.
pub const ARGUMENTS_MESH: u64 = 16;
/// Offset of the dispatch over its vertices.
pub const ARGUMENTS_MESH_VERTICES: u64 = 80;
/// Offset of the indexed draw of opaque triangles.
pub const ARGUMENTS_OPAQUE: u64 = 32;
/// Offset of the draw of thin triangles.
pub const ARGUMENTS_THIN: u64 = 64;
/// Offset of the dispatch over thin triangles.
pub const ARGUMENTS_THIN_LISTS: u64 = 96;
/// Offsets of the dispatches over the chunks of vertices, edges and triangles.
pub const ARGUMENTS_CHUNKS: [u64; 3] = [112, 128, 144];
/// Bytes of `SkyCorner` in WGSL.
pub const SKY_CORNER_BYTES: u64 = 48;

/// Arguments of the two draws of the sky's cells, interpolated and exact, and the grid; `CellDraws` of WGSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/sky/cells.wgsl")]
pub struct CellDraws {
    pub smooth: [u32; 5],
    pub exact: [u32; 5],
    pub columns: u32,
    pub rows: u32,
    pub side: u32,
    pub unused: u32,
}
