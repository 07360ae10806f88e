// Third pass of the aurora: the walk on the screen. One thread per streak and image order steps through equal parts of its light; between the
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

/// Splats whose lesser standard deviation is less than this are added pixel by pixel; wider ones where it is half of this and more: less would be too narrow for
/// the coarse pixels once what enlarging adds has been taken off.
const NARROW: f32 = 1.5;
/// Sizes of the tiles whose depths are known: 8 pixels, 16, and so on.
const TILES: u32 = 6u;
const LEAST_TILE: u32 = 8u;

/// The least and the greatest depth of what is drawn in a box of pixels (left, top, right, bottom) on the screen, at least.
fn depths_in(pixels: vec4<f32>) -> vec2<f32> {
    let inside = vec4<u32>(clamp(pixels, vec4<f32>(0.0), frame.size.xyxy - 1.0));
    let side = max(inside.z - inside.x, inside.w - inside.y);
    // Tiles as wide as the box, as far as there are: it touches two of them a side.
    let size = min(firstLeadingBit(max(side, LEAST_TILE) / LEAST_TILE) + 1u, TILES - 1u);
    let tile = inside >> vec4<u32>(size + firstTrailingBit(LEAST_TILE));
    var range = vec2<f32>(1.0, 0.0);
    for (var y = tile.y; y <= tile.w; y++) {
        for (var x = tile.x; x <= tile.z; x++) {
            let part = textureLoad(ranges, vec2<u32>(x, y), size).xy;
            range = vec2<f32>(min(range.x, part.x), max(range.y, part.y));
        }
    }
    return range;
}

/// Km around the ends of a streak that its splats may reach, beside their spread: the longest stretch goes half its length beyond them.
const BEYOND: f32 = 30.0;

/// Whether nothing of a streak can be seen: all its ends are beyond one edge of the screen, or behind what is drawn there.
fn unseen(first: u32, count: u32) -> bool {
    let reach_km = 3.0 * aurora.splats.x + BEYOND;
    // Beyond the right, the upper, the left and the lower edge.
    var beyond = vec4<bool>(true);
    var near = false;
    var around = vec4<f32>(1e9, 1e9, -1e9, -1e9);
    var nearest = 0.0;
    for (var k = 0u; k <= count; k++) {
        let end = chords[first + k];
        let reach = reach_km * max(length(end.east.xyz), length(end.north.xyz));
        let clip = clip_position(end.apparent.xyz);
        // Distances from the four planes through the camera and the screen's edges, at least.
        let over = vec4<f32>(clip.xy, -clip.xy) - clip.w - reach * (frame.projection.xyxy + 1.0);
        beyond &= over > vec4<f32>(0.0);
        near |= !(clip.w > 2.0 * reach + frame.projection.z);
        let w = max(clip.w - reach, 1e-9);
        let pixel = (vec2<f32>(0.5, -0.5) * clip.xy / clip.w + 0.5) * frame.size.xy;
        let pixels = reach * (frame.projection.xy + 1.0) / w * 0.5 * frame.size.xy;
        around = vec4<f32>(min(around.xy, pixel - pixels), max(around.zw, pixel + pixels));
        nearest = max(nearest, frame.projection.z / w);
    }
    if any(beyond) {
        return true;
    }
    if near {
        return false;
    }
    return nearest < depths_in(around).x;
}

/// An even stretch of the fall has a twelfth of its length squared as variance; a little more closes the gaps between stretches.
const STRETCH: f32 = 0.12;
/// Parts of a streak are one splat as long as they reach over no more than this many standard deviations.
const MERGED: f32 = 2.0;

