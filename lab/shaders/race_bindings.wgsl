#define_import_path lensrunner::gpu::bindings

// What the lookup reads, where the chart of methods times it alone.

struct RaceFrame {
    radial: vec4<f32>, // x: look-ups of each thread, w: the camera's radius
}

/// As in shaders/gpu/bindings.wgsl.
const TABLE_ROW: u32 = 1024u;

@group(0) @binding(0) var<uniform> frame: RaceFrame;
@group(0) @binding(1) var lens_slice: texture_2d<f32>;
