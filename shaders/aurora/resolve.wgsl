// Last pass of the aurora: the spectrum becomes a colour, and is added to the picture, tile by tile where there is light. And before the strokes of the finest level,
// the same tiles of that are made black.

/// Linear sRGB of a kilorayleigh of each line, seen with this image's Doppler shift, in the unit of the picture's luminance. w of the first two: width and height
/// of a tile in NDC.
@group(1) @binding(0) var<uniform> line_colours: array<vec4<f32>, 4>;
/// Of each image, as in tiles.wgsl.
@group(1) @binding(1) var<storage, read> numbers: array<u32>;

/// The finest level.
@group(2) @binding(0) var accumulated: texture_2d<f32>;
/// The next coarser level of the pyramid, with all that is in those coarser still.
@group(2) @binding(1) var coarse: texture_2d<f32>;
@group(2) @binding(2) var linear: sampler;

/// Colours go along from the vertices: a software driver reads a uniform in every pixel anew.
struct Screen {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) green: vec3<f32>,
    @location(1) @interpolate(flat) blue: vec3<f32>,
    @location(2) @interpolate(flat) red: vec3<f32>,
    @location(3) @interpolate(flat) crimson: vec3<f32>,
}

/// The instance is four times the image and the kind of tiles that are drawn: 1 with light in the finest level alone, 2 in coarser ones alone, 3 in both.
@vertex
fn vertex(@builtin(vertex_index) i: u32, @builtin(instance_index) instance: u32) -> Screen {
    // Two triangles for each tile, or none.
    let tile = vec2<u32>((i / 6u) % TILE_COLUMNS, (i / 6u) / TILE_COLUMNS);
    let image = instance / 4u;
    let lit = vec2<u32>(numbers[tiles_of(image, true) + tile.y], numbers[tiles_of(image, false) + tile.y]) >> tile.xx;
    let kind = (lit.x & 1u) + 2u * (lit.y & 1u);
    let k = i % 6u;
    let corner = vec2<f32>(vec2<bool>((k & 1u) == 1u, (k >= 2u) & (k != 3u)) & vec2<bool>(kind == instance % 4u));
    let place = (vec2<f32>(tile) + corner) * vec2<f32>(line_colours[0].w, line_colours[1].w);
    // As near as can be, so that no depth hides it where there is one.
    let position = vec4<f32>(place.x - 1.0, 1.0 - place.y, 1.0, 1.0);
    return Screen(position, line_colours[0].xyz, line_colours[1].xyz, line_colours[2].xyz, line_colours[3].xyz);
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
