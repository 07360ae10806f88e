// Stage 1: one thread per place of the grid, the ends and the middle of every arc on both its circles.

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let columns = disk.sizes.x;
    if id.x >= columns * disk.sizes.z {
        return;
    }
    let row = id.x / columns;
    let column = id.x % columns;
    let cut = column / 2u;
    var theta = cuts[cut];
    if column % 2u == 1u {
        theta = theta_between(theta, cuts[cut + 1u], 0.5);
    }
    disk_vertices[id.x] = disk_vertex(row, theta);
}
