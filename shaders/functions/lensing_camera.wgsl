// What the lensing functions need of the frame.

/// Texels in a row of a table.
const TABLE_ROW: u32 = 1024u;

fn lens_texel(index: u32) -> vec4<f32> {
    return textureLoad(lens_slice, vec2<u32>(index % TABLE_ROW, index / TABLE_ROW), 0);
}
