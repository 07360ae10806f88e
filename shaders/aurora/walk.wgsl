// Second pass of the aurora: the walk on the screen. One thread per streak and image order steps through equal parts of its light; between the
// ends of a chord the apparent place is linear in height, so a step is a few products and one reciprocal. (Paper 3 steps linearly on the
// screen itself, which is right from the side and wrong from below; AURORA_LINEAR does so.)

/// Variance that a pixel itself has, and the least that a splat may have: light must not depend on where in its pixel a point is.
const PIXEL_VARIANCE: f32 = 0.35;
/// The widest a splat may be, pixels: one just before the camera is large, and faint.
const MOST_SIGMA: f32 = 160.0;
/// The brightest that the middle of one splat may be, kR: sums of them must stay within half floats.
const BRIGHTEST: f32 = 1e4;
/// Fainter splats are left out, kR.
const FAINTEST: f32 = 1e-4;

/// Pixels that the apparent place `c` moves by when it changes by `v`.
fn screen_step(c: vec3<f32>, v: vec3<f32>, focal: vec2<f32>) -> vec2<f32> {
    let inverse = -1.0 / c.z;
    return focal * (v.xy + c.xy * (v.z * inverse)) * inverse;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let index = id.x;
    if index >= aurora.counts.x {
        return;
    }
    let streak = streak_of(index);
    let chord_count = chords_of(streak.kind);
    let first = (id.y * aurora.counts.x + index) * chord_room();
    let segment = segments[streak.segment];
    // How hard its electrons are, by the flux when those of the middle came down.
    let fall = fall_of(streak, chords[first + chord_count / 2u].north.w);
    // Collisions of this streak, and from them photons of its lines, in kR km².
    let row = min(u32(fall.x), ROWS - 2u);
    let part = fall.x - f32(row);
    var photons: vec4<f32>;
    for (var line = 0u; line < 4u; line++) {
        photons[line] = mix(falls[4u * row + line], falls[4u * row + 4u + line], part);
    }
    var lines = vec4<f32>(0.0);
    if streak.kind == GREEN {
        lines.x = photons.x;
    } else if streak.kind == PROMPT {
        lines.y = photons.y;
        lines.w = photons.w;
    } else {
        lines.z = photons.z;
    }
    let count = min(aurora.counts.z, arrayLength(&splats));
    let light = max(lines.x + lines.y + lines.z + lines.w, 1e-12);
    // A streak of twice the energy stands for half as many electrons: the flux of energy is what is given.
    let power = light * streak.share * segment.light.x / f32(count);
    lines /= light;

    let focal = frame.projection.xy * 0.5 * frame.size.xy;
    let range = height_range(streak.kind);
    let top = chords[first].apparent;
    let foot = chords[first + chord_count].apparent;
    let is_linear = (aurora.history.w & AURORA_LINEAR) != 0u;
    if is_linear & ((top.w * foot.w == 0.0) | (max(top.z, foot.z) > -frame.projection.z)) {
        return;
    }
    var upper = height_of(fall.x, streak.kind, 0.0);
    for (var k = 0u; k < count; k++) {
        let lower = height_of(fall.x, streak.kind, f32(k + 1u) / f32(count));
        let length_km = upper - lower;
        let height = 0.5 * (upper + lower);
        upper = lower;
        let chord = chord_at(streak.kind, height, chord_count);
        let above = chord_height(streak.kind, chord, chord_count);
        let per_chord = above - chord_height(streak.kind, chord + 1u, chord_count);
        let a = chords[first + chord];
        let b = chords[first + chord + 1u];
        if a.apparent.w * b.apparent.w == 0.0 {
            continue;
        }
        let s = clamp((above - height) / per_chord, 0.0, 1.0);
        // Homogeneous coordinates, linear between the ends.
        var c = mix(a.apparent.xyz, b.apparent.xyz, s);
        let down = (b.apparent.xyz - a.apparent.xyz) / per_chord;
        if -c.z < frame.projection.z {
            continue;
        }
        let east = screen_step(c, mix(a.east.xyz, b.east.xyz, s), focal);
        let north = screen_step(c, mix(a.north.xyz, b.north.xyz, s), focal);
        // Linear on the screen between top and foot, if paper 3's way is asked for.
        let t = (range.x - height) / (range.x - range.y);
        let p = mix(top.xy / -top.z, foot.xy / -foot.z, t);
        let fallen = select(screen_step(c, down, focal), focal * (foot.xy / -foot.z - top.xy / -top.z) / (range.x - range.y), is_linear);
        c = select(c, vec3<f32>(p * -c.z, c.z), is_linear);
        // The blob, seen through the derivative of the projection: σ² J Jᵀ.
        let j = vec3<f32>(dot(vec3<f32>(east.x, north.x, fallen.x), vec3<f32>(east.x, north.x, fallen.x)),
            dot(vec3<f32>(east.x, north.x, fallen.x), vec3<f32>(east.y, north.y, fallen.y)),
            dot(vec3<f32>(east.y, north.y, fallen.y), vec3<f32>(east.y, north.y, fallen.y)));
        let blob = aurora.electrons.z * aurora.electrons.z;
        // An even stretch of the fall has a twelfth of its length squared as variance; a little more closes the gaps between stretches.
        let stretch = length_km * length_km * 0.12;
        let xx = blob * j.x + stretch * fallen.x * fallen.x + PIXEL_VARIANCE;
        let xy = blob * j.y + stretch * fallen.x * fallen.y;
        let yy = blob * j.z + stretch * fallen.y * fallen.y + PIXEL_VARIANCE;
        let spread = sqrt(max(xx * yy - xy * xy, 1e-12));
        // kR: photons per area across the line of sight, and √det J Jᵀ is pixels per km².
        let area = sqrt(max(j.x * j.z - j.y * j.y, 0.0));
        let peak = min(power * mix(a.east.w, b.east.w, s) * area / (6.2831853 * spread), BRIGHTEST);
        if !(peak > FAINTEST) {
            continue;
        }
        // Half axes: eigenvectors of the covariance.
        let mean = 0.5 * (xx + yy);
        let gap = sqrt(max(0.25 * (xx - yy) * (xx - yy) + xy * xy, 0.0));
        let major = min(sqrt(mean + gap), MOST_SIGMA);
        let minor = min(sqrt(max(mean - gap, PIXEL_VARIANCE)), MOST_SIGMA);
        var direction = vec2<f32>(1.0, 0.0);
        if gap > 1e-6 * mean {
            // Of the two ways to write the eigenvector, the longer is exact.
            let u = vec2<f32>(mean + gap - yy, xy);
            let v = vec2<f32>(xy, mean + gap - xx);
            direction = normalize(select(v, u, dot(u, u) > dot(v, v)));
        }
        let clip = clip_position(c);
        let ndc = clip.xy / clip.w;
        let margin = 1.0 + 6.0 * major / min(frame.size.x, frame.size.y);
        if !all(abs(ndc) < vec2<f32>(margin)) {
            continue;
        }
        let slot = atomicAdd(&splat_draws[id.y].instances, 1u);
        if slot >= aurora.history.z {
            atomicSub(&splat_draws[id.y].instances, 1u);
            return;
        }
        splats[id.y * aurora.history.z + slot] = Splat(vec4<f32>(ndc, clip.z / clip.w, peak),
            vec4<f32>(direction * major, vec2<f32>(-direction.y, direction.x) * minor), lines);
    }
}
