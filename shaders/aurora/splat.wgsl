// Fourth pass of the aurora: luminous points added up as Gaussians, in kR of each of the four lines; each in its level of the pyramid. Depth is that
// of the point.

@group(1) @binding(0) var<uniform> level: Level;

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
    // exp(−r²/2): a driver reads a table no faster.
    return in.light * exp2(-0.7213475 * dot(in.place, in.place));
}
