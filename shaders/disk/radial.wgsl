#define_import_path lensrunner::disk::radial

// Functions of the radius for sprites and polygons, which have points at any: a table of src/scene/disk/radial.rs, linear in r.

#import lensrunner::disk::motion::disk_frequency
#import lensrunner::disk::types::{mixed_gas, RadialGas}
#import lensrunner::gpu::bindings::frame

@group(1) @binding(1) var<storage, read> radial_table: array<RadialGas>;

fn radial_gas(r: f32) -> RadialGas {
    let last = arrayLength(&radial_table) - 1u;
    let first = radial_table[0].radius;
    let end = radial_table[last].radius;
    let place = clamp((r - first) / (end - first), 0.0, 1.0) * f32(last);
    let i = min(u32(place), last - 1u);
    return mixed_gas(radial_table[i], radial_table[i + 1u], place - f32(i));
}

/// ν_observed/ν_emitted (x) and |cos| to the normal in the gas's frame (y) for gas at r seen in the direction `apparent` (camera axes),
/// from what a photon conserves, energy and angular momentum, and whether it left outward.
fn gas_ratio(apparent: vec3<f32>, r: f32, outward: bool, gas: RadialGas) -> vec2<f32> {
    let past = (frame.rain_from_camera * vec4<f32>(normalize(apparent), -1.0)).xyz;
    let k = -past;
    let n = frame.outward;
    let energy = length(past) - frame.river_speed * dot(n, k);
    let found = disk_frequency(energy, cross(n * frame.camera_radius, k), r, outward, vec2<f32>(gas.outward, gas.along));
    return vec2<f32>(clamp(1.0 / found.x, 1e-3, 1e3), found.y);
}
