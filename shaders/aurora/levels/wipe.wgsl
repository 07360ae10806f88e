// Before the strokes of the aurora's finest level: the lit tiles of that are made black.

#import lensrunner::aurora::levels::lit_corners::lit_corner

@vertex
fn vertex(@builtin(vertex_index) i: u32, @builtin(instance_index) instance: u32) -> @builtin(position) vec4<f32> {
    // As near as can be, so that no depth hides it.
    return vec4<f32>(lit_corner(i, instance), 1.0, 1.0);
}

@fragment
fn fragment() -> @location(0) vec4<f32> {
    return vec4<f32>(0.0);
}
