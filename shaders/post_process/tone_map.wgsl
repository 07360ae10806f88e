// Tone mapping: exposure, bloom, tone curve. The target encodes sRGB.

#import lensrunner::gpu::types::Adaptation
#import lensrunner::post_process::tone_curve::display_light

@group(2) @binding(0) var picture: texture_2d<f32>;
@group(2) @binding(1) var linear_sampler: sampler;
@group(2) @binding(2) var bloom: texture_2d<f32>;
/// A copy of `adaptation`: of a storage buffer that may be written, a software driver reads every pixel's anew.
@group(2) @binding(3) var<uniform> adapted: Adaptation;

struct Screen {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> Screen {
    let corner = vec2<f32>(f32((i << 1u) & 2u), f32(i & 2u));
    return Screen(vec4<f32>(corner * 2.0 - 1.0, 0.0, 1.0), vec2<f32>(corner.x, 1.0 - corner.y));
}

@fragment
fn fragment(in: Screen) -> @location(0) vec4<f32> {
    let glow = textureSampleLevel(bloom, linear_sampler, in.uv, 0.0).rgb;
    let light = display_light(textureLoad(picture, vec2<i32>(in.position.xy), 0).rgb, glow, adapted.exposure) * adapted.steadied;
    // Half a step of 8-bit noise against banding in the dark.
    let noise = fract(52.9829189 * fract(dot(in.position.xy, vec2<f32>(0.06711056, 0.00583715)))) - 0.5;
    return vec4<f32>(max(light + noise / 1024.0, vec3<f32>(0.0)), 1.0);
}
