//! Light in the vacuum around the hole, solved exactly: which ray joins a point to a camera, in which direction it is seen, how
//! long it travelled.
//!
//! A ray is followed from the camera backwards. u = 1/r, Φ is the angle swept since the camera, w = du/dΦ, and
//!
//! u″ = −u + 3/2 u²,  e² = w² + u² − u³  (Darwin 1959, Proc. R. Soc. A 249, 180),
//!
//! e = E/L being the inverse of the impact parameter: photon energy over angular momentum, so e < 0 where E < 0 (only inside the
//! horizon). `orbit` has u(Φ) in closed form, `solve` finds the w that meets a point, `delay` the travel time, `angles` the
//! directions that observers see, `sky` the rays that come from infinity.
//!
//! Lengths in r_s, times in r_s/c, angles in radians.

mod angles;
mod delay;
mod orbit;
mod sky;
mod solve;

pub use angles::{Launch, launch, rain_angle, rain_momentum, shadow_angle, static_angle, static_redshift};
pub use delay::{delay, zero_energy_delay};
pub use orbit::{SweepEnd, follow};
pub use sky::{sky_angle, sky_rate, sky_slope, swept_to_sky};
pub use solve::{join, join_near};

/// The sign of the photon's energy at infinity E. `Minus` exists only where both ends of the ray are inside the horizon; the same
/// path through space then belongs to two photons, emitted at two times and seen in two directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Branch {
    /// E > 0: every ray that has been outside, and the later of the two inside.
    Plus,
    /// E < 0: light that the hole never let out.
    Minus,
}

/// The order of an image: 1 the primary, 2 the secondary on the hole's other side, 3 the one after a full turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Order(u8);

impl Order {
    /// The orders that are drawn, nearest first.
    pub const ALL: [Order; 3] = [Order(1), Order(2), Order(3)];

    /// The order `n`, or None unless n is 1, 2 or 3.
    pub fn new(n: u8) -> Option<Order> {
        (1..=3).contains(&n).then_some(Order(n))
    }

    /// The number: 1, 2 or 3.
    pub fn number(self) -> u8 {
        self.0
    }

    /// Whether the image appears at the azimuth opposite to the point's (around the axis through hole and camera).
    pub fn flips(self) -> bool {
        self.0 == 2
    }

    /// Φ, the angle that the ray sweeps around the hole, for a point at the angle `phi` in [0, π] from the camera:
    /// φ, 2π − φ, 2π + φ.
    pub fn swept(self, phi: f64) -> f64 {
        use std::f64::consts::TAU;
        match self.0 {
            1 => phi,
            2 => TAU - phi,
            _ => TAU + phi,
        }
    }
}

/// A ray that joins a point to a camera, without its travel time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// w = du/dΦ at the camera, in 1/r_s: positive where the camera looks down into the hole.
    pub slope: f64,
    /// du/dΦ at the point, in the same sense of Φ, in 1/r_s.
    pub emission_slope: f64,
    /// e = E/L in 1/r_s, signed by the branch; |e| is the inverse of the impact parameter.
    pub energy: f64,
}

/// The ray that joins a point to the camera, followed from the camera backwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Connection {
    /// w = du/dΦ at the camera, in 1/r_s.
    pub slope: f64,
    /// du/dΦ at the point, in 1/r_s.
    pub emission_slope: f64,
    /// e = E/L in 1/r_s, signed by the branch: e² = w² + u² − u³ at either end.
    pub energy: f64,
    /// Painlevé–Gullstrand time of arrival minus that of emission, in r_s/c; infinite for u = 0.
    pub delay: f64,
}

/// The ray that joins the point at `u_point` = 1/r (0 is the sky) to the camera at `u_camera` = 1/L and sweeps the angle
/// `swept` = Φ > 0.
///
/// None where no such ray exists: a point at or under the horizon seen from outside, a point nearer to the hole than a camera
/// inside, a point inside beyond Φ = arccos(1 − 2r) − arccos(1 − 2L), branch minus with an end outside, or an argument out of
/// range (u outside 1e-30 to 1e6 but for u_point = 0, Φ outside 1e-30 to 30, not finite).
pub fn connect(u_point: f64, swept: f64, u_camera: f64, branch: Branch) -> Option<Connection> {
    let ray = join(u_point, swept, u_camera, branch)?;
    Some(Connection {
        slope: ray.slope,
        emission_slope: ray.emission_slope,
        energy: ray.energy,
        delay: delay(&ray, u_point, swept, u_camera),
    })
}
