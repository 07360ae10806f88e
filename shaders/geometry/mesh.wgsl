// Stage 5, the mesh stage: evaluates the projection for each vertex of the work items, then writes their triangles.

#import lensrunner::geometry::bindings::{counters, indices, model_triangle, model_vertex, seen, work}
#import lensrunner::geometry::clip::{finite_vector, pixel_fineness}
#import lensrunner::geometry::emit::emit_thin
#import lensrunner::geometry::patch::{ARC_SHARE, BLOCK, body_point, comes_first, facing_of, fan_input, seen_vertex}
#import lensrunner::geometry::project::{body_input, project_point, ProjectedPoint, ProjectionInput}
#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::{Instance, is_thin, ModelTriangle, PIECE_FAN, PIECE_STRIP, PIECE_TRIANGLE, SeenVertex, WorkItem}
#import lensrunner::instances::bounds::leaves_bounds
#import lensrunner::instances::instance::instance_at

/// Rows and columns of the vertex `k` of a block.
fn triangle_row(k: u32) -> u32 {
    // Row i of the grid has i + 1 vertices; the root is exact for the few rows of a block after the correction.
    var row = u32((sqrt(8.0 * f32(k) + 1.0) - 1.0) * 0.5);
    if (row + 1u) * (row + 2u) / 2u <= k { row += 1u; }
    if row * (row + 1u) / 2u > k { row -= 1u; }
    return row;
}

/// Position of vertex i of a side of n cells, if the side has only `level` segments: the nearest of its points. Surplus vertices coincide
/// and their triangles vanish; what remains is the polyline that the neighbour draws too.
fn snapped(i: u32, n: u32, level: u32) -> f32 {
    return round(f32(i) * f32(level) / f32(n)) / f32(level);
}

/// Position of a vertex of a fan, from the axis (0) to the outer edge (1); below 0 past the axis.
var<private> fan_place: f32;

/// Whether the axis at this height is the outer border of the order's image, where Φ = (order − 1)π.
fn axis_is_outside(height: f32, order: u32) -> bool {
    return (order == 2u && height < 0.0) || (order == 3u && height > 0.0);
}

/// How far past the axis, in r_s, a vertex near it is moved, so that two orders overlap; 0 where that is not needed. The order before
/// begins there with arcs that are cut at other points, and a pixel between two chords of one circle could be missed. Chords of the outer
/// order sag over those of the inner; those of the inner are moved by more than they sag. Near the ring an image moves by half of what its
/// source does, that of the third order by a twentieth. Thin images are sums of areas and would become too bright. `apparent` is where the
/// fan's outer point is seen: arcs are cut by the budget there.
fn past_axis(instance: Instance, input: ProjectionInput, apparent: vec3<f32>) -> f32 {
    let budget = frame.error_budget / pixel_fineness(apparent, apparent);
    let past = 4.0 * ARC_SHARE * budget * abs(input.along) * select(1.0, 10.0, instance.order == 3u);
    return select(0.0, past, axis_is_outside(input.height, instance.order) && !is_thin(instance));
}

/// One thread per new vertex: evaluates the projection. Threads are not bound to work items, whose vertices are often few: a group that
/// served one item would leave most of its lanes idle.
@compute @workgroup_size(64)
fn vertices(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let index = counters.model_vertices + (group.y * groups.x + group.x) * 64u + lane;
    if index >= min(atomicLoad(&counters.vertices), frame.capacity.vertices) {
        return;
    }
    // Written by the stage that made the item.
    let item = work[seen[index].instance];
    let instance = instance_at(item.piece.instance);
    let triangle = model_triangle(item.piece.triangle);
    let k = index - item.first_vertex;
    var corner: vec3<f32>;
    var s = 1.0;
    if item.piece.kind == PIECE_FAN {
        let w = min(BLOCK, item.columns - item.first_column);
        let point = fan_point(item, item.first_row + k / (w + 1u), item.first_column + k % (w + 1u));
        corner = point.xyz;
        s = point.w;
    } else if item.piece.kind == PIECE_STRIP {
        let w = min(BLOCK, item.columns - item.first_column);
        corner = strip_point(item, k / (w + 1u), item.first_column + k % (w + 1u));
    } else {
        corner = triangle_point(item, k);
    }
    fan_place = s;
    var vertex = vertex_at(item, instance, triangle, corner, s);
    if item.piece.kind == PIECE_FAN {
        vertex.axis_uv = texture_coordinates(instance, triangle, item.piece.corner_a);
        vertex.from_axis = fan_place;
    }
    seen[index] = vertex;
}

