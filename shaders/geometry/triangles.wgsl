// Stage 3, the object stage: one thread per model triangle and image order. Culls, cuts at the axis, draws what is flat enough as it is,
// and hands the rest on: to the mesh stage if eight segments a side are enough, else to be split.

#import lensrunner::chosen::method::METHOD_FILTERS
#import lensrunner::chosen::worldlines::before_turning
#import lensrunner::geometry::bindings::{
    chunk_of, counters, EDGE_CUT, model_triangle, NO_INSTANCE, seen, states, VERTEX_ON_AXIS, VERTEX_UNSEEN,
}
#import lensrunner::geometry::clip::clip_position
#import lensrunner::geometry::emit::{emit_piece, emit_whole, emit_work, hand_over, off_screen, pixels}
#import lensrunner::geometry::patch::{BLOCK, is_lost, meets_axis, offset_of, turned_away}
#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::{Chunk, Instance, Piece, PIECE_FAN, PIECE_TRIANGLE}
#import lensrunner::instances::instance::instance_at

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = group.y * groups.x + group.x;
    let chunk = chunk_of(index);
    if chunk.instance == NO_INSTANCE {
        return;
    }
    if chunk.first + lane < instance_at(chunk.instance).triangle_count {
        decide(chunk, lane);
        hand_over(0u);
    }
}

fn decide(chunk: Chunk, lane: u32) {
    let instance = instance_at(chunk.instance);
    let number = instance.first_triangle + chunk.first + lane;
    let triangle = model_triangle(number);
    let base = instance.first_seen;
    let slots = vec3<u32>(base) + triangle.vertices;
    let o0 = states[slots.x];
    let o1 = states[slots.y];
    let o2 = states[slots.z];
    if o0.w == VERTEX_UNSEEN || o1.w == VERTEX_UNSEEN || o2.w == VERTEX_UNSEEN {
        return;
    }
    if METHOD_FILTERS {
        if area_ratio(slots, offset_of(o0.xyz), offset_of(o1.xyz), offset_of(o2.xyz)) <= LARGEST_AREA_RATIO {
            emit_whole(chunk.instance, number);
        }
        return;
    }
    if turned_away(instance, triangle, offset_of(o0.xyz), leaving_of(instance, slots.x), leaving_of(instance, slots.y),
        leaving_of(instance, slots.z)) {
        return;
    }
    let e0 = states[instance.first_state + triangle.edges.x];
    let e1 = states[instance.first_state + triangle.edges.y];
    let e2 = states[instance.first_state + triangle.edges.z];
    let corner_a = vec3<f32>(1.0, 0.0, 0.0);
    let corner_b = vec3<f32>(0.0, 1.0, 0.0);
    let corner_c = vec3<f32>(0.0, 0.0, 1.0);

    let cut = cut_at_axis(instance, array<vec4<f32>, 3>(o0, o1, o2), array<vec4<f32>, 3>(e0, e1, e2));
    if cut.hidden {
        return;
    }
    if any(cut.fans) {
        atomicAdd(&counters.cut, 1u);
        if cut.fans.x { emit_piece(chunk.instance, number, PIECE_FAN, 0u, cut.apex, corner_b, corner_c); }
        if cut.fans.y { emit_piece(chunk.instance, number, PIECE_FAN, 0u, cut.apex, corner_c, corner_a); }
        if cut.fans.z { emit_piece(chunk.instance, number, PIECE_FAN, 0u, cut.apex, corner_a, corner_b); }
        return;
    }

    let v0 = seen[slots.x].apparent;
    let v1 = seen[slots.y].apparent;
    let v2 = seen[slots.z].apparent;
    let levels = vec3<u32>(bitcast<u32>(e0.x), bitcast<u32>(e1.x), bitcast<u32>(e2.x));
    let most = max(levels.x, max(levels.y, levels.z));
    if off_screen(v0, v1, v2, max(e0.w, max(e1.w, e2.w))) {
        return;
    }
    if most <= 1u {
        emit_whole(chunk.instance, number);
        return;
    }
    if most <= BLOCK {
        let piece = Piece(chunk.instance, number, PIECE_TRIANGLE, 0u, corner_a, corner_b, corner_c);
        emit_work(piece, vec4<u32>(levels, 1u), most, 1u);
        return;
    }
    emit_piece(chunk.instance, number, PIECE_TRIANGLE, 0u, corner_a, corner_b, corner_c);
}

