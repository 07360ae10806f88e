//! What is known of a target: the true state where the mission marks "now", else what its light tells.

use glam::DVec3;

use super::history::History;
use super::pilot::rollout::{PlannedBurn, Point, flown};
use super::sight::emission_time;
use crate::spacetime::Observer;
use crate::spacetime::light::Order;
use crate::spacetime::matter::ShipState;
use crate::spacetime::orbit::static_momentum;

/// What is known of a target now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Where it is and how it moves, if it has fallen freely since.
    pub point: Point,
    /// How old that knowledge is, in r_s/c.
    pub age: f64,
    /// It is a place, and does not fall.
    pub rests: bool,
}

/// What is known of a ship's `history` at T = `time` in a ship in the state `own`. `now`: where it is now is told, else its light alone
/// tells. None before any has come.
pub fn known(own: &ShipState, time: f64, history: &History, now: bool) -> Option<Known> {
    let emitted = if now { time } else { emission_time(&eye(own), time, history, Order::ALL[0])? };
    let sample = history.at(emitted);
    let age = time - emitted;
    Some(Known { point: flown(&Point { x: sample.position, p: sample.momentum }, age, &PlannedBurn::COAST), age, rests: false })
}

/// A ship as an observer.
pub fn eye(ship: &ShipState) -> Observer {
    let ShipState { position, momentum, attitude, .. } = *ship;
    Observer { position, momentum, attitude, field_of_view: 1.0 }
}

/// What rests at a place outside the horizon.
pub fn resting(place: DVec3) -> Option<Known> {
    Some(Known { point: Point { x: place, p: static_momentum(place)? }, age: 0.0, rests: true })
}
