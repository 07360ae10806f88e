// Where an apparent point lies on the screen.

fn finite_vector(v: vec3<f32>) -> bool {
    // NaN fails every comparison; infinities fail this one.
    return all(abs(v) < vec3<f32>(1e30));
}

/// Clip position of an apparent point. Depth is near over the part of the light path along the camera's axis: along one line of sight it orders points as
/// the light path itself does, and it alone is linear over a flat triangle on the screen. Near over the light path, of a triangle seen under a wide
/// angle from close by, is not: what lies a hundredth farther would show through.
fn clip_position(apparent: vec3<f32>) -> vec4<f32> {
    return vec4<f32>(apparent.xy * frame.projection.xy, frame.projection.z, -apparent.z);
}

/// The share of the angle that a pixel has in the middle of the screen which one has in the corners: a plane screen draws out what is seen beside its
/// middle, by the square of the cosine.
fn least_pixel() -> f32 {
    let tangents = 1.0 / frame.projection.xy;
    return 1.0 / (1.0 + dot(tangents, tangents));
}

/// A pixel where two apparent points are seen is smaller than in the middle: this many times at least. What a view of 60 degrees has in its corners counts
/// as the middle; what is off the screen counts as its corners.
fn pixel_fineness(a: vec3<f32>, b: vec3<f32>) -> f32 {
    let cosines = max(-vec2<f32>(a.z, b.z), vec2<f32>(0.0)) / max(vec2<f32>(length(a), length(b)), vec2<f32>(1e-20));
    let cosine = min(cosines.x, cosines.y);
    return max(1.0, 0.7 / max(cosine * cosine, least_pixel()));
}
