// Third pass of the aurora: the walk on the screen. One thread per streak and image order steps through parts of its light. Between the
// ends of a chord the apparent position is linear in height, so a step is a few products and one reciprocal. (Sekiguchi et al. step
// linearly on the screen itself, which is right from the side and wrong from below; AURORA_LINEAR does so.)

#import lensrunner::aurora::capacities::{allocate_stroke, light_up}
#import lensrunner::aurora::streaks::{
    aurora, AURORA_LINEAR, chord_at, chord_height, chord_room, chords, chords_of, fall_at, height_of, height_range, is_chord, photons_of,
    ranges, segments, Streak, streak_of, strokes,
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
/// The least size of the depth tiles, whose least and greatest depths are known: 8 pixels, 16, and so on, a level of `ranges` each. As in
/// src/render/aurora/levels.rs.
const LEAST_DEPTH_TILE: u32 = 8u;

/// The least and the greatest depth of what is drawn in a box of pixels (left, top, right, bottom) on the screen, at least.
fn depths_in(pixels: vec4<f32>) -> vec2<f32> {
    let inside = vec4<u32>(clamp(pixels, vec4<f32>(0.0), frame.size.xyxy - 1.0));
    let side = max(inside.z - inside.x, inside.w - inside.y);
    // Tiles as wide as the box, as far as there are: it touches two of them a side.
    let size = min(firstLeadingBit(max(side, LEAST_DEPTH_TILE) / LEAST_DEPTH_TILE) + 1u, textureNumLevels(ranges) - 1u);
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
        let reach = reach_km * max(length(end.along), length(end.across));
        let clip = clip_position(end.apparent);
        // Distances from the four planes through the camera and the screen's edges, at least.
        let over = vec4<f32>(clip.xy, -clip.xy) - clip.w - reach * (frame.focal.xyxy + 1.0);
        beyond &= over > vec4<f32>(0.0);
        near |= !(clip.w > 2.0 * reach + frame.near);
        let w = max(clip.w - reach, 1e-9);
        let pixel = (vec2<f32>(0.5, -0.5) * clip.xy / clip.w + 0.5) * frame.size;
        let pixels = reach * (frame.focal + 1.0) / w * 0.5 * frame.size;
        around = vec4<f32>(min(around.xy, pixel - pixels), max(around.zw, pixel + pixels));
        nearest = max(nearest, frame.near / w);
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
    let c = select(b.apparent, a.apparent, a.apparent.z < -frame.near);
    let fallen = length(screen_step(c, (b.apparent - a.apparent) / per_chord, focal));
    let along = screen_step(c, a.along, focal);
    let across = screen_step(c, a.across, focal);
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
    let a = chords[first + chord];
    let b = chords[first + chord + 1u];
    return vec4<f32>(mix(a.apparent, b.apparent, s), select(0.0, 1.0, is_chord(a.seen, b.seen)));
}

