//! The air above 80 km: densities of the three species that matter, temperature, and the mass of air overhead.

/// One height of `TABLE`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Air {
    /// Mass density, g cm⁻³.
    pub mass: f64,
    /// Number density of N₂, cm⁻³.
    pub n2: f64,
    /// Number density of O₂, cm⁻³.
    pub o2: f64,
    /// Number density of atomic oxygen, cm⁻³.
    pub o: f64,
    /// Temperature, K.
    pub temperature: f64,
}

/// (z in km, ρ in kg m⁻³, N₂, O₂, O in m⁻³, T in K): NRLMSISE-00 (Picone et al. 2002) at 67.9° N, 25° E, 2003-01-21 00 UT, F10.7 = 150,
/// Ap = 4.
const TABLE: [(f64, f64, f64, f64, f64, f64); 23] = [
    (80.0, 1.165e-5, 1.911e20, 4.919e19, 2.323e15, 224.0),
    (85.0, 5.550e-6, 9.144e19, 2.310e19, 4.191e16, 221.0),
    (90.0, 2.685e-6, 4.441e19, 1.092e19, 2.246e17, 212.0),
    (95.0, 1.286e-6, 2.130e19, 5.033e18, 4.737e17, 196.0),
    (100.0, 5.688e-7, 9.409e18, 2.092e18, 5.205e17, 186.0),
    (105.0, 2.308e-7, 3.809e18, 7.748e17, 3.888e17, 191.0),
    (110.0, 9.158e-8, 1.504e18, 2.723e17, 2.440e17, 215.0),
    (115.0, 3.755e-8, 6.103e17, 9.724e16, 1.422e17, 268.0),
    (120.0, 1.696e-8, 2.719e17, 3.830e16, 8.288e16, 356.0),
    (130.0, 5.848e-9, 9.089e16, 1.034e16, 3.964e16, 511.0),
    (140.0, 2.866e-9, 4.294e16, 4.093e15, 2.425e16, 615.0),
    (150.0, 1.643e-9, 2.358e16, 1.950e15, 1.653e16, 689.0),
    (160.0, 1.031e-9, 1.409e16, 1.039e15, 1.199e16, 742.0),
    (180.0, 4.734e-10, 5.773e15, 3.561e14, 6.970e15, 806.0),
    (200.0, 2.444e-10, 2.602e15, 1.393e14, 4.345e15, 840.0),
    (220.0, 1.351e-10, 1.228e15, 5.815e13, 2.804e15, 857.0),
    (250.0, 6.038e-11, 4.160e14, 1.667e13, 1.501e15, 868.0),
    (280.0, 2.895e-11, 1.447e14, 4.963e12, 8.194e14, 872.0),
    (300.0, 1.825e-11, 7.224e13, 2.239e12, 5.505e14, 874.0),
    (350.0, 6.204e-12, 1.301e13, 3.152e11, 2.066e14, 875.0),
    (400.0, 2.272e-12, 2.409e12, 4.584e10, 7.880e13, 875.0),
    (450.0, 8.781e-13, 4.573e11, 6.863e9, 3.049e13, 875.0),
    (500.0, 3.572e-13, 8.895e10, 1.056e9, 1.196e13, 875.0),
];

/// The lowest height that is used, in km: an electron of any energy has stopped far above it.
pub const FLOOR: f64 = 40.0;
/// The highest height that is used, in km.
pub const CEILING: f64 = 1000.0;

/// The air at height `z` (km). Logarithms of the densities are linear between the rows of the table and continue with the last slope beyond
/// its ends. Heights are clamped to [[`FLOOR`], [`CEILING`]]; NaN gives the air of the ceiling.
pub fn air(z: f64) -> Air {
    let z = if z.is_nan() { CEILING } else { z.clamp(FLOOR, CEILING) };
    let i = TABLE.partition_point(|row| row.0 <= z).clamp(1, TABLE.len() - 1);
    let (a, b) = (TABLE[i - 1], TABLE[i]);
    let s = (z - a.0) / (b.0 - a.0);
    let log = |a: f64, b: f64| a * (b / a).powf(s);
    // kg m⁻³ → g cm⁻³ and m⁻³ → cm⁻³.
    Air {
        mass: 1e-3 * log(a.1, b.1),
        n2: 1e-6 * log(a.2, b.2),
        o2: 1e-6 * log(a.3, b.3),
        o: 1e-6 * log(a.4, b.4),
        temperature: a.5 + (b.5 - a.5) * s.clamp(0.0, 1.0),
    }
}

/// The mass of air above height `z` (km) in a vertical column, g cm⁻²: the exact integral of the density of [`air`].
pub fn overhead(z: f64) -> f64 {
    let z = if z.is_nan() { CEILING } else { z.clamp(FLOOR, CEILING) };
    // From here up to the end of each interval, then the exponential tail over the last.
    let mut total = 0.0;
    let mut low = z;
    let mut below = air(low).mass;
    for row in TABLE.iter().filter(|row| row.0 > z) {
        let above = 1e-3 * row.1;
        // ∫ρ of an exponential is Δz·Δρ/Δln ρ; 1e5 cm per km.
        total += 1e5 * (row.0 - low) * (below - above) / (below / above).ln();
        (low, below) = (row.0, above);
    }
    let (a, b) = (TABLE[TABLE.len() - 2], TABLE[TABLE.len() - 1]);
    let scale_height = (b.0 - a.0) / (a.1 / b.1).ln();
    total + 1e5 * scale_height * below
}
