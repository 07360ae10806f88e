// Stars drawn as spots of constant shape and exact total light, so that they neither blink nor stretch as they move across pixels.

@group(1) @binding(0) var<storage, read> seen_stars: array<SeenStar>;

struct Spot {
    @builtin(position) position: vec4<f32>,
    @location(0) place: vec2<f32>,
    @location(1) @interpolate(flat) colour: vec3<f32>,
}

/// Standard deviation of the spot, in pixels. 0.7 is the narrowest Gaussian whose light, sampled at pixel
/// centres, changes by less than 1 % as it moves (its transform at the sampling frequency is e^{−2π²·0.49} = 6e-5).
const SPOT_SIGMA: f32 = 0.7;

@vertex
fn vertex(@builtin(vertex_index) i: u32, @builtin(instance_index) instance: u32) -> Spot {
    let star = seen_stars[instance];
    let corners = array<vec2<f32>, 6>(vec2<f32>(-1.0, -1.0), vec2<f32>(1.0, -1.0), vec2<f32>(1.0, 1.0),
        vec2<f32>(-1.0, -1.0), vec2<f32>(1.0, 1.0), vec2<f32>(-1.0, 1.0));
    let corner = corners[i] * star.place.z;
    // A depth just nearer than the sky's: everything solid hides it.
    return Spot(vec4<f32>(star.place.xy + corner * 2.0 / frame.size.xy, 1e-12, 1.0), corner, star.colour.rgb);
}

@fragment
fn fragment(in: Spot) -> @location(0) vec4<f32> {
    let weight = exp(-dot(in.place, in.place) / (2.0 * SPOT_SIGMA * SPOT_SIGMA)) / (2.0 * 3.14159265 * SPOT_SIGMA * SPOT_SIGMA);
    return vec4<f32>(in.colour * weight, 0.0);
}
