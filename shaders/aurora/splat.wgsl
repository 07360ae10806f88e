// Fourth pass of the aurora: luminous points added up as Gaussians, tabulated, in kR of each of the four lines; each in its level of the pyramid. Depth is that
// of the point.

/// exp(−x/2) for x = r²/σ² from 0 to 9, 256 entries, the last of them 0.
@group(1) @binding(0) var gaussian: texture_2d<f32>;
@group(1) @binding(1) var<uniform> level: Level;

struct Level {
    /// From NDC of the screen to those of the level with its margin: xy times, zw plus.
    place: vec4<f32>,
}

struct Spot {
    @builtin(position) position: vec4<f32>,
    @location(0) place: vec2<f32>,
    @location(1) @interpolate(flat) light: vec4<f32>,
}

/// `place` and `light` as in `Corner` of streaks.wgsl.
@vertex
fn vertex(@builtin(vertex_index) i: u32, @location(0) place: vec3<f32>, @location(1) light: vec4<f32>) -> Spot {
    return Spot(vec4<f32>(place.xy * level.place.xy + level.place.zw, place.z, 1.0), corner_of(i % 3u), light);
}

@fragment
fn fragment(in: Spot) -> @location(0) vec4<f32> {
    let entry = min(u32(dot(in.place, in.place) * (255.0 / 9.0) + 0.5), 255u);
    return in.light * textureLoad(gaussian, vec2<u32>(entry, 0u), 0).x;
}
