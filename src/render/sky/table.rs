//! The table of light from infinity, made anew for each camera radius from the exact solution. `sky/table.wgsl` reads it.

use std::f64::consts::PI;

use crate::spacetime::light;

/// Nodes. The cubic of Hermite between them is right to 1e-6 rad (a test holds it).
pub const NODES: usize = 256;
/// End of the axis s, where the gap to the edge of the shadow is e⁻¹² of ψ_shadow; `SKY_S` of WGSL.
const S_END: f64 = 12.0;
/// End of the axis Φ, three half turns; `SKY_PHI` of WGSL.
const PHI_END: f64 = 3.0 * PI;

/// Rows (Φ(s), dΦ/ds, s(Φ), ds/dΦ) for a camera at radius `l` (in r_s).
pub fn sky_table(l: f64) -> Vec<[f32; 4]> {
    let u = 1.0 / l;
    let edge = light::shadow_angle(u);
    let swept = |s: f64| if s <= 0.0 { 0.0 } else { light::sky_angle(edge * -(-s).exp_m1(), u).unwrap_or(f64::NAN) };
    let seen = |phi: f64| {
        if phi <= 0.0 {
            return 0.0;
        }
        let gap = light::sky_slope(phi, u).map_or(f64::NAN, |slope| {
            let energy = (slope * slope + u * u - u * u * u).max(0.0).sqrt();
            1.0 - light::rain_angle(slope, energy, u) / edge
        });
        -gap.max(1e-9).ln()
    };
    // Slopes by differences over a small part of a step: the functions are analytic.
    let rows: Vec<f64> = (0..NODES)
        .flat_map(|i| {
            let s = S_END * i as f64 / (NODES - 1) as f64;
            let phi = PHI_END * i as f64 / (NODES - 1) as f64;
            let d = 1e-4;
            let slope = |f: &dyn Fn(f64) -> f64, x: f64| if x < d { (f(x + d) - f(x)) / d } else { (f(x + d) - f(x - d)) / (2.0 * d) };
            [swept(s), slope(&swept, s), seen(phi), slope(&seen, phi)]
        })
        .collect();
    rows.chunks_exact(4).map(|r| std::array::from_fn(|k| r[k] as f32)).collect()
}

/// The rows where light is straight: Φ = ψ, and the shadow is a point.
pub fn straight_sky_table() -> Vec<[f32; 4]> {
    (0..NODES)
        .map(|i| {
            let share = i as f64 / (NODES - 1) as f64;
            let (s, phi) = (S_END * share, PHI_END * share);
            let gap = (-s).exp();
            // The axis of s ends with the gap of the last node; beyond a half turn there is nothing.
            let least = (-S_END).exp();
            let left = (1.0 - phi / PI).max(least);
            let slope = if left > least { 1.0 / (PI * left) } else { 0.0 };
            [PI * (1.0 - gap), PI * gap, -left.ln(), slope].map(|x| x as f32)
        })
        .collect()
}

/// The Rust twin of `hermite` in WGSL: value and slope at `x` in [0, 1] of the cubic through (0, a), (1, b) with slopes da, db.
fn hermite(a: f32, da: f32, b: f32, db: f32, x: f32) -> [f32; 2] {
    let c2 = 3.0 * (b - a) - 2.0 * da - db;
    let c3 = 2.0 * (a - b) + da + db;
    [a + x * (da + x * (c2 + x * c3)), da + x * (2.0 * c2 + 3.0 * x * c3)]
}

/// The Rust twin of `sky_swept`: Φ∞ and its slope at s.
pub fn sky_swept(table: &[[f32; 4]], s: f32) -> [f32; 2] {
    let last = table.len() - 1;
    let step = S_END as f32 / last as f32;
    let x = (s / step).clamp(0.0, last as f32);
    let i = (x as usize).min(last - 1);
    let (a, b) = (table[i], table[i + 1]);
    let [value, slope] = hermite(a[0], a[1] * step, b[0], b[1] * step, x - i as f32);
    [value, slope / step]
}

/// The Rust twin of `sky_seen`: s of the ray that sweeps Φ, and its slope.
pub fn sky_seen(table: &[[f32; 4]], swept: f32) -> [f32; 2] {
    let last = table.len() - 1;
    let step = PHI_END as f32 / last as f32;
    let x = (swept / step).clamp(0.0, last as f32);
    let i = (x as usize).min(last - 1);
    let (a, b) = (table[i], table[i + 1]);
    let [value, slope] = hermite(a[2], a[3] * step, b[2], b[3] * step, x - i as f32);
    [value, slope / step]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both directions against the exact solution, between nodes, for cameras far, near and inside.
    #[test]
    fn the_table_meets_the_exact_sky() {
        for l in [0.3, 0.97, 1.02, 1.5, 3.0, 10.0, 300.0] {
            let table = sky_table(l);
            let u = 1.0 / l;
            let edge = light::shadow_angle(u);
            for k in 1..400 {
                let s = 11.5 * k as f64 / 400.0;
                let exact = light::sky_angle(edge * -(-s).exp_m1(), u).unwrap();
                let got = sky_swept(&table, s as f32)[0];
                assert!((f64::from(got) - exact).abs() < 4e-6 * (1.0 + exact), "L = {l}, s = {s}: got {got}, want {exact}");
                let back = sky_seen(&table, exact.min(PHI_END - 1e-3) as f32)[0];
                if exact < PHI_END - 1e-3 {
                    assert!((f64::from(back) - s).abs() < 2e-5 * (1.0 + s), "L = {l}, Φ = {exact}: got s = {back}, want {s}");
                }
            }
        }
    }
}
