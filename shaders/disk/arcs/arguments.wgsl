// Between the stages: counts become indirect arguments.

#import lensrunner::disk::arcs::bindings::{disk_counters, end_of}
#import lensrunner::disk::types::disk

struct DiskArguments {
    mesh: vec4<u32>,
    /// For each list of triangles: indices, instances, first index, base vertex; then first instance and three words unused.
    draws: array<vec4<u32>, 8>,
}

@group(2) @binding(0) var<storage, read_write> arguments: DiskArguments;

@compute @workgroup_size(1)
fn before_mesh() {
    let count = min(atomicLoad(&disk_counters.vertices), disk.vertex_room - disk.columns * disk.rows);
    disk_counters.stage = 1u;
    arguments.mesh = vec4<u32>((count + 63u) / 64u, 1u, 1u, 0u);
}

@compute @workgroup_size(1)
fn before_draw() {
    for (var list = 0u; list < 4u; list++) {
        let count = min(atomicLoad(&disk_counters.indices[list]), end_of(list) - disk.regions[list]);
        arguments.draws[2u * list] = vec4<u32>(count, 1u, disk.regions[list], 0u);
        arguments.draws[2u * list + 1u] = vec4<u32>(0u);
    }
}
