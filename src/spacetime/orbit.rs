//! Free orbits: states from orbit elements, r_s = c = 1. Oracles: Chandrasekhar, *The Mathematical Theory of Black Holes*, section 19.

use glam::{DQuat, DVec3};

use super::matter::{ShipState, angular_momentum, barrier, energy, gamma};
use super::metric::river_speed;

/// Where an orbit lies and where on it the ship is. All angles in radians.
///
/// The reference plane is z = 0 with directions counted from +x towards +y. Inclination 0 goes round counter-clockwise seen from +z,
/// π clockwise (retrograde).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elements {
    /// Semi-latus rectum in r_s: apsides at p/(1+e) and p/(1−e). A circle has its radius here.
    pub semi_latus_rectum: f64,
    /// Eccentricity in [0, 1); 0 is a circle.
    pub eccentricity: f64,
    /// Angle between the orbit's plane and z = 0, in [0, π].
    pub inclination: f64,
    /// Azimuth of the ascending node, where the ship passes z = 0 upwards.
    pub node: f64,
    /// Angle at the hole from the ascending node to the ship, along its motion.
    pub phase: f64,
    /// χ in r = p/(1 + e cos χ): 0 at the periapsis, π at the apoapsis, outbound between.
    pub anomaly: f64,
}

/// Why there is no such orbit.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum OrbitError {
    /// No circular orbit at or under the photon sphere.
    #[error("a circular orbit needs a radius above 1.5 r_s (the photon sphere), not {radius}")]
    Circle {
        /// The radius asked for, in r_s.
        radius: f64,
    },
    /// Periapsis under the unstable orbit, or not a bound ellipse.
    #[error(
        "an eccentric orbit needs 0 <= eccentricity < 1 and semi_latus_rectum >= 3 + eccentricity r_s, not eccentricity {eccentricity}, semi_latus_rectum {semi_latus_rectum}"
    )]
    Eccentric {
        /// The semi-latus rectum asked for, in r_s.
        semi_latus_rectum: f64,
        /// The eccentricity asked for.
        eccentricity: f64,
    },
}

impl Elements {
    /// A circle of radius `radius` (r_s) in the plane z = 0, counter-clockwise from +z, the ship at azimuth `phase`.
    pub fn circle(radius: f64, phase: f64) -> Self {
        Elements { semi_latus_rectum: radius, eccentricity: 0.0, inclination: 0.0, node: 0.0, phase, anomaly: 0.0 }
    }

    /// (E, L) per mass: E² = 2[(p−1)² − e²]/[p(2p−3−e²)], L² = p²/(2p−3−e²).
    pub fn constants(&self) -> Result<(f64, f64), OrbitError> {
        let (p, e) = (self.semi_latus_rectum, self.eccentricity);
        if e == 0.0 && !(p > 1.5 && p.is_finite()) {
            return Err(OrbitError::Circle { radius: p });
        }
        if e != 0.0 && !((0.0..1.0).contains(&e) && p >= 3.0 + e && p.is_finite()) {
            return Err(OrbitError::Eccentric { semi_latus_rectum: p, eccentricity: e });
        }
        let denominator = 2.0 * p - 3.0 - e * e;
        let energy_squared = 2.0 * ((p - 1.0) * (p - 1.0) - e * e) / (p * denominator);
        Ok((energy_squared.sqrt(), p / denominator.sqrt()))
    }

    /// The ship's state, its body axes along the rain axes.
    pub fn state(&self) -> Result<ShipState, OrbitError> {
        let (energy, momentum) = self.constants()?;
        let (p, e) = (self.semi_latus_rectum, self.eccentricity);
        let r = p / (1.0 + e * libm::cos(self.anomaly));
        // (dr/dτ)² = E² − (1 − 1/r)(1 + L²/r²) without its cancellation at the apsides: in u = 1/r it is
        // L²(du/dφ)² = L²(u − u₁)(u₂ − u)(u₃ − u) with u₁,₂ = (1 ∓ e)/p, u₃ = 1 − 2/p, and the first two factors are (e sin χ/p)².
        let u3 = 1.0 - 2.0 / p;
        let radial = momentum * (e / p) * libm::sin(self.anomaly) * (u3 - 1.0 / r).max(0.0).sqrt();
        let plane = DQuat::from_rotation_z(self.node) * DQuat::from_rotation_x(self.inclination);
        let outward = plane * DVec3::new(libm::cos(self.phase), libm::sin(self.phase), 0.0);
        let along = plane * DVec3::new(-libm::sin(self.phase), libm::cos(self.phase), 0.0);
        Ok(ShipState::new(outward * r, momentum_from_constants(energy, momentum, r, radial, outward, along)))
    }
}

