// What the lensing functions need of the frame.

fn lens_texel(index: u32) -> vec4<f32> {
    return textureLoad(lens_slice, vec2<u32>(index % TABLE_ROW, index / TABLE_ROW), 0);
}
