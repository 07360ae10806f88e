// Stars drawn as spots of constant shape and exact total light, so that they neither blink nor stretch as they move across pixels.

#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::SeenStar

@group(1) @binding(0) var<storage, read> seen_stars: array<SeenStar>;

struct Spot {
    @builtin(position) position: vec4<f32>,
    @location(0) place: vec2<f32>,
    @location(1) @interpolate(flat) colour: vec3<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> Spot {
    let star = seen_stars[i / 3u];
    // The triangle round the spot: a third more pixels than a square, but half the triangles, and these are what a software driver pays
    // for.
    let corners = array<vec2<f32>, 3>(vec2<f32>(-1.7320508, -1.0), vec2<f32>(1.7320508, -1.0), vec2<f32>(0.0, 2.0));
    let corner = corners[i % 3u] * star.radius;
    // A depth just nearer than the sky's: everything solid hides it.
    return Spot(vec4<f32>(star.place + corner * 2.0 / frame.size, 1e-12, 1.0), corner, star.colour);
}

@fragment
fn fragment(in: Spot) -> @location(0) vec4<f32> {
    let square = 2.0 * frame.star_sigma * frame.star_sigma;
    let weight = exp(-dot(in.place, in.place) / square) / (3.14159265 * square);
    return vec4<f32>(in.colour * weight, 0.0);
}
