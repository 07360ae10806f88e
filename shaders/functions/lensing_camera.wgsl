// What the lensing functions need of the frame: the slice's first four rows are the camera's constants, the rest its coefficients.

const LENS_ROWS: u32 = 4u;

fn lens_texel(index: u32) -> vec4<f32> {
    return lens_slice[LENS_ROWS + index];
}

fn lens_camera() -> LensCamera {
    let p = lens_slice[0];
    let q = lens_slice[1];
    let s = lens_slice[2];
    let size = lens_slice[3];
    return LensCamera(p.x, p.y, p.z, p.w, q.x, q.y, q.z, q.w, s.x, s.y, s.z, u32(size.x), u32(size.y), 0u, 0u, 0u);
}
