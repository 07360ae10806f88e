//! Where the image of a ship appears: the same light path and emission time as the renderer's.

use crate::spacetime::Observer;
use glam::{DQuat, DVec3};

use crate::render::instances::{branch_of, emission_time};
use crate::sim::History;
use crate::spacetime::frames;
use crate::spacetime::light::{self, Order};

/// A ship as a camera sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apparition {
    /// Towards its image, in camera axes (−z forward), of unit length.
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

/// Where light from `position` (on the slice of its emission), `age` r_s/c old, is seen, in camera axes.
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

/// The direction to where the ship really is on the slice T = const, as if light were straight and at once, in camera axes.
pub fn true_direction(camera: &Observer, position: DVec3) -> Option<DVec3> {
    (position - camera.position).try_normalize().map(|line| camera.attitude.conjugate() * line)
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
