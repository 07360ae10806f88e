// The shape of a splat, for those who lay it out and those who fill it.

/// The corners of a triangle round three standard deviations of a splat, in standard deviations along its half axes.
fn corner_of(k: u32) -> vec2<f32> {
    return select(vec2<f32>(select(-5.196152, 5.196152, k == 1u), -3.0), vec2<f32>(0.0, 6.0), k == 2u);
}
