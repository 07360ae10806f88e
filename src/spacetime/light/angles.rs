//! Directions and frequencies: what observers make of a ray.
//!
//! At either end of a ray take the outward radial direction and the tangential direction of increasing Φ. Light followed backwards
//! has du/dΦ = w; the photon itself runs the other way, towards −Φ.

use super::orbit::{CRITICAL_ENERGY_SQUARED, PHOTON_SPHERE};

/// The photon's momentum in the rain frame (falling from rest at infinity) per angular momentum, (radial, tangential), in 1/r_s,
/// at u on the ray of slope w and energy e. The tangential part is −u; the length is the frequency that the rain frame measures,
/// while e is the frequency at infinity. The look direction is the opposite one.
pub fn rain_momentum(slope: f64, energy: f64, u: f64) -> [f64; 2] {
    [-look_radial(slope, energy, u), -u]
}

/// The radial part of the look direction whose tangential part is u, rain frame: (βe + w)/(u − 1), or the same without
/// cancellation for ingoing light.
fn look_radial(w: f64, e: f64, u: f64) -> f64 {
    let beta = u.sqrt();
    if w > 0.0 || e < 0.0 { (beta * e + w) / (u - 1.0) } else { (e - u) * (e + u) / (beta * e - w) }
}

/// ψ in the rain frame, in [0, π] from the outward radial direction, of the light that reaches u = 1/r with slope `slope` and
/// energy `energy` (both 1/r_s).
pub fn rain_angle(slope: f64, energy: f64, u: f64) -> f64 {
    libm::atan2(u, look_radial(slope, energy, u))
}

/// ψ in the frame of a static observer, in [0, π] from the outward radial direction; None at and under the horizon, where nothing
/// is static. The energy plays no part: e² = w² + u² − u³.
pub fn static_angle(slope: f64, _energy: f64, u: f64) -> Option<f64> {
    (u < 1.0).then(|| libm::atan2(u * (1.0 - u).sqrt(), -slope))
}

/// A ray as it leaves the camera, backwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Launch {
    /// w = du/dΦ in 1/r_s.
    pub slope: f64,
    /// e = E/L in 1/r_s; negative only inside.
    pub energy: f64,
}

/// The ray that a rain-frame observer at u = 1/r sees at ψ in (0, π): the inverse of [`rain_angle`]. Both numbers grow without
/// bound towards the radial directions.
pub fn launch(psi_rain: f64, u: f64) -> Launch {
    let beta = u.sqrt();
    let (sin, cos) = libm::sincos(psi_rain);
    Launch { slope: -u * (beta + cos) / sin, energy: u * (1.0 + beta * cos) / sin }
}

/// ψ in the rain frame of the edge of the shadow for a camera at `u_camera` = 1/L, outside or inside; the shadow is ψ greater than that.
/// It is the ray from the photon sphere (Synge 1966 for a static camera).
pub fn shadow_angle(u_camera: f64) -> f64 {
    let slope = (PHOTON_SPHERE - u_camera) * (u_camera + 1.0 / 3.0).sqrt();
    rain_angle(slope, CRITICAL_ENERGY_SQUARED.sqrt(), u_camera)
}

/// ν_observed/ν_emitted between a static emitter at `u_point` and a static camera at `u_camera`; None unless both are outside.
pub fn static_redshift(u_point: f64, u_camera: f64) -> Option<f64> {
    (u_point < 1.0 && u_camera < 1.0).then(|| ((1.0 - u_point) / (1.0 - u_camera)).sqrt())
}
