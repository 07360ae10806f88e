// Method "newton": the residual table, then one Newton step on the closed form in f32.

/// Triangles are cut at the axis and subdivided, none is dropped.
const METHOD_FILTERS: bool = false;

fn method_ray(along: f32, across: f32, height: f32, order: u32, elapsed: f32) -> LensRay {
    let cam = lens_camera();
    let at = source_point(cam, along, across, height);
    let sweep = swept(at, order);
    return refined_ray(cam, at, sweep, lookup(cam, at, sweep, elapsed));
}
