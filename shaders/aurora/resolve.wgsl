// Last pass of the aurora: the spectrum becomes a colour, and is added to the picture.

@group(1) @binding(0) var accumulated: texture_2d<f32>;
/// Linear sRGB of a kilorayleigh of each line, seen with this image's Doppler shift, in the unit of the picture's luminance. w of the first: where the rows
/// of this image begin in `lit_rows`; of the second: height of a row in NDC.
@group(1) @binding(1) var<uniform> line_colours: array<vec4<f32>, 4>;
/// The next coarser level of the pyramid, with all that is in those coarser still.
@group(1) @binding(2) var coarse: texture_2d<f32>;

/// A bit for each row of the screen that may have light, among other numbers.
@group(1) @binding(3) var<storage, read> lit_rows: array<u32>;

/// Colours go along from the vertices: a software driver reads a uniform in every pixel anew.
struct Screen {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) green: vec3<f32>,
    @location(1) @interpolate(flat) blue: vec3<f32>,
    @location(2) @interpolate(flat) red: vec3<f32>,
    @location(3) @interpolate(flat) crimson: vec3<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> Screen {
    // Two triangles for each row, or none.
    let row = i / 6u;
    let k = i % 6u;
    let lit = (lit_rows[u32(line_colours[0].w) + row / 32u] >> (row & 31u)) & 1u;
    let corner = vec2<f32>(select(-1.0, 1.0, (k & 1u) == 1u), select(0.0, 1.0, (k >= 2u) & (k != 3u)));
    let position = vec4<f32>(corner.x, 1.0 - (f32(row) + corner.y * f32(lit)) * line_colours[1].w, 0.0, 1.0);
    return Screen(position, line_colours[0].xyz, line_colours[1].xyz, line_colours[2].xyz, line_colours[3].xyz);
}

@fragment
fn fragment(in: Screen) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(in.position.xy);
    let lines = textureLoad(accumulated, pixel, 0) + enlarged(coarse, pixel);
    // Where there is no light nothing need be read back and added to.
    if !(lines.x + lines.y + lines.z + lines.w > 0.0) {
        discard;
    }
    let rgb = lines.x * in.green + lines.y * in.blue + lines.z * in.red + lines.w * in.crimson;
    // Single lines lie outside sRGB; what is negative is cut off here at the end, which keeps their hue strong.
    return vec4<f32>(clamp(rgb, vec3<f32>(0.0), vec3<f32>(6e4)), 0.0);
}
