// Third pass of the aurora: the walk on the screen. One thread per streak and image order steps through parts of its light. Between the
// ends of a chord the apparent position is linear in height, so a step is a few products and one reciprocal. (Sekiguchi et al. step
// linearly on the screen itself, which is right from the side and wrong from below; AURORA_LINEAR does so.)

#import lensrunner::aurora::rooms::{light_up, room_of}
#import lensrunner::aurora::streaks::{
    aurora, AURORA_LINEAR, chord_at, chord_height, chord_room, chords, chords_of, fall_at, height_of, height_range, photons_of, ranges,
    segments, Streak, streak_of, strokes,
}
#import lensrunner::aurora::stroke::{CORNERS, FILLED, SIGMAS, Stroke}
#import lensrunner::geometry::clip::clip_position
#import lensrunner::gpu::bindings::frame

/// Variance of a pixel, and the least variance of a stroke: light must not depend on where in its pixel a point is.
const PIXEL_VARIANCE: f32 = 0.35;
/// Greatest brightness of a stroke, in kR, before its ends are blurred: it is stored in half floats.
const BRIGHTEST: f32 = 1e4;
/// Fainter strokes are left out, kR.
const FAINTEST: f32 = 1e-4;

/// By how many pixels the apparent position `c` moves when it changes by `v`.
fn screen_step(c: vec3<f32>, v: vec3<f32>, focal: vec2<f32>) -> vec2<f32> {
    let inverse = -1.0 / c.z;
    return focal * (v.xy + c.xy * (v.z * inverse)) * inverse;
}

/// Strokes whose lesser standard deviation, in pixels, is below this are added pixel by pixel. Wider ones go to the level where it is half
/// of this or more; with less it would be too narrow for the coarse pixels once the widening by enlarging has been taken off.
const NARROW: f32 = 1.5;
/// Sizes of the depth tiles, whose least and greatest depths are known: 8 pixels, 16, and so on. As in src/render/aurora/levels.rs.
const DEPTH_TILES: u32 = 6u;
const LEAST_DEPTH_TILE: u32 = 8u;

/// The least and the greatest depth of what is drawn in a box of pixels (left, top, right, bottom) on the screen, at least.
fn depths_in(pixels: vec4<f32>) -> vec2<f32> {
    let inside = vec4<u32>(clamp(pixels, vec4<f32>(0.0), frame.size.xyxy - 1.0));
    let side = max(inside.z - inside.x, inside.w - inside.y);
    // Tiles as wide as the box, as far as there are: it touches two of them a side.
    let size = min(firstLeadingBit(max(side, LEAST_DEPTH_TILE) / LEAST_DEPTH_TILE) + 1u, DEPTH_TILES - 1u);
    let tile = inside >> vec4<u32>(size + firstTrailingBit(LEAST_DEPTH_TILE));
    var range = vec2<f32>(1.0, 0.0);
    for (var y = tile.y; y <= tile.w; y++) {
        for (var x = tile.x; x <= tile.z; x++) {
            let part = textureLoad(ranges, vec2<u32>(x, y), size).xy;
            range = vec2<f32>(min(range.x, part.x), max(range.y, part.y));
        }
    }
    return range;
}

/// By how many km strokes may reach beyond the ends of a streak, apart from their spread: the longest goes half its length beyond them.
const BEYOND: f32 = 30.0;

