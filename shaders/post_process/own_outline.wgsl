// The outline of the player's own ship in a picture that was drawn smaller and enlarged: there it would be as coarse as the drawn texels.
// Where its edge passes between the texels beside a pixel, the pixel takes the colour of those that are on its own side of the edge.

#import lensrunner::gpu::bindings::frame

/// The picture as it was drawn.
@group(2) @binding(0) var source: texture_2d<f32>;
/// Where the ship is, in the pixels of the output: 1, elsewhere 0.
@group(2) @binding(1) var mask: texture_2d<f32>;
@group(2) @binding(2) var linear_sampler: sampler;

/// The ship's circle, wider by the kernel's reach of two texels, in two triangles of a square.
@vertex
fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    let width = frame.size.x;
    let radius = frame.unmetered_radius + 2.0 / width;
    let k = i % 3u + i / 3u;
    let corner = vec2<f32>(vec2<u32>(k & 1u, k >> 1u)) * 2.0 - 1.0;
    let place = frame.unmetered_middle + corner * radius;
    return vec4<f32>(2.0 * place * vec2<f32>(1.0, -width / frame.size.y), 0.0, 1.0);
}

/// The ship's share of a place of the output, between pixels.
fn ship_at(uv: vec2<f32>) -> f32 {
    return textureSampleLevel(mask, linear_sampler, uv, 0.0).r;
}

/// Whether the ship is in the pixel of the output that this place, in pixels, lies in.
fn is_ship(place: vec2<f32>) -> bool {
    return textureLoad(mask, clamp(vec2<i32>(place), vec2<i32>(0), vec2<i32>(textureDimensions(mask)) - 1), 0).r > 0.5;
}

/// Weight of a texel of the other side: only where there is none of one's own does it count.
const OTHER_SIDE: f32 = 1e-3;

@fragment
fn fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let output = vec2<f32>(textureDimensions(mask));
    let size = vec2<f32>(textureDimensions(source));
    let place = position.xy / output * size - 0.5;
    let first = floor(place);
    let here = is_ship(position.xy);
    var is_mixed = false;
    for (var k = 0u; k < 4u; k++) {
        let beside = first + vec2<f32>(vec2<u32>(k & 1u, k >> 1u)) + 0.5;
        is_mixed = is_mixed | (is_ship(beside / size * output) != here);
    }
    // A loop of no rounds is all that software drivers skip work by.
    let taps = select(0u, 16u, is_mixed);
    let last = vec2<i32>(size) - 1;
    var ship = vec4<f32>(0.0);
    var rest = vec4<f32>(0.0);
    var share = 0.0;
    for (var k = 0u; k < taps; k++) {
        let tap = vec2<f32>(vec2<u32>(k & 3u, k >> 2u)) - 1.0;
        let texel = first + tap;
        let away = saturate(1.0 - 0.5 * abs(texel - place));
        let near = away.x * away.y;
        let inside = ship_at((texel + 0.5) / size);
        let colour = vec4<f32>(textureLoad(source, clamp(vec2<i32>(texel), vec2<i32>(0), last), 0).rgb, 1.0);
        ship += near * (inside * inside + OTHER_SIDE) * colour;
        rest += near * ((1.0 - inside) * (1.0 - inside) + OTHER_SIDE) * colour;
        // Sixteen places about the pixel's middle: the edge is as smooth as those that smooth.wgsl has smoothed.
        share += ship_at((position.xy + 0.5 * (tap - 0.5)) / output) / 16.0;
    }
    if !is_mixed {
        discard;
    }
    return vec4<f32>(mix(rest.rgb / rest.w, ship.rgb / ship.w, share), 1.0);
}
