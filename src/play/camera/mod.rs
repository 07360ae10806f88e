//! Where the player's camera is: behind the ship or in its cockpit, following its turns smoothly.

pub mod director;
pub mod orbit;

use crate::spacetime::Observer;
use glam::{DQuat, DVec3};

use crate::render::stage::third_person;
use crate::sim::Sample;
use crate::spacetime::matter::ShipState;

/// From where the player looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CameraView {
    /// Behind and above the ship.
    #[default]
    ThirdPerson,
    /// From its nose; the ship itself is not drawn.
    Cockpit,
}

impl CameraView {
    /// The other one.
    pub fn toggled(self) -> CameraView {
        match self {
            CameraView::ThirdPerson => CameraView::Cockpit,
            CameraView::Cockpit => CameraView::ThirdPerson,
        }
    }
}

/// Behind (+z) and above (+y) the ship, in lengths of the ship.
pub const BEHIND: DVec3 = DVec3::new(0.0, 0.62, 3.4);
/// The wall time in which a third-person camera follows a turn of its ship, in seconds.
const LAG: f64 = 0.18;

/// A camera that follows.
#[derive(Clone, Copy, Debug, Default)]
pub struct Follower {
    attitude: Option<DQuat>,
}

impl Follower {
    /// The attitude after `seconds` of wall time, behind that of the ship by `LAG`; at once where `rigid`.
    pub fn follow(&mut self, ship: DQuat, seconds: f64, rigid: bool) -> DQuat {
        let next = match self.attitude {
            Some(before) if !rigid => before.slerp(ship, 1.0 - (-seconds / LAG).exp()).normalize(),
            _ => ship,
        };
        self.attitude = Some(next);
        next
    }

    /// Turns at once, about its own axes.
    pub fn led(&mut self, turn: DQuat) {
        self.attitude = self.attitude.map(|before| (before * turn).normalize());
    }

    /// Forgets the past: the next look is straight along the ship.
    pub fn reset(&mut self) {
        self.attitude = None;
    }
}

/// The state of a ship at a sample of its worldline.
pub fn state_of(sample: &Sample) -> ShipState {
    ShipState { position: sample.position, momentum: sample.momentum, attitude: sample.attitude, proper_time: sample.proper_time }
}

/// The camera of `view` on a ship of `length` r_s whose camera has turned to `attitude`.
pub fn on_ship(state: &ShipState, view: CameraView, attitude: DQuat, length: f64, field_of_view: f64) -> Observer {
    let turned = ShipState { attitude, ..*state };
    let offset = match view {
        CameraView::ThirdPerson => BEHIND * length,
        CameraView::Cockpit => DVec3::ZERO,
    };
    third_person(&turned, offset, DQuat::IDENTITY, field_of_view)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_camera_comes_after_the_ship() {
        let mut follower = Follower::default();
        assert_eq!(follower.follow(DQuat::IDENTITY, 0.1, false), DQuat::IDENTITY);
        let turned = DQuat::from_rotation_y(0.5);
        let soon = follower.follow(turned, 0.05, false).angle_between(turned);
        assert!(soon > 0.1 && soon < 0.45, "{soon}");
        for _ in 0..60 {
            follower.follow(turned, 0.05, false);
        }
        assert!(follower.follow(turned, 0.05, false).angle_between(turned) < 1e-6);
    }

    #[test]
    fn the_cockpit_is_where_the_ship_is() {
        let state = ShipState::new(DVec3::X * 8.0, DVec3::new(0.1, 0.3, 0.0));
        let camera = on_ship(&state, CameraView::Cockpit, DQuat::IDENTITY, 0.25, 1.0);
        assert_eq!(camera.position, state.position);
        let behind = on_ship(&state, CameraView::ThirdPerson, DQuat::IDENTITY, 0.25, 1.0);
        assert!((behind.position - state.position).z > 0.5);
        assert_eq!(behind.momentum, state.momentum);
    }
}
