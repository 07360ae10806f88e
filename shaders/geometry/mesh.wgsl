// Stage 5, the mesh stage: one workgroup per work item. Evaluates the projection for each vertex of the block, writes vertices and indices.

/// Rows and columns of the vertex `k` of a block.
fn triangle_row(k: u32) -> u32 {
    // Row i of the grid has i + 1 vertices; the root is exact for the few rows of a block after the correction.
    var row = u32((sqrt(8.0 * f32(k) + 1.0) - 1.0) * 0.5);
    if (row + 1u) * (row + 2u) / 2u <= k { row += 1u; }
    if row * (row + 1u) / 2u > k { row -= 1u; }
    return row;
}

/// Where vertex i of a side of n cells goes, if the side itself has only `level` segments: the nearest of its points. The points left over
/// fall together and their triangles vanish; what remains is the polyline that the neighbour draws too.
fn snapped(i: u32, n: u32, level: u32) -> f32 {
    return round(f32(i) * f32(level) / f32(n)) / f32(level);
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = group.y * groups.x + group.x;
    if index >= min(atomicLoad(&counters.work), frame.capacity.z) {
        return;
    }
    let item = work[index];
    let placement = placements[item.piece.what.x];
    let triangle = model_triangles[item.piece.what.y];
    let fan = item.piece.what.z == PIECE_FAN;
    let h = min(BLOCK, item.grid.x - item.grid.z);
    let w = min(BLOCK, item.grid.y - item.grid.w);

    for (var k = lane; k < item.place.z; k += 64u) {
        if fan {
            seen[item.place.x + k] = fan_vertex(item, placement, triangle, item.grid.z + k / (w + 1u), item.grid.w + k % (w + 1u));
        } else {
            seen[item.place.x + k] = triangle_vertex(item, placement, triangle, k);
        }
    }
    storageBarrier();

    let first = item.place.x;
    for (var k = lane; k < item.place.w; k += 64u) {
        var a: u32; var b: u32; var c: u32;
        if fan {
            let cell = k / 2u;
            let row = cell / w;
            let column = cell % w;
            let v = first + row * (w + 1u) + column;
            a = v;
            b = select(v + w + 1u, v + w + 2u, k % 2u == 1u);
            c = select(v + w + 2u, v + 1u, k % 2u == 1u);
        } else {
            // Row r holds 2r + 1 triangles: r + 1 upright, r upside down.
            var r = u32(sqrt(f32(k)));
            if (r + 1u) * (r + 1u) <= k { r += 1u; }
            if r * r > k { r -= 1u; }
            let i = k - r * r;
            let upper = first + r * (r + 1u) / 2u;
            let lower = first + (r + 1u) * (r + 2u) / 2u;
            let column = i / 2u;
            if i % 2u == 0u {
                a = upper + column; b = lower + column; c = lower + column + 1u;
            } else {
                a = upper + column; b = lower + column + 1u; c = upper + column + 1u;
            }
        }
        let slot = item.place.y + 3u * k;
        // A place in the index buffer is held for every triangle: one that is thin or unseen leaves a point there.
        if unseen(a) || unseen(b) || unseen(c) || emit_thin(a, b, c, two_sided(placement)) {
            b = a;
            c = a;
        }
        indices[slot] = a;
        indices[slot + 1u] = b;
        indices[slot + 2u] = c;
    }
}

fn unseen(vertex: u32) -> bool {
    return seen[vertex].apparent.w <= 0.0;
}

/// Vertex k of a triangle's grid: row i counts from corner 0 to the opposite edge, column j along that edge.
fn triangle_vertex(item: WorkItem, placement: Placement, triangle: ModelTriangle, k: u32) -> SeenVertex {
    let n = item.grid.x;
    let i = triangle_row(k);
    let j = k - i * (i + 1u) / 2u;
    let c0 = item.piece.corner_0.xyz;
    let c1 = item.piece.corner_1.xyz;
    let c2 = item.piece.corner_2.xyz;
    var corner: vec3<f32>;
    if i == 0u {
        corner = c0;
    } else if i == n && j == 0u {
        corner = c1;
    } else if i == n && j == n {
        corner = c2;
    } else if j == 0u {
        corner = side_point(c0, c1, i, n, item.levels.z);
    } else if j == i {
        corner = side_point(c0, c2, i, n, item.levels.y);
    } else if i == n {
        corner = side_point(c1, c2, j, n, item.levels.x);
    } else {
        corner = (c0 * f32(n - i) + c1 * f32(i - j) + c2 * f32(j)) / f32(n);
    }
    return vertex_at(placement, item.piece.what.x, triangle, corner);
}

