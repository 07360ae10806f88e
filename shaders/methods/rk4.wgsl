// Methods "rk4-16", "rk4-64" and "rk4-256": shooting, each shot SHOT_STEPS steps of Runge and Kutta's fourth-order rule in f32. No table.

/// Triangles are cut at the axis and subdivided, none is dropped.
const METHOD_FILTERS: bool = false;

fn method_ray(along: f32, across: f32, height: f32, order: u32, elapsed: f32) -> LensRay {
    let cam = lens_camera();
    let at = source_point(cam, along, across, height);
    return integrated_ray(cam, at, swept(at, order));
}