/// The direction in which light leaves a seen vertex, at T₀; w: its radius.
fn leaving_of(instance: Instance, slot: u32) -> vec4<f32> {
    return vec4<f32>(before_turning(instance, seen[slot].leaving, seen[slot].path), seen[slot].radius);
}

/// Where the axis meets a triangle, its image opens into an arc. It is cut there into fans.
struct Cut {
    /// Where the axis is, barycentric.
    apex: vec3<f32>,
    /// Which of the edges have a fan from there, by their opposite corners.
    fans: vec3<bool>,
    /// Whether nothing of the triangle is visible.
    hidden: bool,
}

/// The cut of a triangle, by its corners (by the axis, w: VERTEX_*) and the states of its edges.
fn cut_at_axis(instance: Instance, corners: array<vec4<f32>, 3>, edges: array<vec4<f32>, 3>) -> Cut {
    let on_axis = vec3<bool>(corners[0].w == VERTEX_ON_AXIS, corners[1].w == VERTEX_ON_AXIS, corners[2].w == VERTEX_ON_AXIS);
    let cuts = vec3<bool>(is_cut(edges[0]), is_cut(edges[1]), is_cut(edges[2]));
    if any(on_axis) {
        let apex = select(vec3<f32>(0.0), vec3<f32>(1.0), on_axis);
        // Of an edge on the axis no surface is visible.
        return Cut(apex, on_axis, dot(apex, vec3<f32>(1.0)) > 1.0 || any(cuts));
    }
    if any(cuts) {
        // The fraction counts from the lower vertex of the edge.
        var apex = vec3<f32>(1.0 - edges[2].z, edges[2].z, 0.0);
        apex = select(apex, vec3<f32>(1.0 - edges[1].z, 0.0, edges[1].z), cuts.y);
        apex = select(apex, vec3<f32>(0.0, 1.0 - edges[0].z, edges[0].z), cuts.x);
        return Cut(apex, !cuts, false);
    }
    if is_lost(instance, corners[0].xyz, corners[1].xyz, corners[2].xyz) {
        return Cut(vec3<f32>(0.0), vec3<bool>(false), true);
    }
    let at = meets_axis(corners[0].xyz, corners[1].xyz, corners[2].xyz, instance.order);
    return Cut(at, vec3<bool>(at.x >= 0.0), false);
}

fn is_cut(edge: vec4<f32>) -> bool {
    return (bitcast<u32>(edge.y) & EDGE_CUT) != 0u;
}

/// Yamashita 2012: a triangle larger than this times its size without the hole is not drawn.
const LARGEST_AREA_RATIO: f32 = 9.0;

/// S/S′: the area of a triangle on the screen over the area that it has there without the hole. Where a corner is behind the camera, 0.
fn area_ratio(slots: vec3<u32>, o0: vec3<f32>, o1: vec3<f32>, o2: vec3<f32>) -> f32 {
    let with_hole = area_on_screen(seen[slots.x].apparent, seen[slots.y].apparent, seen[slots.z].apparent);
    let without = area_on_screen(seen_straight(o0), seen_straight(o1), seen_straight(o2));
    if with_hole < 0.0 || without < 0.0 {
        return 0.0;
    }
    return with_hole / max(without, 1e-12);
}

/// In square pixels; −1 if a corner is behind the camera.
fn area_on_screen(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> f32 {
    let near = frame.near;
    if -a.z < near || -b.z < near || -c.z < near {
        return -1.0;
    }
    let p = pixels(clip_position(a));
    let u = pixels(clip_position(b)) - p;
    let v = pixels(clip_position(c)) - p;
    return 0.5 * abs(u.x * v.y - u.y * v.x);
}

/// Where straight light from an offset would be seen, by a static observer's directions boosted to the rain and to the camera.
fn seen_straight(offset: vec3<f32>) -> vec3<f32> {
    let n = frame.outward;
    let beta = frame.river_speed;
    let gamma = inverseSqrt(max(1.0 - beta * beta, 1e-6));
    let distance = length(offset);
    let along = dot(offset, n);
    let rain = offset + n * (gamma * (along - beta * distance) - along);
    return (frame.camera_from_rain * vec4<f32>(rain, -gamma * (distance - beta * along))).xyz;
}
