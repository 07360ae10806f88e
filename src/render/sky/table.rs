//! The table of light from infinity at the camera's radius. It is solved exactly at nodes of ln L, each when a camera first comes near it,
//! and interpolated between them. `sky/table.wgsl` reads it.

use std::f64::consts::PI;

use crate::spacetime::light::{self, Branch, Launch};

/// Nodes. The cubic of Hermite between them is right to 1e-6 rad (a test holds it).
pub const NODES: usize = 256;
/// End of the axis s, where the gap to the edge of the shadow is e⁻¹² of ψ_shadow; `SKY_S` of WGSL.
const S_END: f64 = 12.0;
/// End of the axis Φ, three half turns; `SKY_PHI` of WGSL.
const PHI_END: f64 = 3.0 * PI;

/// Radii of the camera (r_s) between which tables are interpolated.
const RANGE: [f64; 2] = [0.05, 5000.0];
/// Between two nodes of ln L: the cubic through four is right to 4e-7.
const STEP: f64 = 0.1;

/// Tables at nodes of ln L.
#[derive(Debug)]
pub struct SkyTables {
    /// One after the other; room for all.
    rows: Vec<[f32; 4]>,
    /// Which have been solved.
    solved: Vec<bool>,
}

impl Default for SkyTables {
    fn default() -> Self {
        // One more than the range takes at its near end, two at its far end.
        let count = ((RANGE[1] / RANGE[0]).ln() / STEP) as usize + 4;
        SkyTables { rows: vec![[0.0; 4]; count * NODES], solved: vec![false; count] }
    }
}

impl SkyTables {
    /// Puts the rows of [`sky_table`] for a camera at radius `l` (in r_s) in place of what `rows` holds. Beyond the range they are solved
    /// for that radius alone.
    pub fn at(&mut self, l: f64, rows: &mut Vec<[f32; 4]>) {
        rows.clear();
        if !(RANGE[0]..=RANGE[1]).contains(&l) {
            rows.extend(sky_rows(l));
            return;
        }
        let x = (l / RANGE[0]).ln() / STEP;
        // The first of the four nodes about it; they lie at −1, 0, 1 and 2 from `t`.
        let first = x.max(0.0) as usize;
        let t = (x - first as f64) as f32;
        for k in first..first + 4 {
            if !std::mem::replace(&mut self.solved[k], true) {
                let node = RANGE[0] * ((k as f64 - 1.0) * STEP).exp();
                self.rows[k * NODES..(k + 1) * NODES].iter_mut().zip(sky_rows(node)).for_each(|(row, solved)| *row = solved);
            }
        }
        let [before, after] = [t + 1.0, t - 1.0];
        let weights =
            [t * after * (2.0 - t) / 6.0, before * after * (t - 2.0) / 2.0, before * t * (2.0 - t) / 2.0, before * t * after / 6.0];
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| &self.rows[(first + k) * NODES..(first + k + 1) * NODES]);
        rows.extend(a.iter().zip(b).zip(c).zip(d).map(|(((a, b), c), d)| {
            std::array::from_fn(|k| weights[0] * a[k] + weights[1] * b[k] + weights[2] * c[k] + weights[3] * d[k])
        }));
    }
}

/// Rows (Φ(s), dΦ/ds, s(Φ), ds/dΦ) for a camera at radius `l` (in r_s), solved exactly.
pub fn sky_table(l: f64) -> Vec<[f32; 4]> {
    sky_rows(l).collect()
}

fn sky_rows(l: f64) -> impl Iterator<Item = [f32; 4]> {
    let u = 1.0 / l;
    let edge = light::shadow_angle(u);
    // The next ray is about where this one's slope and rate say.
    let mut guess = None;
    let last = (NODES - 1) as f64;
    (0..NODES).map(move |i| {
        if i == 0 {
            // Along the axis light goes straight, and aberration by the river makes Φ of ψ.
            let swept_by_psi = 1.0 / (1.0 + u.sqrt());
            return [0.0, edge * swept_by_psi, 0.0, 1.0 / (edge * swept_by_psi)].map(|x| x as f32);
        }
        let gap = edge * (-S_END * i as f64 / last).exp();
        let psi = edge - gap;
        let ray = light::launch(psi, u);
        let swept = light::sky_angle(psi, u).unwrap_or(f64::NAN);
        let by_s = gap * swept_by_psi(ray, psi, swept, u);
        let phi = PHI_END * i as f64 / last;
        let ray = light::join_near(0.0, phi, u, Branch::Plus, guess)
            .map_or(Launch { slope: f64::NAN, energy: f64::NAN }, |ray| Launch { slope: ray.slope, energy: ray.energy });
        let psi = light::rain_angle(ray.slope, ray.energy, u);
        let gap = (edge - psi).max(1e-9 * edge);
        let rate = light::sky_rate(ray, phi, u);
        guess = rate.map(|rate| ray.slope + PHI_END / last / rate);
        [swept, by_s, (edge / gap).ln(), 1.0 / (gap * swept_by_psi(ray, psi, phi, u))].map(|x| x as f32)
    })
}

