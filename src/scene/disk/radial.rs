//! Functions of the radius alone: temperature after Page and Thorne, motion on orbits and inside them, density. r_s = c = 1.

use std::f64::consts::PI;

use crate::scene::config;
use crate::spacetime::orbit::{momentum_from_constants, orbital_frequency};
use glam::DVec3;

/// The last stable circular orbit, in r_s.
pub const LAST_ORBIT: f64 = 3.0;
/// Energy and angular momentum per mass of the last stable orbit: √(8/9) and √3 r_s.
const PLUNGE: (f64, f64) = (0.942_809_041_582_063_4, 1.732_050_807_568_877_2);
/// Width, in r_s, over which the carried heat fades outside that orbit (a Gaussian's scale), and the power by which the hotter of two
/// temperatures wins without a kink. By hand: 0.25 r_s from the edge the value of Page & Thorne 1974 is right to a part in 10⁷.
const CARRIED_WIDTH: f64 = 0.2;
/// See [`CARRIED_WIDTH`].
const WINS: i32 = 8;
/// Width, in r_s, over which gas thins out at the inner edge: of a disk that ends outside the last stable orbit, and of one that falls in.
/// By hand, so that the edge is no hard line.
const INNER_FADE: [f64; 2] = [0.1, 0.4];
/// Least part of light that comes through where the key `opacity` asks for none: e⁻⁷.
const LEAST_THROUGH: f64 = 1e-3;
/// Inner edge of the falling gas as drawn, in r_s: farther in it has less than a hundredth of the disk's density, and its light is
/// redshifted away.
const PLUNGE_END: f64 = 1.25;
/// Speed, in c, at which friction lets gas drift in at the last stable orbit; chosen by hand. Falling gas thins out as its speed grows
/// beyond this, and what is behind becomes visible.
const DRIFT: f64 = 0.002;
/// Share of the disk's width, from its outer edge, over which the gas thins out. By hand.
const OUTER_FADE: f64 = 0.35;
/// Temperature of the gas at the last stable orbit over that of the hottest ring. By Page & Thorne 1974 no torque acts there and the
/// surface is cold. Moving gas keeps heat; the falling part is visible by it.
const CARRIED_HEAT: f64 = 0.5;

// SI, CODATA 2018 and IAU 2015.
const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;
/// GM☉/c², in m.
const SOLAR_LENGTH: f64 = 1_476.625_038;
/// Eddington luminosity of one solar mass, 4πGM☉ m_p c/σ_T, in W.
const EDDINGTON: f64 = 1.256_6e31;

/// Flux of a disk round a hole without spin, times M²/Ṁ (G = c = 1), at x = r/M > 6: Page & Thorne 1974, eq. 15n, with the logarithm's
/// factor √3/2. Zero at x ≤ 6.
pub fn page_thorne_flux(x: f64) -> f64 {
    if x <= 6.0 {
        return 0.0;
    }
    let (root, s3, s6) = (x.sqrt(), 3f64.sqrt(), 6f64.sqrt());
    let logarithm = ((root + s3) * (s6 - s3) / ((root - s3) * (s6 + s3))).ln();
    3.0 / (8.0 * PI) / ((x - 3.0) * x * x * root) * (root - s6 + 0.5 * s3 * logarithm)
}

/// The greatest value of [`page_thorne_flux`], at x = 9.550928.
const PEAK_FLUX: f64 = 1.367_811e-5;

/// Temperature, motion and density over the radius.
#[derive(Clone, Debug)]
pub struct Radial {
    inner: f64,
    outer: f64,
    /// Temperature of the hottest ring of Page and Thorne's disk, in K.
    peak: f64,
    /// Optical depth straight through the disk.
    depth: f64,
    /// [`Radial::lag`] at equal steps of √(3 − r).
    lags: Vec<f64>,
}

/// Steps of the table of lags.
const LAG_STEPS: usize = 64;

impl Radial {
    /// From the keys of `[disk]` and the hole's mass.
    pub fn new(disk: &config::Disk, mass_solar: f64) -> Radial {
        let flow = disk.accretion_rate * EDDINGTON * mass_solar / disk.efficiency;
        let length = SOLAR_LENGTH * mass_solar;
        Radial {
            inner: disk.inner,
            outer: disk.outer.max(disk.inner + 0.1),
            peak: (PEAK_FLUX * flow / (length * length) / STEFAN_BOLTZMANN).powf(0.25),
            depth: -(1.0 - disk.opacity).max(LEAST_THROUGH).ln(),
            lags: lags(),
        }
    }

    /// The radii between which there is gas, in r_s. A disk that reaches the last stable orbit continues inside it as falling gas.
    pub fn extent(&self) -> [f64; 2] {
        let inner = if self.inner <= LAST_ORBIT { PLUNGE_END } else { self.inner };
        [inner, self.outer]
    }

