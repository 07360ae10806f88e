//! Rays from infinity: direction to swept angle in closed form, and back.

use super::angles::{launch, shadow_angle};
use super::orbit::{CRITICAL_ENERGY_SQUARED, Continued, PHOTON_SPHERE, critical_excess, shoot};
use super::solve::in_range;
use super::{Branch, Launch, join};

/// Φ∞, the angle that the ray seen at `psi_rain` (rain frame, in [0, π]) sweeps on its way from infinity to the camera at
/// `u_camera` = 1/L; None in the shadow, ψ ≥ [`shadow_angle`], where no such ray exists. It grows without bound towards the edge.
pub fn sky_angle(psi_rain: f64, u_camera: f64) -> Option<f64> {
    if !(in_range(u_camera) && psi_rain >= 0.0 && psi_rain < shadow_angle(u_camera)) {
        return None;
    }
    let ray = launch(psi_rain, u_camera);
    if !ray.slope.is_finite() || psi_rain == 0.0 {
        return Some(0.0);
    }
    swept_to_sky(ray.slope, ray.energy, u_camera)
}

/// As [`sky_angle`] for the ray of slope `slope` and energy `energy` at the camera (1/r_s); None if it does not escape.
///
/// By the addition theorem 4q(Φ∞) = ((e − w)/u)² + 1 − u, and Φ is the integral of dU/√(U³ − U² + e²) from there to infinity,
/// one R_F (Carlson; DLMF 19.29.19).
pub fn swept_to_sky(slope: f64, energy: f64, u_camera: f64) -> Option<f64> {
    let (w, e, u) = (slope, energy, u_camera);
    // The critical ray is seen at this slope from outside the photon sphere and from inside it.
    if !(in_range(u) && e > 0.0 && e.is_finite() && w < (PHOTON_SPHERE - u) * (u + 1.0 / 3.0).sqrt()) {
        return None;
    }
    let chord = if w > 0.0 { u * (1.0 - u) / (e + w) } else { (e - w) / u };
    let end = chord * chord + 1.0 - u;
    let slope_there = w - chord * (end - u);
    let root = lowest_root(e);
    let rest = to_pole(end, slope_there, root);
    if slope_there <= 0.0 {
        return Some(rest);
    }
    // Beyond the half period, which ends at the highest real root; the way to the next pole is the shorter rest.
    let d = excess(slope, energy, u);
    let discriminant = -48.0 * d * (1.0 + root) / ((root + 2.0 / 3.0) * (root + 2.0 / 3.0));
    let turning_point = if discriminant < 0.0 { -root } else { 0.5 * (1.0 + root + discriminant.sqrt()) };
    Some(2.0 * to_pole(turning_point, 0.0, root) - rest)
}

/// The slope w at the camera of the light from the sky that sweeps `swept` = Φ∞ > 0; None unless Φ∞ and `u_camera` are positive
/// and finite. The inverse of [`swept_to_sky`].
pub fn sky_slope(swept: f64, u_camera: f64) -> Option<f64> {
    join(0.0, swept, u_camera, Branch::Plus).map(|ray| ray.slope)
}

/// ∂Φ∞/∂w in r_s at the ray that is seen at `u_camera` and sweeps `swept` = Φ∞ from the sky; None if there is no such ray. While w grows
/// by dw, u at the far end grows by `by_slope` dw, and the sky is that much farther along the ray.
pub fn sky_rate(ray: Launch, swept: f64, u_camera: f64) -> Option<f64> {
    let Launch { slope, energy } = ray;
    match shoot(u_camera, slope, excess(slope, energy, u_camera), swept) {
        Continued::At(carried) => Some((carried.by_slope + carried.by_d * slope / 8.0) / energy),
        Continued::Escaped | Continued::Plunged => None,
    }
}

/// d = (e² − 4/27)/16 of a ray at `u`, by whichever of w and e tells it without cancellation.
fn excess(slope: f64, energy: f64, u: f64) -> f64 {
    if u < 1.0 { critical_excess(u, slope) } else { (energy * energy - CRITICAL_ENERGY_SQUARED) / 16.0 }
}

/// s > 0 of the lowest root U = −s of U³ − U² + e²: s²(1 + s) = e².
fn lowest_root(e: f64) -> f64 {
    // Newton from above on a convex function: never overshoots.
    let mut s = e.min(libm::cbrt(e) * libm::cbrt(e));
    for _ in 0..20 {
        let step = (s * s * (1.0 + s) - e * e) / (s * (2.0 + 3.0 * s));
        s -= step;
        if step.abs() <= 1e-9 * s {
            break;
        }
    }
    s
}

/// ∫ dU/√((U + s)(U² − (1 + s)U + s(1 + s))) from `from` to infinity; `slope` is plus or minus the root's value at `from`, which
/// near the critical ray is known better than U tells.
fn to_pole(from: f64, slope: f64, s: f64) -> f64 {
    let v = 2.0 * (s * (3.0 * s + 2.0)).sqrt();
    let quadratic = if from + s > 0.0 { slope.abs() / (from + s).sqrt() } else { 0.5 * v };
    let x = 2.0 * (quadratic + from) - 1.0 - s;
    let centre = x + 1.0 + 3.0 * s;
    4.0 * carlson_rf(x.max(0.0), centre + v, (centre - v).max(0.0))
}

/// Carlson's R_F by duplication (Carlson 1979, Numer. Math. 33, 1), relative error about 1e-15.
fn carlson_rf(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    // Each round quarters the differences; from any finite start a few dozen are enough.
    for _ in 0..1000 {
        let mean = (x + y + z) / 3.0;
        let (dx, dy) = (1.0 - x / mean, 1.0 - y / mean);
        let dz = -dx - dy;
        // The first term left out is of the eighth power.
        if dx.abs().max(dy.abs()).max(dz.abs()) < 0.012 || mean == 0.0 {
            let e2 = dx * dy - dz * dz;
            let e3 = dx * dy * dz;
            let series = 1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0 - 5.0 * e2 * e2 * e2 / 208.0
                + 3.0 * e3 * e3 / 104.0
                + e2 * e2 * e3 / 16.0;
            return series / mean.sqrt();
        }
        let (a, b, c) = (x.sqrt(), y.sqrt(), z.sqrt());
        let lambda = a * (b + c) + b * c;
        x = 0.25 * (x + lambda);
        y = 0.25 * (y + lambda);
        z = 0.25 * (z + lambda);
    }
    f64::NAN
}
