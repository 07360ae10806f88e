//! Where a scene's camera is at any T: the same for every renderer of it.

use crate::spacetime::Observer;
use glam::{DMat3, DQuat, DVec3};

use super::{Mount, SceneCamera};
use crate::spacetime::frames;
use crate::spacetime::matter::{ShipState, gamma, has_ended, momentum_of, step};

/// The camera, or the ship that it follows, has fallen into the singularity, from where nothing is seen.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("--at: by T = {0} the camera has fallen into the singularity, from where nothing is seen; an earlier T shows the fall")]
pub struct CameraEnded(pub f64);

/// The nearest to the hole that a third-person camera goes while its ship is outside, in r_s.
const CAMERA_FLOOR: f64 = 1.003;

impl SceneCamera {
    /// An error if, at T = `time`, the camera or the ship that it follows has come to where nothing is seen; `ships` as for
    /// [`SceneCamera::viewpoint`].
    pub fn check(&self, time: f64, ships: &[(&str, ShipState)]) -> Result<(), CameraEnded> {
        let ended = match &self.mount {
            Mount::Follow { ship, .. } => ships.iter().any(|(name, state)| name == ship && has_ended(state)),
            Mount::Static(_) | Mount::Falling(_) | Mount::Planet { .. } => {
                let view = self.viewpoint(time, ships);
                has_ended(&ShipState::new(view.position, view.momentum))
            }
        };
        if ended { Err(CameraEnded(time)) } else { Ok(()) }
    }

    /// The camera at T = `time`; `ships` are the states of the ships then, by name. Without the ship that it follows it looks on from 20
    /// r_s.
    pub fn viewpoint(&self, time: f64, ships: &[(&str, ShipState)]) -> Observer {
        let state = match &self.mount {
            Mount::Static(state) => *state,
            Mount::Falling(state) => fall(state, time),
            Mount::Planet { place, view, planet } => {
                // A planet's orbit was checked when the scene was read.
                let at = |time: f64| {
                    let state = planet.state(time).unwrap_or(ShipState::new(DVec3::Z * 20.0, DVec3::ZERO));
                    let dipole = planet.dipole();
                    beside(&state, dipole * *place * planet.radius, dipole * *view, self.fov)
                };
                let seen = at(time);
                // It turns with the planet: light of the ground below comes to it unshifted.
                let step = TURNING_STEP * planet.day;
                let velocity = (at(time + step).position - at(time - step).position) / (2.0 * step);
                return Observer { momentum: momentum_of(seen.position, velocity).unwrap_or(seen.momentum), ..seen };
            }
            Mount::Follow { ship, offset, look, up } => {
                let Some((_, state)) = ships.iter().find(|(name, _)| name == ship) else {
                    return Observer {
                        position: DVec3::Z * 20.0,
                        momentum: DVec3::ZERO,
                        attitude: DQuat::IDENTITY,
                        field_of_view: self.fov,
                    };
                };
                return beside(state, *offset, frames::look(*look, *up).unwrap_or(DQuat::IDENTITY), self.fov);
            }
        };
        Observer { position: state.position, momentum: state.momentum, attitude: state.attitude, field_of_view: self.fov }
    }
}

/// The part of a day over which a point of the planet goes straight.
const TURNING_STEP: f64 = 1e-4;

/// A camera beside a ship: at `offset` (r_s) in the ship's rest frame and body axes, moving as the ship does, outside r = 1 as long as the
/// ship is. `view` turns camera axes into body axes.
pub fn beside(state: &ShipState, offset: DVec3, view: DQuat, field_of_view: f64) -> Observer {
    let away = state.attitude * offset;
    // On the slice T = const a rest length is contracted along the momentum.
    let p = state.momentum;
    let g = gamma(p);
    let contraction = DMat3::IDENTITY - DMat3::from_cols(p * p.x, p * p.y, p * p.z) * (1.0 / (g * (1.0 + g)));
    let mut position = state.position + contraction * away;
    if state.position.length() > CAMERA_FLOOR && position.length() < CAMERA_FLOOR {
        position = position.normalize() * CAMERA_FLOOR;
    }
    Observer { position, momentum: p, attitude: state.attitude * view, field_of_view }
}

/// Free fall from T = 0.
fn fall(state: &ShipState, time: f64) -> ShipState {
    /// As the simulation's step.
    const STEP: f64 = 0.01;
    let steps = (time / STEP).ceil().max(1.0);
    (0..steps as u64).fold(*state, |state, _| step(&state, time / steps, DVec3::ZERO, DVec3::ZERO))
}
