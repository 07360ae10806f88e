//! Which images of a planet are seen through the accretion disk. They are added to the picture before the disk is laid over it, so the disk
//! dims them.

use crate::spacetime::Observer;
use glam::DVec3;

use crate::spacetime::light::{Branch, Order, join};

/// Steps of the integration, in radians: the radius at which light crosses the plane is right to a millionth.
const STEP: f64 = 0.02;

/// Tells the radii, in r_s, at which light from `position` crosses the plane z = 0 on its way to the camera; `bends` is false in flat space.
pub fn crossings(camera: &Observer, position: DVec3, order: Order, bends: bool, mut tell: impl FnMut(f64)) {
    let (l, r) = (camera.radius(), position.length());
    if !bends {
        let part = camera.position.z / (camera.position.z - position.z);
        if (0.0..1.0).contains(&part) {
            tell(camera.position.lerp(position, part).length());
        }
        return;
    }
    let n = camera.position / l;
    let across = position - n * position.dot(n);
    let side = across.try_normalize().unwrap_or_else(|| n.any_orthonormal_vector()) * if order.flips() { -1.0 } else { 1.0 };
    let swept = order.swept(across.length().atan2(position.dot(n)).max(1e-12));
    let Some(ray) = join(1.0 / r, swept, 1.0 / l, Branch::Plus) else { return };
    // The ray is at the angle Φ in the direction n cos Φ + side sin Φ; followed backwards from the camera: u″ = 3u²/2 − u.
    let height = |angle: f64| n.z * angle.cos() + side.z * angle.sin();
    let steps = (swept / STEP).ceil().max(1.0);
    let step = swept / steps;
    let force = |u: f64| 1.5 * u * u - u;
    let (mut u, mut slope) = (1.0 / l, ray.slope);
    let mut low = height(0.0);
    for k in 0..steps as u32 {
        let before = u;
        let (a, b) = (slope, force(u));
        let (c, d) = (slope + 0.5 * step * b, force(u + 0.5 * step * a));
        let (e, f) = (slope + 0.5 * step * d, force(u + 0.5 * step * c));
        let (g, h) = (slope + step * f, force(u + step * e));
        u += step / 6.0 * (a + 2.0 * c + 2.0 * e + g);
        slope += step / 6.0 * (b + 2.0 * d + 2.0 * f + h);
        let high = height(f64::from(k + 1) * step);
        if low * high < 0.0 {
            let part = low / (low - high);
            tell(1.0 / (before + (u - before) * part));
        }
        low = high;
    }
}

/// Whether the disk between two radii is in front of the position as seen in this order.
pub fn is_behind(camera: &Observer, position: DVec3, order: Order, bends: bool, [inner, outer]: [f64; 2]) -> bool {
    let mut is_behind = false;
    crossings(camera, position, order, bends, |radius| is_behind |= (inner..outer).contains(&radius));
    is_behind
}
