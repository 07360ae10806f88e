// Stage 3, the mesh stage: one thread per vertex that halving asks for.

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let grid = disk.sizes.x * disk.sizes.z;
    if id.x >= min(atomicLoad(&disk_counters.vertices), disk.room.x - grid) {
        return;
    }
    let job = jobs[id.x];
    let arcs = disk.sizes.y;
    let cut = job.x % arcs;
    let theta = theta_between(cuts[cut], cuts[cut + 1u], f32(job.y) / f32(job.z));
    disk_vertices[grid + id.x] = disk_vertex(job.x / arcs, theta);
}
