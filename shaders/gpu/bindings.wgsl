#define_import_path lensrunner::gpu::bindings

// One number, one meaning everywhere. Group 0: the frame and its tables. Group 1: geometry. Group 2: images.
//
// Tables are textures of numbers, row after row of TABLE_ROW texels (render/gpu/layout.rs): a texel of four numbers is fetched at once,
// where a software driver reads a storage buffer number by number and lane by lane.

#import lensrunner::gpu::types::Frame

/// Texels in a row of a table.
const TABLE_ROW: u32 = 1024u;

@group(0) @binding(0) var<uniform> frame: Frame;
/// The lensing table sliced at this frame's camera radius (lensing/slice.wgsl says how it is laid out).
@group(0) @binding(1) var lens_slice: texture_2d<f32>;
/// The deflection of light from infinity (sky/table.wgsl).
@group(0) @binding(2) var sky_slice: texture_2d<f32>;
/// Linear sRGB of a black body over ln T (gpu/colour.wgsl).
@group(0) @binding(3) var blackbody: texture_2d<f32>;