/// dΦ∞/dψ at the ray that is seen at `psi` (rain frame, in rad) and sweeps `swept`, where dw/dψ = e/sin ψ.
fn swept_by_psi(ray: Launch, psi: f64, swept: f64, u: f64) -> f64 {
    light::sky_rate(ray, swept, u).map_or(f64::NAN, |rate| rate * ray.energy / psi.sin())
}

/// Puts the rows where light is straight in place of what `rows` holds: Φ = ψ, and the shadow is a point.
pub fn straight_sky_table(rows: &mut Vec<[f32; 4]>) {
    rows.clear();
    rows.extend((0..NODES).map(|i| {
        let share = i as f64 / (NODES - 1) as f64;
        let (s, phi) = (S_END * share, PHI_END * share);
        let gap = (-s).exp();
        // The axis of s ends with the gap of the last node; beyond a half turn there is nothing.
        let least = (-S_END).exp();
        let left = (1.0 - phi / PI).max(least);
        let slope = if left > least { 1.0 / (PI * left) } else { 0.0 };
        [PI * (1.0 - gap), PI * gap, -left.ln(), slope].map(|x| x as f32)
    }));
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

    /// Both directions against the exact solution, between nodes of the rows and of the radius, for cameras far, near and inside.
    #[test]
    fn the_table_meets_the_exact_sky() {
        let mut tables = SkyTables::default();
        let mut table = Vec::new();
        let (mut first, mut second) = (0.0f64, 0.0f64);
        for l in [0.02, 0.05, 0.052, 0.08, 0.3, 0.97, 1.0, 1.02, 1.5, 1.501, 3.0, 10.0, 55.0, 300.0, 5000.0, 1e5] {
            tables.at(l, &mut table);
            let u = 1.0 / l;
            let edge = light::shadow_angle(u);
            for k in 1..400 {
                let s = 11.5 * k as f64 / 400.0;
                let exact = light::sky_angle(edge * -(-s).exp_m1(), u).unwrap();
                let got = sky_swept(&table, s as f32)[0];
                first = first.max((f64::from(got) - exact).abs() / (1.0 + exact));
                assert!((f64::from(got) - exact).abs() < 4e-6 * (1.0 + exact), "L = {l}, s = {s}: got {got}, want {exact}");
                let back = sky_seen(&table, exact.min(PHI_END - 1e-3) as f32)[0];
                // From so far the light turns into its winding within less than the distance of two nodes.
                if exact < PHI_END - 1e-3 && l < 1e3 {
                    second = second.max((f64::from(back) - s).abs() / (1.0 + s));
                    assert!((f64::from(back) - s).abs() < 2e-5 * (1.0 + s), "L = {l}, Φ = {exact}: got s = {back}, want {s}");
                }
            }
        }
        println!("Φ is off by {first:.1e}, s by {second:.1e}");
    }

    /// The slopes of the nodes are those of the values.
    #[test]
    fn the_slopes_are_those_of_the_values() {
        for l in [0.05, 0.97, 1.5, 12.0, 300.0] {
            let u = 1.0 / l;
            let edge = light::shadow_angle(u);
            let d = 1e-4;
            let slope = |f: &dyn Fn(f64) -> f64, x: f64| (f(x + d) - f(x - d)) / (2.0 * d);
            let swept = |s: f64| light::sky_angle(edge * -(-s).exp_m1(), u).unwrap();
            let seen = |phi: f64| {
                let ray = light::join(0.0, phi, u, Branch::Plus).unwrap();
                -(1.0 - light::rain_angle(ray.slope, ray.energy, u) / edge).ln()
            };
            for (i, row) in sky_table(l).into_iter().enumerate().skip(1).step_by(12) {
                let (s, phi) = (S_END * i as f64 / (NODES - 1) as f64, PHI_END * i as f64 / (NODES - 1) as f64);
                for (got, want) in [(row[1], slope(&swept, s)), (row[3], slope(&seen, phi))] {
                    assert!((f64::from(got) - want).abs() < 1e-5 * (1.0 + want), "L = {l}, node {i}: {got}, not {want}");
                }
            }
        }
    }
}
