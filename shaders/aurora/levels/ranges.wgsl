// Before the aurora's walk: the least and the greatest depth of what is drawn, by depth tiles of 8 × 8 pixels, of 16 × 16, and so on. A
// wide stroke that is in front of or behind everything in its box need not be tested pixel by pixel, so it may be added in coarse pixels.

@group(1) @binding(0) var depths: texture_depth_2d;
@group(1) @binding(1) var finer: texture_2d<f32>;
@group(1) @binding(2) var nearest: sampler;

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32((i << 1u) & 2u), f32(i & 2u));
    return vec4<f32>(corner * 2.0 - 1.0, 0.0, 1.0);
}

/// Tiles of 8 × 8 pixels; x: the least, y: the greatest depth.
@fragment
fn first(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let size = vec2<f32>(textureDimensions(depths));
    // Between four pixels; at the screen's edge those on it are taken twice.
    let first = floor(position.xy) * 8.0 + 1.0;
    var least = vec4<f32>(1.0);
    var greatest = vec4<f32>(0.0);
    for (var k = 0u; k < 16u; k++) {
        let four = textureGather(depths, nearest, (first + 2.0 * vec2<f32>(f32(k & 3u), f32(k >> 2u))) / size);
        least = min(least, four);
        greatest = max(greatest, four);
    }
    return vec4<f32>(min(min(least.x, least.y), min(least.z, least.w)), max(max(greatest.x, greatest.y), max(greatest.z, greatest.w)), 0.0,
        0.0);
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
