#define_import_path lensrunner::geometry::clip

// Where an apparent point lies on the screen.

#import lensrunner::gpu::bindings::frame

fn finite_vector(v: vec3<f32>) -> bool {
    // NaN fails every comparison; infinities fail this one.
    return all(abs(v) < vec3<f32>(1e30));
}

/// Clip position of an apparent point. Depth is the near distance over the component of the light path along the camera's axis. Along one
/// line of sight it orders points as the light path does, and only this depth is linear over a flat triangle on the screen. With the near
/// distance over the light path itself, what lies a hundredth farther would show through a triangle seen under a wide angle from close by.
fn clip_position(apparent: vec3<f32>) -> vec4<f32> {
    return vec4<f32>(apparent.xy * frame.focal, frame.near, -apparent.z);
}

/// The angle of a pixel in the corners of the screen over that in the middle: the projection onto a plane stretches what is seen off its
/// middle, by the square of the cosine.
fn least_pixel() -> f32 {
    let tangents = 1.0 / frame.focal;
    return 1.0 / (1.0 + dot(tangents, tangents));
}

/// How many times smaller a pixel is where two apparent points are seen than in the middle of the screen, at least. Down to what a view of
/// 60 degrees has in its corners it counts as 1; what is off the screen counts as its corners.
fn pixel_fineness(a: vec3<f32>, b: vec3<f32>) -> f32 {
    let cosines = max(-vec2<f32>(a.z, b.z), vec2<f32>(0.0)) / max(vec2<f32>(length(a), length(b)), vec2<f32>(1e-20));
    let cosine = min(cosines.x, cosines.y);
    return max(1.0, 0.7 / max(cosine * cosine, least_pixel()));
}
