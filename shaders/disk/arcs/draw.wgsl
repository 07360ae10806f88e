// The rasteriser's part of the disk of arcs. One draw per image order, the farthest first; each is laid over what is behind it.

#import lensrunner::disk::gas::{
    bent_colour, Cooling, far_along, Gas, gas_at, near_pattern, STEP, Streaks, streaks_of, taps_of, two_looks, unseen_of, unseen_variance,
}
#import lensrunner::disk::light::gas_light
#import lensrunner::disk::motion::disk_slant
#import lensrunner::disk::types::{coverage, disk}
#import lensrunner::geometry::clip::clip_position

/// `DiskVertex` from the vertex buffer.
struct SeenDisk {
    @location(0) apparent: vec3<f32>,
    @location(1) path: f32,
    @location(2) turns: f32,
    @location(3) pattern_height: f32,
    @location(4) ln_temperature: f32,
    @location(5) depth: f32,
    @location(6) ln_g: f32,
    @location(7) cosine: f32,
    @location(8) filled: f32,
    @location(9) from_middle: f32,
    @location(10) half_width: f32,
    @location(11) bend_height: f32,
    @location(12) bend_light: f32,
    @location(13) bend_depth: f32,
    @location(14) side: f32,
}

/// What a vertex of an arc hands on: Gas, with the height in the pattern in place of the radius and, in order 1, the share of the area that
/// has gas in place of the distance from the middle; and AcrossRing. It is repeated here because what one stage hands to the next may hold
/// no structures, and polygons do not need the rest.
struct ArcGas {
    @builtin(position) position: vec4<f32>,
    @location(0) even: vec4<f32>,
    @location(1) odd: vec4<f32>,
    @location(2) light: vec4<f32>,
    @location(3) slope: vec4<f32>,
    @location(4) seen: vec4<f32>,
    @location(5) across: f32,
    @location(6) @interpolate(flat) bend: vec3<f32>,
}

/// Position of a pixel in its ring.
struct AcrossRing {
    /// 0 on one of the ring's circles and 1 on the other.
    @location(5) across: f32,
    /// How far the ring's middle deviates from the straight line between its circles: height in the pattern, log₂ of light over its slope,
    /// optical depth over that of the line. An arc's triangles begin with a vertex of the inner circle, which has it.
    @location(6) @interpolate(flat) bend: vec3<f32>,
}

@vertex
fn vertex(seen: SeenDisk) -> ArcGas {
    let light = gas_light(seen.ln_temperature - seen.ln_g, seen.ln_g);
    let thin = vec2<f32>(select(seen.from_middle, seen.filled, seen.half_width > WIDE), seen.half_width);
    let gas = gas_at(clip_position(seen.apparent), seen.turns, seen.pattern_height, seen.path, seen.depth, light, thin, seen.cosine);
    let bend = vec3<f32>(seen.bend_height, seen.bend_light * 1.44269504, seen.bend_depth);
    return ArcGas(gas.position, gas.even, gas.odd, gas.light, vec4<f32>(gas.slope.xyz, seen.pattern_height), gas.seen, seen.side, bend);
}

/// The gas of a ring at a pixel.
struct OfRing {
    /// Height in the pattern.
    height: f32,
    /// log₂ of its light beyond that of the vertices, over its slope.
    brighter: f32,
    /// Optical depth along the ray; from near, straight through.
    depth: f32,
}

/// The gas between a ring's two circles: parabolas that are right on both circles and in the middle.
fn of_ring(in: Gas, ring: AcrossRing) -> OfRing {
    // A sliver that hardly touches a pixel may have any value at its centre.
    let t = saturate(ring.across);
    let bent = 4.0 * (t - t * t) * ring.bend;
    return OfRing(max(in.slope.w + bent.x, 0.0), bent.y, max(in.light.w * (1.0 + bent.z), 0.0));
}

/// Order 1 from far: the slant is in the vertices. Where gaps are closed gas has a share of the area.
@fragment
fn far_fragment(in: Gas, ring: AcrossRing) -> @location(0) vec4<f32> {
    return far_colour(in, ring) * in.seen.x;
}

/// Orders 2 and 3, from far.
@fragment
fn thin_fragment(in: Gas, ring: AcrossRing) -> @location(0) vec4<f32> {
    return far_colour(in, ring) * (coverage(in.seen.x, in.seen.y) * disk.filled);
}

/// The turning by the orbits is not linear over a triangle: each pixel computes it.
fn far_colour(in: Gas, ring: AcrossRing) -> vec4<f32> {
    let here = of_ring(in, ring);
    return bent_colour(in.light.rgb, in.slope.xyz, here.depth, two_looks(streaks_of(in, here.height, 2.0 * STEP)), here.brighter);
}

/// Columns and rows of the finest level of the near pattern: powers of two, so that a position is wrapped by a mask.
const NEAR_SIZE: vec2<i32> = vec2<i32>(1024, 512);
/// Its coarsest level, of two columns and one row.
const NEAR_LEVELS: f32 = 9.0;

