//! The look aside: while a key is held, the camera turns from where the ship points to where the target is seen; let go, it turns back.

use glam::{DQuat, DVec3};

use crate::sim::History;
use crate::spacetime::matter::ShipState;

use crate::play::camera::{CameraView, on_ship};
use crate::sim::sight::facing;

/// Wall time of the whole turn, in seconds.
const TURN: f64 = 0.4;
/// Most corrections of the camera's attitude in a frame, and the correction (rad) that needs no other: a tenth of a pixel at 60° over 1280.
const CORRECTIONS: (usize, f64) = (8, 1e-4);

/// How far the camera has turned aside.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gaze {
    /// Share of the way from the ship's attitude to the target, 0 to 1.
    share: f64,
    /// The whole turn, from the ship's axes to those of a camera that looks at the target.
    turn: DQuat,
}

impl Gaze {
    /// The camera's attitude after `seconds` of wall time: on the way from `ship` to `target`, or back where that is None; at once where
    /// `rigid`.
    pub fn turned(&mut self, ship: DQuat, target: Option<DQuat>, seconds: f64, rigid: bool) -> DQuat {
        let step = if rigid { 1.0 } else { seconds / TURN };
        match target {
            Some(target) => {
                self.turn = (ship.conjugate() * target).normalize();
                self.share = (self.share + step).min(1.0);
            }
            None => self.share = (self.share - step).max(0.0),
        }
        // It sets off and arrives slowly.
        let share = self.share * self.share * (3.0 - 2.0 * self.share);
        if share == 0.0 { ship } else { (ship * DQuat::IDENTITY.slerp(self.turn, share)).normalize() }
    }

    /// Whether the camera does not look along the ship.
    pub fn aside(&self) -> bool {
        self.share > 0.0
    }

    /// The attitude in which a camera on the ship has the image of order 1 of `target`, at T = `time`, in the middle; None where it is not
    /// seen. `follows` is the attitude of the camera that looks ahead; its upwards stays so.
    pub fn facing(&self, state: &ShipState, view: CameraView, length: f64, follows: DQuat, time: f64, target: &History) -> Option<DQuat> {
        let up = follows * DVec3::Y;
        // The third-person camera goes round the ship as it turns, which moves what is near: from the last frame's answer it is not far.
        let mut attitude = if self.aside() { follows * self.turn } else { follows };
        for _ in 0..CORRECTIONS.0 {
            let before = attitude;
            attitude = facing(&on_ship(state, view, before, length, 1.0), time, target, up)?;
            if attitude.angle_between(before) < CORRECTIONS.1 {
                break;
            }
        }
        Some(attitude)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::sight::apparition;
    use crate::spacetime::light::Order;
    use crate::spacetime::orbit::static_momentum;

    fn hovering(position: DVec3) -> ShipState {
        ShipState::new(position, static_momentum(position).unwrap_or_default())
    }

    /// Ahead, aside, behind, near by, and beyond the hole, where light is bent most: its image comes to the middle in both views.
    #[test]
    fn the_image_of_the_target_comes_to_the_middle() {
        let ship = ShipState { attitude: DQuat::from_rotation_z(0.4) * DQuat::from_rotation_y(0.7), ..hovering(DVec3::X * 9.0) };
        for there in [[2.0, 7.0, 1.0], [9.0, -6.0, 0.5], [13.0, 1.0, 2.0], [9.4, 0.6, 0.2], [-8.0, 0.5, 0.3], [9.0, 0.0, 5.0]] {
            let target = History::new(0.0, &hovering(DVec3::from_array(there)));
            for view in [CameraView::Cockpit, CameraView::ThirdPerson] {
                let mut gaze = Gaze::default();
                let mut camera = on_ship(&ship, view, ship.attitude, 0.25, 1.0);
                for _ in 0..40 {
                    let facing = gaze.facing(&ship, view, 0.25, ship.attitude, 0.0, &target);
                    let attitude = gaze.turned(ship.attitude, facing, 0.05, false);
                    camera = on_ship(&ship, view, attitude, 0.25, 1.0);
                }
                let seen = apparition(&camera, 0.0, &target, Order::ALL[0]).expect("seen").direction;
                assert!(seen.angle_between(DVec3::NEG_Z) < 1e-3, "{there:?} {view:?}: {seen}");
            }
        }
    }

    #[test]
    fn it_turns_smoothly_there_and_back() {
        let ship = DQuat::from_rotation_x(0.3);
        let target = ship * DQuat::from_rotation_y(2.0);
        let (mut gaze, mut last) = (Gaze::default(), ship);
        for (wanted, goal) in [(Some(target), target), (None, ship)] {
            for _ in 0..40 {
                let next = gaze.turned(ship, wanted, 0.02, false);
                // At most one and a half times the mean speed.
                assert!(next.angle_between(last) < 1.6 * 2.0 * 0.02 / TURN, "{}", next.angle_between(last));
                last = next;
            }
            assert!(last.angle_between(goal) < 1e-6);
        }
        assert_eq!((last, gaze.aside()), (ship, false));
        assert!(gaze.turned(ship, Some(target), 0.02, true).angle_between(target) < 1e-6, "at once");
    }

    /// There the camera keeps to the target however the ship turns.
    #[test]
    fn it_stays_on_the_target_while_the_ship_turns() {
        let mut gaze = Gaze::default();
        let target = DQuat::from_rotation_y(1.0);
        for frame in 0..60 {
            let ship = DQuat::from_rotation_z(0.05 * f64::from(frame));
            let attitude = gaze.turned(ship, Some(target), 0.02, false);
            assert!(frame < 25 || attitude.angle_between(target) < 1e-6, "{frame}");
        }
    }
}
