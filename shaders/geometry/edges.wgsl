// Stage 2: one thread per model edge and image order. The number of segments depends on the edge alone, so its two triangles agree on it.

#import lensrunner::chosen::worldlines::{before_turning, is_rim, MAY_FOLD}
#import lensrunner::geometry::bindings::{
    ALONE, chunk_of, EDGE_CUT, EDGE_LIMB, EDGE_UNSEEN, model_edge, model_position, NO_INSTANCE, seen, states, VERTEX_ON_AXIS,
    VERTEX_PLAIN, VERTEX_UNSEEN,
}
#import lensrunner::geometry::clip::pixel_fineness
#import lensrunner::geometry::patch::{
    angle_between, axis_core, axis_matters, BLOCK, edge_error, fan_input, level_for, limb_strictness, most_segments, most_turn, MUST_SPLIT,
    narrow_strictness, offset_of, on_limb, ring_strictness, ring_tangent, slack_of, strictness, turn_about_axis, uneven_sag,
}
#import lensrunner::geometry::project::{body_input, project_point}
#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::{FLAG_INSIDE, Instance, is_thin}
#import lensrunner::instances::instance::instance_at

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = group.y * groups.x + group.x;
    let chunk = chunk_of(index);
    if chunk.instance == NO_INSTANCE {
        return;
    }
    let instance = instance_at(chunk.instance);
    let local = chunk.first + lane;
    if local >= instance.edge_count {
        return;
    }
    let edge = model_edge(instance.first_edge + local);
    let a = states[instance.first_seen + edge.x];
    let b = states[instance.first_seen + edge.y];
    let slot = instance.first_state + local;
    if a.w == VERTEX_UNSEEN || b.w == VERTEX_UNSEEN {
        states[slot] = vec4<f32>(bitcast<f32>(1u), bitcast<f32>(EDGE_UNSEEN), 0.0, 0.0);
        return;
    }
    let from_seen = seen[instance.first_seen + edge.x];
    let to_seen = seen[instance.first_seen + edge.y];
    let cut = cut_by_axis(instance, a, b, from_seen.apparent);
    if cut >= 0.0 {
        states[slot] = vec4<f32>(bitcast<f32>(1u), bitcast<f32>(EDGE_CUT), cut, 0.0);
        return;
    }
    var ends: Ends;
    ends.a = a;
    ends.b = b;
    ends.body_a = model_position(instance.first_vertex + edge.x);
    ends.body_b = model_position(instance.first_vertex + edge.y);
    ends.apparent_a = from_seen.apparent;
    ends.apparent_b = to_seen.apparent;
    ends.radius = from_seen.radius;
    let alone = edge.z == ALONE;
    ends.limb = is_rim(instance, alone, ends.body_a, ends.body_b)
        || (!alone && MAY_FOLD && on_limb(instance, edge, before_turning(instance, from_seen.leaving, from_seen.path),
            before_turning(instance, to_seen.leaving, to_seen.path), offset_of(a.xyz)));
    let division = divide(instance, ends);
    states[slot] = vec4<f32>(bitcast<f32>(division.level), bitcast<f32>(select(0u, EDGE_LIMB, ends.limb)), 0.0, division.error);
}

/// An edge of a model, with what the stage of vertices found of its ends.
struct Ends {
    /// Positions by the axis; w: VERTEX_*.
    a: vec4<f32>,
    b: vec4<f32>,
    /// On the body.
    body_a: vec3<f32>,
    body_b: vec3<f32>,
    apparent_a: vec3<f32>,
    apparent_b: vec3<f32>,
    /// Of a, from the hole.
    radius: f32,
    /// Whether the edge may be an outline.
    limb: bool,
}

/// Where the axis visibly cuts an edge, as a share of the way from a to b; −1 if it does not. By the foot of the axis on the edge, and the
/// distance there.
fn cut_by_axis(instance: Instance, a: vec4<f32>, b: vec4<f32>, apparent: vec3<f32>) -> f32 {
    let d = b.xy - a.xy;
    let t = clamp(-dot(a.xy, d) / max(dot(d, d), 1e-30), 0.0, 1.0);
    let foot = mix(a.xyz, b.xyz, vec3<f32>(t));
    let plain = a.w == VERTEX_PLAIN && b.w == VERTEX_PLAIN;
    let cut = plain && length(foot.xy) < axis_core(instance, apparent) && axis_matters(foot.z, instance.order);
    return select(-1.0, t, cut);
}

struct Division {
    /// Number of segments.
    level: u32,
    /// Of the chord of the whole edge, radians.
    error: f32,
}

