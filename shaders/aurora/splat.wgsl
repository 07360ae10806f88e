// Third pass of the aurora: luminous points added up as Gaussians, tabulated, in kR of each of the four lines. Depth is that of the point.

@group(1) @binding(0) var<storage, read> splats: array<Splat>;
/// exp(−x/2) for x = r²/σ² from 0 to 9, 256 entries.
@group(1) @binding(1) var<storage, read> gaussian: array<f32>;

struct Splat {
    place: vec4<f32>,
    axes: vec4<f32>,
    lines: vec4<f32>,
}

struct Spot {
    @builtin(position) position: vec4<f32>,
    @location(0) place: vec2<f32>,
    @location(1) @interpolate(flat) light: vec4<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) i: u32, @builtin(instance_index) instance: u32) -> Spot {
    let splat = splats[instance];
    let corners = array<vec2<f32>, 6>(vec2<f32>(-1.0, -1.0), vec2<f32>(1.0, -1.0), vec2<f32>(1.0, 1.0),
        vec2<f32>(-1.0, -1.0), vec2<f32>(1.0, 1.0), vec2<f32>(-1.0, 1.0));
    // Three standard deviations.
    let corner = corners[i] * 3.0;
    let pixels = splat.axes.xy * corner.x + splat.axes.zw * corner.y;
    return Spot(vec4<f32>(splat.place.xy + pixels * 2.0 / frame.size.xy, splat.place.z, 1.0), corner, splat.lines * splat.place.w);
}

@fragment
fn fragment(in: Spot) -> @location(0) vec4<f32> {
    let x = dot(in.place, in.place);
    if x >= 9.0 {
        discard;
    }
    return in.light * gaussian[u32(x * (255.0 / 9.0) + 0.5)];
}