/// Whether nothing of a streak can be seen: all its ends are beyond one edge of the screen, or behind what is drawn there.
fn unseen(spread: vec2<f32>, first: u32, count: u32) -> bool {
    let reach_km = 3.0 * sqrt(max(spread.x, spread.y)) + BEYOND;
    // Beyond the right, the upper, the left and the lower edge.
    var beyond = vec4<bool>(true);
    var near = false;
    var around = vec4<f32>(1e9, 1e9, -1e9, -1e9);
    var nearest = 0.0;
    for (var k = 0u; k <= count; k++) {
        let end = chords[first + k];
        let reach = reach_km * max(length(end.along.xyz), length(end.across.xyz));
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

/// Parts of a streak are one stroke as long as they extend over no more than this many standard deviations.
const MERGED: f32 = 2.0;
/// Half the width of a parabola over its standard deviation, √5: the blur of a stroke's ends.
const END: f32 = 2.236068;
/// Least length of a stroke over the half width of that blur: a shorter one looks no different.
const SHORTEST: f32 = 0.25;
/// An end of a stroke nearer than this share of the farther end's distance is cut off: it may be behind the camera.
const NEAREST: f32 = 0.1;

/// Length along the fall, in km, that is as long on the screen as a stroke is wide there (one standard deviation), about the upper end of
/// the chord at a height.
fn width_along(streak: Streak, height: f32, first: u32, count: u32, focal: vec2<f32>) -> f32 {
    let kind = streak.kind;
    let chord = chord_at(kind, height, count);
    let a = chords[first + chord];
    let b = chords[first + chord + 1u];
    let per_chord = chord_height(kind, chord, count) - chord_height(kind, chord + 1u, count);
    // Whichever end is in front of the camera.
    let c = select(b.apparent.xyz, a.apparent.xyz, a.apparent.z < -frame.projection.z);
    let fallen = length(screen_step(c, (b.apparent.xyz - a.apparent.xyz) / per_chord, focal));
    let along = screen_step(c, a.along.xyz, focal);
    let across = screen_step(c, a.across.xyz, focal);
    let wide = min(dot(along, along) * streak.spread.x, dot(across, across) * streak.spread.y) + PIXEL_VARIANCE;
    return sqrt(wide) / max(fallen, 1e-6);
}

/// The share of a streak's light that is above the beginning of its part `k` of `count`. The first and the last part have less, because
/// light is thin there and they are long. `phase` lets parts of neighbours begin at different heights, so that no layers are visible.
fn light_above(k: u32, count: u32, phase: f32) -> f32 {
    return smoothstep(0.0, f32(count), f32(k) + select(phase, 0.0, (k == 0u) | (k >= count)));
}

/// Where a streak begins. Its first part is evenly bright and long: if all began at the greatest height, curtains would end there in an
/// edge. With tops distributed as 2t over [0, 1), denser the higher, and strokes brighter by 1/t, the mean brightness falls off linearly,
/// and no light is lost.
fn top_of(streak: Streak, fall: f32, count: u32) -> f32 {
    let t = sqrt(fract(streak.wait + streak.phase + 0.5));
    let lower = height_of(fall, streak.kind, light_above(1u, count, streak.phase));
    return mix(lower, height_of(fall, streak.kind, 0.0), t);
}

/// Where a streak is seen at a height: apparent position, homogeneous; w is 0 where it is not seen.
fn apparent_at(kind: u32, height: f32, first: u32, count: u32) -> vec4<f32> {
    let chord = chord_at(kind, height, count);
    let above = chord_height(kind, chord, count);
    let s = clamp((above - height) / (above - chord_height(kind, chord + 1u, count)), 0.0, 1.0);
    let a = chords[first + chord].apparent;
    let b = chords[first + chord + 1u].apparent;
    return vec4<f32>(mix(a.xyz, b.xyz, s), a.w * b.w);
}

/// A stroke on the screen, in pixels.
struct Shape {
    /// From its middle to its end along it, with its blur there, and to its side.
    half: vec2<f32>,
    side: vec2<f32>,
    /// Length of what is evenly bright, half the width of the blur at its ends, and the standard deviation across it.
    stretch: f32,
    blurred: f32,
    sigma: f32,
}

/// The layout of a stroke of a length along the unit vector `u`, in a level. `blur` has the covariances (along, across, both) that it shall
/// have on the screen.
fn shape_of(level: u32, u: vec2<f32>, seen: f32, blur: vec3<f32>) -> Shape {
    // Enlarging widens it, so it is added narrower by that.
    let widening = 0.25 * (f32(1u << (2u * level)) - 1.0);
    let narrower = max(blur.xy - widening, vec2<f32>(0.5 * PIXEL_VARIANCE));
    var shape: Shape;
    shape.sigma = sqrt(narrower.y);
    shape.blurred = END * sqrt(max(narrower.x - blur.z * blur.z / narrower.y, 0.1 * narrower.x));
    shape.stretch = max(seen, SHORTEST * shape.blurred);
    shape.half = u * (0.5 * shape.stretch + shape.blurred);
    shape.side = (vec2<f32>(-u.y, u.x) + u * (blur.z / narrower.y)) * SIGMAS * shape.sigma;
    return shape;
}

/// The pixels (left, top, right, bottom) that a stroke with its middle at `pixel` lights: two pixels of its level further, where that is
/// enlarged.
fn box_of(pixel: vec2<f32>, shape: Shape, level: u32) -> vec4<f32> {
    let reach = abs(shape.half) + abs(shape.side) + select(1.0, 2.0 * f32(1u << level), level > 0u);
    return vec4<f32>(pixel - reach, pixel + reach);
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
    if unseen(streak.spread, first, chord_count) {
        return;
    }
    let segment = segments[streak.segment];
    // How hard its electrons are, by the flux when those of its middle came down. In rays there are more of them, and harder ones.
    let fall = fall_at(chords[first + chord_count / 2u].along.w);
    let count = min(aurora.counts.z, arrayLength(&strokes));
    // Collisions of 35 eV, in kR km².
    let collisions = streak.share * segment.light.x;
    let focal = frame.projection.xy * 0.5 * frame.size.xy;
    let range = height_range(streak.kind);
    let top = chords[first].apparent;
    let foot = chords[first + chord_count].apparent;
    let is_linear = (aurora.history.w & AURORA_LINEAR) != 0u;
    if is_linear & ((top.w * foot.w == 0.0) | (max(top.z, foot.z) > -frame.projection.z)) {
        return;
    }
    var upper = top_of(streak, fall, count);
    var made = photons_of(fall, streak.kind, 0.0);
    // Parts of the light; `k` is the next one. Parts close together on the screen, as seen along the streak, are one stroke.
    var k = 0u;
    while k < count {
        let start = upper;
        // A width holds for its own chord.
        let end = chord_height(streak.kind, chord_at(streak.kind, start, chord_count) + 1u, chord_count);
        let most_km = min(MERGED * width_along(streak, start, first, chord_count, focal), start - end);
        // Moments of the joined parts: light, light times height from here, light times its square.
        var sums = vec3<f32>(0.0);
        loop {
            let passed = light_above(k, count, streak.phase);
            k++;
            let below = light_above(k, count, streak.phase);
            let lower = height_of(fall, streak.kind, below);
            let middle = 0.5 * (upper + lower) - start;
            let extent = upper - lower;
            sums += (below - passed) * vec3<f32>(1.0, middle, middle * middle + extent * extent / 12.0);
            upper = lower;
            if !(start - height_of(fall, streak.kind, light_above(k + 1u, count, streak.phase)) < most_km) | (k >= count) {
                break;
            }
        }
        // An evenly bright line with the mean and the variance of them all.
        let mean = sums.y / sums.x;
        let height = start + mean;
        let half_km = sqrt(3.0 * max(sums.z / sums.x - mean * mean, 0.0));
        var high = apparent_at(streak.kind, height + half_km, first, chord_count);
        var low = apparent_at(streak.kind, height - half_km, first, chord_count);
        let made_before = made;
        made = photons_of(fall, streak.kind, light_above(k, count, streak.phase));
        let chord = chord_at(streak.kind, height, chord_count);
        let above = chord_height(streak.kind, chord, chord_count);
        let per_chord = above - chord_height(streak.kind, chord + 1u, chord_count);
        let a = chords[first + chord];
        let b = chords[first + chord + 1u];
        if (high.w * low.w == 0.0) | (a.apparent.w * b.apparent.w == 0.0) {
            continue;
        }
        // Linear on the screen between top and foot, if the way of Sekiguchi et al. is asked for.
        let t = (range.x - height - vec2<f32>(half_km, -half_km)) / (range.x - range.y);
        let screen = vec4<f32>(mix(top.xy / -top.z, foot.xy / -foot.z, t.x), mix(top.xy / -top.z, foot.xy / -foot.z, t.y));
        high = vec4<f32>(select(high.xy, screen.xy * -high.z, is_linear), high.zw);
        low = vec4<f32>(select(low.xy, screen.zw * -low.z, is_linear), low.zw);
        // What is behind the camera or much nearer than the rest is cut off.
        let least = max(frame.projection.z, NEAREST * max(-high.z, -low.z));
        if max(-high.z, -low.z) <= least {
            continue;
        }
        // Homogeneous coordinates are linear between the ends, and so is the light that is left.
        var left = 1.0;
        if -high.z < least {
            let t = (-least - high.z) / (low.z - high.z);
            high = mix(high, low, t);
            left = 1.0 - t;
        }
        if -low.z < least {
            let t = (-least - high.z) / (low.z - high.z);
            low = mix(high, low, t);
            left *= t;
        }
        let c = 0.5 * (high.xyz + low.xyz);
        let s = clamp((above - height) / per_chord, 0.0, 1.0);
        let along = screen_step(c, mix(a.along.xyz, b.along.xyz, s), focal);
        let across = screen_step(c, mix(a.across.xyz, b.across.xyz, s), focal);
        let fallen = screen_step(c, (b.apparent.xyz - a.apparent.xyz) / per_chord, focal);
        // The blur of a point of it, seen through the derivative of the projection, J: J diag(σ²) Jᵀ.
        let variance = vec3<f32>(streak.spread, aurora.strokes.x * aurora.strokes.x);
        let x = vec3<f32>(along.x, across.x, fallen.x);
        let y = vec3<f32>(along.y, across.y, fallen.y);
        let blur = vec3<f32>(dot(variance, x * x), dot(variance, x * y), dot(variance, y * y)) + vec3<f32>(PIXEL_VARIANCE, 0.0, PIXEL_VARIANCE);
        // The same along the stroke on the screen and to the left of it.
        let ends = focal * (low.xy / -low.z - high.xy / -high.z);
        let seen = length(ends);
        var u = vec2<f32>(1.0, 0.0);
        if seen > 1e-3 {
            u = ends / seen;
        }
        let v = vec2<f32>(-u.y, u.x);
        let uu = blur.x * u.x * u.x + 2.0 * blur.y * u.x * u.y + blur.z * u.y * u.y;
        let vv = blur.x * v.x * v.x + 2.0 * blur.y * v.x * v.y + blur.z * v.y * v.y;
        let uv = blur.x * u.x * v.x + blur.y * (u.x * v.y + u.y * v.x) + blur.z * u.y * v.y;
        // The least width of the stroke: the lesser eigenvalue, with the variance of the line.
        let total = uu + seen * seen / 12.0;
        let gap = sqrt(0.25 * (total - vv) * (total - vv) + uv * uv);
        let minor = sqrt(max(0.5 * (total + vv) - gap, PIXEL_VARIANCE));
        // The level at which its standard deviation is 0.75 to 1.5 pixels.
        let coarsest = max(u32(aurora.strokes.y), 1u) - 1u;
        var level = min(u32(max(log2(2.0 * minor / NARROW), 0.0)), coarsest);
        let clip = clip_position(c);
        let high_clip = clip_position(high.xyz);
        let low_clip = clip_position(low.xyz);
        let middle = 0.5 * (high_clip.xy / high_clip.w + low_clip.xy / low_clip.w);
        let depth = clip.z / clip.w;
        let pixel = (vec2<f32>(0.5, -0.5) * middle + 0.5) * frame.size.xy;
        var shape = shape_of(level, u, seen, vec3<f32>(uu, vv, uv));
        var around = box_of(pixel, shape, level);
        if any(around.zw < vec2<f32>(0.0)) | any(around.xy > frame.size.xy) {
            continue;
        }
        if level > 0u {
            let range = depths_in(around);
            // Behind all that is there (depth is reversed); and what an outline crosses is tested pixel by pixel.
            if depth < range.x {
                continue;
            }
            if depth < range.y {
                level = 0u;
                shape = shape_of(level, u, seen, vec3<f32>(uu, vv, uv));
                around = box_of(pixel, shape, level);
            }
        }
        // kR: photons per area across the line of sight, and √det J Jᵀ is pixels per km². (2.5066 is √2π.)
        let area = length(cross(x, y));
        let waited = mix(a.along.w, b.along.w, s);
        let prompt = mix(a.across.w, b.across.w, s);
        let photons = (made - made_before) * (left * collisions) * vec4<f32>(waited, prompt, waited, prompt);
        let full = photons * (area / (FILLED * shape.stretch * 2.5066283 * shape.sigma));
        let light = full * min(1.0, BRIGHTEST / max(max(full.x, full.y), max(full.z, full.w)));
        if !(light.x + light.y + light.z + light.w > FAINTEST) {
            continue;
        }
        let room = room_of(id.y, &level);
        if room == 0xffffffffu {
            return;
        }
        light_up(id.y, around, frame.size.xy, level == 0u);
        let half = shape.half * 2.0 / frame.size.xy;
        let side = shape.side * 2.0 / frame.size.xy;
        let halves = array<u32, 2>(pack2x16float(light.xy), pack2x16float(light.zw));
        strokes[room / CORNERS] = Stroke(array(middle.x, middle.y), array(half.x, half.y), array(side.x, side.y), depth, shape.stretch / (2.0 * shape.blurred), halves);
    }
}
