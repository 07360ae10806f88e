#define_import_path lensrunner::gpu::bindings

// What the walks and the lookup of the aurora's experiment read.

#import lensrunner_lab::aurora::experiment::Experiment

/// As in shaders/gpu/bindings.wgsl.
const TABLE_ROW: u32 = 1024u;

@group(0) @binding(0) var<uniform> frame: Experiment;
@group(0) @binding(1) var lens_slice: texture_2d<f32>;
