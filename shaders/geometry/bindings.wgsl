#define_import_path lensrunner::geometry::bindings

#import lensrunner::gpu::bindings::TABLE_ROW
#import lensrunner::gpu::types::{Chunk, ModelTriangle, ModelVertex, Piece, SeenVertex, ThinVertex, WorkItem}

// Models are in tables, three texels for a vertex, one for an edge, two for a triangle, bits of f32 or u32.
@group(1) @binding(1) var vertex_table: texture_2d<u32>;
@group(1) @binding(2) var edge_table: texture_2d<u32>;
@group(1) @binding(3) var triangle_table: texture_2d<u32>;
/// Chunks of 64 threads of one instance, one a texel, filled up to the size of the dispatch with NO_INSTANCE.
@group(1) @binding(4) var chunk_table: texture_2d<u32>;
// Seven storage buffers and the arguments make eight: WebGPU guarantees no more to a stage.
@group(1) @binding(5) var<storage, read_write> seen: array<SeenVertex>;
/// First of each model vertex (from `ids.z` of its instance on) the position at emission by the axis, as `ProjectedPoint.by_axis`; w:
/// VERTEX_*. Then of each model edge (from `ids.w` on) x: level (bits of a u32), y: EDGE_* (bits of a u32), z: where the axis cuts, as a
/// fraction, w: error in radians.
@group(1) @binding(6) var<storage, read_write> states: array<vec4<f32>>;
/// Two queues of `capacity.z` pieces each: one is split into the other.
@group(1) @binding(7) var<storage, read_write> pieces: array<Piece>;
@group(1) @binding(8) var<storage, read_write> work: array<WorkItem>;
@group(1) @binding(9) var<storage, read_write> indices: array<u32>;
@group(1) @binding(10) var<storage, read_write> thin: array<ThinVertex>;
@group(1) @binding(11) var<storage, read_write> counters: Counters;

/// Where a texel of a table is.
fn table_place(texel: u32) -> vec2<u32> {
    return vec2<u32>(texel % TABLE_ROW, texel / TABLE_ROW);
}

fn model_vertex(number: u32) -> ModelVertex {
    let normal = textureLoad(vertex_table, table_place(3u * number + 1u), 0);
    let position = textureLoad(vertex_table, table_place(3u * number), 0);
    let material = textureLoad(vertex_table, table_place(3u * number + 2u), 0).x;
    return ModelVertex(bitcast<vec3<f32>>(position.xyz), bitcast<f32>(position.w), bitcast<vec3<f32>>(normal.xyz), bitcast<f32>(normal.w),
        material, 0u, 0u, 0u);
}

fn model_position(number: u32) -> vec3<f32> {
    return bitcast<vec3<f32>>(textureLoad(vertex_table, table_place(3u * number), 0).xyz);
}

/// The two vertices of an edge, and those opposite to it in its two triangles, or `ALONE`.
fn model_edge(number: u32) -> vec4<u32> {
    return textureLoad(edge_table, table_place(number), 0);
}

fn model_triangle(number: u32) -> ModelTriangle {
    let corners = textureLoad(triangle_table, table_place(3u * number), 0);
    let edges = textureLoad(triangle_table, table_place(3u * number + 1u), 0);
    let seen_from = textureLoad(triangle_table, table_place(3u * number + 2u), 0);
    return ModelTriangle(corners.xyz, corners.w, edges.xyz, edges.w, seen_from);
}

fn chunk_of(number: u32) -> Chunk {
    let words = textureLoad(chunk_table, table_place(number), 0);
    return Chunk(words.x, words.y);
}

struct Counters {
    vertices: atomic<u32>,
    indices: atomic<u32>,
    work: atomic<u32>,
    thin: atomic<u32>,
    /// Lengths of the two queues of pieces; below, which one is read now.
    pieces: array<atomic<u32>, 2>,
    turn: u32,
    /// Patches drawn coarser than asked because a buffer was full or the splitting too deep.
    coarse: atomic<u32>,
    /// Triangles cut at the axis.
    cut: atomic<u32>,
    /// Results that were not finite and were left out.
    caught: atomic<u32>,
    /// Seen vertices before those of the mesh stage.
    model_vertices: u32,
    /// Patches that found no room at all.
    lost: atomic<u32>,
    /// Triangles outside of where their object's image can be, left out.
    outside: atomic<u32>,
    /// Pieces split so far.
    split: u32,
    /// Images of bodies that are drawn as if they moved more slowly, as the processor counted them.
    calmed: u32,
    /// Passes of splitting that had anything to split.
    passes: u32,
    /// 1 in the last pass: what would be split is drawn as it is.
    is_last: u32,
    /// Images that show their coarsest model because finer ones found no room, and those that found none at all.
    simpler: atomic<u32>,
    left_out: atomic<u32>,
    /// What is taken, by the processor and by what is held: instances, seen vertices and states in both rooms of `HeldFrame`, chunks of
    /// vertices, edges and triangles.
    images: atomic<u32>,
    held_vertices: array<atomic<u32>, 2>,
    held_states: array<atomic<u32>, 2>,
    chunks: array<atomic<u32>, 3>,
}

/// Indirect arguments, one row of four words each (an indexed draw takes two).
struct Arguments {
    refine: vec4<u32>,
    mesh: vec4<u32>,
    opaque: vec4<u32>,
    opaque_rest: vec4<u32>,
    thin: vec4<u32>,
    mesh_vertices: vec4<u32>,
    thin_lists: vec4<u32>,
    /// Over the chunks of the first three stages, where something is held in place.
    vertices: vec4<u32>,
    edges: vec4<u32>,
    triangles: vec4<u32>,
}

const NO_INSTANCE: u32 = 0xffffffffu;

const VERTEX_PLAIN: f32 = 0.0;
const VERTEX_ON_AXIS: f32 = 1.0;
const VERTEX_UNSEEN: f32 = -1.0;

/// For an edge that is not between two triangles, where a surface ends or several meet: no vertex is opposite.
const ALONE: u32 = 0xffffffffu;

const EDGE_CUT: u32 = 1u;
const EDGE_UNSEEN: u32 = 2u;
/// The edge may be an outline.
const EDGE_LIMB: u32 = 4u;