/// One group per work item: joins its vertices to triangles.
@compute @workgroup_size(32)
fn triangles(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let index = group.y * groups.x + group.x;
    if index >= min(atomicLoad(&counters.work), frame.capacity.work) {
        return;
    }
    let instance = instance_at(work[index].piece.instance);
    let triangle = model_triangle(work[index].piece.triangle);
    let facing = facing_of(instance, triangle, instance.offset);
    let kind = work[index].piece.kind;
    let w = min(BLOCK, work[index].columns - work[index].first_column);
    let first = work[index].first_vertex;
    let first_index = work[index].first_index;
    for (var k = lane; k < work[index].triangle_count; k += 32u) {
        var a: u32; var b: u32; var c: u32;
        if kind != PIECE_TRIANGLE {
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
        let slot = first_index + 3u * k;
        // Every triangle has its place in the index buffer; one that is thin, unseen or out of bounds leaves a point there.
        if unseen(a) || unseen(b) || unseen(c) || leaves_bounds(instance, a, b, c) || emit_thin(a, b, c, instance, facing, triangle.seen_from) {
            b = a;
            c = a;
        }
        indices[slot] = a;
        indices[slot + 1u] = b;
        indices[slot + 2u] = c;
    }
}

fn unseen(vertex: u32) -> bool {
    return seen[vertex].path <= 0.0;
}

/// Vertex k of a triangle's grid, barycentric: row i counts from corner 0 to the opposite edge, column j along that edge.
fn triangle_point(item: WorkItem, k: u32) -> vec3<f32> {
    let n = item.rows;
    let i = triangle_row(k);
    let j = k - i * (i + 1u) / 2u;
    let c0 = item.piece.corner_a;
    let c1 = item.piece.corner_b;
    let c2 = item.piece.corner_c;
    if i == 0u {
        return c0;
    } else if i == n && j == 0u {
        return c1;
    } else if i == n && j == n {
        return c2;
    } else if j == 0u {
        return side_point(c0, c1, i, n, item.levels.z);
    } else if j == i {
        return side_point(c0, c2, i, n, item.levels.y);
    } else if i == n {
        return side_point(c1, c2, j, n, item.levels.x);
    }
    return (c0 * f32(n - i) + c1 * f32(i - j) + c2 * f32(j)) / f32(n);
}

/// Point i of n on a side of `level` segments, the same from both ends.
fn side_point(a: vec3<f32>, b: vec3<f32>, i: u32, n: u32, level: u32) -> vec3<f32> {
    if i == 0u {
        return a;
    }
    if i == n {
        return b;
    }
    if comes_first(a, b) {
        return a + (b - a) * snapped(i, n, level);
    }
    return b + (a - b) * snapped(n - i, n, level);
}

/// A vertex of a fan's grid: the point of its outer edge, barycentric, and w: how far from the axis towards it. Each side has its own
/// level: the arc at the axis, the outer edge, the two radial sides.
fn fan_point(item: WorkItem, row: u32, column: u32) -> vec4<f32> {
    let c1 = item.piece.corner_b;
    let c2 = item.piece.corner_c;
    let rows = item.rows;
    let columns = item.columns;
    var s = f32(row) / f32(rows);
    if column == 0u {
        s = snapped(row, rows, item.levels.z);
    } else if column == columns {
        s = snapped(row, rows, item.levels.w);
    }
    var level = columns;
    if row == rows {
        level = item.levels.y;
    } else if row == 0u {
        level = item.levels.x;
    }
    return vec4<f32>(side_point(c1, c2, column, columns, level), s);
}

/// A vertex of a strip, barycentric: row 1 runs along the edge opposite corner 0, row 0 along the other two.
fn strip_point(item: WorkItem, row: u32, column: u32) -> vec3<f32> {
    let c0 = item.piece.corner_a;
    let c1 = item.piece.corner_b;
    let c2 = item.piece.corner_c;
    let columns = item.columns;
    if row == 1u {
        return side_point(c1, c2, column, columns, item.levels.x);
    }
    // No side has fewer cells than segments.
    let first = item.levels.z + (columns - item.levels.z - item.levels.y) / 2u;
    if column <= first {
        return side_point(c1, c0, column, first, item.levels.z);
    }
    return side_point(c0, c2, column - first, columns - first, item.levels.y);
}

/// Texture coordinates of barycentric coordinates in a model triangle.
fn texture_coordinates(instance: Instance, triangle: ModelTriangle, corner: vec3<f32>) -> vec2<f32> {
    let first = instance.first_vertex;
    let v0 = model_vertex(first + triangle.vertices.x);
    let v1 = model_vertex(first + triangle.vertices.y);
    let v2 = model_vertex(first + triangle.vertices.z);
    return vec2<f32>(v0.u, v0.v) * corner.x + vec2<f32>(v1.u, v1.v) * corner.y
        + vec2<f32>(v2.u, v2.v) * corner.z;
}

/// The seen vertex of a point of a model triangle (s = 1), or of a point between a fan's axis and that point (s < 1). A corner of the model
/// is taken from the first stage, with the same bits.
fn vertex_at(item: WorkItem, instance: Instance, triangle: ModelTriangle, point: vec3<f32>, s: f32) -> SeenVertex {
    if s == 1.0 && (point.x == 1.0 || point.y == 1.0 || point.z == 1.0) {
        let which = select(select(triangle.vertices.z, triangle.vertices.y, point.y == 1.0), triangle.vertices.x, point.x == 1.0);
        return seen[instance.first_seen + which];
    }
    // Inside a fan: the axis point and the outer point at their emission times, then the position between them. Elsewhere the point alone,
    // and again if it is moved past the axis.
    let body = body_point(instance, triangle, point);
    var apex = 0.0;
    var apex_height = 0.0;
    var found: ProjectedPoint;
    var attitude = vec4<f32>(0.0);
    var count = select(3u, 2u, s == 1.0);
    for (var k = select(0u, 1u, s == 1.0); k < count; k++) {
        var input = body_input(body);
        if k == 0u {
            input = body_input(body_point(instance, triangle, item.piece.corner_a));
        } else if k == 2u {
            input = fan_input(apex, found.by_axis, s);
            input.height = mix(apex_height, dot(found.position, frame.outward), s);
            let past = past_axis(instance, input, found.ray.apparent);
            if input.across < past {
                fan_place = select(s, -min(past / max(length(found.by_axis.xy), 1e-9), 0.5), s == 0.0);
                input.across = -past;
            }
        }
        let next = project_point(instance, input, instance.order);
        if k == 0u {
            apex = next.by_axis.z;
            apex_height = dot(next.position, frame.outward);
        } else {
            found = next;
            attitude = select(attitude, next.attitude, k == 1u);
        }
        if k == 1u && s == 1.0 {
            let height = dot(found.position, frame.outward);
            let here = ProjectionInput(body, true, found.by_axis.z, length(found.by_axis.xy), height, vec3<f32>(0.0));
            count = select(2u, 3u, found.ray.valid && here.across < past_axis(instance, here, found.ray.apparent));
        }
    }
    let corner = mix(item.piece.corner_a, point, vec3<f32>(s));
    let first = instance.first_vertex;
    let v0 = model_vertex(first + triangle.vertices.x);
    let v1 = model_vertex(first + triangle.vertices.y);
    let v2 = model_vertex(first + triangle.vertices.z);
    let normal = v0.normal * corner.x + v1.normal * corner.y + v2.normal * corner.z;
    var vertex = seen_vertex(instance, item.piece.instance, found, attitude, normal,
        texture_coordinates(instance, triangle, point), v0.material + instance.first_material);
    if !found.ray.valid || !finite_vector(found.ray.apparent) {
        atomicAdd(&counters.caught, 1u);
        vertex.apparent = vec3<f32>(0.0);
        vertex.path = 0.0;
    }
    return vertex;
}
