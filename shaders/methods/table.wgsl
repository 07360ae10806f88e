// Method "table": the residual table, with the closed form where camera and point are both inside the horizon.

/// Triangles are cut at the axis and subdivided, none is dropped.
const METHOD_FILTERS: bool = false;

fn method_ray(along: f32, across: f32, height: f32, order: u32, elapsed: f32) -> LensRay {
    return lens_lookup_aged(along, across, height, order, elapsed);
}

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
