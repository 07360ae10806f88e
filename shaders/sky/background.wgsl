// The background: the Milky Way behind everything, filtered by the size of the lensed pixel. Cells come from cells.wgsl. The alpha of the
// picture is how much of the sky is covered: nothing yet.

#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::colour::shifted_colour
#import lensrunner::gpu::types::{FLAG_BEAMING, FLAG_DOPPLER, SkyCorner}
#import lensrunner::sky::direction::{PANORAMA_BRIGHT, PANORAMA_FAINT, panorama_level, panorama_light, sky_view}

@group(1) @binding(0) var<storage, read> corners: array<SkyCorner>;
/// The root of the brightness, in 8 bits as in its file.
@group(1) @binding(1) var milky_way: texture_2d<f32>;
@group(1) @binding(2) var milky_way_sampler: sampler;

struct Smooth {
    @builtin(position) position: vec4<f32>,
    /// Place on the panorama, and its level.
    @location(0) @interpolate(linear) place: vec3<f32>,
    /// The seen colours of the faintest and of the brightest parts.
    @location(1) @interpolate(linear) faint: vec3<f32>,
    @location(2) @interpolate(linear) bright: vec3<f32>,
}

@vertex
fn smooth_vertex(@builtin(vertex_index) i: u32) -> Smooth {
    let corner = corners[i];
    let level = panorama_level(corner.size, textureDimensions(milky_way).y);
    // At the far end of the reversed depth.
    return Smooth(vec4<f32>(corner.ndc_x, corner.ndc_y, 0.0, 1.0), vec3<f32>(corner.place, level), corner.faint,
        corner.bright);
}

@fragment
fn smooth_fragment(in: Smooth) -> @location(0) vec4<f32> {
    let root = textureSampleLevel(milky_way, milky_way_sampler, in.place.xy, in.place.z).r;
    return vec4<f32>(min(panorama_light(root, in.faint, in.bright), vec3<f32>(6e4)), 0.0);
}

struct Exact {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(linear) ndc: vec2<f32>,
}

@vertex
fn exact_vertex(@builtin(vertex_index) i: u32) -> Exact {
    let ndc = vec2<f32>(corners[i].ndc_x, corners[i].ndc_y);
    return Exact(vec4<f32>(ndc, 0.0, 1.0), ndc);
}

@fragment
fn exact_fragment(in: Exact) -> @location(0) vec4<f32> {
    let view = sky_view(in.ndc);
    if !view.lit {
        return vec4<f32>(0.0);
    }
    let level = panorama_level(view.size, textureDimensions(milky_way).y);
    let root = textureSampleLevel(milky_way, milky_way_sampler, view.uv, level).r;
    let flags = frame.flags;
    let colour = shifted_colour(panorama_light(root, PANORAMA_FAINT, PANORAMA_BRIGHT), view.g, (flags & FLAG_DOPPLER) != 0u,
        (flags & FLAG_BEAMING) != 0u);
    return vec4<f32>(min(colour * frame.sky_brightness, vec3<f32>(6e4)), 0.0);
}
