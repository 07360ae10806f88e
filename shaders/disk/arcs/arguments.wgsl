// Between the stages: counts become indirect arguments.

#import lensrunner::disk::arcs::bindings::{disk_counters, end_of}
#import lensrunner::disk::types::disk

/// Workgroups.
struct Dispatch {
    x: u32,
    y: u32,
    z: u32,
    unused: u32,
}

struct IndexedDraw {
    indices: u32,
    instances: u32,
    first_index: u32,
    base_vertex: u32,
    first_instance: u32,
    unused_a: u32,
    unused_b: u32,
    unused_c: u32,
}

struct DiskArguments {
    mesh: Dispatch,
    /// Of each list of triangles.
    draws: array<IndexedDraw, 4>,
}

@group(2) @binding(0) var<storage, read_write> arguments: DiskArguments;

@compute @workgroup_size(1)
fn before_mesh() {
    let count = min(atomicLoad(&disk_counters.vertices), disk.vertex_room - disk.columns * disk.rows);
    disk_counters.stage = 1u;
    arguments.mesh = Dispatch((count + 63u) / 64u, 1u, 1u, 0u);
}

@compute @workgroup_size(1)
fn before_draw() {
    for (var list = 0u; list < 4u; list++) {
        let count = min(atomicLoad(&disk_counters.indices[list]), end_of(list) - disk.regions[list]);
        arguments.draws[list] = IndexedDraw(count, 1u, disk.regions[list], 0u, 0u, 0u, 0u, 0u);
    }
}
