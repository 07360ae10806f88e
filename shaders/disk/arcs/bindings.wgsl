#define_import_path lensrunner::disk::arcs::bindings

#import lensrunner::disk::types::{Circle, Counters, disk, DiskVertex, Job, Segments}
#import lensrunner::gpu::bindings::TABLE_ROW

@group(1) @binding(1) var<storage, read> circles: array<Circle>;
/// σ of each cut, in rad.
@group(1) @binding(2) var<storage, read> cuts: array<f32>;
/// `Ring`, a texel each.
@group(1) @binding(3) var ring_table: texture_2d<u32>;
/// `Bend`, a texel each, for each row at each of THIN_AZIMUTHS azimuths.
@group(1) @binding(4) var bend_table: texture_2d<f32>;
@group(1) @binding(5) var<storage, read_write> disk_vertices: array<DiskVertex>;
/// For each arc of a circle.
@group(1) @binding(6) var<storage, read_write> segments: array<Segments>;
/// For each vertex past the grid.
@group(1) @binding(7) var<storage, read_write> jobs: array<Job>;
@group(1) @binding(8) var<storage, read_write> disk_indices: array<u32>;
@group(1) @binding(9) var<storage, read_write> disk_counters: Counters;

/// What is between two circles.
struct Ring {
    /// Their rows.
    inner: u32,
    outer: u32,
    /// Image order.
    order: u32,
}

fn ring_of(number: u32) -> Ring {
    let texel = textureLoad(ring_table, vec2<u32>(number % TABLE_ROW, number / TABLE_ROW), 0);
    return Ring(texel.x, texel.y, texel.z);
}

/// For the ring that begins at a row, how far its middle deviates from the straight line between its circles.
struct Bend {
    /// Height in the pattern.
    height: f32,
    /// Logarithm of light, over itself with its sign turned, where θ is positive and where it is negative.
    light: f32,
    other_light: f32,
    /// Optical depth straight through, over that of the line.
    depth: f32,
}

/// Between two entries of the table.
fn table_bend(number: u32, t: f32) -> Bend {
    let a = textureLoad(bend_table, vec2<u32>(number % TABLE_ROW, number / TABLE_ROW), 0);
    let b = textureLoad(bend_table, vec2<u32>((number + 1u) % TABLE_ROW, (number + 1u) / TABLE_ROW), 0);
    let mean = mix(a, b, vec4<f32>(t));
    return Bend(mean.x, mean.y, mean.z, mean.w);
}

/// The end of a list of triangles in the indices.
fn end_of(list: u32) -> u32 {
    return select(disk.regions[min(list + 1u, 3u)], disk.regions_end, list == 3u);
}