/// Km along the fall that are as long on the screen as a splat is wide there (one standard deviation), about the upper end of the chord at a height.
fn width_along(kind: u32, height: f32, first: u32, count: u32, focal: vec2<f32>) -> f32 {
    let chord = chord_at(kind, height, count);
    let a = chords[first + chord];
    let b = chords[first + chord + 1u];
    let per_chord = chord_height(kind, chord, count) - chord_height(kind, chord + 1u, count);
    // Whichever end is before the camera.
    let c = select(b.apparent.xyz, a.apparent.xyz, a.apparent.z < -frame.projection.z);
    let fallen = length(screen_step(c, (b.apparent.xyz - a.apparent.xyz) / per_chord, focal));
    let east = screen_step(c, a.east.xyz, focal);
    let north = screen_step(c, a.north.xyz, focal);
    let wide = min(dot(east, east), dot(north, north)) * aurora.splats.x * aurora.splats.x + PIXEL_VARIANCE;
    return sqrt(wide) / max(fallen, 1e-6);
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
    if unseen(first, chord_count) {
        return;
    }
    let segment = segments[streak.segment];
    // How hard its electrons are, by the flux when those of the middle came down.
    let fall = fall_at(chords[first + chord_count / 2u].north.w);
    // Photons of its lines per 35 eV, and from them the light of this streak, in kR km².
    let row = min(u32(fall), ROWS - 2u);
    let part = fall - f32(row);
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
    let count = min(aurora.counts.z, arrayLength(&corners));
    let light = max(lines.x + lines.y + lines.z + lines.w, 1e-12);
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
    var upper = height_of(fall, streak.kind, 0.0);
    // Equal parts of the light, the next of them `k`; those that are near one another on the screen, seen along the streak, are one splat.
    var k = 0u;
    while k < count {
        let start = upper;
        // A width holds for its own chord.
        let end = chord_height(streak.kind, chord_at(streak.kind, start, chord_count) + 1u, chord_count);
        let most_km = min(MERGED * width_along(streak.kind, start, first, chord_count, focal), start - end);
        // Parts, their heights from here and the squares of those.
        var sums = vec3<f32>(0.0);
        loop {
            let lower = height_of(fall, streak.kind, f32(k + 1u) / f32(count));
            let middle = 0.5 * (upper + lower) - start;
            let extent = upper - lower;
            sums += vec3<f32>(1.0, middle, middle * middle + STRETCH * extent * extent);
            upper = lower;
            k++;
            if !(start - height_of(fall, streak.kind, f32(k + 1u) / f32(count)) < most_km) | (k >= count) {
                break;
            }
        }
        let parts = sums.x;
        let height = start + sums.y / parts;
        let stretch = max(sums.z / parts - (sums.y / parts) * (sums.y / parts), 0.0);
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
        let blob = aurora.splats.x * aurora.splats.x;
        let xx = blob * j.x + stretch * fallen.x * fallen.x + PIXEL_VARIANCE;
        let xy = blob * j.y + stretch * fallen.x * fallen.y;
        let yy = blob * j.z + stretch * fallen.y * fallen.y + PIXEL_VARIANCE;
        let spread = sqrt(max(xx * yy - xy * xy, 1e-12));
        // kR: photons per area across the line of sight, and √det J Jᵀ is pixels per km².
        let area = sqrt(max(j.x * j.z - j.y * j.y, 0.0));
        let peak = min(parts * power * mix(a.east.w, b.east.w, s) * area / (6.2831853 * spread), BRIGHTEST);
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
        let place = clip.xyz / clip.w;
        let pixel = (vec2<f32>(0.5, -0.5) * place.xy + 0.5) * frame.size.xy;
        let axes = vec4<f32>(direction * major, vec2<f32>(-direction.y, direction.x) * minor);
        // The level at which it is three quarters to one and a half pixels narrow.
        let coarsest = max(u32(aurora.splats.y), 1u) - 1u;
        var level = min(u32(max(log2(2.0 * minor / NARROW), 0.0)), coarsest);
        // All but 1 % of the light is within three standard deviations, and two pixels of its level further where that is enlarged.
        let reach = 3.0 * sqrt(axes.xy * axes.xy + axes.zw * axes.zw) + select(1.0, 2.0 * f32(1u << level), level > 0u);
        let around = vec4<f32>(pixel - reach, pixel + reach);
        if any(around.zw < vec2<f32>(0.0)) | any(around.xy > frame.size.xy) {
            continue;
        }
        if level > 0u {
            let range = depths_in(around);
            // Behind all that is there (depth is reversed); and what an outline crosses is tested pixel by pixel.
            if place.z < range.x {
                continue;
            }
            level = select(0u, level, place.z >= range.y);
        }
        let room = room_of(id.y, &level);
        if room == 0xffffffffu {
            return;
        }
        // Enlarging widens it, so it is added narrower by that.
        let size = 1.0 / f32(1u << level);
        let widening = 0.25 * (1.0 - size * size);
        let wide = size * vec2<f32>(major, minor);
        let narrower = sqrt(wide * wide - widening);
        let shrink = narrower / wide;
        let kilorayleighs = lines * (peak / (shrink.x * shrink.y));
        let halves = array<u32, 2>(pack2x16float(kilorayleighs.xy), pack2x16float(kilorayleighs.zw));
        let ndc = axes * shrink.xxyy * 2.0 / frame.size.xyxy;
        for (var n = 0u; n < 3u; n++) {
            let corner = corner_of(n);
            let at = place.xy + ndc.xy * corner.x + ndc.zw * corner.y;
            corners[room + n] = Corner(at.x, at.y, place.z, halves);
        }
    }
}
