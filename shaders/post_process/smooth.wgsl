// Smooths the outlines of bodies. The tone-mapped picture is blurred along its edges, as FXAA does it (Lottes 2009); in linear light an
// edge beside a bright one would stay a step. Pixels without a body within a pixel do not change: stars and thin lines are smooth by
// themselves. It is drawn over the finished picture in tiles, and only in those with an outline: on a software driver all pixels would take
// three times as long as tone mapping.

@group(2) @binding(0) var display: texture_2d<f32>;
@group(2) @binding(1) var linear_sampler: sampler;
@group(2) @binding(2) var depth: texture_depth_2d;

/// Steps below this stay, in square roots of light: this share of the brightest neighbour, and this in the dark.
const LEAST_STEP: vec2<f32> = vec2<f32>(0.125, 0.03);
/// Half the length of the longest blur, in pixels.
const LONGEST: f32 = 8.0;

/// Pixels along the side of a tile; as in src/render/post_process/mod.rs.
const TILE: u32 = 16u;
/// A tile has an outline if its nearest depth is this many times the farthest, or if a part of it shows no body.
const STEP: f32 = 1.01;

/// The two triangles of the tile `tile`, or nothing if it has no outline. Every other pixel is tested, and those beside the tile, since
/// outlines extend beyond it.
@vertex
fn vertex(@builtin(vertex_index) i: u32, @builtin(instance_index) tile: u32) -> @builtin(position) vec4<f32> {
    let size = textureDimensions(depth);
    let columns = (size.x + TILE - 1u) / TILE;
    let first = vec2<u32>(tile % columns, tile / columns) * TILE;
    let last = vec2<i32>(size) - 1;
    var nearest = 0.0;
    var farthest = 1e30;
    for (var k = 0u; k < 100u; k++) {
        let place = vec2<i32>(first) + 2 * vec2<i32>(vec2<u32>(k % 10u, k / 10u)) - 1;
        let here = textureLoad(depth, clamp(place, vec2<i32>(0), last), 0);
        nearest = max(nearest, here);
        farthest = min(farthest, here);
    }
    let corner = vec2<u32>(select(0u, 1u, i == 1u || i == 2u || i == 4u), select(0u, 1u, i == 2u || i == 4u || i == 5u));
    let place = vec2<f32>(min(first + corner * TILE, size)) / vec2<f32>(size);
    let shown = select(0.0, 1.0, nearest > STEP * farthest);
    return vec4<f32>((place * 2.0 - 1.0) * vec2<f32>(1.0, -1.0) * shown, 0.0, 1.0);
}

fn colour_at(uv: vec2<f32>) -> vec3<f32> {
    return textureSampleLevel(display, linear_sampler, uv, 0.0).rgb;
}

/// Roughly the perceived brightness.
fn lightness(colour: vec3<f32>) -> f32 {
    return sqrt(dot(colour, vec3<f32>(0.2126, 0.7152, 0.0722)));
}

/// Whether a body is drawn at a place or beside it: depth is reversed, nothing is 0.
fn beside_a_body(place: vec2<i32>) -> bool {
    let across = max(textureLoad(depth, place - vec2<i32>(1, 0), 0), textureLoad(depth, place + vec2<i32>(1, 0), 0));
    let down = max(textureLoad(depth, place - vec2<i32>(0, 1), 0), textureLoad(depth, place + vec2<i32>(0, 1), 0));
    return max(textureLoad(depth, place, 0), max(across, down)) > 0.0;
}

@fragment
fn fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let place = vec2<i32>(position.xy);
    let here = textureLoad(display, place, 0).rgb;
    let pixel = 1.0 / vec2<f32>(textureDimensions(display));
    let uv = position.xy * pixel;
    // Each corner is the mean of four pixels.
    let a = lightness(colour_at(uv + pixel * vec2<f32>(-0.5, -0.5)));
    let b = lightness(colour_at(uv + pixel * vec2<f32>(0.5, -0.5)));
    let c = lightness(colour_at(uv + pixel * vec2<f32>(-0.5, 0.5)));
    let d = lightness(colour_at(uv + pixel * vec2<f32>(0.5, 0.5)));
    let middle = lightness(here);
    let least = min(middle, min(min(a, b), min(c, d)));
    let most = max(middle, max(max(a, b), max(c, d)));
    // Along the edge: across the gradient. The nearer it is to a row or a column, the longer are its steps.
    let along = vec2<f32>(c + d - a - b, a + c - b - d);
    let steepness = min(abs(along.x), abs(along.y)) + max(0.03 * (a + b + c + d), 0.008);
    let reach = clamp(along / steepness, vec2<f32>(-LONGEST), vec2<f32>(LONGEST)) * pixel;
    let near = 0.5 * (colour_at(uv - reach / 6.0) + colour_at(uv + reach / 6.0));
    let far = 0.5 * near + 0.25 * (colour_at(uv - 0.5 * reach) + colour_at(uv + 0.5 * reach));
    // What reaches beyond the edge's end brings in something else.
    let reached = lightness(far);
    let smoothed = select(near, far, (reached >= least) & (reached <= most));
    let is_edge = (most - least > max(LEAST_STEP.x * most, LEAST_STEP.y)) & beside_a_body(place);
    return vec4<f32>(select(here, smoothed, is_edge), 1.0);
}
