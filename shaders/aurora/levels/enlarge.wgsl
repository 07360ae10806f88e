#define_import_path lensrunner::aurora::levels::enlarge

// A level of the aurora's pyramid as the next finer one sees it. Levels but the finest have a texel of margin on each side
// (src/render/aurora/levels.rs).

/// The light of a coarse level at a position of the next finer one, in pixels of the finer one (without its margin). At the middle of a
/// pixel the filter takes two texels a side with weights 3/4 and 1/4, which adds a variance of 3/4 of a fine pixel squared. On a software
/// driver it takes half the time of four fetches.
fn enlarged(coarse: texture_2d<f32>, linear: sampler, place: vec2<f32>) -> vec4<f32> {
    return textureSampleLevel(coarse, linear, (0.5 * place + 1.0) / vec2<f32>(textureDimensions(coarse)), 0.0);
}
