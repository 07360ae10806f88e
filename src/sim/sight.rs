//! What light brings: when the light left by which a ship is seen, and where its image appears. The ray to the observer in closed form,
//! in f64, and the root of T − T_e = delay(x(T_e)).

use glam::{DQuat, DVec3};

use super::history::History;
use crate::spacetime::light::{self, Branch, Order};
use crate::spacetime::{Observer, frames};

/// A ship as an observer sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apparition {
    /// Towards its image, in the observer's axes (−z forward), of unit length.
    pub direction: DVec3,
    /// Age of the light in T, in r_s/c.
    pub age: f64,
}

/// The image of this order of the ship with the worldline `history`, seen at T = `time`; None where no light of it arrives.
pub fn apparition(camera: &Observer, time: f64, history: &History, order: Order) -> Option<Apparition> {
    let emitted = emission_time(camera, time, history, order)?;
    let position = history.at(emitted).position;
    Some(Apparition { direction: direction(camera, position, order, time - emitted)?, age: time - emitted })
}

/// The attitude in which `camera` has the image of order 1 of that ship in the middle, and `up` (rain axes) upwards; None where it is not
/// seen. The camera is to stay where it is as it turns.
pub fn facing(camera: &Observer, time: f64, history: &History, up: DVec3) -> Option<DQuat> {
    let seen = apparition(camera, time, history, Order::ALL[0])?.direction;
    frames::look(camera.attitude * seen, up)
}

/// Where light from `position` (on the slice of its emission), `age` r_s/c old, is seen, in the observer's axes.
pub fn direction(camera: &Observer, position: DVec3, order: Order, age: f64) -> Option<DVec3> {
    let (l, r) = (camera.radius(), position.length());
    let outward = camera.position / l;
    let across = position - outward * position.dot(outward);
    let phi = across.length().atan2(position.dot(outward)).max(1e-12);
    let ray = light::connect(1.0 / r, order.swept(phi), 1.0 / l, branch_of(camera, position, age))?;
    let psi = light::rain_angle(ray.slope, ray.energy, 1.0 / l);
    let side = across.try_normalize().unwrap_or_else(|| outward.any_orthonormal_vector());
    let side = if order.flips() { -side } else { side };
    Some(camera.seen_direction(outward * psi.cos() + side * psi.sin()))
}

/// The direction to where the ship really is on the slice T = const, as if light were straight and at once, in the observer's axes.
pub fn true_direction(camera: &Observer, position: DVec3) -> Option<DVec3> {
    (position - camera.position).try_normalize().map(|line| camera.attitude.conjugate() * line)
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

/// The root of an increasing function of T_e, given with its slope. It is negative in the camera's past and has no value where no light
/// leaves any more. Newton's method within a bracket, from `time` backwards.
pub fn leaving(time: f64, late: impl Fn(f64) -> Option<(f64, f64)>) -> Option<f64> {
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
#[cfg(test)]
mod tests {
    use super::*;
    use crate::spacetime::orbit::static_momentum;

    fn hovering(position: DVec3) -> Observer {
        Observer { position, momentum: static_momentum(position).unwrap_or_default(), attitude: DQuat::IDENTITY, field_of_view: 1.0 }
    }

    #[test]
    fn far_from_the_hole_light_is_straight() {
        let camera = hovering(DVec3::new(0.0, 3.0e6, 2.0e6));
        let there = camera.position + DVec3::new(100.0, 50.0, -300.0);
        let seen = direction(&camera, there, Order::ALL[0], 0.0).expect("seen");
        let straight = true_direction(&camera, there).expect("apart");
        // Bending by 1/r and aberration by the rain's 1/√r, 5e-4, which hovering undoes but for its square.
        assert!(seen.angle_between(straight) < 2e-3, "{seen} {straight}");
    }

    #[test]
    fn the_second_image_is_on_the_other_side() {
        let camera = hovering(DVec3::Z * 10.0);
        let there = DVec3::new(4.0, 0.0, -6.0);
        let first = direction(&camera, there, Order::ALL[0], 0.0).expect("first");
        let second = direction(&camera, there, Order::ALL[1], 0.0).expect("second");
        assert!(first.x > 0.0 && second.x < 0.0, "{first} {second}");
        assert!(first.y.abs() < 1e-9 && second.y.abs() < 1e-9);
    }

    #[test]
    fn light_is_as_old_as_its_way_is_long() {
        let far = DVec3::new(0.0, 0.0, 1.0e4);
        let state = crate::spacetime::matter::ShipState::new(far, static_momentum(far).unwrap_or_default());
        let history = History::new(0.0, &state);
        let camera = hovering(far + DVec3::X * 10.0);
        let seen = apparition(&camera, 0.0, &history, Order::ALL[0]).expect("seen");
        assert!((seen.age - 10.0).abs() < 0.2, "{}", seen.age);
    }
}
