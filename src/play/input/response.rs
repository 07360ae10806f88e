//! From a stick's way to what is done: dead zone and curve.

use glam::{DVec2, DVec3};

use crate::scene::config::Controls;
use crate::sim::assist::Stick;

/// How a stick answers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Response {
    /// Share of its way that does nothing.
    pub dead_zone: f64,
    /// Exponent of the answer.
    pub curve: f64,
}

impl Response {
    /// Of the left stick, as configured.
    pub fn left(controls: &Controls) -> Response {
        Response { dead_zone: controls.left_stick_dead_zone, curve: controls.left_stick_curve }
    }

    /// Of the right stick and the triggers, as configured.
    pub fn right(controls: &Controls) -> Response {
        Response { dead_zone: controls.right_stick_dead_zone, curve: controls.right_stick_curve }
    }

    /// The answer, 0 to 1, to a stick that is pushed by `way`, 0 to 1.
    pub fn answer(&self, way: f64) -> f64 {
        let beyond = ((way - self.dead_zone) / (1.0 - self.dead_zone)).clamp(0.0, 1.0);
        beyond.powf(self.curve)
    }

    /// The answer to both axes of a stick: its direction stays, so that the dead zone is round.
    pub fn both(&self, way: DVec2) -> DVec2 {
        way.normalize_or_zero() * self.answer(way.length())
    }
}

/// The sticks after `before`, with `asked` for now. A thumb trembles: what differs by less than a thirtieth of the whole way and a sixth of
/// its own stays as it was, but for rest and the end. So a replay keeps what was meant.
pub fn steadied(before: &Stick, asked: &Stick) -> Stick {
    let axis = |before: f64, asked: f64| {
        let trembles = asked != 0.0 && asked.abs() < 1.0 && (asked - before).abs() < (before.abs() / 6.0).max(1.0 / 30.0);
        if trembles { before } else { asked }
    };
    let each = |before: DVec3, asked: DVec3| DVec3::from_array(std::array::from_fn(|k| axis(before[k], asked[k])));
    Stick { thrust: each(before.thrust, asked.thrust), turn: each(before.turn, asked.turn) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_in_the_dead_zone_all_at_the_end_and_no_jump() {
        let response = Response { dead_zone: 0.2, curve: 2.0 };
        assert_eq!([0.0, 0.2, 1.0].map(|way| response.answer(way)), [0.0, 0.0, 1.0]);
        assert!((response.answer(0.6) - 0.25).abs() < 1e-12);
        let steps: Vec<f64> = (0..=100).map(|k| response.answer(f64::from(k) / 100.0)).collect();
        assert!(steps.windows(2).all(|pair| pair[1] >= pair[0] && pair[1] - pair[0] < 0.03));
    }

    /// A push of half the way by a trembling thumb is one.
    #[test]
    fn what_trembles_stays() {
        let mut stick = Stick::default();
        let asked = |k: u32| 0.5 + 0.03 * f64::from(k % 7).sin();
        let mut pushes: Vec<f64> = (0..50).map(asked).chain([0.2, 0.21, 0.0, 0.01, 0.99, 1.0]).collect();
        for push in &mut pushes {
            stick = steadied(&stick, &Stick { thrust: DVec3::X * *push, turn: DVec3::ZERO });
            *push = stick.thrust.x;
        }
        pushes.dedup();
        assert_eq!(pushes, [0.5, 0.2, 0.0, 0.99, 1.0]);
    }

    #[test]
    fn the_direction_stays() {
        let response = Response { dead_zone: 0.2, curve: 1.6 };
        let way = DVec2::new(0.5, -0.3);
        assert!(response.both(way).angle_to(way).abs() < 1e-12);
        assert_eq!(response.both(DVec2::new(0.1, 0.1)), DVec2::ZERO);
    }
}
