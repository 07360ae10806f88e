// Before the aurora's walk: the least and the greatest depth of what is drawn, by tiles of 8 × 8 pixels, of 16 × 16, and so on. A wide stroke that is before or
// behind all of its box need not be tested pixel by pixel, so it may be added where pixels are coarse.

@group(1) @binding(0) var depths: texture_depth_2d;
@group(1) @binding(1) var finer: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32((i << 1u) & 2u), f32(i & 2u));
    return vec4<f32>(corner * 2.0 - 1.0, 0.0, 1.0);
}

/// Tiles of 8 × 8 pixels; x: the least, y: the greatest depth.
@fragment
fn first(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let last = vec2<i32>(textureDimensions(depths)) - 1;
    let corner = vec2<i32>(position.xy) * 8;
    var range = vec2<f32>(1.0, 0.0);
    for (var k = 0; k < 64; k++) {
        let depth = textureLoad(depths, min(corner + vec2<i32>(k & 7, k >> 3u), last), 0);
        range = vec2<f32>(min(range.x, depth), max(range.y, depth));
    }
    return vec4<f32>(range, 0.0, 0.0);
}

/// Tiles of twice the side from four.
@fragment
fn next(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let corner = vec2<i32>(position.xy) * 2;
    var range = vec2<f32>(1.0, 0.0);
    for (var k = 0; k < 4; k++) {
        let part = textureLoad(finer, corner + vec2<i32>(k & 1, k >> 1u), 0).xy;
        range = vec2<f32>(min(range.x, part.x), max(range.y, part.y));
    }
    return vec4<f32>(range, 0.0, 0.0);
}
