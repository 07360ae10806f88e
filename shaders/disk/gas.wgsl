#define_import_path lensrunner::disk::gas

#import lensrunner::disk::light::GasLight
#import lensrunner::disk::motion::{disk_rate, disk_shares}
#import lensrunner::disk::types::{disk, own_share}

/// The pattern with its finest octaves, in 8 bits, as (value + 4)/8. Each texel holds itself and its next neighbours to the right, below
/// and across, so that one fetch is enough for bilinear interpolation. It is fetched and not sampled: software drivers then compute no more
/// than the address.
@group(2) @binding(1) var far_pattern: texture_2d<f32>;
/// The pattern without its finest octaves, laid out in the same way.
@group(2) @binding(2) var near_pattern: texture_2d<f32>;

/// Side of the pattern in the texels in which sizes of pixels are given: every other column of the lattice of src/scene/disk/noise.rs, and
/// all of its rows.
const PATTERN_SIZE: f32 = 512.0;
/// Side of the finest level of the far pattern, in texels: a power of two, so that a position is wrapped by a mask.
const FAR_SIDE: u32 = 1024u;

/// What a pixel needs. Two generations of streaks are visible at a time, an even and an odd one, and each in turn is the younger. So both
/// vary smoothly over a triangle, except at the moment when one dies and the next but one is born, and then its share is 0. What is the
/// same for a whole frame is worked into the vertices: software drivers read a uniform lane by lane, in each pixel anew.
struct Gas {
    @builtin(position) position: vec4<f32>,
    /// Even generation: its position in the pattern, in turns and heights, without the motion of the orbits (x, y); its age in r_s/c (z);
    /// log₂ of the factor by which it cools the gas per unit of the pattern (w).
    @location(0) even: vec4<f32>,
    /// The odd generation.
    @location(1) odd: vec4<f32>,
    /// log₂ of the light of gas of mean density; w: its optical depth.
    @location(2) light: vec4<f32>,
    /// d ln light/d ln T; w: radius in the pattern in r_s; for arcs the height there.
    @location(3) slope: vec4<f32>,
    /// Distance from the middle of a thin image and its half width, both in pixels; light path; |cos| to the normal.
    @location(4) seen: vec4<f32>,
}

/// Least light of which the logarithm is taken. Streaks multiply light by up to 10¹⁰ where the gas is so cold that light is steep.
const LEAST_LIGHT: f32 = 1e-30;

/// The gas at a vertex seen at `position`, at `turns` and `height` in the pattern.
fn gas_at(position: vec4<f32>, turns: f32, height: f32, path: f32, depth: f32, light: GasLight, thin: vec2<f32>, cosine: f32) -> Gas {
    let time = disk.renewals - path * disk.renewals_per_time;
    let number = floor(time);
    let grown = time - number;
    // The light of a thin image already contains the mean of its streaks.
    let shares = disk_shares(grown) * (0.36067376 * disk.contrast * sqrt(own_share(thin.y)));
    let age = grown * disk.renewal + disk.newborn;
    let place = vec2<f32>(turns, 0.0) + disk.offset + number * disk.offset_step;
    let young = vec4<f32>(place, age, shares.x);
    let old = vec4<f32>(place - disk.offset_step, age + disk.renewal, shares.y);
    let is_even = fract(0.5 * number) < 0.25;
    return Gas(position, select(old, young, is_even), select(young, old, is_even),
        vec4<f32>(log2(max(light.rgb, vec3<f32>(LEAST_LIGHT))), depth),
        vec4<f32>(light.slope, exp2(4.0 * height)), vec4<f32>(thin, path, cosine));
}

/// A generation counts if its share is above this part of the other's: more than is left of one over a triangle in which it dies, 4 r_s of
/// light path long.
const LEAST_SHARE: f32 = 0.03;

/// The position of a pixel in the pattern, in both generations, and how much of the pattern it covers.
struct Streaks {
    even: vec2<f32>,
    odd: vec2<f32>,
    /// The pixel's longest side there, in both generations.
    even_side: vec2<f32>,
    odd_side: vec2<f32>,
    /// log₂ of the factor by which each generation, even and odd, cools the gas per unit of the pattern.
    shares: vec2<f32>,
    /// Square of the longest of these sides, in texels of the pattern itself.
    long: f32,
    /// Square of the side, in such texels, of the texel with which the pixel is looked up.
    square: f32,
}

