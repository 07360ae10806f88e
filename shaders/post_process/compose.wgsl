// Lays the sum of the thin triangles over the picture, once: their mean colour, as far as they cover the pixel.

#import lensrunner::post_process::coverage::{before_later, covered}

@group(2) @binding(0) var source: texture_2d<f32>;
@group(2) @binding(1) var signed_source: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32((i << 1u) & 2u), f32(i & 2u));
    return vec4<f32>(corner * 2.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let sum = textureLoad(source, vec2<i32>(position.xy), 0);
    if sum.a <= 0.0 {
        discard;
    }
    let coverages = textureLoad(signed_source, vec2<i32>(position.xy), 0).rg;
    let part = covered(sum.a, coverages.x);
    let weight = before_later(part, coverages.y);
    // Triangles that fold over are taken off again, which rounding may overdo.
    return vec4<f32>(max(sum.rgb, vec3<f32>(0.0)) * (weight / sum.a), weight);
}
