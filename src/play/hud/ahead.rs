//! Lines of what is to come, drawn through the lensing: one's own course, the target's from what its light shows, and the way of a bolt
//! fired now. Each is the line of the places, as things held there would be seen.

use glam::DVec3;

use crate::sim::History;
use crate::sim::bolts::{LIFE, bolt_momentum};
use crate::sim::guidance::approach;
use crate::sim::known::Known;
use crate::sim::pilot::rollout::{Point, coast};
use crate::sim::sight::{direction, emission_time};
use crate::spacetime::Observer;
use crate::spacetime::light::Order;
use crate::spacetime::matter::ShipState;

/// How far ahead a course is shown, in r_s/c, and in how many pieces.
const COURSE: (f64, usize) = (24.0, 24);
/// The same for a bolt: as long as it flies.
const SHOT: (f64, usize) = (LIFE, 32);

/// Directions in camera axes, one after the other; None where a place is not seen.
pub type AheadLine = Vec<Option<DVec3>>;

/// The free fall of a ship from its state.
pub fn course(camera: &Observer, state: &ShipState) -> AheadLine {
    seen(camera, places(Point::from(state), COURSE))
}

/// The free fall of the target from where its light left it.
pub fn target_course(camera: &Observer, time: f64, history: &History) -> AheadLine {
    let Some(emitted) = emission_time(camera, time, history, Order::ALL[0]) else { return AheadLine::new() };
    let sample = history.at(emitted);
    seen(camera, places(Point { x: sample.position, p: sample.momentum }, COURSE))
}

/// The way of a bolt fired now.
pub fn shot(camera: &Observer, state: &ShipState) -> AheadLine {
    let bolt = Point { x: state.position, p: bolt_momentum(state.momentum, state.attitude * DVec3::NEG_Z) };
    seen(camera, places(bolt, SHOT))
}

/// Where and when one passes the target, if both coast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pass {
    /// How near, in r_s.
    pub distance: f64,
    /// In how many r_s/c of T.
    pub ahead: f64,
    /// Where one's own ship and the target are then, in camera axes; None where that place is not seen.
    pub directions: [Option<DVec3>; 2],
}

/// How one passes a target; None if both part from now on.
pub fn pass(camera: &Observer, own: &ShipState, known: &Known) -> Option<Pass> {
    let near = approach(&Point::from(own), known)?;
    Some(Pass { distance: near.distance, ahead: near.ahead, directions: near.places.map(|place| seen_at(camera, place)) })
}

/// The places of a free fall, from the end of the first piece on.
fn places(start: Point, (span, pieces): (f64, usize)) -> Vec<DVec3> {
    let step = span / pieces as f64;
    let mut now = start;
    (0..pieces)
        .map(|_| {
            now = coast(&now, step);
            now.x
        })
        .collect()
}

/// Each place as a camera sees what is held there.
fn seen(camera: &Observer, places: Vec<DVec3>) -> AheadLine {
    places.into_iter().map(|place| seen_at(camera, place)).collect()
}

/// Where a camera sees what is held at a place.
fn seen_at(camera: &Observer, place: DVec3) -> Option<DVec3> {
    (place.length() > 1.0).then(|| direction(camera, place, Order::ALL[0], 0.0)).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spacetime::orbit::circular_orbit;

    #[test]
    fn ships_that_meet_come_nearest_where_they_meet() {
        let own = circular_orbit(8.0, 0.0).expect("a circle");
        // The other way round, an eighth ahead: they meet after a sixteenth.
        let mut other = circular_orbit(8.0, std::f64::consts::FRAC_PI_4).expect("a circle");
        let rain = other.position / other.position.length() * (other.momentum.dot(other.position) / other.position.length());
        other.momentum = 2.0 * rain - other.momentum;
        let camera = Observer { position: own.position, momentum: own.momentum, attitude: own.attitude, field_of_view: 1.0 };
        let Pass { distance: nearest, ahead: when, directions } =
            pass(&camera, &own, &Known { point: Point::from(&other), age: 0.0, rests: false }).expect("they meet");
        assert!(directions[0].expect("seen").angle_between(directions[1].expect("seen")) < 0.3);
        let sixteenth = std::f64::consts::FRAC_PI_8 / crate::spacetime::orbit::orbital_frequency(8.0);
        assert!(nearest < 0.5 && (when - sixteenth).abs() < 1.0, "{nearest} {when} {sixteenth}");
    }
}
