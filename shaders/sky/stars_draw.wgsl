// Stars, drawn into the picture as spots.

#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::SeenStar
#import lensrunner::sky::star_spot::{BRIGHT_RADIUS, DIM_FOR_ONE, spot_corner, spot_share}

@group(1) @binding(0) var<storage, read> seen_stars: array<SeenStar>;

/// Standard deviation of the narrowest spots, in drawn pixels: as they move their light, sampled at pixel centres, changes by up to 4 %
/// (twice its transform at the sampling frequency, e^{−2π²·0.45²}).
const LEAST_SIGMA: f32 = 0.45;

struct Spot {
    @builtin(position) position: vec4<f32>,
    @location(0) place: vec2<f32>,
    @location(1) @interpolate(flat) colour: vec3<f32>,
}

/// Standard deviation of spots, in drawn pixels: that of the output, as far as it can be sampled.
fn drawn_sigma() -> f32 {
    return max(frame.star_sigma / frame.enlargement, min(LEAST_SIGMA, frame.star_sigma));
}

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> Spot {
    let star = seen_stars[i / 3u];
    let is_enlarged = frame.enlargement > 1.0;
    let is_dim = abs(star.radius) < BRIGHT_RADIUS * frame.star_sigma;
    // Of the dim stars of a picture that is enlarged one stands for some: here they only count for glow and exposure.
    let stands_for = select(1.0, f32(DIM_FOR_ONE), is_enlarged & is_dim);
    let radius = select(abs(star.radius), max(star.radius, 0.0), is_enlarged);
    let corner = spot_corner(i % 3u) * (radius * (drawn_sigma() / frame.star_sigma));
    // A depth just nearer than the sky's: everything solid hides it.
    return Spot(vec4<f32>(star.place + corner * 2.0 / frame.size, 1e-12, 1.0), corner,
        star.colour * stands_for / (frame.enlargement * frame.enlargement));
}

@fragment
fn fragment(in: Spot) -> @location(0) vec4<f32> {
    return vec4<f32>(in.colour * spot_share(in.place, drawn_sigma()), 0.0);
}