/// Two sides of a pixel in the pattern.
struct Sides {
    a: vec2<f32>,
    b: vec2<f32>,
}

/// Position in the pattern of gas of a generation at a height in it.
fn place_in(generation: vec4<f32>, height: f32) -> vec2<f32> {
    return generation.xy + vec2<f32>(-disk_rate(height) * generation.z, height);
}

/// The streaks of a pixel at `height` in the pattern.
fn streaks_of(in: Gas, height: f32, most: f32) -> Streaks {
    return streaks_at(in, place_in(in.even, height), place_in(in.odd, height), most);
}

/// The streaks of a pixel at positions `even` and `odd` in the pattern. A texel is no shorter than the pixel's length over `most`.
fn streaks_at(in: Gas, even: vec2<f32>, odd: vec2<f32>, most: f32) -> Streaks {
    // Pixels outside the triangle may be anywhere, and their positions enter the differences. Differences are taken of each generation by
    // itself, since neighbouring pixels may choose differently.
    return streaks_over(in, even, odd, Sides(dpdx(even), dpdy(even)), Sides(dpdx(odd), dpdy(odd)), most);
}

/// The streaks at positions `even` and `odd` of the pattern, for a pixel that covers these sides of it. The square of the texel is half the
/// square of the pixel's width, as a texel shows more than itself, but at least that of its length over `most`. Shear and slant stretch
/// pixels in the pattern up to a hundred times as long as wide. A texel as long as the pixel would blur, and one as wide would show chance:
/// streaks seen edge on became dashes. So the pattern is looked up at several positions along the pixel.
fn streaks_over(in: Gas, even: vec2<f32>, odd: vec2<f32>, even_sides: Sides, odd_sides: Sides, most: f32) -> Streaks {
    let even_long = vec2<f32>(dot(even_sides.a, even_sides.a), dot(even_sides.b, even_sides.b));
    let odd_long = vec2<f32>(dot(odd_sides.a, odd_sides.a), dot(odd_sides.b, odd_sides.b));
    var result: Streaks;
    result.even = even;
    result.odd = odd;
    result.even_side = select(even_sides.a, even_sides.b, even_long.y > even_long.x);
    result.odd_side = select(odd_sides.a, odd_sides.b, odd_long.y > odd_long.x);
    result.shares = vec2<f32>(in.even.w, in.odd.w);
    // One size is used for both: that of the younger generation, if it counts. Across a triangle where one dies and the next but one is
    // born its position is meaningless.
    let shows = result.shares > LEAST_SHARE * result.shares.yx;
    let by_even = shows.x & (!shows.y | (in.even.z < in.odd.z));
    let squares = PATTERN_SIZE * PATTERN_SIZE * vec2<f32>(max(even_long.x, even_long.y), max(odd_long.x, odd_long.y));
    let long = select(squares.y, squares.x, by_even);
    let area = PATTERN_SIZE * PATTERN_SIZE * select(cross_of(odd_sides), cross_of(even_sides), by_even);
    result.long = max(squares.x, squares.y);
    result.square = max(0.5 * area * area / max(long, 1e-30), long / (most * most));
    return result;
}

fn cross_of(sides: Sides) -> f32 {
    return sides.a.x * sides.b.y - sides.a.y * sides.b.x;
}

/// The far pattern at a level, over 8.
fn far_value(place: vec2<f32>, level: u32) -> f32 {
    let side = FAR_SIDE >> level;
    let texel = place * f32(side) - 0.5;
    let whole = floor(texel);
    let t = texel - whole;
    // The first level is on the left, the others are below one another beside it.
    let corner = vec2<i32>(select(0, i32(FAR_SIDE), level > 0u), max(i32(FAR_SIDE) - i32(2u * side), 0));
    let v = textureLoad(far_pattern, (vec2<i32>(whole) & vec2<i32>(i32(side) - 1)) + corner, 0);
    let row = mix(v.xz, v.yw, vec2<f32>(t.x));
    return mix(row.x, row.y, t.y) - 0.5;
}

/// What streaks do to the gas in a pixel.
struct Cooling {
    /// log₂ of the factor by which they cool it.
    power: f32,
    /// Variance of ln T of what is finer than the pixel and therefore not seen.
    unseen: f32,
}