/// The near pattern, which lacks its finest octaves, smooth: between texels by weights 3t² − 2t³. The finest octaves are the same pattern,
/// eight times finer.
fn close_pattern(place: vec2<f32>, level: f32) -> f32 {
    let which = u32(clamp(level + 0.5, 0.0, NEAR_LEVELS));
    let size = NEAR_SIZE >> vec2<u32>(which);
    let texel = place * vec2<f32>(size) - 0.5;
    let whole = floor(texel);
    let straight = texel - whole;
    // A texel smaller than a pixel is interpolated linearly.
    let t = select(straight, straight * straight * (3.0 - 2.0 * straight), level < 0.0);
    // The first level is on the left, the others one below the other beside it.
    let corner = vec2<i32>(select(0, NEAR_SIZE.x, which > 0u), max(NEAR_SIZE.y - 2 * size.y, 0));
    let v = textureLoad(near_pattern, (vec2<i32>(whole) & (size - 1)) + corner, 0);
    let row = mix(v.xz, v.yw, vec2<f32>(t.x));
    return mix(row.x, row.y, t.y);
}

/// Most positions along a pixel from near: low over the plane pixels are longest.
const CLOSE_TAPS: u32 = 16u;
/// Lengths of a pixel, in texels of the pattern, between which the smooth pattern goes over to positions along the pixel in the far
/// pattern. In a longer pixel no grain is visible, and each position costs half as much.
const LONG: vec2<f32> = vec2<f32>(1.5, 3.0);

/// Distance of positions along a pixel at which the finest octaves are looked up smoothly, in texels of the pattern. Their cells are half a
/// texel by a quarter; one position in a longer pixel shows chance, which turned streaks into stairs and dashes.
const FINE_STEP: f32 = 0.5;
/// Most such positions.
const FINE_TAPS: f32 = 4.0;
/// Strength of the finest octaves over the others.
const FINE: f32 = 0.35;

/// The streaks of both generations by the smooth pattern: once, and the finest octaves at `taps` positions along a pixel. What differs
/// there has one colour, by its mean and its variance.
fn near_along(at: Streaks, taps: u32) -> Cooling {
    let level = 0.5 * log2(max(at.square, 1e-12));
    let share = 1.0 / f32(max(taps, 1u));
    var sum = 0.0;
    var squares = 0.0;
    for (var k = 0u; k < taps; k++) {
        let t = (f32(k) + 0.5) * share - 0.5;
        let even = close_pattern(8.0 * (at.even + t * at.even_side), level + 3.0);
        let odd = close_pattern(8.0 * (at.odd + t * at.odd_side), level + 3.0);
        let power = FINE * dot(at.shares, vec2<f32>(even, odd));
        sum += power;
        squares += power * power;
    }
    let mean = sum * share;
    let power = dot(at.shares, vec2<f32>(close_pattern(at.even, level), close_pattern(at.odd, level)));
    return Cooling(power + mean, unseen_of(at, unseen_variance(level)) + 0.48045301 * max(squares * share - mean * mean, 0.0));
}

/// Half width, in pixels, above which an image is of order 1.
const WIDE: f32 = 1e5;

/// From near: the slant is computed in each pixel; streaks by the smooth pattern.
@fragment
fn near_fragment(in: Gas, ring: AcrossRing) -> @location(0) vec4<f32> {
    let here = of_ring(in, ring);
    let most = min(disk.most_looks, f32(CLOSE_TAPS));
    let at = streaks_of(in, here.height, STEP * most);
    let long = sqrt(at.long);
    let share = smoothstep(LONG.x, LONG.y, long);
    // Positions that do not count are not looked up.
    let far = far_along(at, select(0u, taps_of(at, u32(most)), share > 0.0));
    let near = near_along(at, select(0u, u32(clamp(ceil(long / FINE_STEP), 1.0, min(FINE_TAPS, most))), share < 1.0));
    let cooling = Cooling(mix(near.power, far.power, share), mix(near.unseen, far.unseen, share));
    let depth = here.depth * disk_slant(in.seen.w, in.seen.z, near_half_height(here.height));
    let part = select(coverage(in.seen.x, in.seen.y) * disk.filled, in.seen.x, in.seen.y > WIDE);
    return bent_colour(in.light.rgb, in.slope.xyz, depth, cooling, here.brighter) * part;
}

/// For a close camera, the part of order 1 that is far: the slant is computed in each pixel, streaks as from far.
@fragment
fn beyond_fragment(in: Gas, ring: AcrossRing) -> @location(0) vec4<f32> {
    let here = of_ring(in, ring);
    let depth = here.depth * disk_slant(in.seen.w, in.seen.z, near_half_height(here.height));
    return bent_colour(in.light.rgb, in.slope.xyz, depth, two_looks(streaks_of(in, here.height, 2.0 * STEP)), here.brighter) * in.seen.x;
}

/// Half height of the disk at a height in the pattern: thickness times the radius there.
fn near_half_height(height: f32) -> f32 {
    return max(disk.thickness * exp2(4.0 * height), 1e-3);
}
