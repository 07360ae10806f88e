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

/// Steps of the share below this are rounding.
const LEAST_STEP: f32 = 0.01;
/// Weight of a texel of the other side: only where there is none of one's own does it count.
const OTHER_SIDE: f32 = 1e-3;

@fragment
fn fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = 1.0 / vec2<f32>(textureDimensions(mask));
    let uv = position.xy * pixel;
    let size = vec2<f32>(textureDimensions(source));
    let place = uv * size - 0.5;
    let first = floor(place);
    // A tent of three pixels: the edge is as smooth as those that smooth.wgsl has smoothed.
    let half = 0.5 * pixel;
    let share = 0.25 * (ship_at(uv + half) + ship_at(uv - half) + ship_at(uv + vec2<f32>(half.x, -half.y))
        + ship_at(uv + vec2<f32>(-half.x, half.y)));
    var least = share;
    var most = share;
    for (var k = 0u; k < 4u; k++) {
        let beside = ship_at((first + vec2<f32>(vec2<u32>(k & 1u, k >> 1u)) + 0.5) / size);
        least = min(least, beside);
        most = max(most, beside);
    }
    if most - least < LEAST_STEP {
        discard;
    }
    let last = vec2<i32>(size) - 1;
    var ship = vec4<f32>(0.0);
    var rest = vec4<f32>(0.0);
    for (var k = 0u; k < 16u; k++) {
        let texel = first + vec2<f32>(vec2<u32>(k & 3u, k >> 2u)) - 1.0;
        let away = saturate(1.0 - 0.5 * abs(texel - place));
        let near = away.x * away.y;
        let inside = ship_at((texel + 0.5) / size);
        let colour = vec4<f32>(textureLoad(source, clamp(vec2<i32>(texel), vec2<i32>(0), last), 0).rgb, 1.0);
        ship += near * (inside * inside + OTHER_SIDE) * colour;
        rest += near * ((1.0 - inside) * (1.0 - inside) + OTHER_SIDE) * colour;
    }
    return vec4<f32>(mix(rest.rgb / rest.w, ship.rgb / ship.w, share), 1.0);
}
