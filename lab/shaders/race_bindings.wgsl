#define_import_path lensrunner::gpu::bindings

// What the lookup reads, where the chart of methods times it alone.

struct RaceFrame {
    /// Look-ups of each thread.
    lookups: f32,
    unused_a: f32,
    unused_b: f32,
    /// In r_s, as in the frame of the game.
    camera_radius: f32,
}

/// As in shaders/gpu/bindings.wgsl.
const TABLE_ROW: u32 = 1024u;

@group(0) @binding(0) var<uniform> frame: RaceFrame;
@group(0) @binding(1) var lens_slice: texture_2d<f32>;
