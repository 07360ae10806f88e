#define_import_path lensrunner::post_process::tone_curve

// Exposure, bloom and tone curve of one pixel: of the picture that is shown, and of its mean brightness.

#import lensrunner::gpu::bindings::frame

/// A filmic curve: straight in the dark, a soft shoulder that reaches white at about ten times middle grey; colours lose their hue only
/// as they come near to white.
fn tone_curve(x: vec3<f32>) -> vec3<f32> {
    let peak = max(max(x.r, max(x.g, x.b)), 1e-12);
    let mapped = 1.0 - exp(-peak);
    let toned = x * (mapped / peak);
    let bleach = smoothstep(0.6, 1.0, mapped);
    return toned + bleach * bleach * (vec3<f32>(1.0) - toned);
}

/// The colour on the screen, linear, 1 for white: of the light of the picture and of its glow there, at an exposure.
fn display_light(picture: vec3<f32>, glow: vec3<f32>, exposure: f32) -> vec3<f32> {
    // Infinite where sums of light were more than halves can hold.
    let light = min(picture, vec3<f32>(6e4));
    let exposed = mix(light, glow, frame.bloom) * (exposure * frame.exposure_bias);
    return tone_curve(exposed);
}
