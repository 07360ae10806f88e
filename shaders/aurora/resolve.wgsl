// Last pass of the aurora: the spectrum becomes a colour, and is added to the picture.

@group(1) @binding(0) var accumulated: texture_2d<f32>;
/// The next coarser level of the pyramid, with all that is in those coarser still.
@group(1) @binding(2) var coarse: texture_2d<f32>;
/// CIE XYZ of a kilorayleigh of each line, seen with this image's Doppler shift, in the unit of the picture's luminance.
@group(1) @binding(1) var<uniform> line_colours: array<vec4<f32>, 4>;

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32((i << 1u) & 2u), f32(i & 2u));
    return vec4<f32>(corner * 2.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(position.xy);
    let lines = textureLoad(accumulated, pixel, 0) + enlarged(coarse, pixel);
    if !(lines.x + lines.y + lines.z + lines.w > 0.0) {
        discard;
    }
    let xyz = lines.x * line_colours[0].xyz + lines.y * line_colours[1].xyz + lines.z * line_colours[2].xyz + lines.w * line_colours[3].xyz;
    // Linear sRGB (IEC 61966-2-1). Single lines lie outside it; what is negative is cut off here at the end, which keeps their hue strong.
    let rgb = vec3<f32>(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
        -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
        0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
    return vec4<f32>(clamp(rgb, vec3<f32>(0.0), vec3<f32>(6e4)), 0.0);
}
