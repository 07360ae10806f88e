//! What light brings: when the light left by which a ship is seen, and where its image appears. The ray to the observer in closed form,
//! in f64, and the root of T − T_e = delay(x(T_e)).

use glam::{DQuat, DVec3};

use super::history::{History, Sample};
use crate::spacetime::light::{self, Branch, Order};
use crate::spacetime::matter::gamma;
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
    let phi = libm::atan2(across.length(), position.dot(outward)).max(1e-12);
    let ray = light::connect(1.0 / r, order.swept(phi), 1.0 / l, branch_of(camera, position, age))?;
    let psi = light::rain_angle(ray.slope, ray.energy, 1.0 / l);
    let side = across.try_normalize().unwrap_or_else(|| outward.any_orthonormal_vector());
    let side = if order.flips() { -side } else { side };
    Some(camera.seen_direction(outward * libm::cos(psi) + side * libm::sin(psi)))
}

/// g = ν_observed/ν_emitted of light that left a ship in the state `emitted` and reaches `camera` after `age` r_s/c, in the image of this
/// order: of the photon with the rain-frame momentum k, who moves with p measures the frequency γ|k| − p·k. None where no ray joins them.
pub fn frequency_ratio(camera: &Observer, emitted: &Sample, order: Order, age: f64) -> Option<f64> {
    let (l, r) = (camera.radius(), emitted.position.length());
    let (n, m) = (camera.position / l, emitted.position / r);
    let across = m - n * m.dot(n);
    let phi = libm::atan2(across.length(), m.dot(n)).max(1e-12);
    let ray = light::connect(1.0 / r, order.swept(phi), 1.0 / l, branch_of(camera, emitted.position, age))?;
    let side = across.try_normalize().unwrap_or_else(|| n.any_orthonormal_vector());
    let turn = if order.flips() { -1.0 } else { 1.0 };
    // Directions of increasing Φ at the camera and at the ship.
    let along = [side * turn, (side * m.dot(n) - n * m.dot(side)) * turn];
    let frequency = |slope: f64, radius: f64, [outward, along]: [DVec3; 2], p: DVec3| {
        let [radial, tangential] = light::rain_momentum(slope, ray.energy, 1.0 / radius);
        let k = outward * radial + along * tangential;
        gamma(p) * k.length() - p.dot(k)
    };
    let g = frequency(ray.slope, l, [n, along[0]], camera.momentum) / frequency(ray.emission_slope, r, [m, along[1]], emitted.momentum);
    (g.is_finite() && g > 0.0).then_some(g)
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
    let phi = libm::atan2(across.length(), position.dot(n)).max(1e-12);
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
    let line = |t: f64| {
        let sample = history.at(t);
        Some([sample.position, sample.velocity])
    };
    emission_time_of(camera, time, line, order)
}

/// As [`emission_time`] for anything that has a position on the slice (r_s) and dx/dT (c) at each T.
pub fn emission_time_of(camera: &Observer, time: f64, line: impl Fn(f64) -> Option<[DVec3; 2]>, order: Order) -> Option<f64> {
    leaving(time, |t| {
        let [position, velocity] = line(t)?;
        let branch = branch_of(camera, position, time - t);
        let (delay, gradient) = light_path(camera, position, order, branch)?;
        let sign = if branch == Branch::Minus { -1.0 } else { 1.0 };
        Some((sign * (t + delay - time), sign * (1.0 + gradient.dot(velocity))))
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

    /// The time between two wave crests by both clocks: of order 1 and 2, for orbits and falls, outside and inside the horizon.
    #[test]
    fn frequencies_go_as_the_clocks_tick() {
        use crate::sim::Command;
        use crate::spacetime::matter::{ShipState, step};
        use crate::spacetime::orbit::circular_orbit;
        let orbit = |r: f64, phase: f64| circular_orbit(r, phase).expect("a circle");
        let rain = |r: f64, y: f64, p: DVec3| ShipState::new(DVec3::new(r, y, 0.1), p);
        let mut seen = 0;
        // What falls from rest at infinity goes from r to the middle in 2/3 r^1.5: from 3.3 in 4.0, from 3 in 3.5.
        for (own, other, time) in [
            (orbit(6.0, 0.0), orbit(6.0, 2.0), 30.0),
            (orbit(9.0, 0.0), orbit(3.2, 2.5), 30.0),
            (orbit(3.2, 1.0), orbit(12.0, -1.0), 40.0),
            (rain(14.0, 1.0, DVec3::new(0.1, -0.1, 0.05)), orbit(7.0, 0.3), 30.0),
            (orbit(8.0, 0.0), rain(12.0, -5.0, DVec3::new(0.3, 0.4, 0.3)), 40.0),
            (rain(3.3, 0.2, DVec3::new(0.0, 0.1, 0.0)), rain(3.0, 0.1, DVec3::new(0.0, -0.1, 0.1)), 3.5),
        ] {
            // Fine nodes: between them a worldline is a cubic.
            let mut history = History::new(0.0, &other);
            let mut state = other;
            for k in 1..=(128.0 * time) as u32 {
                state = step(&state, 1.0 / 128.0, DVec3::ZERO, DVec3::ZERO);
                if state.position.length() < 0.2 {
                    break;
                }
                history.push(f64::from(k) / 128.0, &state, &Command::default());
            }
            let camera = |t: f64| {
                let own = step(&own, t, DVec3::ZERO, DVec3::ZERO);
                Observer { position: own.position, momentum: own.momentum, attitude: own.attitude, field_of_view: 1.0 }
            };
            for order in [Order::ALL[0], Order::ALL[1]] {
                // Central differences of times that are known to 1e-12 r_s/c: 1e-4 is best.
                let h = 1e-4;
                let emitted = |t: f64| emission_time(&camera(t), t, &history, order);
                let (Some(before), Some(now), Some(after)) = (emitted(time - h), emitted(time), emitted(time + h)) else { continue };
                let sent = history.at(now);
                // dT = γ dτ for each of them.
                let ticked = (after - before) / (2.0 * h) * gamma(camera(time).momentum) / gamma(sent.momentum);
                let g = frequency_ratio(&camera(time), &sent, order, time - now).expect("a ray");
                assert!((g / ticked - 1.0).abs() < 1e-5, "{:?} {sent:?} {order:?}: {g} {ticked}", camera(time));
                assert!(time < 10.0 || now > 0.0, "before the first node at T = {now}");
                seen += 1;
            }
        }
        assert!(seen >= 10, "only {seen} images");
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
