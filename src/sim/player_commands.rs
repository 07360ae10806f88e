//! The player's commands, in whole numbers that a replay keeps exactly, and what they make of a ship.

use bevy::prelude::*;
use glam::DVec3;

use super::assist::{AssistMode, AssistSettings, Assisted, Reference, Stick, assisted, direct, kept_off, matched};
use super::pilot::steer::turn_nose;
use super::ship::Engine;
use crate::scene::GameConfig;
use crate::spacetime::matter::ShipState;

/// The player's commands in a step. They are all of the player that the simulation knows, so a replay is a list of these.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct PlayerCommands {
    /// Thrust on body axes (right, up, backwards), each from −127 to 127.
    pub thrust: [i8; 3],
    /// Turn about the body axes (pitch up, yaw left, roll left), each from −127 to 127.
    pub turn: [i8; 3],
    /// How the flight assist helps.
    pub assist: AssistMode,
    /// The assist takes away all motion against the target.
    pub matching: bool,
    /// The autopilot flies instead.
    pub autopilot: bool,
    /// The player looks at the target.
    pub looking: bool,
    /// The nose turns to where thrust leads to the target, and the assist serves on that way ([`super::target::Targets::mark`]).
    pub facing: bool,
    /// A bolt is to be fired.
    pub fire: bool,
    /// The game's pace, in r_s/c of T a second: a full turn stick means so much a second.
    pub pace: f64,
}

impl Default for PlayerCommands {
    fn default() -> Self {
        let pace = GameConfig::default().clock.pace;
        PlayerCommands {
            thrust: [0; 3],
            turn: [0; 3],
            assist: AssistMode::Off,
            matching: false,
            autopilot: false,
            looking: false,
            facing: false,
            fire: false,
            pace,
        }
    }
}

impl PlayerCommands {
    /// A stick's full deflection.
    pub const FULL: f64 = 127.0;

    /// The sticks nearest to `stick`, the rest at rest.
    pub fn holding(stick: &Stick) -> PlayerCommands {
        // NaN is no deflection.
        let whole = |axis: f64| (axis.clamp(-1.0, 1.0) * PlayerCommands::FULL).round() as i8;
        PlayerCommands { thrust: stick.thrust.to_array().map(whole), turn: stick.turn.to_array().map(whole), ..PlayerCommands::default() }
    }

    /// As they are with the nose turning to `mark` (a unit vector on body axes), on whose way the assist `serves`.
    pub fn turned_to(&self, mark: DVec3, serves: AssistMode) -> PlayerCommands {
        let turn = PlayerCommands::holding(&Stick { turn: turn_nose(mark, 1.0), ..Stick::default() }).turn;
        let assist = match self.assist {
            AssistMode::Off => AssistMode::Off,
            _ if self.matching => AssistMode::Target,
            _ => serves,
        };
        PlayerCommands { turn: [turn[0], turn[1], self.turn[2]], assist, ..*self }
    }

    /// The sticks.
    pub fn stick(&self) -> Stick {
        let share = |axis: i8| f64::from(axis.max(-127)) / PlayerCommands::FULL;
        Stick { thrust: DVec3::from_array(self.thrust.map(share)), turn: DVec3::from_array(self.turn.map(share)) }
    }
}

/// How a ship is controlled by hand.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct ManualControl {
    /// How the flight assist helps.
    pub assist: AssistSettings,
    /// The fastest turn, in radians a second of wall time.
    pub turn_rate: f64,
}

impl From<&GameConfig> for ManualControl {
    fn from(config: &GameConfig) -> Self {
        ManualControl { assist: AssistSettings::from(config), turn_rate: config.ship.turn_rate }
    }
}

impl PlayerCommands {
    /// Whether they need to know how the target moves.
    pub fn needs_target(&self) -> bool {
        self.matching || self.assist == AssistMode::Target
    }

    /// What they make of a ship in this state; `target` is the target's dx/dT (c) as far as it is known.
    pub fn command(&self, state: &ShipState, engine: &Engine, target: Option<DVec3>, settings: &AssistSettings) -> Assisted {
        let stick = self.stick();
        let free = |command| Assisted { command, avoiding: false };
        match (self.matching, self.assist, target) {
            (true, AssistMode::Off, Some(velocity)) => free(matched(state, &stick, engine, Reference::Target(velocity))),
            (true, _, Some(velocity)) => kept_off(state, matched(state, &stick, engine, Reference::Target(velocity)), engine, settings),
            (_, AssistMode::Off, _) => free(direct(&stick, engine)),
            (_, AssistMode::Target, Some(velocity)) => assisted(state, &stick, engine, Reference::Target(velocity), settings),
            (_, AssistMode::Orbit | AssistMode::Target, _) => assisted(state, &stick, engine, Reference::Orbit, settings),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sticks_come_back_within_half_a_step() {
        let stick = Stick { thrust: DVec3::new(0.3, -1.0, 2.0), turn: DVec3::new(f64::NAN, 0.004, -0.77) };
        let back = PlayerCommands::holding(&stick).stick();
        assert!((back.thrust - DVec3::new(0.3, -1.0, 1.0)).abs().max_element() <= 0.5 / PlayerCommands::FULL, "{back:?}");
        assert!((back.turn - DVec3::new(0.0, 0.004, -0.77)).abs().max_element() <= 0.5 / PlayerCommands::FULL, "{back:?}");
        assert_eq!(PlayerCommands { thrust: [-128, 0, 0], ..PlayerCommands::default() }.stick().thrust.x, -1.0);
    }
}
