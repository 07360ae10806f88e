// Method "table-linear": the residual table, linear between the nodes of the slice: four texels instead of sixteen.

/// Triangles are cut at the axis and subdivided, none is dropped.
const METHOD_FILTERS: bool = false;

fn residuals(cam: LensCamera, x: f32, y: f32) -> vec3<f32> {
    let px = clamp(x, 0.0, 1.0) * f32(cam.nx - 1u);
    let py = clamp(y, 0.0, 1.0) * f32(cam.ny - 1u);
    let i = min(u32(px), cam.nx - 2u);
    let j = min(u32(py), cam.ny - 2u);
    let at = HEADER + j * cam.nx + i;
    let tx = px - f32(i);
    let low = mix(lens_texel(at).xyz, lens_texel(at + 1u).xyz, vec3<f32>(tx));
    let high = mix(lens_texel(at + cam.nx).xyz, lens_texel(at + cam.nx + 1u).xyz, vec3<f32>(tx));
    return mix(low, high, vec3<f32>(py - f32(j)));
}

fn method_ray(along: f32, across: f32, height: f32, order: u32, elapsed: f32) -> LensRay {
    return lens_lookup_aged(along, across, height, order, elapsed);
}
