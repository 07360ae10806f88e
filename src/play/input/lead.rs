//! The player's input leads the camera: in a replay, where nobody flies, all of it; in flight a pinch.

use bevy::prelude::*;
use glam::DVec2;

use crate::play::camera::orbit::Orbit;
use crate::play::input::PlayerInput;
use crate::play::input::action::Action;
use crate::play::input::mouse::MouseTurn;
use crate::play::input::touch::TouchControls;
use crate::play::player_state::PlayerState;

/// In a replay the mouse and the keys that otherwise fly lead the camera.
pub fn lead_camera(
    input: PlayerInput,
    real: Res<Time<Real>>,
    mut turn: ResMut<MouseTurn>,
    touch: Res<TouchControls>,
    mut player: ResMut<PlayerState>,
) {
    /// By the keys, in radians a second, and the logarithm of the distance a second.
    const RATES: (f64, f64) = (1.2, 1.5);
    let (stick, seconds) = (input.stick(), real.delta_secs_f64());
    let mouse = turn.take();
    let keys = DVec2::new(stick.turn.x, stick.turn.y) * (RATES.0 * seconds);
    player.orbit.moved(mouse + keys, (stick.thrust.z * RATES.1 * seconds).exp() * f64::from(touch.pinch.unwrap_or(1.0)));
    if input.holds(Action::LookAtTarget) {
        player.orbit = Orbit::default();
    }
}

/// In flight a pinch has the third-person camera nearer or farther.
pub fn pinch_camera(touch: Res<TouchControls>, mut player: ResMut<PlayerState>) {
    if let Some(pinch) = touch.pinch {
        player.orbit.moved(DVec2::ZERO, f64::from(pinch));
    }
}
