// Stage 4: one thread per arc. Joins the points of its two circles by triangles; its radial sides point to the hole, where they are seen
// straight.

#import lensrunner::disk::arcs::bindings::{circles, disk_counters, disk_indices, disk_vertices, end_of, ring_of, segments}
#import lensrunner::disk::types::{disk, Segments}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let arcs = disk.arcs;
    if id.x >= arcs * disk.rings {
        return;
    }
    let ring = ring_of(id.x / arcs);
    let arc = id.x % arcs;
    let inner = segments[ring.inner * arcs + arc];
    let outer = segments[ring.outer * arcs + arc];
    if (inner.beyond & outer.beyond) != 0u {
        return;
    }
    let first_inner = ring.inner * disk.columns + 2u * arc;
    let first_outer = ring.outer * disk.columns + 2u * arc;
    var nearest = 1e9;
    for (var k = 0u; k < 3u; k++) {
        nearest = min(nearest, min(disk_vertices[first_inner + k].path, disk_vertices[first_outer + k].path));
    }
    if nearest <= 0.0 || max(circles[ring.inner].gas.depth, circles[ring.outer].gas.depth) < 1e-4 {
        return;
    }
    let total = inner.count + outer.count;
    let beyond = ring.order == 1u && disk.near_orders > 0u && nearest > disk.close;
    let list = select(ring.order - 1u, 3u, beyond);
    let end = end_of(list);
    var slot = disk.regions[list] + atomicAdd(&disk_counters.indices[list], 3u * total);
    if slot + 3u * total > end {
        // No room. What is left of the list becomes empty triangles, since the draw goes to its end.
        for (; slot < end; slot++) {
            disk_indices[slot] = 0u;
        }
        atomicAdd(&disk_counters.coarse, 1u);
        return;
    }
    atomicAdd(&disk_counters.arcs, 1u);
    var i = 0u;
    var j = 0u;
    while i + j < total {
        // Step on the circle whose next point comes first; i/inner.count < j/outer.count in whole numbers.
        let a = point(first_inner, inner, i);
        let b = point(first_outer, outer, j);
        var c = 0u;
        if i < inner.count && (j == outer.count || (i + 1u) * outer.count <= (j + 1u) * inner.count) {
            i += 1u;
            c = point(first_inner, inner, i);
        } else {
            j += 1u;
            c = point(first_outer, outer, j);
        }
        disk_indices[slot] = a;
        disk_indices[slot + 1u] = b;
        disk_indices[slot + 2u] = c;
        slot += 3u;
    }
}

/// The vertex of point i of an arc of a circle.
fn point(first: u32, arc: Segments, i: u32) -> u32 {
    if i == 0u {
        return first;
    }
    if i == arc.count {
        return first + 2u;
    }
    if arc.count == 2u {
        return first + 1u;
    }
    return disk.columns * disk.rows + arc.first + i - 1u;
}