/// Point i of n on a side of `level` segments, the same from both ends.
fn side_point(a: vec3<f32>, b: vec3<f32>, i: u32, n: u32, level: u32) -> vec3<f32> {
    if comes_first(a, b) {
        return a + (b - a) * snapped(i, n, level);
    }
    return b + (a - b) * snapped(n - i, n, level);
}

/// The seen vertex of a point of a model triangle. A corner of the model itself is taken from the first stage, to the last bit.
fn vertex_at(placement: Placement, index: u32, triangle: ModelTriangle, corner: vec3<f32>) -> SeenVertex {
    if corner.x == 1.0 || corner.y == 1.0 || corner.z == 1.0 {
        let which = select(select(triangle.vertices.z, triangle.vertices.y, corner.y == 1.0), triangle.vertices.x, corner.x == 1.0);
        return seen[placement.ids.z + which];
    }
    let body = body_point(placement, triangle, corner);
    let offset = emitted_offset(placement, body, placement.ids.x);
    let ray = sight_at(offset, placement.ids.x);
    return finished(placement, index, triangle, corner, ray, offset);
}

fn fan_vertex(item: WorkItem, placement: Placement, triangle: ModelTriangle, row: u32, column: u32) -> SeenVertex {
    let order = placement.ids.x;
    let c1 = item.piece.corner_1.xyz;
    let c2 = item.piece.corner_2.xyz;
    let rows = item.grid.x;
    let columns = item.grid.y;
    // Each side has its own level: the arc at the axis, the outer edge, the two radial sides.
    var t = f32(column) / f32(columns);
    if row == rows {
        t = snapped(column, columns, item.levels.y);
    } else if row == 0u {
        t = snapped(column, columns, item.levels.x);
    }
    var s = f32(row) / f32(rows);
    if column == 0u {
        s = snapped(row, rows, item.levels.z);
    } else if column == columns {
        s = snapped(row, rows, item.levels.w);
    }
    var outer = edge_point(c1, c2, t);
    if row == rows {
        if !comes_first(c1, c2) {
            outer = c2 + (c1 - c2) * snapped(columns - column, columns, item.levels.y);
        } else {
            outer = c1 + (c2 - c1) * t;
        }
        if column == 0u { outer = c1; }
        if column == columns { outer = c2; }
        return vertex_at(placement, item.piece.what.x, triangle, outer);
    }
    let apex = apex_offset(emitted_offset(placement, body_point(placement, triangle, item.piece.corner_0.xyz), order));
    let rim = emitted_offset(placement, body_point(placement, triangle, outer), order);
    let ray = fan_sight(apex, rim, s, order);
    let corner = mix(item.piece.corner_0.xyz, outer, vec3<f32>(s));
    return finished(placement, item.piece.what.x, triangle, corner, ray, apex + (rim - apex) * s);
}

fn finished(placement: Placement, index: u32, triangle: ModelTriangle, corner: vec3<f32>, ray: Sight, offset: vec3<f32>) -> SeenVertex {
    let first = placement.vertices.x;
    let v0 = model_vertices[first + triangle.vertices.x];
    let v1 = model_vertices[first + triangle.vertices.y];
    let v2 = model_vertices[first + triangle.vertices.z];
    let normal = v0.normal * corner.x + v1.normal * corner.y + v2.normal * corner.z;
    let u = v0.position.w * corner.x + v1.position.w * corner.y + v2.position.w * corner.z;
    var vertex = seen_vertex(placement, index, ray, offset, normal_of(placement, normal.xyz), vec2<f32>(u, normal.w), v0.info.x + placement.triangles.z);
    if !ray.valid || !finite(ray.apparent) {
        atomicAdd(&counters.caught, 1u);
        vertex.apparent = vec4<f32>(0.0, 0.0, 0.0, 0.0);
    }
    return vertex;
}
