// Second pass of the aurora: the ends of each streak's chords, from what was projected beside them. One thread per end and image order.

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
    let body = at_height(a.xy + step * streak.along + across, height, streak.south);
    let slot = end_index + select(0u, aurora.counts.y + 1u, streak.kind == RED);
    let reference = references[first_reference(streak.segment, streak.south, id.y) + slot];
    let middle = vec3<f32>(reference.east.w, reference.north.w, reference.up.w);
    let aside = transpose(across_field(middle)) * (body - middle);
    var end: ChordEnd;
    let seen = reference.apparent.xyz + reference.east.xyz * aside.x + reference.north.xyz * aside.y + reference.up.xyz * aside.z;
    end.apparent = vec4<f32>(seen, reference.apparent.w);
    let flux = mix(a.z, b.z, streak.along);
    let arc = f32(segment.range.y) + streak.along * f32(segment.range.w);
    end.east = vec4<f32>(reference.east.xyz, flux * mix(1.0, rays(arc, aurora.clock.z - wait), aurora.clock.w));
    end.north = vec4<f32>(reference.north.xyz, flux);
    chords[id.y * aurora.counts.x * ends + index] = end;
}
