// Bloom: the picture at a quarter of its size (at a half of it where it is enlarged twice or more), halved a few times, then mixed together
// again.

@group(2) @binding(0) var source: texture_2d<f32>;
@group(2) @binding(1) var linear_sampler: sampler;

struct Screen {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> Screen {
    let corner = vec2<f32>(f32((i << 1u) & 2u), f32(i & 2u));
    return Screen(vec4<f32>(corner * 2.0 - 1.0, 0.0, 1.0), vec2<f32>(corner.x, 1.0 - corner.y));
}

/// Four bilinear taps: the mean of 4 × 4 texels, which is a box for a quarter of the size and overlaps for a half. Sums of light that
/// halves cannot hold are infinite in the picture, and one such pixel would spread.
@fragment
fn down(in: Screen) -> @location(0) vec4<f32> {
    let d = 1.0 / vec2<f32>(textureDimensions(source));
    let mean = 0.25 * (textureSampleLevel(source, linear_sampler, in.uv + d * vec2<f32>(-1.0, -1.0), 0.0)
        + textureSampleLevel(source, linear_sampler, in.uv + d * vec2<f32>(1.0, -1.0), 0.0)
        + textureSampleLevel(source, linear_sampler, in.uv + d * vec2<f32>(-1.0, 1.0), 0.0)
        + textureSampleLevel(source, linear_sampler, in.uv + d * vec2<f32>(1.0, 1.0), 0.0));
    return clamp(mean, vec4<f32>(0.0), vec4<f32>(6e4));
}

/// The coarser level, smoothed; blending mixes it with the finer one. At the end the finest, smoothed as well.
@fragment
fn up(in: Screen) -> @location(0) vec4<f32> {
    let d = 0.5 / vec2<f32>(textureDimensions(source));
    let sum = textureSampleLevel(source, linear_sampler, in.uv + d * vec2<f32>(-1.0, -1.0), 0.0)
        + textureSampleLevel(source, linear_sampler, in.uv + d * vec2<f32>(1.0, -1.0), 0.0)
        + textureSampleLevel(source, linear_sampler, in.uv + d * vec2<f32>(-1.0, 1.0), 0.0)
        + textureSampleLevel(source, linear_sampler, in.uv + d * vec2<f32>(1.0, 1.0), 0.0);
    return vec4<f32>(0.25 * sum.rgb, 1.0);
}
