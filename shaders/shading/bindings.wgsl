#define_import_path lensrunner::shading::bindings

// Group 2: what surfaces are drawn from, behind the instances.

#import lensrunner::gpu::types::{Material, SeenVertex}

@group(2) @binding(1) var<storage, read> seen: array<SeenVertex>;
@group(2) @binding(2) var<storage, read> materials: array<Material>;
@group(2) @binding(3) var surface_textures: texture_2d_array<f32>;
@group(2) @binding(4) var surface_sampler: sampler;
