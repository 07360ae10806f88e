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
