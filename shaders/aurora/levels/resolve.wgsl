// Last pass of the aurora: the spectrum becomes a colour, and is added to the picture, lit tile by lit tile.

#import lensrunner::aurora::levels::enlarge::enlarged
#import lensrunner::aurora::levels::lit_corners::{lines_seen, lit_corner, SHIFTS}

/// The finest level.
@group(2) @binding(0) var accumulated: texture_2d<f32>;
/// The next coarser level of the pyramid, with all that is in those coarser still.
@group(2) @binding(1) var coarse: texture_2d<f32>;
@group(2) @binding(2) var linear: sampler;

/// Colours come from the vertices, linear over a tile: a software driver reads a uniform anew in every pixel.
struct Screen {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(linear) green: vec3<f32>,
    @location(1) @interpolate(linear) blue: vec3<f32>,
    @location(2) @interpolate(linear) red: vec3<f32>,
    @location(3) @interpolate(linear) crimson: vec3<f32>,
}

/// The colour of a line at a place on the screen (NDC).
fn colour_at(line: u32, place: vec2<f32>) -> vec3<f32> {
    let steps = clamp(lines_seen.middle + dot(lines_seen.slope, place), 0.0, f32(SHIFTS - 1u));
    let below = min(u32(steps), SHIFTS - 2u);
    return mix(lines_seen.colours[4u * below + line], lines_seen.colours[4u * below + 4u + line], vec3<f32>(steps - f32(below)));
}

@vertex
fn vertex(@builtin(vertex_index) i: u32, @builtin(instance_index) instance: u32) -> Screen {
    let place = lit_corner(i, instance);
    return Screen(vec4<f32>(place, 1.0, 1.0), colour_at(0u, place), colour_at(1u, place), colour_at(2u, place), colour_at(3u, place));
}

fn coloured(in: Screen, lines: vec4<f32>) -> vec4<f32> {
    // Without light nothing need be read back and added to.
    if !(lines.x + lines.y + lines.z + lines.w > 0.0) {
        discard;
    }
    let rgb = lines.x * in.green + lines.y * in.blue + lines.z * in.red + lines.w * in.crimson;
    // Single lines are outside sRGB; negative values are cut off at the end, which keeps their hue strong.
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
