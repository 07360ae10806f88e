//! Turns by the mouse.

use bevy::prelude::*;
use glam::DVec2;

use crate::scene::GameConfig;
use crate::sim::Hands;

/// Turns asked for by the mouse and not flown yet: pitch (up) and yaw (left), in radians.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub struct MouseTurn(pub DVec2);

/// A turn that waits is at most this large, in radians, so that the ship stops soon after the hand.
const MOST_WAITING: f64 = 0.5;

impl MouseTurn {
    /// The mouse moved by `pixels` (right, down).
    pub fn push(&mut self, pixels: Vec2, config: &GameConfig) {
        let controls = &config.controls;
        let pitch = if controls.invert_y { f64::from(pixels.y) } else { -f64::from(pixels.y) };
        let yaw = if controls.invert_x { f64::from(pixels.x) } else { -f64::from(pixels.x) };
        let turn = DVec2::new(pitch, yaw) * controls.mouse_sensitivity;
        self.0 = (self.0 + turn).clamp_length_max(MOST_WAITING);
    }

    /// The deflection (pitch, yaw), each in [−1, 1], that flies as much of the turn as a step can; `most` radians turn in a step at full
    /// deflection.
    pub fn pull(&mut self, most: f64) -> DVec2 {
        if most <= 0.0 {
            return DVec2::ZERO;
        }
        // In the steps that the hands are kept in: what is too little for one waits.
        let deflection = (self.0 / most).clamp(DVec2::NEG_ONE, DVec2::ONE);
        let deflection = (deflection * Hands::FULL).round() / Hands::FULL;
        self.0 -= deflection * most;
        deflection
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mouse_turns_as_far_as_it_went() {
        let mut config = GameConfig::default();
        let mut turn = MouseTurn::default();
        turn.push(Vec2::new(50.0, -20.0), &config);
        // Right is a yaw to the right, forward (up the screen) a pitch up; 0.002 rad a pixel.
        assert!((turn.0 - DVec2::new(0.04, -0.1)).length() < 1e-12);
        let mut flown = DVec2::ZERO;
        for _ in 0..20 {
            flown += turn.pull(0.01) * 0.01;
        }
        assert!((flown - DVec2::new(0.04, -0.1)).length() < 1e-12, "{flown}");
        assert_eq!(turn.pull(0.0), DVec2::ZERO);
        (config.controls.invert_x, config.controls.invert_y) = (true, true);
        let mut other = MouseTurn::default();
        other.push(Vec2::new(50.0, -20.0), &config);
        assert!((other.0 + DVec2::new(0.04, -0.1)).length() < 1e-12);
    }
}