/// Covariances of the blur of a stroke on the screen, in pixels².
struct Blur {
    along: f32,
    across: f32,
    both: f32,
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

/// The layout of a stroke of a length along the unit vector `u`, in a level, with the blur that it shall have on the screen.
fn shape_of(level: u32, u: vec2<f32>, seen: f32, blur: Blur) -> Shape {
    // Enlarging widens it, so it is added narrower by that.
    let widening = 0.25 * (f32(1u << (2u * level)) - 1.0);
    let narrower = max(vec2<f32>(blur.along, blur.across) - widening, vec2<f32>(0.5 * PIXEL_VARIANCE));
    var shape: Shape;
    shape.sigma = sqrt(narrower.y);
    shape.blurred = END * sqrt(max(narrower.x - blur.both * blur.both / narrower.y, 0.1 * narrower.x));
    shape.stretch = max(seen, SHORTEST * shape.blurred);
    shape.half = u * (0.5 * shape.stretch + shape.blurred);
    shape.side = (vec2<f32>(-u.y, u.x) + u * (blur.both / narrower.y)) * SIGMAS * shape.sigma;
    return shape;
}

/// The pixels (left, top, right, bottom) that a stroke with its middle at `pixel` lights: two pixels of its level further, where that is
/// enlarged.
fn box_of(pixel: vec2<f32>, shape: Shape, level: u32) -> vec4<f32> {
    let reach = abs(shape.half) + abs(shape.side) + select(1.0, 2.0 * f32(1u << level), level > 0u);
    return vec4<f32>(pixel - reach, pixel + reach);
}

/// Parts of a streak's light that are drawn as one stroke: an evenly bright line with the mean and the variance of them all.
struct Joined {
    /// The number of the first part after them, and the height where it begins.
    next: u32,
    lower: f32,
    /// Height of the middle, and half the length, km.
    height: f32,
    half_km: f32,
}

/// Joins the parts from `k` of `count` on, which begin at the height `start`, as long as they extend over less than `most_km`.
fn join(streak: Streak, fall: f32, k: u32, count: u32, start: f32, most_km: f32) -> Joined {
    var joined: Joined;
    joined.next = k;
    joined.lower = start;
    // Moments of the joined parts: light, light times height from here, light times its square.
    var sums = vec3<f32>(0.0);
    loop {
        let passed = light_above(joined.next, count, streak.phase);
        joined.next++;
        let below = light_above(joined.next, count, streak.phase);
        let lower = height_of(fall, streak.kind, below);
        let middle = 0.5 * (joined.lower + lower) - start;
        let extent = joined.lower - lower;
        sums += (below - passed) * vec3<f32>(1.0, middle, middle * middle + extent * extent / 12.0);
        joined.lower = lower;
        let further = light_above(joined.next + 1u, count, streak.phase);
        if !(start - height_of(fall, streak.kind, further) < most_km) | (joined.next >= count) {
            break;
        }
    }
    let mean = sums.y / sums.x;
    joined.height = start + mean;
    joined.half_km = sqrt(3.0 * max(sums.z / sums.x - mean * mean, 0.0));
    return joined;
}

/// The ends of a stroke, apparent positions, homogeneous; and the share of it that is left, 0 if nothing is seen of it.
struct Line {
    high: vec4<f32>,
    low: vec4<f32>,
    left: f32,
}

/// The stroke of joined parts between its ends. What is behind the camera or much nearer than the rest is cut off.
fn line_of(streak: Streak, joined: Joined, first: u32, count: u32, is_linear: bool) -> Line {
    var line: Line;
    line.high = apparent_at(streak.kind, joined.height + joined.half_km, first, count);
    line.low = apparent_at(streak.kind, joined.height - joined.half_km, first, count);
    // A long part may go over several chords.
    let above = chords[first + chord_at(streak.kind, joined.height + joined.half_km, count)].seen;
    let below = chords[first + chord_at(streak.kind, joined.height - joined.half_km, count) + 1u].seen;
    if line.high.w * line.low.w == 0.0 || !is_chord(above, below) {
        return line;
    }
    // Linear on the screen between top and foot, if the way of Sekiguchi et al. is asked for.
    let range = height_range(streak.kind);
    let top = chords[first].apparent;
    let foot = chords[first + count].apparent;
    let t = (range.x - joined.height - vec2<f32>(joined.half_km, -joined.half_km)) / (range.x - range.y);
    let screen = vec4<f32>(mix(top.xy / -top.z, foot.xy / -foot.z, t.x), mix(top.xy / -top.z, foot.xy / -foot.z, t.y));
    line.high = vec4<f32>(select(line.high.xy, screen.xy * -line.high.z, is_linear), line.high.zw);
    line.low = vec4<f32>(select(line.low.xy, screen.zw * -line.low.z, is_linear), line.low.zw);
    let least = max(frame.near, NEAREST * max(-line.high.z, -line.low.z));
    if max(-line.high.z, -line.low.z) <= least {
        return line;
    }
    // Homogeneous coordinates are linear between the ends, and so is the light that is left.
    line.left = 1.0;
    if -line.high.z < least {
        let t = (-least - line.high.z) / (line.low.z - line.high.z);
        line.high = mix(line.high, line.low, t);
        line.left = 1.0 - t;
    }
    if -line.low.z < least {
        let t = (-least - line.high.z) / (line.low.z - line.high.z);
        line.low = mix(line.high, line.low, t);
        line.left *= t;
    }
    return line;
}

/// How a stroke lies on the screen, in pixels.
struct Seen {
    /// Its direction, a unit vector, and its length.
    direction: vec2<f32>,
    length: f32,
    blur: Blur,
    /// √det J Jᵀ of the derivative of the projection, J: pixels per km².
    area: f32,
    /// Light of the chord there, as a share: what waited, and what was prompt.
    waited: f32,
    prompt: f32,
}

/// The same of a stroke at the height of the joined parts.
fn seen_of(streak: Streak, joined: Joined, line: Line, first: u32, count: u32, focal: vec2<f32>) -> Seen {
    let chord = chord_at(streak.kind, joined.height, count);
    let above = chord_height(streak.kind, chord, count);
    let per_chord = above - chord_height(streak.kind, chord + 1u, count);
    let a = chords[first + chord];
    let b = chords[first + chord + 1u];
    let c = 0.5 * (line.high.xyz + line.low.xyz);
    let s = clamp((above - joined.height) / per_chord, 0.0, 1.0);
    let along = screen_step(c, mix(a.along, b.along, s), focal);
    let across = screen_step(c, mix(a.across, b.across, s), focal);
    let fallen = screen_step(c, (b.apparent - a.apparent) / per_chord, focal);
    // The blur of a point of it, seen through J: J diag(σ²) Jᵀ.
    let variance = vec3<f32>(streak.spread, aurora.point * aurora.point);
    let x = vec3<f32>(along.x, across.x, fallen.x);
    let y = vec3<f32>(along.y, across.y, fallen.y);
    let blur = vec3<f32>(dot(variance, x * x), dot(variance, x * y), dot(variance, y * y)) + vec3<f32>(PIXEL_VARIANCE, 0.0, PIXEL_VARIANCE);
    // The same along the stroke on the screen and to the left of it.
    let ends = focal * (line.low.xy / -line.low.z - line.high.xy / -line.high.z);
    var seen: Seen;
    seen.length = length(ends);
    seen.direction = vec2<f32>(1.0, 0.0);
    if seen.length > 1e-3 {
        seen.direction = ends / seen.length;
    }
    let u = seen.direction;
    let v = vec2<f32>(-u.y, u.x);
    let uu = blur.x * u.x * u.x + 2.0 * blur.y * u.x * u.y + blur.z * u.y * u.y;
    let vv = blur.x * v.x * v.x + 2.0 * blur.y * v.x * v.y + blur.z * v.y * v.y;
    let uv = blur.x * u.x * v.x + blur.y * (u.x * v.y + u.y * v.x) + blur.z * u.y * v.y;
    seen.blur = Blur(uu, vv, uv);
    seen.area = length(cross(x, y));
    seen.waited = mix(a.waited, b.waited, s);
    seen.prompt = mix(a.prompt, b.prompt, s);
    return seen;
}

/// The level to which a stroke goes: that at which its standard deviation is 0.75 to 1.5 pixels.
fn level_of(seen: Seen) -> u32 {
    // The least width of the stroke: the lesser eigenvalue, with the variance of the line.
    let total = seen.blur.along + seen.length * seen.length / 12.0;
    let vv = seen.blur.across;
    let gap = sqrt(0.25 * (total - vv) * (total - vv) + seen.blur.both * seen.blur.both);
    let minor = sqrt(max(0.5 * (total + vv) - gap, PIXEL_VARIANCE));
    let coarsest = max(aurora.levels, 1u) - 1u;
    return min(u32(max(log2(2.0 * minor / NARROW), 0.0)), coarsest);
}

/// Draws a stroke of an image order with this light, in photons by line. False if there is no room for it.
fn draw_stroke(order: u32, line: Line, seen: Seen, photons: vec4<f32>) -> bool {
    let c = 0.5 * (line.high.xyz + line.low.xyz);
    var level = level_of(seen);
    let clip = clip_position(c);
    let high_clip = clip_position(line.high.xyz);
    let low_clip = clip_position(line.low.xyz);
    let middle = 0.5 * (high_clip.xy / high_clip.w + low_clip.xy / low_clip.w);
    let depth = clip.z / clip.w;
    let pixel = (vec2<f32>(0.5, -0.5) * middle + 0.5) * frame.size;
    var shape = shape_of(level, seen.direction, seen.length, seen.blur);
    var around = box_of(pixel, shape, level);
    if any(around.zw < vec2<f32>(0.0)) | any(around.xy > frame.size) {
        return true;
    }
    if level > 0u {
        let range = depths_in(around);
        // Behind all that is there (depth is reversed); and what an outline crosses is tested pixel by pixel.
        if depth < range.x {
            return true;
        }
        if depth < range.y {
            level = 0u;
            shape = shape_of(level, seen.direction, seen.length, seen.blur);
            around = box_of(pixel, shape, level);
        }
    }
    // kR: photons per area across the line of sight. (2.5066 is √2π.)
    let full = photons * (seen.area / (FILLED * shape.stretch * 2.5066283 * shape.sigma));
    let light = full * min(1.0, BRIGHTEST / max(max(full.x, full.y), max(full.z, full.w)));
    if !(light.x + light.y + light.z + light.w > FAINTEST) {
        return true;
    }
    let slot = allocate_stroke(order, &level);
    if slot == 0xffffffffu {
        return false;
    }
    light_up(order, around, frame.size, level == 0u);
    let half = shape.half * 2.0 / frame.size;
    let side = shape.side * 2.0 / frame.size;
    strokes[slot / CORNERS] = Stroke(middle, half, side, depth, shape.stretch / (2.0 * shape.blurred), pack2x16float(light.xy),
        pack2x16float(light.zw));
    return true;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let index = id.x;
    if index >= aurora.streaks {
        return;
    }
    let streak = streak_of(index);
    let chord_count = chords_of(streak.kind);
    let first = (id.y * aurora.streaks + index) * chord_room();
    if unseen(streak.spread, first, chord_count) {
        return;
    }
    // How hard its electrons are, by the flux when those of its middle came down. In rays there are more of them, and harder ones.
    let fall = fall_at(chords[first + chord_count / 2u].waited);
    let count = min(aurora.parts, arrayLength(&strokes));
    // Collisions of 35 eV, in kR km².
    let collisions = streak.share * segments[streak.segment].collisions;
    let focal = frame.focal * 0.5 * frame.size;
    let top = chords[first];
    let foot = chords[first + chord_count];
    let is_linear = (aurora.flags & AURORA_LINEAR) != 0u;
    if is_linear & ((top.seen * foot.seen == 0.0) | (max(top.apparent.z, foot.apparent.z) > -frame.near)) {
        return;
    }
    var joined: Joined;
    joined.lower = top_of(streak, fall, count);
    var made = photons_of(fall, streak.kind, 0.0);
    // Parts of the light. Those close together on the screen, as seen along the streak, are one stroke.
    while joined.next < count {
        let start = joined.lower;
        // A width holds for its own chord.
        let end = chord_height(streak.kind, chord_at(streak.kind, start, chord_count) + 1u, chord_count);
        let most_km = min(MERGED * width_along(streak, start, first, chord_count, focal), start - end);
        joined = join(streak, fall, joined.next, count, start, most_km);
        let made_before = made;
        made = photons_of(fall, streak.kind, light_above(joined.next, count, streak.phase));
        let chord = chord_at(streak.kind, joined.height, chord_count);
        if !is_chord(chords[first + chord].seen, chords[first + chord + 1u].seen) {
            continue;
        }
        let line = line_of(streak, joined, first, chord_count, is_linear);
        if line.left <= 0.0 {
            continue;
        }
        let seen = seen_of(streak, joined, line, first, chord_count, focal);
        let photons = (made - made_before) * (line.left * collisions) * vec4<f32>(seen.waited, seen.prompt, seen.waited, seen.prompt);
        if !draw_stroke(id.y, line, seen, photons) {
            return;
        }
    }
}
