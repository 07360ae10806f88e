// First pass of the aurora: the ends of all chords go through the lensing lookup, and nothing else does. One thread per end and image order.

/// How far from the end its neighbours across the field are taken, km: far against the rounding of the lookup, near against its bending.
const ASIDE: f32 = 20.0;

/// A node's place and flux `age` seconds ago; before the oldest row it stays there.
fn node_at(node: u32, age: f32) -> vec4<f32> {
    let x = clamp(age / aurora.clock.x, 0.0, f32(aurora.history.x - 1u));
    let row = min(u32(x), aurora.history.x - 2u);
    let newer = nodes[row * aurora.counts.w + node];
    let older = nodes[(row + 1u) * aurora.counts.w + node];
    return mix(newer, older, x - f32(row));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let ends = aurora.counts.y + 1u;
    let index = id.x;
    if index >= aurora.counts.x * ends {
        return;
    }
    let streak = streak_of(index / ends);
    let range = height_range(streak.kind);
    let height = mix(range.x, range.y, f32(index % ends) / f32(aurora.counts.y));
    let age = waits(streak, height) + aurora.clock.y;
    let segment = segments[streak.segment];
    let a = node_at(segment.range.y, age);
    let b = node_at(segment.range.y + segment.range.w, age);
    let step = b.xy - a.xy;
    let across = vec2<f32>(-step.y, step.x) / max(length(step), 1e-3) * (streak.across * segment.light.y);
    var body = on_field_line(a.xy + step * streak.along + across, height);
    if streak.south {
        body.z = -body.z;
    }
    // Two unit vectors across the dipole's field there.
    let n = body / max(length(body), 1.0);
    let up = normalize(n * (3.0 * n.z) - vec3<f32>(0.0, 0.0, 1.0));
    let east = normalize(cross(vec3<f32>(0.0, 0.0, 1.0), n) + vec3<f32>(1e-6, 0.0, 0.0));
    let north = cross(up, east);

    let placement = aurora_placements[id.y];
    let order = placement.ids.x;
    var seen: array<vec3<f32>, 3>;
    var valid = true;
    for (var k = 0u; k < 3u; k++) {
        let aside = select(select(vec3<f32>(0.0), east, k == 1u), north, k == 2u) * ASIDE;
        let found = answer(placement, query_body(body + aside), order);
        seen[k] = found.ray.apparent;
        valid = valid && found.ray.valid && finite_vector(found.ray.apparent);
    }
    var end: ChordEnd;
    end.apparent = vec4<f32>(seen[0], select(0.0, 1.0, valid));
    end.east = vec4<f32>((seen[1] - seen[0]) / ASIDE, mix(a.z, b.z, streak.along));
    end.north = vec4<f32>((seen[2] - seen[0]) / ASIDE, 0.0);
    chords[id.y * aurora.counts.x * ends + index] = end;
}
