// Between the strokes of two levels of the aurora's pyramid: what was added up in the coarser one is enlarged into the finer.

@group(1) @binding(0) var coarse: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32((i << 1u) & 2u), f32(i & 2u));
    return vec4<f32>(corner * 2.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return enlarged(coarse, vec2<i32>(position.xy) - 1);
}
