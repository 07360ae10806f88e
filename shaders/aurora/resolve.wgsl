// Last pass of the aurora: the spectrum becomes a colour, and is added to the picture, tile by tile where there is light. And before the strokes of the finest level,
// the same tiles of that are made black.

/// Frequency ratios that colours are given at. Twin of src/render/aurora/colours.rs.
const SHIFTS: u32 = 8u;

struct Lines {
    /// Linear sRGB of a kilorayleigh of each line at each frequency ratio, the least first, in the unit of the picture's luminance.
    colours: array<vec4<f32>, 4u * SHIFTS>,
    /// Steps from the least ratio: in the middle of the screen, by its coordinates right and up (NDC).
    steps: vec4<f32>,
    /// Width and height of a tile in NDC.
    tile: vec4<f32>,
}

@group(1) @binding(0) var<uniform> lines_seen: Lines;
/// Of each image, as in lit_tiles.wgsl.
@group(1) @binding(1) var<storage, read> numbers: array<u32>;

/// The finest level.
@group(2) @binding(0) var accumulated: texture_2d<f32>;
/// The next coarser level of the pyramid, with all that is in those coarser still.
@group(2) @binding(1) var coarse: texture_2d<f32>;
@group(2) @binding(2) var linear: sampler;

/// Colours go along from the vertices, straight over a tile: a software driver reads a uniform in every pixel anew.
struct Screen {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(linear) green: vec3<f32>,
    @location(1) @interpolate(linear) blue: vec3<f32>,
    @location(2) @interpolate(linear) red: vec3<f32>,
    @location(3) @interpolate(linear) crimson: vec3<f32>,
}

/// The colour of a line at a place on the screen (NDC).
fn colour_at(line: u32, place: vec2<f32>) -> vec3<f32> {
    let steps = clamp(lines_seen.steps.x + dot(lines_seen.steps.yz, place), 0.0, f32(SHIFTS - 1u));
    let below = min(u32(steps), SHIFTS - 2u);
    return mix(lines_seen.colours[4u * below + line].xyz, lines_seen.colours[4u * below + 4u + line].xyz, vec3<f32>(steps - f32(below)));
}

/// The instance is four times the image and the kind of tiles that are drawn: 1 with light in the finest level alone, 2 in coarser ones alone, 3 in both.
@vertex
fn vertex(@builtin(vertex_index) i: u32, @builtin(instance_index) instance: u32) -> Screen {
    // Two triangles for each tile, or none.
    let tile = vec2<u32>((i / 6u) % LIT_TILE_COLUMNS, (i / 6u) / LIT_TILE_COLUMNS);
    let image = instance / 4u;
    let lit = vec2<u32>(numbers[lit_tiles_of(image, true) + tile.y], numbers[lit_tiles_of(image, false) + tile.y]) >> tile.xx;
    let kind = (lit.x & 1u) + 2u * (lit.y & 1u);
    let k = i % 6u;
    let corner = vec2<f32>(vec2<bool>((k & 1u) == 1u, (k >= 2u) & (k != 3u)) & vec2<bool>(kind == instance % 4u));
    let down = (vec2<f32>(tile) + corner) * lines_seen.tile.xy;
    let place = vec2<f32>(down.x - 1.0, 1.0 - down.y);
    // As near as can be, so that no depth hides it where there is one.
    return Screen(vec4<f32>(place, 1.0, 1.0), colour_at(0u, place), colour_at(1u, place), colour_at(2u, place), colour_at(3u, place));
}

@fragment
fn wipe() -> @location(0) vec4<f32> {
    return vec4<f32>(0.0);
}

fn coloured(in: Screen, lines: vec4<f32>) -> vec4<f32> {
    // Where there is no light nothing need be read back and added to.
    if !(lines.x + lines.y + lines.z + lines.w > 0.0) {
        discard;
    }
    let rgb = lines.x * in.green + lines.y * in.blue + lines.z * in.red + lines.w * in.crimson;
    // Single lines lie outside sRGB; what is negative is cut off here at the end, which keeps their hue strong.
    return vec4<f32>(clamp(rgb, vec3<f32>(0.0), vec3<f32>(6e4)), 0.0);
}

@fragment
fn finest(in: Screen) -> @location(0) vec4<f32> {
    return coloured(in, textureLoad(accumulated, vec2<i32>(in.position.xy), 0));
}

@fragment
fn coarser(in: Screen) -> @location(0) vec4<f32> {
    return coloured(in, enlarged(coarse, linear, in.position.xy));
}

@fragment
fn both(in: Screen) -> @location(0) vec4<f32> {
    return coloured(in, textureLoad(accumulated, vec2<i32>(in.position.xy), 0) + enlarged(coarse, linear, in.position.xy));
}