/// Rain-frame momentum at radius `r` > 1 from E, L, u^r = dr/dτ (all per mass) and the unit vectors outward and along the transverse
/// motion: p_r = (u^r + βE)/(1 − β²), p_φ = L/r.
pub fn momentum_from_constants(energy: f64, angular_momentum: f64, r: f64, radial_velocity: f64, outward: DVec3, along: DVec3) -> DVec3 {
    let beta = river_speed(r);
    outward * ((radial_velocity + beta * energy) / (1.0 - beta * beta)) + along * (angular_momentum / r)
}

/// A circular free orbit of radius `radius` (r_s) in z = 0, counter-clockwise seen from +z, at azimuth `phase` (rad).
pub fn circular_orbit(radius: f64, phase: f64) -> Result<ShipState, OrbitError> {
    Elements::circle(radius, phase).state()
}

/// Ω = dφ/dT = 1/√(2r³) of a circular free orbit, in c/r_s.
pub fn orbital_frequency(radius: f64) -> f64 {
    1.0 / (2.0 * radius * radius * radius).sqrt()
}

/// The lowest radius, in r_s, of the free fall of a body in this state from now on; None where it ends in the hole.
///
/// (dr/dτ)² = E² − (1 − u)(1 + L²u²) with u = 1/r: the turning point is the first zero inwards, found to 1 % of r and then halved down to
/// 10⁻⁶. Who flies outwards for ever is as low as now.
pub fn lowest_radius(state: &ShipState) -> Option<f64> {
    let r = state.position.length();
    let (e, l) = (energy(state), angular_momentum(state).length());
    let square = |u: f64| e * e - (1.0 - u) * (1.0 + l * l * u * u);
    let outwards = state.position.dot(state.momentum) / r > gamma(state.momentum) * river_speed(r);
    if r <= 1.0 {
        return None;
    }
    // Within the barrier it may turn back.
    if outwards && e >= 1.0 && barrier(l * l).is_none_or(|[peak, height]| r >= peak || e * e > height) {
        return Some(r);
    }
    let (mut outer, step) = (1.0 / r, 1.01);
    while outer < 1.0 {
        let inner = (outer * step).min(1.0);
        if square(inner) < 0.0 {
            let (mut low, mut high) = (outer, inner);
            while high - low > 1e-6 * high {
                let middle = 0.5 * (low + high);
                if square(middle) < 0.0 { high = middle } else { low = middle }
            }
            return Some(1.0 / low);
        }
        outer = inner;
    }
    None
}

/// Rain-frame momentum of an observer hovering at `position`: p = nβ/√(1 − β²). None where none exists (r ≤ 1).
pub fn static_momentum(position: DVec3) -> Option<DVec3> {
    let r = position.length();
    let beta = river_speed(r);
    (r > 1.0).then(|| position * (beta / (r * (1.0 - beta * beta).sqrt())))
}

/// Rain-frame momentum of the circular free orbit through `position` in the plane spanned with `along` (any vector not parallel to it),
/// turning towards `along`. None for r ≤ 1.5 or a degenerate plane.
pub fn circular_momentum(position: DVec3, along: DVec3) -> Option<DVec3> {
    let r = position.length();
    let outward = position / r;
    let along = (along - outward * along.dot(outward)).try_normalize()?;
    let (energy, angular_momentum) = Elements::circle(r, 0.0).constants().ok()?;
    Some(momentum_from_constants(energy, angular_momentum, r, 0.0, outward, along))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fall_is_lowest_at_the_periapsis() {
        for anomaly in [0.5, 2.0, 3.0, 4.5] {
            let ellipse = Elements { eccentricity: 0.4, semi_latus_rectum: 7.0, anomaly, ..Elements::circle(7.0, 0.3) };
            let lowest = lowest_radius(&ellipse.state().expect("an orbit")).expect("it does not fall in");
            assert!((lowest - 5.0).abs() < 1e-4, "{anomaly}: {lowest}");
        }
        let circle = circular_orbit(6.0, 1.0).expect("a circle");
        assert!(lowest_radius(&circle).is_some_and(|lowest| (lowest - 6.0).abs() < 0.1));
        let rain = ShipState::new(DVec3::X * 6.0, DVec3::ZERO);
        assert_eq!(lowest_radius(&rain), None);
        let away = ShipState::new(DVec3::X * 6.0, DVec3::X * 3.0);
        assert_eq!(lowest_radius(&away), Some(6.0));
        // Outwards from within the barrier of a great L, not over it: it turns and falls in.
        let outward = momentum_from_constants(1.1, 2.6, 1.2, 0.5, DVec3::X, DVec3::Y);
        assert_eq!(lowest_radius(&ShipState::new(DVec3::X * 1.2, outward)), None);
    }
}
