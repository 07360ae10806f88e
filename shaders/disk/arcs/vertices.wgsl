// Stages 1 and 3, in two dispatches of one pipeline: one thread per vertex. The first projects the grid: the ends and the middle of every
// arc on both its circles. The second, the mesh stage, projects the vertices that segments ask for.

#import lensrunner::disk::arcs::bindings::{cuts, disk_counters, disk_vertices, jobs}
#import lensrunner::disk::arcs::place::disk_vertex
#import lensrunner::disk::sigma::bearing
#import lensrunner::disk::types::{disk, Job}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let columns = disk.columns;
    let arcs = disk.arcs;
    let grid = columns * disk.rows;
    let halved = disk_counters.stage == 1u;
    if id.x >= select(grid, min(atomicLoad(&disk_counters.vertices), disk.vertex_room - grid), halved) {
        return;
    }
    var job = Job(id.x / columns * arcs + id.x % columns / 2u, id.x % columns % 2u, 2u);
    var slot = id.x;
    if halved {
        job = jobs[id.x];
        slot += grid;
    } else if id.x % columns == columns - 1u {
        // The last column ends the last arc.
        job = Job(job.arc - 1u, 2u, 2u);
    }
    let cut = job.arc % arcs;
    let sigma = mix(cuts[cut], cuts[cut + 1u], f32(job.number) / f32(job.count));
    disk_vertices[slot] = disk_vertex(job.arc / arcs, bearing(sigma, disk.steepness));
}
