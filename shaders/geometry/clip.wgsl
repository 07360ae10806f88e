// Where an apparent point lies on the screen.

fn finite_vector(v: vec3<f32>) -> bool {
    // NaN fails every comparison; infinities fail this one.
    return all(abs(v) < vec3<f32>(1e30));
}

/// Clip position of an apparent point. Depth is near over light path, so that it orders points along one line of sight.
fn clip_position(apparent: vec3<f32>) -> vec4<f32> {
    let distance = max(length(apparent), 1e-9);
    let forward = -apparent.z;
    return vec4<f32>(apparent.xy * frame.projection.xy, frame.projection.z * forward / distance, forward);
}
