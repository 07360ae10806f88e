//! The spectral lines of an aurora: photons per ion pair by height, the delay of the light, and its colour.
//!
//! Four channels: green O(¹S) 557.7 nm; the first negative bands of N₂⁺ at 427.8 and 391.4 nm, blue and violet; red O(¹D) 630.0 and 636.4
//! nm; and the crimson first positive bands of N₂ (600 to 700 nm, taken as 650). Lines that share an upper state are one channel; its
//! photons are those of the first of them, and each line has its own Doppler shift. Rates: Solomon et al. 1988, as in GLOW (`gchem.f90`);
//! shares of the species: Rees 1989.
//!
//! Left out are lines without a ratio in those sources, or visible only when strongly shifted: N₂⁺ 470.9 nm, O(¹S) 297.2 nm, and the
//! infrared first positive bands.

use super::air::{Air, air};
use crate::scene::blackbody::matching;

/// Lines, in the order of every array of four here and in the shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Line {
    /// O(¹S) 557.7 nm.
    Green,
    /// N₂⁺ first negative bands; photons are those of 427.8 nm.
    Blue,
    /// O(¹D) 630.0 and 636.4 nm; photons are those of 630.0 nm.
    Red,
    /// N₂ first positive bands.
    Crimson,
}

impl Line {
    /// All of them, in order.
    pub const ALL: [Line; 4] = [Line::Green, Line::Blue, Line::Red, Line::Crimson];

    /// Its wavelengths in nm, each with its photons per photon of the first.
    pub fn bands(self) -> &'static [(f64, f64)] {
        match self {
            Line::Green => &[(557.7, 1.0)],
            Line::Blue => &[(427.8, 1.0), (391.4, VIOLET_BRANCH / BLUE_BRANCH)],
            Line::Red => &[(630.0, 1.0), (636.4, RED_OTHER / RED_RATE)],
            Line::Crimson => &[(650.0, 1.0)],
        }
    }
}

/// Radiative rates of O(¹S), s⁻¹: 557.7 nm, and 297.2 nm beside it.
const GREEN_RATE: f64 = 1.06;
const GREEN_OTHER: f64 = 0.045;
/// Radiative rates of O(¹D), s⁻¹: 630.0 and 636.4 nm.
const RED_RATE: f64 = 0.00585;
const RED_OTHER: f64 = 0.00185;
/// N₂⁺(B) per ionisation of N₂, and the parts of it that shine at 427.8 nm, the (0,1) band, and at 391.4 nm, the (0,0) band.
const ION_BRANCH: f64 = 0.11;
const BLUE_BRANCH: f64 = 0.20;
const VIOLET_BRANCH: f64 = 0.65;
/// O(¹D) made per ion pair: a middling value over direct excitation, recombination and transfer (crude: a factor 2 either way).
const RED_PER_PAIR: f64 = 0.5;
/// N₂(A) made per ion pair of N₂, with the cascade from above (crude).
const TRIPLET_PER_PAIR: f64 = 0.55;
/// O(¹S) per O₂⁺ that recombines (0.07 to 0.1), O₂⁺ taken as the share of ionised O₂.
const RECOMBINATION: f64 = 0.08;
/// O(¹S) per ionisation of O: direct excitation (crude: no source gives it alone, and it makes most of the green of electrons below 1 keV).
const DIRECT_GREEN: f64 = 0.05;
/// Visible photons of the first positive bands per ion pair of N₂ (crude: Vallance Jones 1974 gives 1PG in 600–700 nm of half of 557.7 nm).
const CRIMSON_PER_PAIR: f64 = 0.045;

/// Of O(¹S) by O, cm³ s⁻¹, and by O₂, cm³ s⁻¹ and K: k exp(T₀/T). As GLOW has them.
const GREEN_BY_O: f64 = 2.0e-14;
const GREEN_BY_O2: (f64, f64) = (4.0e-12, -865.0);
/// Of O(¹D) by N₂, O₂ and O, likewise.
const RED_BY_N2: (f64, f64) = (2.0e-11, 107.8);
const RED_BY_O2: (f64, f64) = (2.9e-11, 67.5);
const RED_BY_O: f64 = 3.0e-12;
/// Of N₂(A): the rate at which it hands its energy to O, cm³ s⁻¹, and the part of that which makes O(¹S); its own radiation (Vegard and
/// Kaplan's bands), s⁻¹; by O₂, cm³ s⁻¹. As GLOW has them.
const TRIPLET_TO_O: f64 = 3.1e-11;
const TRIPLET_YIELD: f64 = 0.19;
const TRIPLET_RATE: f64 = 0.77;
const TRIPLET_BY_O2: f64 = 4.1e-12;
/// How often N₂ and O are ionised for one O₂, by number (Rees 1989, table 3.4).
const IONISED_N2: f64 = 0.92;
const IONISED_O: f64 = 0.56;

