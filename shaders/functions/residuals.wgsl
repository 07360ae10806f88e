// The residuals of the slice at coordinates in 0 to 1, clamped: cubic B-splines, sixteen texels.

fn residuals(cam: LensCamera, x: f32, y: f32) -> vec3<f32> {
    let px = clamp(x, 0.0, 1.0) * f32(cam.nx - 1u);
    let py = clamp(y, 0.0, 1.0) * f32(cam.ny - 1u);
    let i = min(u32(px), cam.nx - 2u);
    let j = min(u32(py), cam.ny - 2u);
    let wx = spline_weights(px - f32(i));
    let wy = spline_weights(py - f32(j));
    var sum = vec3<f32>(0.0);
    // Always 4, but not to the compiler: unrolled, the loop is a fifth of every pass that looks rays up.
    let rows = min(cam.ny, 4u);
    for (var b = 0u; b < rows; b++) {
        let at = HEADER + (j + b) * (cam.nx + 2u) + i;
        let row = wx.x * lens_texel(at).xyz + wx.y * lens_texel(at + 1u).xyz + wx.z * lens_texel(at + 2u).xyz + wx.w * lens_texel(at + 3u).xyz;
        sum += wy[b] * row;
    }
    return sum;
}
