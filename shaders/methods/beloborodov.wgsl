// Method "beloborodov": Beloborodov's cosine relation (2002, ApJ 566, L85). Order 1, both ends outside.

/// Triangles are cut at the axis and subdivided, none is dropped.
const METHOD_FILTERS: bool = false;

fn tilt(u: f32, y: f32) -> f32 {
    return (1.0 - u) * y;
}

fn method_ray(along: f32, across: f32, height: f32, order: u32, elapsed: f32) -> LensRay {
    let cam = lens_camera();
    let at = source_point(cam, along, across, height);
    return closed_ray(cam, at, order);
}
