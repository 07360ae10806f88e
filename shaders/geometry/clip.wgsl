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