/// Variance of the part of the pattern that is finer than texels of a level: 1 for the pattern and 0.35² for its finest octaves, which are
/// the same eight times finer. A fit to the halvings of src/scene/disk/noise.rs, right to 0.08.
fn unseen_variance(level: f32) -> f32 {
    let t = clamp(0.125 * level, 0.0, 1.0);
    return 0.05 * clamp(1.0 + 0.33 * level, 0.0, 1.0) + 1.0725 * (t * t * (3.0 - 2.0 * t));
}

/// The level of the far pattern for a pixel: log₂ of its side in texels of the finest level, rounded, from the exponent of its square.
fn far_level(at: Streaks) -> u32 {
    return (bitcast<u32>(max(at.square, 0.25)) - (124u << 23u)) >> 24u;
}

/// Distance of positions along a pixel, in texels. A texel covers about as much, and streaks are smoother the longer they are.
const STEP: f32 = 3.0;

/// Number of positions along a pixel's longest side at which the far pattern is looked up, at most `most`.
fn taps_of(at: Streaks, most: u32) -> u32 {
    return u32(clamp(ceil(sqrt(at.long / (STEP * STEP * max(at.square, 0.25)))), 1.0, f32(most)));
}

/// log₂ of the factor by which streaks cool the gas, at the share `t` of the pixel's longest side from its middle.
fn power_along(at: Streaks, t: f32, level: u32) -> f32 {
    let even = far_value(at.even + t * at.even_side, level);
    let odd = far_value(at.odd + t * at.odd_side, level);
    return 8.0 * dot(at.shares, vec2<f32>(even, odd));
}

/// The variance of ln T for a variance of the pattern.
fn unseen_of(at: Streaks, variance: f32) -> f32 {
    return 0.48045301 * dot(at.shares, at.shares) * variance;
}

/// The streaks of both generations by the far pattern, at `taps` positions along a pixel (0: none). What is seen there has one colour, by
/// its mean and its variance, like what is not resolved.
fn far_along(at: Streaks, taps: u32) -> Cooling {
    let level = far_level(at);
    let share = 1.0 / f32(max(taps, 1u));
    var sum = 0.0;
    var squares = 0.0;
    for (var k = 0u; k < taps; k++) {
        let power = power_along(at, (f32(k) + 0.5) * share - 0.5, level);
        sum += power;
        squares += power * power;
    }
    let mean = sum * share;
    let unseen = unseen_of(at, unseen_variance(f32(level) - 1.0));
    return Cooling(mean, unseen + 0.48045301 * max(squares * share - mean * mean, 0.0));
}

/// The same at two positions, which is best from far: four cost a sixth more of the disk's time and leave five sixths of the error.
fn two_looks(at: Streaks) -> Cooling {
    let level = far_level(at);
    let a = power_along(at, -0.25, level);
    let b = power_along(at, 0.25, level);
    let unseen = unseen_of(at, unseen_variance(f32(level) - 1.0));
    return Cooling(0.5 * (a + b), unseen + 0.12011325 * (a - b) * (a - b));
}

/// Light, premultiplied, and opacity of gas that streaks cool. Its density is the fourth power of its temperature. With the temperature's
/// factor t light goes as exp(slope·(1 − 1/t)): Wien's law with the slope of Planck's. Light is steep in t, so unresolved streaks add light
/// in the mean: a factor of exp(½v(s² − s)/(1 + sv)) for a variance v of ln t; with the opacity a(t), s² − s + 2s·a'/a + a''/a takes the
/// place of s² − s.
fn gas_colour(light: vec3<f32>, slope: vec3<f32>, depth: f32, cooling: Cooling) -> vec4<f32> {
    return bent_colour(light, slope, depth, cooling, 0.0);
}

/// The same for light that is brighter by `brighter`, in log₂ over its slope.
fn bent_colour(light: vec3<f32>, slope: vec3<f32>, depth: f32, cooling: Cooling, brighter: f32) -> vec4<f32> {
    let cooler = exp2(-cooling.power);
    let square = cooler * cooler;
    let q = depth / (square * square);
    let passed = exp2(-1.44269504 * q);
    let alpha = 1.0 - passed;
    let steep = 4.0 * q * passed / max(alpha, 1e-6);
    let s = slope * cooler;
    let added = s * (s + (2.0 * steep - 1.0)) + steep * (4.0 - 4.0 * q);
    let mean = 0.72134752 * cooling.unseen * added / (1.0 + cooling.unseen * s);
    return vec4<f32>(exp2(light + slope * (1.44269504 * (1.0 - cooler) + brighter) + min(mean, vec3<f32>(8.0))) * alpha, alpha);
}
