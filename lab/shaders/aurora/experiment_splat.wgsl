// The splats of the aurora's experiment: points added up as Gaussians, photons of each of the four lines. Both walks go through it.

#import lensrunner_lab::aurora::experiment::{Experiment, LEVELS}

@group(0) @binding(0) var<uniform> frame: Experiment;
@group(0) @binding(1) var<storage, read> points: array<vec4<u32>>;
/// Photons per collision by line at each level.
@group(0) @binding(2) var<uniform> light: array<vec4<f32>, LEVELS>;

/// As in lab/src/aurora/splat.rs: standard deviations in pixels, and how many of them a splat reaches to each side.
const LEAST_SIGMA: f32 = 0.5;
const MOST_SIGMA: f32 = 40.0;
const REACH: f32 = 3.0;

struct Spot {
    @builtin(position) position: vec4<f32>,
    @location(0) place: vec2<f32>,
    @location(1) @interpolate(flat) light: vec4<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) i: u32, @builtin(instance_index) instance: u32) -> Spot {
    let point = bitcast<vec3<f32>>(points[instance].xyz);
    let bits = points[instance].w;
    // The triangle around a circle: half as many as squares have, and a third more pixels.
    let corners = array<vec2<f32>, 3>(vec2<f32>(-1.7320508, -1.0), vec2<f32>(1.7320508, -1.0), vec2<f32>(0.0, 2.0));
    let sigma = clamp(frame.various.y * point.z, LEAST_SIGMA, MOST_SIGMA);
    let corner = corners[i] * REACH;
    let pixels = point.xy + corner * sigma;
    let ndc = pixels / frame.screen.xy - 1.0;
    let weight = f32(bits >> 8u) * point.z * point.z / (6.2831853 * sigma * sigma);
    return Spot(vec4<f32>(ndc.x, -ndc.y, 0.5, 1.0), corner, light[bits & 255u] * weight);
}

@fragment
fn fragment(in: Spot) -> @location(0) vec4<f32> {
    // Sekiguchi et al. tabulate it; an adapter is faster without. As far as the corner of the processor's square, where the triangle
    // reaches so far: what lies between, and beyond its sides, is less than a hundredth of the peak.
    let x = dot(in.place, in.place);
    return select(vec4<f32>(0.0), in.light * exp(-0.5 * x), x <= 2.0 * REACH * REACH);
}
