// A level of the aurora's pyramid as the next finer one sees it. Levels but the finest have a texel of margin on each side (src/render/aurora/levels.rs).

/// The light of a coarse level at a pixel of the next finer one (without its margin): two taps a side with weights 3/4 and 1/4, which adds a variance of
/// 3/4 of a fine pixel squared.
fn enlarged(coarse: texture_2d<f32>, pixel: vec2<i32>) -> vec4<f32> {
    let own = (pixel >> vec2<u32>(1u)) + 1;
    let beside = own + select(vec2<i32>(-1), vec2<i32>(1), (pixel & vec2<i32>(1)) == vec2<i32>(1));
    let near = mix(textureLoad(coarse, own, 0), textureLoad(coarse, vec2<i32>(beside.x, own.y), 0), 0.25);
    let far = mix(textureLoad(coarse, vec2<i32>(own.x, beside.y), 0), textureLoad(coarse, beside, 0), 0.25);
    return mix(near, far, 0.25);
}
