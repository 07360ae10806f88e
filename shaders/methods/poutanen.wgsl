// Method "poutanen": Poutanen's closed form (2020, A&A 640, A24). Order 1, both ends outside.

/// Triangles are cut at the axis and subdivided, none is dropped.
const METHOD_FILTERS: bool = false;

fn tilt(u: f32, y: f32) -> f32 {
    // The logarithm diverges where the ray comes from straight behind, beyond the relation's range (160°).
    let rest = log(max(1.0 - 0.5 * y, 1e-6)) + 0.5 * y;
    return min((1.0 - u) * y * (1.0 + u * u * y * y / 112.0 - 0.0271828183 * u * y * rest), 2.0);
}

fn method_ray(along: f32, across: f32, height: f32, order: u32, elapsed: f32) -> LensRay {
    let cam = lens_camera();
    let at = source_point(cam, along, across, height);
    return closed_ray(cam, at, order);
}
