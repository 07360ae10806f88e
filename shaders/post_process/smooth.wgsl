// Smooths the outlines of bodies. The tone-mapped picture is blurred along its edges, as FXAA does it (Lottes 2009); in linear light an
// edge beside a bright one would stay a step. Pixels without a body within a pixel do not change: stars and thin lines are smooth by
// themselves. It is drawn over the finished picture in tiles, and only in those with an outline, which outlines.wgsl finds: on a software
// driver all pixels would take three times as long as tone mapping.

#import lensrunner::post_process::tiles::tile_corner

@group(2) @binding(0) var display: texture_2d<f32>;
@group(2) @binding(1) var linear_sampler: sampler;
@group(2) @binding(2) var depth: texture_depth_2d;

/// Steps below this stay, in square roots of light: this share of the brightest neighbour, and this in the dark.
const LEAST_STEP: vec2<f32> = vec2<f32>(0.125, 0.03);
/// Half the length of the longest blur, in pixels.
const LONGEST: f32 = 8.0;

/// As in outlines.wgsl.
struct Outlines {
    vertices: u32,
    tiles: u32,
    first_vertex: u32,
    first_instance: u32,
    list: array<u32>,
}

@group(2) @binding(3) var<storage, read> outlines: Outlines;

/// The two triangles of a tile with an outline.
@vertex
fn vertex(@builtin(vertex_index) i: u32, @builtin(instance_index) number: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(tile_corner(outlines.list[number], i), 0.0, 1.0);
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
