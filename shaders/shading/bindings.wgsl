#define_import_path lensrunner::shading::bindings

// Group 2: what surfaces are drawn from, behind the instances.

#import lensrunner::gpu::types::{Material, SeenVertex}

@group(2) @binding(1) var<storage, read> seen: array<SeenVertex>;
@group(2) @binding(2) var<storage, read> materials: array<Material>;
@group(2) @binding(3) var surface_textures: texture_2d_array<f32>;
@group(2) @binding(4) var surface_sampler: sampler;
@group(2) @binding(5) var<storage, read> thin: array<ThinVertex>;

struct ThinVertex {
    position: vec4<f32>,
    /// x: seen vertex (bits), y: coverage, z: image order, w: the share whose light crosses the disk's plane as often as the order says,
    /// and not once less.
    data: vec4<f32>,
}