    /// Temperature at radius `r`, in K, of gas of mean density.
    pub fn temperature(&self, r: f64) -> f64 {
        let disk = (page_thorne_flux(2.0 * r) / PEAK_FLUX).powf(0.25);
        let carried = CARRIED_HEAT
            * if r < LAST_ORBIT {
                // Thinner gas radiates less: the temperature goes as the fourth root of the density, as everywhere.
                thinning(r).powf(0.25)
            } else {
                (-((r - LAST_ORBIT) / CARRIED_WIDTH).powi(2)).exp()
            };
        // The hotter of the two.
        self.peak * (disk.powi(WINS) + carried.powi(WINS)).powf(1.0 / f64::from(WINS))
    }

    /// Optical depth straight through gas of mean density at radius `r`.
    pub fn depth(&self, r: f64) -> f64 {
        let [start, end] = self.extent();
        if !(r > start && r < end) {
            return 0.0;
        }
        let fade = smoothstep(end, end - OUTER_FADE * (end - self.inner), r);
        if self.inner > LAST_ORBIT {
            return self.depth * fade * smoothstep(start, start + INNER_FADE[0], r);
        }
        let falling = if r < LAST_ORBIT { thinning(r) * smoothstep(start, start + INNER_FADE[1], r) } else { 1.0 };
        self.depth * fade * falling
    }

    /// Rain-frame momentum per mass of the gas, (outward, along the rotation): of the circular orbit, or of the plunge inside the last.
    pub fn momentum(&self, r: f64) -> [f64; 2] {
        if r < LAST_ORBIT {
            let (_, outward) = plunge(r);
            return [outward, PLUNGE.1 / r];
        }
        let (energy, angular) = ((r - 1.0) / (r * (r - 1.5)).sqrt(), r / (2.0 * r - 3.0).sqrt());
        let p = momentum_from_constants(energy, angular, r, 0.0, DVec3::X, DVec3::Y);
        [p.x, p.y]
    }

    /// dφ/dT of the pattern, in c/r_s: Ω = 1/√(2r³); inside the last stable orbit that of this orbit.
    pub fn turning_rate(&self, r: f64) -> f64 {
        orbital_frequency(self.pattern_radius(r))
    }

    /// The radius whose pattern the gas at `r` shows, in r_s: gas inside the last stable orbit came from that orbit.
    pub fn pattern_radius(&self, r: f64) -> f64 {
        r.max(LAST_ORBIT)
    }

    /// Azimuth, in rad, by which falling gas at `r` is ahead of the last stable orbit that it left, while that turns on: ∫(dφ − Ω dT) along
    /// the plunge. With it every part of the pattern falls on a geodesic.
    pub fn lag(&self, r: f64) -> f64 {
        if r >= LAST_ORBIT {
            return 0.0;
        }
        let position = (LAST_ORBIT - r).max(0.0).sqrt() / lag_step();
        let k = (position as usize).min(LAG_STEPS - 1);
        self.lags[k] + (position - k as f64) * (self.lags[k + 1] - self.lags[k])
    }
}

/// (dr/dτ, rain-frame outward momentum per mass) of gas that fell from the last stable orbit: dr/dτ = −(3/r − 1)^{3/2}/3.
fn plunge(r: f64) -> (f64, f64) {
    let (energy, angular) = PLUNGE;
    let speed = (LAST_ORBIT / r - 1.0).max(0.0).powf(1.5) / 3.0;
    (-speed, (1.0 + (angular / r).powi(2) - energy * energy) / (energy / r.sqrt() + speed))
}

/// Density of falling gas over that at the last stable orbit: the same mass passes every circle.
fn thinning(r: f64) -> f64 {
    DRIFT / (DRIFT - plunge(r).0)
}

fn lag_step() -> f64 {
    (LAST_ORBIT - 1.0).sqrt() / LAG_STEPS as f64
}

/// The integral by Simpson's rule over s = √(3 − r), in which its integrand is smooth.
fn lags() -> Vec<f64> {
    let (energy, angular) = PLUNGE;
    let rate = orbital_frequency(LAST_ORBIT);
    let integrand = |s: f64| {
        // The integrand at the end is that of its neighbourhood: both its parts vanish there.
        let r = LAST_ORBIT - s.max(1e-3) * s.max(1e-3);
        let (fall, outward) = plunge(r);
        let gamma = energy + outward / r.sqrt();
        (angular / (r * r) - rate * gamma) / -fall * 2.0 * s.max(1e-3)
    };
    let h = lag_step();
    let mut total = 0.0;
    std::iter::once(0.0)
        .chain((0..LAG_STEPS).map(|k| {
            let s = k as f64 * h;
            total += h / 6.0 * (integrand(s) + 4.0 * integrand(s + 0.5 * h) + integrand(s + h));
            total
        }))
        .collect()
}

/// 0 at `from`, 1 at `to`, smooth between, whichever is greater.
pub fn smoothstep(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::GameConfig;

    /// The pattern must not tear at the last stable orbit: at r = 1 a bit of gas has gained some tenths of a turn.
    #[test]
    fn the_lag_starts_at_zero_and_grows() {
        let radial = Radial::new(&GameConfig::default().disk, 1e10);
        assert!(radial.lag(2.999).abs() < 0.15, "{}", radial.lag(2.999));
        let lags: Vec<f64> = (0..20).map(|k| radial.lag(3.0 - 0.1 * f64::from(k))).collect();
        assert!(lags.windows(2).all(|pair| pair[1] > pair[0]), "{lags:?}");
    }
}
