//! When the light left by which something is seen: the ray to the camera in f64, and the root of T − T_e = delay(x(T_e)).

use glam::DVec3;

use crate::render::instances::view::View;
use crate::render::method::Method;
use crate::render::settings::Settings;
use crate::sim::History;
use crate::spacetime::Observer;
use crate::spacetime::light::{self, Branch, Order};

/// The emission time of the centre of a flying body that is seen at `time`, as the settings ask for; None if it is not seen.
pub fn departure(view: &View, time: f64, history: &History, order: Order) -> Option<f64> {
    match view.settings {
        Settings { light_delay: false, .. } => Some(time),
        Settings { method: Method::Flat, .. } => flat_emission_time(view.camera, time, history),
        _ => emission_time(view.camera, time, history, order),
    }
}

/// Travel time of light of this order from a position on the slice to the camera, in r_s/c, and its gradient over the position. None if
/// there is no ray.
pub fn light_path(camera: &Observer, position: DVec3, order: Order, branch: Branch) -> Option<(f64, DVec3)> {
    let (l, r) = (camera.radius(), position.length());
    let n = camera.position / l;
    let across = position - n * position.dot(n);
    let phi = across.length().atan2(position.dot(n)).max(1e-12);
    let ray = light::connect(1.0 / r, order.swept(phi), 1.0 / l, branch)?;
    // dΔ/dx = −k/E at the point, k the photon's spatial momentum there.
    let side = across.try_normalize().unwrap_or_else(|| n.any_orthonormal_vector());
    let turn = if order.flips() { -1.0 } else { 1.0 };
    let m = position / r;
    let tangent = (side * (m.dot(n)) - n * m.dot(side)) * turn;
    let (u, w, e) = (1.0 / r, ray.emission_slope, ray.energy);
    let beta = u.sqrt();
    let radial = if e > 0.0 && (w < 0.0 || u >= 1.0) { (u * u - e * e) / (beta * e - w) } else { (beta * e + w) / (1.0 - u) };
    let momentum = (m * radial - tangent * u) / e;
    ray.delay.is_finite().then_some((ray.delay, -momentum))
}

/// Which of the two rays from a position inside the horizon to a camera inside belongs to light of this age (r_s/c): E < 0 if it is older
/// than light of zero energy.
pub fn branch_of(camera: &Observer, position: DVec3, age: f64) -> Branch {
    let (u, u_camera) = (1.0 / position.length(), 1.0 / camera.radius());
    if u > 1.0 && u_camera > 1.0 && age > light::zero_energy_delay(u, u_camera) { Branch::Minus } else { Branch::Plus }
}

/// The emission time T_e of light that arrives at `time`: the root of T_e + Δ(x(T_e)) − T. It increases strictly with T_e for light of E >
/// 0 and decreases for E < 0. A worldline leaves the camera's past only once, so both branches together have one root. None if the object
/// is not seen.
pub fn emission_time(camera: &Observer, time: f64, history: &History, order: Order) -> Option<f64> {
    leaving(time, |t| {
        let sample = history.at(t);
        let branch = branch_of(camera, sample.position, time - t);
        let (delay, gradient) = light_path(camera, sample.position, order, branch)?;
        let sign = if branch == Branch::Minus { -1.0 } else { 1.0 };
        Some((sign * (t + delay - time), sign * (1.0 + gradient.dot(sample.velocity))))
    })
}

/// The same for straight light.
fn flat_emission_time(camera: &Observer, time: f64, history: &History) -> Option<f64> {
    leaving(time, |t| {
        let sample = history.at(t);
        let line = sample.position - camera.position;
        // Seen across the hole a ship may fall faster than straight light.
        Some((t + line.length() - time, (1.0 + line.normalize_or_zero().dot(sample.velocity)).max(0.05)))
    })
}

/// The root of an increasing function of T_e, given with its slope. It is negative in the camera's past and has no value where no light
/// leaves any more. Newton's method within a bracket, from `time` backwards.
fn leaving(time: f64, late: impl Fn(f64) -> Option<(f64, f64)>) -> Option<f64> {
    let (mut low, mut high) = (f64::NEG_INFINITY, time);
    let mut t = time - late(time).map_or(1.0, |(missing, _)| missing.max(0.0));
    for _ in 0..100 {
        let next = match late(t) {
            // For a camera outside, a body below the horizon has no ray: too late.
            None => {
                high = high.min(t);
                if low.is_finite() { 0.5 * (low + high) } else { t - (time - t).max(1.0) }
            }
            Some((missing, slope)) => {
                if missing > 0.0 {
                    high = high.min(t)
                } else {
                    low = low.max(t)
                }
                // 1e-12 of the delay: f64 has no more.
                if missing.abs() <= 1e-12 * (1.0 + (time - t).abs()) {
                    return Some(t);
                }
                let newton = t - missing / slope.max(1e-3);
                if newton > low && newton < high {
                    newton
                } else if low.is_finite() {
                    0.5 * (low + high)
                } else {
                    t - 2.0 * (time - t).max(1.0)
                }
            }
        };
        if next == t || time - next > 1e7 {
            break;
        }
        t = next;
    }
    // The bracket has closed on a position without a ray, or to rounding.
    (low.is_finite() && high - low <= 1e-9 * (1.0 + (time - low).abs())).then_some(low)
}
