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

/// Values of the rays' noise, a power of two; the seconds after which both its drifts have passed a multiple of them stand in show.rs.
const RAYS_CELLS: i32 = 1024;

/// Smooth noise in [0, 1], of period RAYS_CELLS in x: the clock may start again without a jump.
fn ray_noise(x: f32, channel: u32) -> f32 {
    let cell = floor(x);
    let s = x - cell;
    let key = hash(channel);
    let a = unit(hash(key + u32(i32(cell) & (RAYS_CELLS - 1))));
    let b = unit(hash(key + u32((i32(cell) + 1) & (RAYS_CELLS - 1))));
    return mix(a, b, s * s * (3.0 - 2.0 * s));
}

/// Rays: brightness along the curtain at a few kilometres, drifting, at a time in s.
fn rays(arc: f32, time: f32) -> f32 {
    return ray_noise(arc * 2.7 + 0.11 * time, 3u) * ray_noise(arc * 0.83 - 0.07 * time, 4u) * 4.0;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let ends = chord_room();
    let index = id.x;
    if index >= aurora.counts.x * ends {
        return;
    }
    let streak = streak_of(index / ends);
    let count = chords_of(streak.kind);
    let end_index = index % ends;
    if end_index > count {
        return;
    }
    let height = chord_height(streak.kind, end_index, count);
    let wait = waits(streak, height);
    let age = wait + aurora.clock.y;
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
    let flux = mix(a.z, b.z, streak.along);
    let arc = f32(segment.range.y) + streak.along * f32(segment.range.w);
    end.east = vec4<f32>((seen[1] - seen[0]) / ASIDE, flux * mix(1.0, rays(arc, aurora.clock.z - wait), aurora.clock.w));
    end.north = vec4<f32>((seen[2] - seen[0]) / ASIDE, flux);
    chords[id.y * aurora.counts.x * ends + index] = end;
}
