//! The free camera of photo mode.

use glam::{DQuat, DVec3};

use crate::spacetime::Observer;
use crate::spacetime::orbit::static_momentum;

/// How the free camera moves through space; it stands still in the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CameraMotion {
    /// As the ship does that it was on.
    #[default]
    Ship,
    /// As if it had fallen from rest, far away.
    Falling,
    /// It hovers; inside the horizon, where nothing can, it falls.
    Hovering,
}

impl CameraMotion {
    /// All of them.
    pub const ALL: [CameraMotion; 3] = [CameraMotion::Ship, CameraMotion::Falling, CameraMotion::Hovering];
}

/// The nearest to the hole's middle, and the farthest, in r_s.
const REACH: (f64, f64) = (0.05, 200.0);

/// A camera that goes where one likes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeCamera {
    /// Where it began.
    pub home: Observer,
    /// Position on the slice T = const, in r_s.
    pub position: DVec3,
    /// Camera axes to rain axes.
    pub attitude: DQuat,
    /// How it moves.
    pub motion: CameraMotion,
    /// Horizontal field of view, in radians.
    pub field_of_view: f64,
}

impl FreeCamera {
    /// Where `home` is.
    pub fn at(home: Observer) -> FreeCamera {
        let Observer { position, attitude, field_of_view, .. } = home;
        FreeCamera { home, position, attitude, motion: CameraMotion::Ship, field_of_view }
    }

    /// The camera for the picture.
    pub fn observer(&self) -> Observer {
        let momentum = match self.motion {
            CameraMotion::Ship => self.home.momentum,
            CameraMotion::Falling => DVec3::ZERO,
            CameraMotion::Hovering => static_momentum(self.position).unwrap_or_default(),
        };
        Observer { position: self.position, momentum, attitude: self.attitude, field_of_view: self.field_of_view }
    }

    /// Moves it by `way` (its own axes) times a step that grows with its distance from the hole, and turns it by `turn` (pitch up, yaw
    /// left, roll left, in radians).
    pub fn moved(&mut self, way: DVec3, turn: DVec3) {
        let step = self.position.length().clamp(0.2, 20.0);
        let to = self.position + self.attitude * way * step;
        let r = to.length();
        if r > 0.0 {
            self.position = to * (r.clamp(REACH.0, REACH.1) / r);
        }
        let turned = self.attitude * DQuat::from_rotation_y(turn.y) * DQuat::from_rotation_x(turn.x) * DQuat::from_rotation_z(turn.z);
        self.attitude = turned.normalize();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_goes_through_the_horizon_and_not_into_the_middle() {
        let home = Observer {
            position: DVec3::X * 3.0,
            momentum: DVec3::Y * 0.2,
            attitude: DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2),
            field_of_view: 1.0,
        };
        let mut camera = FreeCamera::at(home);
        assert_eq!(camera.observer(), home);
        let mut inside = false;
        for _ in 0..400 {
            camera.moved(DVec3::NEG_Z * 0.05, DVec3::ZERO);
            for motion in CameraMotion::ALL {
                camera.motion = motion;
                let observer = camera.observer();
                assert!(observer.position.is_finite() && observer.momentum.is_finite());
            }
            inside |= camera.position.length() < 1.0;
            assert!(camera.position.length() >= REACH.0 - 1e-9);
        }
        assert!(inside);
        (0..2000).for_each(|_| camera.moved(DVec3::Z, DVec3::new(0.1, 0.2, 0.3)));
        assert!(camera.position.length() <= REACH.1 + 1e-6 && camera.attitude.is_normalized());
    }
}
