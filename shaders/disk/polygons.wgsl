// The disk of polygons, drawn: triangles that the stages of geometry have tessellated, opaque, nearest first by depth.

#import lensrunner::disk::gas::{Gas, gas_at, gas_colour, STEP, streaks_of, two_looks}
#import lensrunner::disk::light::gas_light
#import lensrunner::disk::motion::disk_slant
#import lensrunner::disk::radial::{gas_ratio, radial_gas}
#import lensrunner::geometry::clip::clip_position
#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::{SeenVertex, texture_point}

@group(1) @binding(0) var<storage, read> seen: array<SeenVertex>;
@group(1) @binding(2) var<storage, read> turning: array<Turning>;

/// How an instance turns.
struct Turning {
    /// In turns per r_s/c.
    rate: f32,
    /// Azimuth, in turns, of what is at 0 in the model at T₀, which is T less the camera's radius.
    azimuth: f32,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Gas {
    let found = seen[index];
    let place_in_disk = texture_point(found);
    let r = max(place_in_disk.y, 1.0);
    let gas = radial_gas(r);
    let ring = turning[found.instance];
    // The gas is that of the place where the light left.
    let azimuth = place_in_disk.x + ring.azimuth + ring.rate * (frame.camera_radius - found.path);
    let turn = 6.28318531 * azimuth;
    let outward = dot(found.leaving, vec3<f32>(cos(turn), sin(turn), 0.0)) > 0.0;
    let ratio = gas_ratio(found.apparent, r, outward, gas);
    let light = gas_light(gas.ln_temperature, log(ratio.x));
    let depth = gas.depth * disk_slant(ratio.y, found.path, gas.half_height);
    let turns = azimuth - gas.lead / 6.28318531;
    return gas_at(clip_position(found.apparent), turns, gas.pattern_height, found.path, depth, light, vec2<f32>(0.0, 1e6), ratio.y);
}

@fragment
fn fragment(in: Gas) -> @location(0) vec4<f32> {
    let height = 0.25 * log2(max(in.slope.w, 1.0));
    return vec4<f32>(gas_colour(in.light.rgb, in.slope.xyz, in.light.w, two_looks(streaks_of(in, height, 2.0 * STEP))).rgb, 1.0);
}
