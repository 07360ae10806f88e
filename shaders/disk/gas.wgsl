// The gas in a pixel: streaks from the pattern, light from that of the vertices.

@group(2) @binding(0) var<uniform> disk: DiskFrame;
/// The pattern with its finest octaves in 8 bits, (value + 4)/8: each texel holds itself and its next neighbours to the right, below and across, so that one
/// fetch does for a bilinear sample. It is fetched and not sampled: software drivers then work out no more than the address.
@group(2) @binding(1) var far_pattern: texture_2d<f32>;
/// The pattern without its finest octaves, laid out in the same way.
@group(2) @binding(2) var near_pattern: texture_2d<f32>;

/// Texels of the pattern that sizes of pixels are told in: every other column of the lattice of src/scene/disk/noise.rs, and its rows, as many.
const PATTERN_SIZE: f32 = 512.0;
/// Texels of the finest level from far, on either side: a power of two, so that a place is brought back into the pattern by a mask.
const FAR_SIDE: u32 = 1024u;

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
    /// d ln light/d ln T; w: radius in the pattern in r_s; of arcs the height there.
    @location(3) slope: vec4<f32>,
    /// Distance from the middle of a thin image and its half width, both in pixels; light path; |cos| to the normal.
    @location(4) seen: vec4<f32>,
}

/// Least light whose logarithm is taken. Streaks multiply it by up to 10¹⁰ where the gas is so cold that light is steep.
const LEAST_LIGHT: f32 = 1e-30;

/// For a vertex that is seen at `position`: `turns` and `height` in the pattern, at a light path, of an optical depth.
fn gas_at(position: vec4<f32>, turns: f32, height: f32, path: f32, depth: f32, light: GasLight, thin: vec2<f32>, cosine: f32) -> Gas {
    let time = disk.renewal.x - path * disk.renewal.y;
    let number = floor(time);
    let grown = time - number;
    // The light of a thin image has its streaks' mean already.
    let shares = disk_shares(grown) * (0.36067376 * disk.gas.x * sqrt(own_share(thin.y)));
    let age = grown * disk.renewal.z + disk.renewal.w;
    let place = vec2<f32>(turns, 0.0) + disk.offset.xy + number * disk.offset.zw;
    let young = vec4<f32>(place, age, shares.x);
    let old = vec4<f32>(place - disk.offset.zw, age + disk.renewal.z, shares.y);
    let is_even = fract(0.5 * number) < 0.25;
    return Gas(position, select(old, young, is_even), select(young, old, is_even), vec4<f32>(log2(max(light.rgb, vec3<f32>(LEAST_LIGHT))), depth),
        vec4<f32>(light.slope, exp2(4.0 * height)), vec4<f32>(thin, path, cosine));
}

/// A generation shows from this part of the other's share on: more than is left of one over a triangle in which it dies, 4 r_s of light path long.
const LEAST_SHARE: f32 = 0.03;

/// Where in the pattern a pixel is, in both generations, and how much of it it covers.
struct Streaks {
    even: vec2<f32>,
    odd: vec2<f32>,
    /// The pixel's longest side there, in both generations.
    even_side: vec2<f32>,
    odd_side: vec2<f32>,
    /// By how much of a factor of two each cools the gas for each unit of the pattern: the even one and the odd one.
    shares: vec2<f32>,
    /// Square of the length of the longest of these sides, in texels of the pattern itself.
    long: f32,
    /// Square of the side of a texel, in such texels, that the pixel should be looked up with.
    square: f32,
}

/// Two sides of a pixel in the pattern.
struct Sides {
    a: vec2<f32>,
    b: vec2<f32>,
}

/// Where in the pattern gas of a generation is, `height` up in it.
fn place_in(generation: vec4<f32>, height: f32) -> vec2<f32> {
    return generation.xy + vec2<f32>(-disk_rate(height) * generation.z, height);
}

/// Of a pixel that is `height` up in the pattern.
fn streaks_of(in: Gas, height: f32, most: f32) -> Streaks {
    return streaks_at(in, place_in(in.even, height), place_in(in.odd, height), most);
}

/// Of a pixel of gas that is at `even` and `odd`. A texel is no shorter than its length over `most`.
fn streaks_at(in: Gas, even: vec2<f32>, odd: vec2<f32>, most: f32) -> Streaks {
    // Neighbours outside the triangle may be anywhere; their places are part of the differences. Differences of each by itself: neighbouring pixels may
    // choose differently.
    return streaks_over(in, even, odd, Sides(dpdx(even), dpdy(even)), Sides(dpdx(odd), dpdy(odd)), most);
}

