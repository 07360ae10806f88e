// Looks rays up and nothing else: what the chart of methods times, and what the tests hold against the twins. The method is
// the module `lensrunner::chosen::method`.

#import lensrunner::chosen::method::method_ray
#import lensrunner::gpu::bindings::frame
#import lensrunner::lensing::lookup::{OLD, YOUNG}
#import lensrunner::lensing::slice::lens_texel

/// Along, across, height, and the order, 4 more for light of any age.
@group(0) @binding(2) var<storage, read> race_rows: array<vec4<f32>>;
/// Two for each thread: cos ψ, sin ψ, delay, presence; frequency, momentum and frequency at the point, e. Summed over its look-ups, where
/// it makes more than one.
@group(0) @binding(3) var<storage, read_write> race_out: array<vec4<f32>>;

/// How far apart the rows of a thread's look-ups are: a prime, so that neighbours go on being neighbours and all rows have their turn.
const APART: u32 = 4099u;

/// More threads than rows look the rows up again.
@compute @workgroup_size(64)
fn race(@builtin(global_invocation_id) id: vec3<u32>) {
    if 2u * id.x + 1u >= arrayLength(&race_out) {
        return;
    }
    var seen = vec4<f32>(0.0);
    var sent = vec4<f32>(0.0);
    for (var k = 0u; k < u32(frame.lookups); k++) {
        let row = race_rows[(id.x + k * APART) % arrayLength(&race_rows)];
        let code = u32(row.w);
        let ray = method_ray(row.x, row.y, row.z, code % 4u, select(YOUNG, OLD, code >= 4u));
        seen += vec4<f32>(ray.cos_psi, ray.sin_psi, ray.delay, select(0.0, 1.0, ray.valid));
        sent += vec4<f32>(ray.frequency, ray.emission_radial, ray.emission_frequency, ray.energy);
    }
    race_out[2u * id.x] = seen;
    race_out[2u * id.x + 1u] = sent;
}

/// The same without the look-up: the cost of a dispatch and of its rows.
@compute @workgroup_size(64)
fn idle(@builtin(global_invocation_id) id: vec3<u32>) {
    if 2u * id.x + 1u >= arrayLength(&race_out) {
        return;
    }
    var sum = vec4<f32>(frame.camera_radius * 0.0) + lens_texel(0u);
    for (var k = 0u; k < u32(frame.lookups); k++) {
        sum += race_rows[(id.x + k * APART) % arrayLength(&race_rows)];
    }
    race_out[2u * id.x] = sum;
    race_out[2u * id.x + 1u] = sum.wzyx;
}
