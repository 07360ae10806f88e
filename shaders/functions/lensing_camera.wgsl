// What the lensing functions need of the frame.

fn lens_texel(index: u32) -> vec4<f32> {
    return lens_slice[index];
}