/// Of what is at `even` and `odd` in the pattern and covers that much of it. The square of a pixel's texel is half the square of the pixel's width, as a texel
/// shows more than itself; of its length over `most` at least. Shear and a slant draw pixels out in the pattern up to a hundred times as long as wide: a texel as
/// long as the pixel is a blur, and one as wide a coincidence, which made dashes of streaks seen edge on. So it is looked up at several places along it.
fn streaks_over(in: Gas, even: vec2<f32>, odd: vec2<f32>, even_sides: Sides, odd_sides: Sides, most: f32) -> Streaks {
    let even_long = vec2<f32>(dot(even_sides.a, even_sides.a), dot(even_sides.b, even_sides.b));
    let odd_long = vec2<f32>(dot(odd_sides.a, odd_sides.a), dot(odd_sides.b, odd_sides.b));
    var result: Streaks;
    result.even = even;
    result.odd = odd;
    result.even_side = select(even_sides.a, even_sides.b, even_long.y > even_long.x);
    result.odd_side = select(odd_sides.a, odd_sides.b, odd_long.y > odd_long.x);
    result.shares = vec2<f32>(in.even.w, in.odd.w);
    // One size does for both: that of the younger, if it shows at all. Across a triangle where one dies and the next but one is born its place is nowhere.
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

/// The pattern from far, of a level, over 8.
fn far_value(place: vec2<f32>, level: u32) -> f32 {
    let side = FAR_SIDE >> level;
    let texel = place * f32(side) - 0.5;
    let whole = floor(texel);
    let t = texel - whole;
    // The first level is on the left, the others one below the other beside it.
    let corner = vec2<i32>(select(0, i32(FAR_SIDE), level > 0u), max(i32(FAR_SIDE) - i32(2u * side), 0));
    let v = textureLoad(far_pattern, (vec2<i32>(whole) & vec2<i32>(i32(side) - 1)) + corner, 0);
    let row = mix(v.xz, v.yw, vec2<f32>(t.x));
    return mix(row.x, row.y, t.y) - 0.5;
}

/// What streaks do to the gas in a pixel.
struct Cooling {
    /// The power of two by which they cool it.
    power: f32,
    /// The variance of ln T among what is finer than the pixel and so was not seen.
    unseen: f32,
}

/// The variance of what of the pattern is finer than texels of a level, so that it is not seen: 1 of the pattern and 0.35² of its finest octaves, the
/// same eight times finer. A fit to the halvings of src/scene/disk/noise.rs, good to 0.08.
fn unseen_variance(level: f32) -> f32 {
    let t = clamp(0.125 * level, 0.0, 1.0);
    return 0.05 * clamp(1.0 + 0.33 * level, 0.0, 1.0) + 1.0725 * (t * t * (3.0 - 2.0 * t));
}

/// The level of the pattern that a pixel takes from far: log₂ of its side in texels of the finest one, rounded, from the exponent of its square.
fn far_level(at: Streaks) -> u32 {
    return (bitcast<u32>(max(at.square, 0.25)) - (124u << 23u)) >> 24u;
}

/// Texels from one place along a pixel to the next. What a texel shows reaches about as far, and streaks are the smoother the longer they are.
const STEP: f32 = 3.0;

/// At how many places a pixel is looked up along its longest side, from far: at up to `most`.
fn taps_of(at: Streaks, most: u32) -> u32 {
    return u32(clamp(ceil(sqrt(at.long / (STEP * STEP * max(at.square, 0.25)))), 1.0, f32(most)));
}

/// The power of two by which the streaks cool the gas, `t` of the pixel's longest side on.
fn power_along(at: Streaks, t: f32, level: u32) -> f32 {
    let even = far_value(at.even + t * at.even_side, level);
    let odd = far_value(at.odd + t * at.odd_side, level);
    return 8.0 * dot(at.shares, vec2<f32>(even, odd));
}

/// The variance of ln T for that of the pattern, in units of log₂ in the shares.
fn unseen_of(at: Streaks, variance: f32) -> f32 {
    return 0.48045301 * dot(at.shares, at.shares) * variance;
}

/// The streaks of both generations from far, at `taps` places along a pixel (of none: nothing): what is seen there has one colour, by its mean and its variance, as what is not
/// seen at all.
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

/// The same at two places, as many as pay from far: four take a sixth more of the time of the disk and leave five sixths of the error.
fn two_looks(at: Streaks) -> Cooling {
    let level = far_level(at);
    let a = power_along(at, -0.25, level);
    let b = power_along(at, 0.25, level);
    let unseen = unseen_of(at, unseen_variance(f32(level) - 1.0));
    return Cooling(0.5 * (a + b), unseen + 0.12011325 * (a - b) * (a - b));
}

/// Light and opacity of gas that streaks cool: premultiplied. Its density is the fourth power of its temperature, and light goes as
/// exp(slope·(1 − 1/t)) over the temperature's factor t: Wien's law, with the slope of Planck's. Light is steep in t, so what streaks too fine to be
/// seen add in the mean counts: exp(½v(s² − s)/(1 + sv)) for a variance v of ln t, and with the opacity, a(t), s² − s + 2s·a'/a + a''/a.
fn gas_colour(light: vec3<f32>, slope: vec3<f32>, depth: f32, cooling: Cooling) -> vec4<f32> {
    return bent_colour(light, slope, depth, cooling, 0.0);
}

/// The same where the light is brighter, by that much in log₂ over its slope.
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
