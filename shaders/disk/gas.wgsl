// The gas in a pixel: streaks from the pattern, light from that of the vertices.

@group(2) @binding(0) var<uniform> disk: DiskFrame;
/// The pattern in 8 bits, (value + 3)/6, which is enough from far and fast.
@group(2) @binding(1) var far_pattern: texture_2d<f32>;
@group(2) @binding(2) var far_sampler: sampler;
/// The pattern itself.
@group(2) @binding(3) var near_pattern: texture_2d<f32>;
@group(2) @binding(4) var near_sampler: sampler;

struct Gas {
    @builtin(position) position: vec4<f32>,
    /// Azimuth in the pattern in turns, radius in the pattern in r_s, optical depth, |cos|.
    @location(0) gas: vec4<f32>,
    /// Light; w: light path.
    @location(1) light: vec4<f32>,
    @location(2) slope: vec3<f32>,
    @location(3) thin: vec2<f32>,
}

struct Streaks {
    young: vec2<f32>,
    old: vec2<f32>,
    shares: vec2<f32>,
    level: f32,
}

/// A pixel may be this much longer than wide in the pattern before the level follows its length: more of it would alias (streaks of a disk that is
/// seen edge on became dashes), less would blur what is seen well.
const LONGEST: f32 = 8.0;

/// The level for a pixel with these derivatives across and down, in texels, of which shear has drawn out a generation along the orbit by `shear` for
/// each texel of height. `share` is the part of the square of its longest side that counts.
fn streak_level(dx: vec2<f32>, dy: vec2<f32>, shear: f32, share: f32) -> f32 {
    let a = vec2<f32>(dx.x + shear * dx.y, dx.y);
    let b = vec2<f32>(dy.x + shear * dy.y, dy.y);
    // Shear does not change the area that a pixel covers.
    let area = abs(dx.x * dy.y - dx.y * dy.x);
    return 0.5 * log2(max(max(area, max(dot(a, a), dot(b, b)) * share), 1e-12));
}

/// Where in the pattern a place is, in both generations that are seen there. A thin image shows the mean of all it holds.
fn streaks_of(gas: vec4<f32>, path: f32, thin: bool) -> Streaks {
    let height = 0.25 * log2(gas.y);
    let place = vec2<f32>(gas.x, height);
    let size = vec2<f32>(textureDimensions(far_pattern));
    let dx = dpdx(place) * size;
    let dy = dpdy(place) * size;
    let time = disk.renewal.x - path * disk.renewal.y;
    let number = floor(time);
    let grown = time - number;
    let age = grown * disk.renewal.z + disk.renewal.w;
    let rate = disk_rate(height);
    let moved = gas.x - rate * age;
    var result: Streaks;
    result.young = vec2<f32>(moved, height) + disk.offset.xy + number * disk.offset.zw;
    result.old = result.young - vec2<f32>(rate * disk.renewal.z, 0.0) - disk.offset.zw;
    result.shares = disk_shares(grown);
    // d rate/d height is −6 ln 2 of the rate. One level does for both: that of the generation that shows more.
    let shear = 4.158883 * rate * size.x / size.y * (age + result.shares.y * disk.renewal.z);
    result.level = streak_level(dx, dy, shear, select(1.0 / (LONGEST * LONGEST), 1.0, thin));
    return result;
}

fn far_value(uv: vec2<f32>, level: f32) -> f32 {
    return 6.0 * textureSampleLevel(far_pattern, far_sampler, uv, level).x - 3.0;
}

/// The streaks of both generations, from far: the finest octaves are smaller than a pixel.
fn far_turbulence(gas: vec4<f32>, path: f32, thin: bool) -> f32 {
    let at = streaks_of(gas, path, thin);
    return at.shares.x * far_value(at.young, at.level) + at.shares.y * far_value(at.old, at.level);
}

/// Light and opacity of gas whose density is exp(deviation·turbulence) times the mean: premultiplied. Its temperature goes as the fourth root of
/// the density, and light as exp(slope·(1 − 1/t)) over the temperature's factor t: Wien's law, with the slope of Planck's.
fn gas_colour(light: vec3<f32>, slope: vec3<f32>, depth: f32, turbulence: f32) -> vec4<f32> {
    let cooler = exp2(-0.36067376 * disk.gas.x * turbulence);
    let twice = cooler * cooler;
    let alpha = 1.0 - exp2(-1.44269504 * depth / (twice * twice));
    return vec4<f32>(light * exp2(slope * (1.44269504 * (1.0 - cooler))) * alpha, alpha);
}
