//! The fall of one electron along the field: how much of its energy is left at each height.
//!
//! Sekiguchi et al. move a particle by v_f Δt. It meets air with probability n π r² v_f Δt (equation 2 there) and loses energy at each
//! meeting; r is tuned. Here the mean loss per path is that of the measured range in air, R(E) = 4.57e-6 E^1.75 g cm⁻² (Barrett & Hays
//! 1976, as Rees 1989 uses it). A collision costs 35 eV: P_c = ρ v_f Δt/(35 eV · dR/dE). Along a path with µ = cos(pitch) the energy left
//! follows from the mass N(z) of air overhead alone: E(z) = E₀ (1 − N(z)/(µ R(E₀)))^{1/1.75}. So a step may be of any length, and a
//! particle can neither pass the ground nor spend more energy than it has.

/// Energy spent per ion pair, in keV: the 35 eV of Fang et al. 2010, after Rees 1989.
pub const PAIR_ENERGY: f64 = 0.035;
/// R(E) = RANGE · E^RANGE_POWER in g cm⁻², E in keV.
pub const RANGE: f64 = 4.57e-6;
/// See [`RANGE`].
const RANGE_POWER: f64 = 1.75;
/// Energies are held to this range, keV: below, the range formula has no meaning; above, electrons pass the lowest height asked.
pub const ENERGIES: [f64; 2] = [0.05, 500.0];
/// The flattest path, as the cosine of the pitch angle: mirrored or flatter electrons never arrive.
const LEAST_SLOPE: f64 = 0.05;

/// The range in air of an electron of `energy` keV, in g cm⁻².
pub fn range(energy: f64) -> f64 {
    RANGE * energy.powf(RANGE_POWER)
}

/// An energy that can be walked: held to [`ENERGIES`]; what is not a number becomes the least.
pub fn sane_energy(energy: f64) -> f64 {
    if energy.is_nan() { ENERGIES[0] } else { energy.clamp(ENERGIES[0], ENERGIES[1]) }
}

/// The cosine of the pitch angle from a uniform number in [0, 1): isotropic downward flux has weight 2µ, so µ = √u.
pub fn slope(uniform: f64) -> f64 {
    uniform.max(0.0).sqrt().clamp(LEAST_SLOPE, 1.0)
}

/// The share of its energy that an electron still has where the mass of air overhead is `overhead` (g cm⁻²), in [0, 1].
/// `reach` is µ R(E₀), the overhead at which it stops.
pub fn share_left(overhead: f64, reach: f64) -> f64 {
    (1.0 - overhead / reach).max(0.0).powf(1.0 / RANGE_POWER)
}

/// Collisions of 35 eV in a step in which the electron goes from `before` to `after` keV: a whole number whose mean over the uniform
/// number `random` is exactly (before − after)/35 eV.
pub fn collisions(before: f64, after: f64, random: f64) -> u32 {
    ((before - after).max(0.0) / PAIR_ENERGY + random).floor() as u32
}

/// What a spectrum is: electrons accelerated through a potential, and hot ones beyond it (an inverted V).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spectrum {
    /// Energy gained in the potential, keV.
    pub accelerated: f64,
    /// Thermal energy, keV.
    pub thermal: f64,
}

impl Spectrum {
    /// An energy (keV) from two uniform numbers in (0, 1]: flux φ ∝ E exp(−(E − E_acc)/E_th) for E ≥ E_acc.
    /// With x = E − E_acc the density is (E_acc + x) e^{−x/E_th}: an exponential with weight E_acc, a Gamma(2) with weight E_th.
    pub fn energy(&self, u: f64, v: f64, which: f64) -> f64 {
        let first = -u.max(1e-12).ln();
        let gamma = which * (self.accelerated + self.thermal) >= self.accelerated;
        let x = if gamma { first - v.max(1e-12).ln() } else { first };
        sane_energy(self.accelerated + self.thermal * x)
    }
}
