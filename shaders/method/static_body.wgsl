#define_import_path lensrunner::method::static_body

// Static bodies, for methods with a hole.

/// Rain-frame momentum and γ of a point of a static body: of a static observer, γβ outward; inside, where nothing is static, of the rain.
fn static_body_momentum(position: vec3<f32>) -> vec4<f32> {
    let r = length(position);
    if r < 1.0 {
        return vec4<f32>(0.0, 0.0, 0.0, 1.0);
    }
    let radius = max(r, 1.0005);
    let gamma = inverseSqrt(1.0 - 1.0 / radius);
    return vec4<f32>(position * (gamma / (radius * sqrt(radius))), gamma);
}
