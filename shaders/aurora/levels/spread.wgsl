// Between the strokes of two levels of the aurora's pyramid: what was added up in the coarser one is enlarged into the finer.

#import lensrunner::aurora::levels::enlarge::enlarged
#import lensrunner::aurora::levels::lit_tiles::{numbers_of, PYRAMID}

@group(1) @binding(0) var coarse: texture_2d<f32>;
@group(1) @binding(1) var linear: sampler;
/// Of each image, as in lit_tiles.wgsl.
@group(1) @binding(2) var<storage, read> numbers: array<u32>;

/// The instance is eight times the image and the finer level.
@vertex
fn vertex(@builtin(vertex_index) i: u32, @builtin(instance_index) instance: u32) -> @builtin(position) vec4<f32> {
    // Nothing where no coarser level has a stroke: then all of them are black, and so is this one.
    var strokes = 0u;
    for (var level = instance % 8u + 1u; level < PYRAMID; level++) {
        strokes += numbers[numbers_of(instance / 8u) + 4u * level];
    }
    let corner = vec2<f32>(f32((i << 1u) & 2u), f32(i & 2u)) * select(0.0, 1.0, strokes > 0u);
    return vec4<f32>(corner * 2.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return enlarged(coarse, linear, position.xy - 1.0);
}
