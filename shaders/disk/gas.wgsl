// The gas in a pixel: streaks from the pattern, light from the black-body texture.

@group(2) @binding(0) var<uniform> disk: DiskFrame;
@group(2) @binding(1) var<storage, read> disk_vertices: array<DiskVertex>;
@group(2) @binding(2) var pattern: texture_2d<f32>;
@group(2) @binding(3) var pattern_sampler: sampler;
@group(2) @binding(4) var black_body: texture_2d<f32>;
@group(2) @binding(5) var black_body_sampler: sampler;

struct Gas {
    @builtin(position) position: vec4<f32>,
    /// As DiskVertex has it.
    @location(0) gas: vec4<f32>,
    @location(1) look: vec4<f32>,
    @location(2) path: f32,
}

struct Streaks {
    young: vec2<f32>,
    old: vec2<f32>,
    shares: vec2<f32>,
    level: f32,
}

/// Where in the pattern a place is, in both generations that are seen there.
fn streaks_of(gas: vec4<f32>, path: f32) -> Streaks {
    // Pattern per pixel: shear moves it along but does not change the area a pixel covers.
    let dx = dpdx(gas.xy);
    let dy = dpdy(gas.xy);
    let size = vec2<f32>(textureDimensions(pattern));
    let area = abs(dx.x * dy.y - dx.y * dy.x) * size.x * size.y;
    let time = disk.renewal.x - path * disk.renewal.y;
    let number = floor(time);
    let grown = time - number;
    let index = u32(clamp(number, 1.0, 15.0));
    let age = grown * disk.renewal.z + disk.renewal.w;
    let rate = disk_rate(gas.y);
    let moved = gas.x - rate * age;
    var result: Streaks;
    result.young = vec2<f32>(moved, gas.y) + disk.offsets[index].xy;
    result.old = vec2<f32>(moved - rate * disk.renewal.z, gas.y) + disk.offsets[index - 1u].xy;
    result.shares = disk_shares(grown);
    result.level = 0.5 * log2(max(area, 1e-12));
    return result;
}

/// Light and opacity of the gas: premultiplied.
fn gas_light(gas: vec4<f32>, gain: f32, depth: f32, turbulence: f32) -> vec4<f32> {
    let ln_density = disk.gas.x * turbulence;
    let alpha = 1.0 - exp(-depth * exp(ln_density));
    let heat = gas.z + 0.25 * ln_density * disk.gas.y;
    let width = f32(textureDimensions(black_body).x);
    let light = textureSampleLevel(black_body, black_body_sampler, vec2<f32>((heat * (width - 1.0) + 0.5) / width, 0.5), 0.0).rgb;
    return vec4<f32>(light * (gain * alpha), alpha);
}
