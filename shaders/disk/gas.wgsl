// The gas in a pixel: streaks from the pattern, light from that of the vertices.

@group(2) @binding(0) var<uniform> disk: DiskFrame;
/// The pattern in 8 bits, (value + 3)/6: each texel holds itself and its next neighbours to the right, below and across, so that one
/// fetch does for a bilinear sample.
@group(2) @binding(1) var far_pattern: texture_2d<f32>;
@group(2) @binding(2) var far_sampler: sampler;
/// The pattern itself.
@group(2) @binding(3) var near_pattern: texture_2d<f32>;
@group(2) @binding(4) var near_sampler: sampler;

/// Texels of the pattern, as src/scene/disk/noise.rs has it.
const PATTERN_SIZE: vec2<f32> = vec2<f32>(512.0, 512.0);

/// What a pixel needs to know. Two generations of streaks are seen at a time, an even and an odd one; by turns each is the younger. So both go smoothly
/// over a triangle, but for the moment when one dies and the next but one is born, and then its share is nothing. All that is the same for a whole frame
/// is worked into the vertices: software drivers read a uniform lane by lane, in each pixel anew.
struct Gas {
    @builtin(position) position: vec4<f32>,
    /// Of the even generation: place in the pattern, in turns and heights, without what the orbits have done to it; its age in r_s/c; by how much of
    /// a factor of two it cools the gas for each unit of the pattern.
    @location(0) even: vec4<f32>,
    /// Of the odd one.
    @location(1) odd: vec4<f32>,
    /// log₂ of the light of gas of mean density; w: its optical depth.
    @location(2) light: vec4<f32>,
    /// d ln light/d ln T; w: radius in the pattern in r_s.
    @location(3) slope: vec4<f32>,
    /// Distance from the middle of a thin image and its half width, both in pixels; light path; |cos| to the normal.
    @location(4) seen: vec4<f32>,
}

/// For a vertex that is seen at `position`: `turns` and `height` in the pattern, at a light path, of an optical depth.
fn gas_at(position: vec4<f32>, turns: f32, height: f32, path: f32, depth: f32, light: GasLight, thin: vec2<f32>, cosine: f32) -> Gas {
    let time = disk.renewal.x - path * disk.renewal.y;
    let number = floor(time);
    let grown = time - number;
    let shares = disk_shares(grown) * (0.36067376 * disk.gas.x);
    let age = grown * disk.renewal.z + disk.renewal.w;
    let place = vec2<f32>(turns, 0.0) + disk.offset.xy + number * disk.offset.zw;
    let young = vec4<f32>(place, age, shares.x);
    let old = vec4<f32>(place - disk.offset.zw, age + disk.renewal.z, shares.y);
    let is_even = fract(0.5 * number) < 0.25;
    return Gas(position, select(old, young, is_even), select(young, old, is_even), vec4<f32>(log2(max(light.rgb, vec3<f32>(1e-9))), depth),
        vec4<f32>(light.slope, exp2(4.0 * height)), vec4<f32>(thin, path, cosine));
}

/// A generation shows from this part of the other's share on: more than is left of one over a triangle in which it dies.
const LEAST_SHARE: f32 = 0.003;

struct Streaks {
    even: vec2<f32>,
    odd: vec2<f32>,
    /// Square of the side of a texel, in texels of the pattern itself, that the pixel should be looked up with.
    square: f32,
}

/// A pixel may be this much longer than wide in the pattern before the level follows its length: more of it would alias (streaks of a disk that is
/// seen edge on became dashes), less would blur what is seen well.
const LONGEST: f32 = 4.0;

/// The square of the side of a texel for a pixel at `place` in the pattern, in texels.
fn square_of(place: vec2<f32>, share: f32) -> f32 {
    let a = dpdx(place);
    let b = dpdy(place);
    return max(abs(a.x * b.y - a.y * b.x), max(dot(a, a), dot(b, b)) * share);
}

/// Where in the pattern a pixel is, in both generations, and how much of it it covers. `share` is the part of the square of the pixel's longest side that
/// counts: a thin image shows the mean of all it holds.
fn streaks_of(in: Gas, share: f32) -> Streaks {
    let height = 0.25 * log2(in.slope.w);
    let rate = disk_rate(height);
    var result: Streaks;
    result.even = in.even.xy + vec2<f32>(-rate * in.even.z, height);
    result.odd = in.odd.xy + vec2<f32>(-rate * in.odd.z, height);
    // One size does for both: that of the younger, if it shows at all. Across a triangle where one dies and the next but one is born its place is nowhere.
    let even_shows = in.even.w > LEAST_SHARE * in.odd.w;
    let odd_shows = in.odd.w > LEAST_SHARE * in.even.w;
    // Differences of each by itself: neighbouring pixels may choose differently.
    let even = square_of(result.even * PATTERN_SIZE, share);
    let odd = square_of(result.odd * PATTERN_SIZE, share);
    result.square = select(odd, even, even_shows & (!odd_shows | (in.even.z < in.odd.z)));
    return result;
}

/// The pattern from far, of a level, less 1/2 and over 6.
fn far_value(place: vec2<f32>, level: u32) -> f32 {
    let size = PATTERN_SIZE * bitcast<f32>((127u - level) << 23u);
    let texel = place * size - 0.5;
    let whole = floor(texel);
    let t = texel - whole;
    let v = textureSampleLevel(far_pattern, far_sampler, (whole + 0.5) / PATTERN_SIZE * bitcast<f32>((127u + level) << 23u), f32(level));
    let row = mix(v.xz, v.yw, vec2<f32>(t.x));
    return mix(row.x, row.y, t.y) - 0.5;
}

/// By which power of two the streaks of both generations cool the gas, from far: the finest octaves are smaller than a pixel.
fn far_cooling(in: Gas, share: f32) -> f32 {
    let at = streaks_of(in, share);
    // log₂ of the side, rounded, from the exponent of its square.
    let level = (bitcast<u32>(max(at.square, 1.0)) - (126u << 23u)) >> 24u;
    return 6.0 * (in.even.w * far_value(at.even, level) + in.odd.w * far_value(at.odd, level));
}

/// Light and opacity of gas that streaks cool by 2^−cooling: premultiplied. Its density is the fourth power of its temperature, and light goes as
/// exp(slope·(1 − 1/t)) over the temperature's factor t: Wien's law, with the slope of Planck's.
fn gas_colour(light: vec3<f32>, slope: vec3<f32>, depth: f32, cooling: f32) -> vec4<f32> {
    let cooler = exp2(-cooling);
    let alpha = 1.0 - exp2(-1.44269504 * depth * exp2(4.0 * cooling));
    return vec4<f32>(exp2(light + slope * (1.44269504 * (1.0 - cooler))) * alpha, alpha);
}
