#define_import_path lensrunner::method::held

// What is held in place, for methods with a hole.

/// Rain-frame momentum and γ of what is held in place: of a static observer, γβ outward; inside, where nothing is static, of the rain.
fn held_momentum(position: vec3<f32>) -> vec4<f32> {
    let r = length(position);
    if r < 1.0 {
        return vec4<f32>(0.0, 0.0, 0.0, 1.0);
    }
    let held = max(r, 1.0005);
    let gamma = inverseSqrt(1.0 - 1.0 / held);
    return vec4<f32>(position * (gamma / (held * sqrt(held))), gamma);
}
