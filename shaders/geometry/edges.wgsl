// Stage 2: one thread per model edge and image order. The number of segments depends on the edge alone, so its two triangles agree on it.

#import lensrunner::chosen::worldlines::{is_rim, MAY_FOLD}
#import lensrunner::geometry::bindings::{
    ALONE, chunks, EDGE_CUT, EDGE_LIMB, edge_states, EDGE_UNSEEN, emitted, model_edges, model_vertices, NO_INSTANCE, seen, VERTEX_ON_AXIS,
    VERTEX_PLAIN, VERTEX_UNSEEN,
}
#import lensrunner::geometry::clip::pixel_fineness
#import lensrunner::geometry::patch::{
    angle_between, axis_core, axis_matters, BLOCK, chord_error, level_for, limb_strictness, most_segments, most_turn, MUST_SPLIT, offset_of,
    on_limb, query_fan, ring_strictness, ring_tangent, slack_of, slimness, strictness, turn_about_axis, uneven_sag,
}
#import lensrunner::geometry::project::{answer, query_body}
#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::{FLAG_INSIDE, is_thin}
#import lensrunner::instances::instance::instance_at

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = group.y * groups.x + group.x;
    let chunk = chunks[index];
    if chunk.instance == NO_INSTANCE {
        return;
    }
    let instance = instance_at(chunk.instance);
    let local = chunk.first + lane;
    if local >= instance.vertices.w {
        return;
    }
    let edge = model_edges[instance.vertices.z + local];
    let order = instance.ids.x;
    let a = emitted[instance.ids.z + edge.x];
    let b = emitted[instance.ids.z + edge.y];
    let slot = instance.ids.w + local;
    if a.w == VERTEX_UNSEEN || b.w == VERTEX_UNSEEN {
        edge_states[slot] = vec4<f32>(bitcast<f32>(1u), bitcast<f32>(EDGE_UNSEEN), 0.0, 0.0);
        return;
    }

    // Does the axis visibly cut the edge? By the foot of the axis on it, and the distance there.
    let plain = a.w == VERTEX_PLAIN && b.w == VERTEX_PLAIN;
    if plain {
        let d = b.xy - a.xy;
        let t = clamp(-dot(a.xy, d) / max(dot(d, d), 1e-30), 0.0, 1.0);
        let foot = mix(a.xyz, b.xyz, vec3<f32>(t));
        if length(foot.xy) < axis_core(instance, seen[instance.ids.z + edge.x].apparent.xyz) && axis_matters(foot.z, order) {
            edge_states[slot] = vec4<f32>(bitcast<f32>(1u), bitcast<f32>(EDGE_CUT), t, 0.0);
            return;
        }
    }

    let from_apparent = seen[instance.ids.z + edge.x].apparent.xyz;
    let to_apparent = seen[instance.ids.z + edge.y].apparent.xyz;
    let leaving_a = seen[instance.ids.z + edge.x].leaving.xyz;
    let leaving_b = seen[instance.ids.z + edge.y].leaving.xyz;
    let p = model_vertices[instance.vertices.x + edge.x].position.xyz;
    let q = model_vertices[instance.vertices.x + edge.y].position.xyz;
    let alone = edge.z == ALONE;
    let limb = is_rim(instance, alone, p, q) || (!alone && MAY_FOLD && on_limb(instance, edge, leaving_a, leaving_b, offset_of(a.xyz)));
    let radial = a.w == VERTEX_ON_AXIS || b.w == VERTEX_ON_AXIS;
    var error = 0.0;
    var whole = true;
    // A short edge is not measured. Away from the axis it bends for two reasons. Aberration and delay are not linear: they bend an edge
    // seen under θ by θ²/8 at most. And light bends differently along it, by the tide 3/2 c³ over the distance d times the square of its
    // length. Both must be below a quarter of the budget (for an outline, of its smaller budget), the tide with another factor of 3 for the
    // shear of images near the ring. Beside the axis an edge also runs along the ring; there it bends by at most an eighth of the square of
    // its turn.
    let seen_under = angle_between(from_apparent, to_apparent);
    let edge_length = distance(a.xyz, b.xyz);
    let nearest = min(length(a.xy), length(b.xy));
    let fineness = pixel_fineness(from_apparent, to_apparent);
    let pixel = frame.size.z / fineness;
    let closer = fineness * max(select(1.0, limb_strictness(instance), limb), ring_strictness(instance, nearest, pixel * length(from_apparent), a.z));
    let least_radius = min(frame.radial.w, seen[instance.ids.z + edge.x].leaving.w);
    let tide = 4.5 * edge_length * edge_length * length(from_apparent) / (least_radius * least_radius * least_radius);
    let quarter = 0.25 * frame.size.w / (closer * slimness(instance));
    let straight = select(0.0625, min(0.0625, 8.0 * quarter), axis_matters(a.z, order) && !is_thin(instance));
    let small = (!limb && seen_under < 8.0 * pixel * inverseSqrt(slimness(instance))) || (seen_under * seen_under < 8.0 * quarter && tide < quarter);
    let short = seen_under < 2.0 * frame.size.w / fineness || (small && edge_length * edge_length < straight * nearest * nearest);
    if radial || !short {
        // A radial side runs from the axis (with the azimuth of its other end) to the plain vertex.
        let apex = select(b.z, a.z, a.w == VERTEX_ON_AXIS);
        let outer = select(a.xyz, b.xyz, a.w == VERTEX_ON_AXIS);
        var points = array<vec3<f32>, 5>(from_apparent, vec3<f32>(0.0), vec3<f32>(0.0), vec3<f32>(0.0), to_apparent);
        var tangent = vec3<f32>(0.0);
        for (var k = select(1u, 0u, radial); k < select(4u, 5u, radial); k++) {
            let t = f32(k) * 0.25;
            var query = query_body(p + (q - p) * t);
            if radial {
                query = query_fan(apex, outer, t);
            }
            let found = answer(instance, query, order).ray;
            points[k] = found.apparent;
            if k == 2u && !radial { tangent = ring_tangent(found); }
            whole = whole && (found.valid || (frame.switches.x & FLAG_INSIDE) == 0u);
        }
        // For a camera inside, if a part of the edge is not seen, its image ends there; splitting finds no more of it.
        let slack = slack_of(instance, tangent, nearest, a.z);
        error = select(0.0, chord_error(points[0], points[1], points[2], points[3], points[4], slack), whole);
    }
    var level = level_for(error * strictness(instance) * closer, 1.0);
    level = min(level, most_segments(instance, a.xyz, b.xyz, pixel * length(from_apparent)));
    let turn = turn_about_axis(a.xyz, b.xyz, order);
    let sag = uneven_sag(a.xyz, b.xyz, level, turn, seen_under);
    if plain && (turn > most_turn(instance) || level_for(sag * fineness * strictness(instance), 1.0) > 1u) {
        error = MUST_SPLIT;
        level = max(level, BLOCK + 1u);
    }
    edge_states[slot] = vec4<f32>(bitcast<f32>(level), bitcast<f32>(select(0u, EDGE_LIMB, limb)), 0.0, error);
}
