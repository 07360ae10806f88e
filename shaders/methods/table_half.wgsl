// Method "table-half": the residual table, cubic, its slice in half precision: two coefficients to a texel.

/// Triangles are cut at the axis and subdivided, none is dropped.
const METHOD_FILTERS: bool = false;

fn half_texel(index: u32) -> vec3<f32> {
    let texel = bitcast<vec4<u32>>(lens_texel(HEADER + index / 2u));
    let pair = select(texel.xy, texel.zw, index % 2u == 1u);
    return vec3<f32>(unpack2x16float(pair.x), unpack2x16float(pair.y).x);
}

fn residuals(cam: LensCamera, x: f32, y: f32) -> vec3<f32> {
    let px = clamp(x, 0.0, 1.0) * f32(cam.nx - 1u);
    let py = clamp(y, 0.0, 1.0) * f32(cam.ny - 1u);
    let i = min(u32(px), cam.nx - 2u);
    let j = min(u32(py), cam.ny - 2u);
    let wx = spline_weights(px - f32(i));
    let wy = spline_weights(py - f32(j));
    var sum = vec3<f32>(0.0);
    let rows = min(cam.ny, 4u);
    for (var b = 0u; b < rows; b++) {
        let at = (j + b) * (cam.nx + 2u) + i;
        sum += wy[b] * (wx.x * half_texel(at) + wx.y * half_texel(at + 1u) + wx.z * half_texel(at + 2u) + wx.w * half_texel(at + 3u));
    }
    return sum;
}

fn method_ray(along: f32, across: f32, height: f32, order: u32, elapsed: f32) -> LensRay {
    return lens_lookup_aged(along, across, height, order, elapsed);
}
