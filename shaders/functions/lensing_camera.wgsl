// What the lensing functions need of the frame.

fn lens_texel(index: u32) -> vec4<f32> {
    // A texture 256 wide: software drivers fetch a texel at once, but a storage buffer one number and one lane at a time.
    return textureLoad(lens_slice, vec2<u32>(index & 255u, index >> 8u), 0);
}
