// Fourth pass of the aurora: luminous points added up as Gaussians, tabulated, in kR of each of the four lines; each in its level of the pyramid. Depth is that
// of the point.

/// exp(−x/2) for x = r²/σ² from 0 to 9, 256 entries, the last of them 0.
@group(1) @binding(0) var gaussian: texture_2d<f32>;
@group(1) @binding(1) var<uniform> level: Level;

/// As in streaks.wgsl.
struct Splat {
    @location(0) place: vec4<f32>,
    @location(1) axes: vec4<f32>,
    @location(2) lines: vec4<f32>,
}

struct Level {
    /// From NDC of the screen to those of the level with its margin: xy times, zw plus.
    place: vec4<f32>,
    /// xy: NDC per pixel of the level.
    pixel: vec4<f32>,
}

struct Spot {
    @builtin(position) position: vec4<f32>,
    @location(0) place: vec2<f32>,
    @location(1) @interpolate(flat) light: vec4<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) i: u32, splat: Splat) -> Spot {
    // A triangle round three standard deviations.
    let corner = select(vec2<f32>(select(-5.196152, 5.196152, i == 1u), -3.0), vec2<f32>(0.0, 6.0), i == 2u);
    let pixels = splat.axes.xy * corner.x + splat.axes.zw * corner.y;
    let place = splat.place.xy * level.place.xy + level.place.zw + pixels * level.pixel.xy;
    return Spot(vec4<f32>(place, splat.place.z, 1.0), corner, splat.lines * splat.place.w);
}

@fragment
fn fragment(in: Spot) -> @location(0) vec4<f32> {
    let entry = min(u32(dot(in.place, in.place) * (255.0 / 9.0) + 0.5), 255u);
    return in.light * textureLoad(gaussian, vec2<u32>(entry, 0u), 0).x;
}
