//! The free camera of replays: the mouse and the turning keys lead it round the ship, the thrust keys nearer and farther.

use glam::{DQuat, DVec2};

/// Where the camera is beside where it follows the ship.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// Upwards and leftwards, in radians.
    turn: DVec2,
    /// Distance from the ship over the usual one.
    zoom: f64,
}

impl Default for Orbit {
    fn default() -> Self {
        Orbit { turn: DVec2::ZERO, zoom: 1.0 }
    }
}

/// The distances that are allowed, over the usual one.
const ZOOM: (f64, f64) = (0.6, 6.0);
/// The farthest up and down, in radians: short of where left and right change places.
const STEEPEST: f64 = 1.5;

impl Orbit {
    /// Moves it by `turn` (upwards, leftwards, in radians) and its distance by the factor `zoom`.
    pub fn moved(&mut self, turn: DVec2, zoom: f64) {
        let wide = self.turn + turn;
        let round = std::f64::consts::TAU;
        self.turn = DVec2::new(wide.x.clamp(-STEEPEST, STEEPEST), (wide.y / round - (wide.y / round).round()) * round);
        self.zoom = (self.zoom * zoom).clamp(ZOOM.0, ZOOM.1);
    }

    /// The attitude of the camera that would otherwise have `follows`.
    pub fn attitude(&self, follows: DQuat) -> DQuat {
        (follows * DQuat::from_rotation_y(self.turn.y) * DQuat::from_rotation_x(self.turn.x)).normalize()
    }

    /// Straight behind, as far off as it is.
    pub fn ahead(&self) -> Orbit {
        Orbit { turn: DVec2::ZERO, ..*self }
    }

    /// Its distance over the usual one.
    pub fn zoom(&self) -> f64 {
        self.zoom
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn it_goes_round_and_not_over_the_top() {
        let mut orbit = Orbit::default();
        assert_eq!(orbit.attitude(DQuat::IDENTITY), DQuat::IDENTITY);
        orbit.moved(DVec2::new(0.0, std::f64::consts::PI), 2.0);
        assert!((orbit.attitude(DQuat::IDENTITY) * DVec3::NEG_Z - DVec3::Z).length() < 1e-9, "it looks back");
        (0..100).for_each(|_| orbit.moved(DVec2::new(0.5, 0.7), 2.0));
        assert_eq!((orbit.turn.x, orbit.zoom), (STEEPEST, ZOOM.1));
        assert!(orbit.turn.y.abs() <= std::f64::consts::PI);
    }
}
