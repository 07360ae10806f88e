// Method "rk4-64": shooting, each shot 64 steps of Runge and Kutta's fourth-order rule in f32. No table.

/// Triangles are cut at the axis and subdivided, none is dropped.
const METHOD_FILTERS: bool = false;

const SHOT_STEPS: u32 = 64u;

fn method_ray(along: f32, across: f32, height: f32, order: u32, elapsed: f32) -> LensRay {
    let cam = lens_camera();
    let at = place(cam, along, across, height);
    return integrated_ray(cam, at, swept(at, order));
}