fn divide(instance: Instance, ends: Ends) -> Division {
    let a = ends.a.xyz;
    let b = ends.b.xyz;
    let order = instance.order;
    let nearest = min(length(a.xy), length(b.xy));
    let fineness = pixel_fineness(ends.apparent_a, ends.apparent_b);
    // Of a pixel at the edge, in r_s.
    let pixel = frame.pixel / fineness * length(ends.apparent_a);
    let closer = fineness * max(select(1.0, limb_strictness(instance), ends.limb), ring_strictness(instance, nearest, pixel, a.z));
    let seen_under = angle_between(ends.apparent_a, ends.apparent_b);
    let radial = ends.a.w == VERTEX_ON_AXIS || ends.b.w == VERTEX_ON_AXIS;
    var error = 0.0;
    if radial || !is_short(instance, ends, closer, seen_under) {
        error = bend(instance, ends, radial);
    }
    var level = level_for(error * strictness(instance) * closer, 1.0);
    level = min(level, most_segments(instance, a, b, pixel));
    let turn = turn_about_axis(a, b, order);
    let sag = uneven_sag(a, b, level, turn, seen_under);
    if !radial && (turn > most_turn(instance) || level_for(sag * fineness * strictness(instance), 1.0) > 1u) {
        return Division(max(level, BLOCK + 1u), MUST_SPLIT);
    }
    return Division(level, error);
}

/// Whether an edge is so short that it is not measured.
///
/// Away from the axis it bends for two reasons. Aberration and delay are not linear: they bend an edge seen under θ by θ²/8 at most. And
/// light bends differently along it, by the tide 3/2 c³ over the distance d times the square of its length. Both must be below a quarter of
/// the budget (for an outline, of its smaller budget), the tide with another factor of 3 for the shear of images near the ring. Beside the
/// axis an edge also runs along the ring; there it bends by at most an eighth of the square of its turn.
fn is_short(instance: Instance, ends: Ends, closer: f32, seen_under: f32) -> bool {
    let fineness = pixel_fineness(ends.apparent_a, ends.apparent_b);
    let edge_length = distance(ends.a.xyz, ends.b.xyz);
    let nearest = min(length(ends.a.xy), length(ends.b.xy));
    let least_radius = min(frame.camera_radius, ends.radius);
    let tide = 4.5 * edge_length * edge_length * length(ends.apparent_a) / (least_radius * least_radius * least_radius);
    let quarter = 0.25 * frame.error_budget / (closer * narrow_strictness(instance));
    let straight = select(0.0625, min(0.0625, 8.0 * quarter), axis_matters(ends.a.z, instance.order) && !is_thin(instance));
    let small = (!ends.limb && seen_under < 8.0 * frame.pixel / fineness * inverseSqrt(narrow_strictness(instance)))
        || (seen_under * seen_under < 8.0 * quarter && tide < quarter);
    return seen_under < 2.0 * frame.error_budget / fineness || (small && edge_length * edge_length < straight * nearest * nearest);
}

/// The error of the chord of an edge (radians), from points at ¼, ½, ¾. A radial edge runs from the axis, with the azimuth of its other
/// end, to the plain vertex; its ends are evaluated too.
fn bend(instance: Instance, ends: Ends, radial: bool) -> f32 {
    let a_on_axis = ends.a.w == VERTEX_ON_AXIS;
    let apex = select(ends.b.z, ends.a.z, a_on_axis);
    let outer = select(ends.a.xyz, ends.b.xyz, a_on_axis);
    var points = array<vec3<f32>, 5>(ends.apparent_a, vec3<f32>(0.0), vec3<f32>(0.0), vec3<f32>(0.0), ends.apparent_b);
    var tangent = vec3<f32>(0.0);
    var whole = true;
    for (var k = select(1u, 0u, radial); k < select(4u, 5u, radial); k++) {
        let t = f32(k) * 0.25;
        var input = body_input(ends.body_a + (ends.body_b - ends.body_a) * t);
        if radial {
            input = fan_input(apex, outer, t);
        }
        let found = project_point(instance, input, instance.order).ray;
        points[k] = found.apparent;
        if k == 2u && !radial {
            tangent = ring_tangent(found);
        }
        whole = whole && (found.valid || (frame.flags & FLAG_INSIDE) == 0u);
    }
    let slack = slack_of(instance, tangent, min(length(ends.a.xy), length(ends.b.xy)), ends.a.z);
    // For a camera inside, if a part of the edge is not seen, its image ends there; splitting finds no more of it.
    return select(0.0, edge_error(points[0], points[1], points[2], points[3], points[4], slack), whole);
}
