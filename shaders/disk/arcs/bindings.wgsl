#define_import_path lensrunner::disk::arcs::bindings

#import lensrunner::disk::types::{Circle, Counters, disk, DiskVertex}
#import lensrunner::gpu::bindings::TABLE_ROW

@group(1) @binding(1) var<storage, read> circles: array<Circle>;
/// σ of each cut, in rad.
@group(1) @binding(2) var<storage, read> cuts: array<f32>;
/// Rows on either side of each ring; z: order.
@group(1) @binding(3) var ring_table: texture_2d<u32>;
/// For each row at each of THIN_AZIMUTHS azimuths, for the ring that begins there: how far its middle deviates from the straight line
/// between its circles. x: height in the pattern; y: logarithm of light, over itself with its sign turned, where θ is positive; w: where it
/// is negative; z: optical depth straight through.
@group(1) @binding(4) var bend_table: texture_2d<f32>;
@group(1) @binding(5) var<storage, read_write> disk_vertices: array<DiskVertex>;
/// For each arc of a circle: x: segments, y: its first vertex past the grid, z: error in rad (bits of an f32), w: sides of the screen
/// beyond which all of it is, as bits.
@group(1) @binding(6) var<storage, read_write> segments: array<vec4<u32>>;
/// For each vertex past the grid: x: segment, y: number, z: of how many.
@group(1) @binding(7) var<storage, read_write> jobs: array<vec4<u32>>;
@group(1) @binding(8) var<storage, read_write> disk_indices: array<u32>;
@group(1) @binding(9) var<storage, read_write> disk_counters: Counters;

fn ring_of(number: u32) -> vec4<u32> {
    return textureLoad(ring_table, vec2<u32>(number % TABLE_ROW, number / TABLE_ROW), 0);
}

fn table_bend(number: u32) -> vec4<f32> {
    return textureLoad(bend_table, vec2<u32>(number % TABLE_ROW, number / TABLE_ROW), 0);
}

/// The end of a list of triangles in the indices.
fn end_of(list: u32) -> u32 {
    return select(disk.regions[min(list + 1u, 3u)], disk.regions_end, list == 3u);
}
