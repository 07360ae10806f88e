// Stage 2: one thread per model edge and order. The level of an edge comes from the edge alone, so its two triangles agree on it.

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = group.y * groups.x + group.x;
    let chunk = chunks[index];
    if chunk.placement == NO_PLACEMENT {
        return;
    }
    let placement = placements[chunk.placement];
    let local = chunk.first + lane;
    if local >= placement.vertices.w {
        return;
    }
    let edge = model_edges[placement.vertices.z + local];
    let order = placement.ids.x;
    let a = emitted[placement.ids.z + edge.x];
    let b = emitted[placement.ids.z + edge.y];
    let slot = placement.ids.w + local;
    if a.w == VERTEX_UNSEEN || b.w == VERTEX_UNSEEN {
        edge_states[slot] = vec4<f32>(bitcast<f32>(1u), bitcast<f32>(EDGE_UNSEEN), 0.0, 0.0);
        return;
    }

    // Does the axis cut the edge? Distance of the axis from the line, across the axis, and the foot on it.
    if a.w == VERTEX_PLAIN && b.w == VERTEX_PLAIN {
        let qa = across_plane(a.xyz);
        let d = across_plane(b.xyz) - qa;
        let t = clamp(-dot(qa, d) / max(dot(d, d), 1e-30), 0.0, 1.0);
        let foot = mix(a.xyz, b.xyz, vec3<f32>(t));
        if length(qa + d * t) < axis_tolerance(foot) && axis_matters(dot(foot, frame.radial.xyz), order) {
            edge_states[slot] = vec4<f32>(bitcast<f32>(1u), bitcast<f32>(EDGE_CUT), t, 0.0);
            return;
        }
    }

    let from_apparent = seen[placement.ids.z + edge.x].apparent.xyz;
    let to_apparent = seen[placement.ids.z + edge.y].apparent.xyz;
    var error: f32;
    if a.w == VERTEX_ON_AXIS {
        error = radial_error(apex_offset(a.xyz), b.xyz, order);
    } else if b.w == VERTEX_ON_AXIS {
        error = radial_error(apex_offset(b.xyz), a.xyz, order);
    } else if angle_between(from_apparent, to_apparent) < 2.0 * frame.size.w {
        // The whole edge is seen under less than the budget allows for its bend.
        error = 0.0;
    } else {
        let p = model_vertices[placement.vertices.x + edge.x].position.xyz;
        let q = model_vertices[placement.vertices.x + edge.y].position.xyz;
        error = chord_error(from_apparent,
            sight_at(emitted_offset(placement, p + (q - p) * 0.25, order), order).apparent,
            sight_at(emitted_offset(placement, p + (q - p) * 0.5, order), order).apparent,
            sight_at(emitted_offset(placement, p + (q - p) * 0.75, order), order).apparent,
            to_apparent);
    }
    edge_states[slot] = vec4<f32>(bitcast<f32>(level_for(error)), bitcast<f32>(0u), 0.0, error);
}
