#define_import_path lensrunner::disk::motion

// The gas of the disk: what has a twin in src/scene/disk/mod.rs.

/// No ray is more slanted than this.
const LEAST_COSINE: f32 = 0.02;

/// Optical depth along a ray over that straight through the disk; the gas behind a camera inside the disk's thickness is taken away.
fn disk_slant(cosine: f32, path: f32, half_height: f32) -> f32 {
    let x = path * cosine / max(half_height, 1e-9);
    return (1.0 - exp(-0.5 * x * x)) / max(cosine, LEAST_COSINE);
}

/// Shares of the younger and the older generation when the younger has lived `grown` of a renewal.
fn disk_shares(grown: f32) -> vec2<f32> {
    let young = grown * grown * (3.0 - 2.0 * grown);
    let old = 1.0 - young;
    return vec2<f32>(young, old) * inverseSqrt(young * young + old * old);
}

/// Orbital frequency in turns per r_s/c at a height in the pattern, r = e^{2.7726 y}: 1/(2π√(2r³)).
fn disk_rate(y: f32) -> f32 {
    return exp2(-6.0 * y) * 0.11253954;
}

/// Of light with this energy and angular momentum, by what a photon conserves: the frequency in the frame of gas at r, which has the
/// rain-frame momentum per mass `gas` (outward, along the orbit), and |cos| to the disk's normal there. `outward`: whether the light left
/// that way.
fn disk_frequency(energy: f32, angular: vec3<f32>, r: f32, outward: bool, gas: vec2<f32>) -> vec2<f32> {
    let spin = angular / r;
    let beta = inverseSqrt(r);
    let root = sqrt(max(energy * energy - (1.0 - 1.0 / r) * dot(spin, spin), 0.0));
    let inward = (dot(spin, spin) - energy * energy) / max(beta * energy + root, 1e-9);
    let radial = select(inward, (beta * energy + root) / max(1.0 - 1.0 / r, 1e-6), outward);
    let gamma = sqrt(1.0 + dot(gas, gas));
    let emitted = max(gamma * (energy + beta * radial) - gas.x * radial - gas.y * spin.z, 1e-6);
    return vec2<f32>(emitted, length(spin.xy) / emitted);
}
