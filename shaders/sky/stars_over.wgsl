// Stars laid over a finished picture that was drawn smaller and enlarged: as wide and as bright as in a picture of the output's own size,
// and dimmed by what covers the sky there.

#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::{Adaptation, SeenStar}
#import lensrunner::post_process::tone_curve::display_light
#import lensrunner::sky::star_spot::{spot_corner, spot_share}

@group(1) @binding(0) var<storage, read> seen_stars: array<SeenStar>;
/// The picture as it was drawn, in linear light; its alpha is how much of the sky is covered.
@group(2) @binding(0) var picture: texture_2d<f32>;
/// As in tone_map.wgsl.
@group(2) @binding(1) var<uniform> adapted: Adaptation;

struct Spot {
    @builtin(position) position: vec4<f32>,
    @location(0) place: vec2<f32>,
    @location(1) @interpolate(flat) colour: vec3<f32>,
}

/// How much of the sky is covered at a place of the screen (normalised device coordinates), between texels.
fn covered_at(ndc: vec2<f32>) -> f32 {
    let size = vec2<f32>(textureDimensions(picture));
    let place = (ndc * vec2<f32>(0.5, -0.5) + 0.5) * size - 0.5;
    let first = vec2<i32>(floor(place));
    let share = place - floor(place);
    let last = vec2<i32>(size) - 1;
    let a = textureLoad(picture, clamp(first, vec2<i32>(0), last), 0).a;
    let b = textureLoad(picture, clamp(first + vec2<i32>(1, 0), vec2<i32>(0), last), 0).a;
    let c = textureLoad(picture, clamp(first + vec2<i32>(0, 1), vec2<i32>(0), last), 0).a;
    let d = textureLoad(picture, clamp(first + vec2<i32>(1, 1), vec2<i32>(0), last), 0).a;
    return clamp(mix(mix(a, b, share.x), mix(c, d, share.x), share.y), 0.0, 1.0);
}

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> Spot {
    let star = seen_stars[i / 3u];
    let free = 1.0 - covered_at(star.place);
    // Where nothing is free, of no size.
    let corner = spot_corner(i % 3u) * select(0.0, abs(star.radius), free > 0.0);
    return Spot(vec4<f32>(star.place + corner * 2.0 / (frame.size * frame.enlargement), 0.0, 1.0), corner, star.colour * free);
}

/// The light of a star, and how much of what is there it takes the place of: no sum is brighter than white, nor than what white is dimmed
/// to where flashes are reduced.
@fragment
fn fragment(in: Spot) -> @location(0) vec4<f32> {
    let light = display_light(in.colour * spot_share(in.place, frame.star_sigma), vec3<f32>(0.0), adapted.exposure);
    return vec4<f32>(light * adapted.steadied, max(light.r, max(light.g, light.b)));
}
