//! The reference for `scene::aurora::fall` (Fang et al. 2010): the height profile of ionisation by isotropic electrons of one energy, 100
//! eV to 1 MeV.

use lensrunner::scene::aurora::air::air;
use lensrunner::scene::aurora::fall::PAIR_ENERGY;

/// P_ij of table 1 there: rows i = 1 to 8, columns j = 0 to 3.
const P: [[f64; 4]; 8] = [
    [1.24616, 1.45903, -0.242269, 0.0595459],
    [2.23976, -4.22918e-7, 0.0136458, 0.00253332],
    [1.41754, 0.144597, 0.0170433, 6.39717e-4],
    [0.248775, -0.150890, 6.30894e-9, 0.00123707],
    [-0.465119, -0.105081, -0.0895701, 0.0122450],
    [0.386019, 0.00175430, -7.42960e-4, 4.60881e-4],
    [-0.645454, 8.49555e-4, -0.0428581, -0.00299302],
    [0.948930, 0.197385, -0.00250660, -0.00206938],
];

/// Boltzmann's constant, erg K⁻¹ (CODATA 2018, exact).
const BOLTZMANN: f64 = 1.380_649e-16;
/// Atomic mass unit, g (CODATA 2018).
const DALTON: f64 = 1.660_539e-24;
/// Standard gravity, cm s⁻², and the Earth's mean radius, km.
const GRAVITY: f64 = 980.665;
const EARTH: f64 = 6371.0;

/// Scale height of the air at `z` (km), in cm: kT/(m̄g).
fn scale_height(z: f64) -> f64 {
    let air = air(z);
    let mean_mass = air.mass / (air.n2 + air.o2 + air.o);
    let gravity = GRAVITY * (EARTH / (EARTH + z)).powi(2);
    // The table's species leave out argon and helium: a hundredth of the number density at these heights.
    BOLTZMANN * air.temperature / (mean_mass.max(DALTON) * gravity)
}

/// Ion pairs per cm³ and s at height `z` (km) for isotropic electrons of `energy` (keV, 0.1 to 1000) that bring `flux` keV cm⁻² s⁻¹ from
/// above. Equations 1 to 5 there.
pub fn ionisation(z: f64, energy: f64, flux: f64) -> f64 {
    let ln = energy.ln();
    let c = P.map(|p| (p[0] + ln * (p[1] + ln * (p[2] + ln * p[3]))).exp());
    let h = scale_height(z);
    let y = 2.0 / energy * (air(z).mass * h / 6e-6).powf(0.7);
    let f = c[0] * y.powf(c[1]) * (-c[2] * y.powf(c[3])).exp() + c[4] * y.powf(c[5]) * (-c[6] * y.powf(c[7])).exp();
    flux * f / (PAIR_ENERGY * h)
}
