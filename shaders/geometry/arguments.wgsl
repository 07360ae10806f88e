// Between the stages: one thread that turns counts into indirect arguments. They lie in a group of their own, because a buffer cannot be
// written and drive a dispatch at once.

#import lensrunner::geometry::bindings::{Arguments, counters}
#import lensrunner::gpu::bindings::frame

@group(2) @binding(0) var<storage, read_write> arguments: Arguments;

/// Before each pass of splitting: switches to the queue that was filled, and empties the other.
@compute @workgroup_size(1)
fn next_pieces() {
    turn_queues();
}

/// Before the last, where fewer passes are made than splitting may need.
@compute @workgroup_size(1)
fn last_pieces() {
    turn_queues();
    counters.is_last = 1u;
}

fn turn_queues() {
    let filled = 1u - counters.turn;
    counters.turn = filled;
    let count = min(atomicLoad(&counters.pieces[filled]), frame.capacity.work);
    atomicStore(&counters.pieces[1u - filled], 0u);
    counters.split += count;
    counters.passes += min(count, 1u);
    arguments.refine = vec4<u32>((count + 63u) / 64u, 1u, 1u, 0u);
}

/// After the last: the mesh stage and the draws.
@compute @workgroup_size(1)
fn finish() {
    let items = min(atomicLoad(&counters.work), frame.capacity.work);
    // Two dimensions: one holds 65,535 groups at most.
    arguments.mesh = vec4<u32>(min(items, 32768u), (items + 32767u) / 32768u, 1u, 0u);
    let groups = (min(atomicLoad(&counters.vertices), frame.capacity.vertices) - counters.model_vertices + 63u) / 64u;
    arguments.mesh_vertices = vec4<u32>(min(groups, 32768u), (groups + 32767u) / 32768u, 1u, 0u);
    arguments.opaque = vec4<u32>(min(atomicLoad(&counters.indices), frame.capacity.indices), 1u, 0u, 0u);
}

/// After the mesh stage, which may add thin triangles.
@compute @workgroup_size(1)
fn finish_thin() {
    arguments.opaque_rest = vec4<u32>(0u, 0u, 0u, 0u);
    let thin = min(atomicLoad(&counters.thin), frame.capacity.thin);
    arguments.thin = vec4<u32>(thin, 1u, 0u, 0u);
    let groups = (thin / 3u + 63u) / 64u;
    arguments.thin_lists = vec4<u32>(min(groups, 32768u), (groups + 32767u) / 32768u, 1u, 0u);
}
