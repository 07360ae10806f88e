#define_import_path lensrunner::lensing::slice

// The slice of the lensing table at the camera's radius, as `lensing::Slice::texels` has it: four texels with the constants of that radius,
// then the coefficients (tangent of half the turn of w, delay, the same of w_e, unused), r fastest.

#import lensrunner::gpu::bindings::{lens_slice, TABLE_ROW}
#import lensrunner::lensing::closed_form::LensCamera

/// Texels before the coefficients.
const HEADER: u32 = 4u;

const SIXTH: f32 = 0.166666666666667;

fn spline_weights(t: f32) -> vec4<f32> {
    let s = 1.0 - t;
    let t2 = t * t;
    let s2 = s * s;
    return vec4<f32>(SIXTH * s2 * s, 4.0 * SIXTH + t2 * (0.5 * t - 1.0), 4.0 * SIXTH + s2 * (0.5 * s - 1.0), SIXTH * t2 * t);
}

fn lens_camera() -> LensCamera {
    let t0 = lens_texel(0u);
    let t1 = lens_texel(1u);
    let t2 = lens_texel(2u);
    let t3 = lens_texel(3u);
    return LensCamera(t0.x, t0.y, t0.z, t0.w, t1.x, t1.y, t1.z, t1.w, t2.x, t2.y, t2.z, u32(t3.x), u32(t3.y), t2.w, t3.z, t3.w);
}

fn lens_texel(index: u32) -> vec4<f32> {
    return textureLoad(lens_slice, vec2<u32>(index % TABLE_ROW, index / TABLE_ROW), 0);
}

/// The residuals of the slice at coordinates in 0 to 1, clamped: cubic B-splines, sixteen texels.
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
        let row = wx.x * lens_texel(at).xyz + wx.y * lens_texel(at + 1u).xyz + wx.z * lens_texel(at + 2u).xyz
            + wx.w * lens_texel(at + 3u).xyz;
        sum += wy[b] * row;
    }
    return sum;
}