/// A rate that goes with the temperature (K), cm³ s⁻¹.
fn rate((k, kelvin): (f64, f64), temperature: f64) -> f64 {
    k * (kelvin / temperature).exp()
}

/// Losses of O(¹S) by collisions at this air, s⁻¹.
fn green_quenching(air: &Air) -> f64 {
    GREEN_BY_O * air.o + rate(GREEN_BY_O2, air.temperature) * air.o2
}

/// Losses of O(¹D) by collisions at this air, s⁻¹. Electrons, below a hundredth of it, are left out.
fn red_quenching(air: &Air) -> f64 {
    rate(RED_BY_N2, air.temperature) * air.n2 + rate(RED_BY_O2, air.temperature) * air.o2 + RED_BY_O * air.o
}

/// Shares of ion pairs that N₂, O₂ and O have.
pub fn shares(air: &Air) -> [f64; 3] {
    let weights = [IONISED_N2 * air.n2, air.o2, IONISED_O * air.o];
    let total: f64 = weights.iter().sum();
    weights.map(|weight| weight / total)
}

/// Excited states (for the molecules: photons) made per ion pair, before quenching, by line.
fn production(air: &Air) -> [f64; 4] {
    let [n2, o2, o] = shares(air);
    let transfer = TRIPLET_TO_O * air.o;
    let to_oxygen = TRIPLET_YIELD * transfer / (transfer + TRIPLET_RATE + TRIPLET_BY_O2 * air.o2);
    [
        TRIPLET_PER_PAIR * n2 * to_oxygen + RECOMBINATION * o2 + DIRECT_GREEN * o,
        ION_BRANCH * BLUE_BRANCH * n2,
        RED_PER_PAIR,
        CRIMSON_PER_PAIR * n2,
    ]
}

/// The part of each excited state that ends as a photon of its line: branching and quenching.
fn survival(air: &Air) -> [f64; 4] {
    [GREEN_RATE / (GREEN_RATE + GREEN_OTHER + green_quenching(air)), 1.0, RED_RATE / (RED_RATE + RED_OTHER + red_quenching(air)), 1.0]
}

/// Photons per ion pair at height `z` (km), by line.
pub fn photons(z: f64) -> [f64; 4] {
    let air = air(z);
    let (made, seen) = (production(&air), survival(&air));
    std::array::from_fn(|k| made[k] * seen[k])
}

/// Mean time from the collision to the photon at height `z` (km), s, by line: green at most 0.9 s, red from milliseconds at 100 km to two
/// minutes, the molecules at once.
pub fn delays(z: f64) -> [f64; 4] {
    let air = air(z);
    [1.0 / (GREEN_RATE + GREEN_OTHER + green_quenching(&air)), 0.0, 1.0 / (RED_RATE + RED_OTHER + red_quenching(&air)), 0.0]
}

/// Planck's constant times c, J nm: the energy of a photon of wavelength λ nm is this over λ.
const HC: f64 = 1.986_445_857e-16;
/// Luminous efficacy at the peak of ȳ, lm/W.
const EFFICACY: f64 = 683.0;

/// CIE XYZ (Y in cd m⁻²) of each line where the first of its [`Line::bands`] has one kilorayleigh, with the others beside it, seen with the
/// frequency ratio `g` = ν_observed/ν_emitted: each band is seen at its own shifted wavelength. One rayleigh is 10¹⁰/4π photons m⁻² s⁻¹
/// sr⁻¹; photons are counted in the source's frame, and radiance goes as g⁴ (of which one power is the photon's energy): I/ν³ is invariant
/// and a line of width ∝ ν integrates to g⁴.
pub fn kilorayleigh_xyz(g: f64) -> [[f64; 3]; 4] {
    Line::ALL.map(|line| {
        let mut xyz = [0.0; 3];
        for (wavelength, photons) in line.bands() {
            let radiance = photons * 1e13 / (4.0 * std::f64::consts::PI) * HC / wavelength * g.powi(4);
            let weights = matching(wavelength / g);
            xyz = std::array::from_fn(|k| xyz[k] + EFFICACY * weights[k] * radiance);
        }
        xyz
    })
}
