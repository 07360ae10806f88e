//! The game's clock: Painlevé–Gullstrand T, in fixed steps.

use bevy::prelude::Resource;

/// Fixed steps per wall second (Bevy's default rate).
pub const STEPS_PER_SECOND: f64 = 64.0;

/// How much T passes per wall second unless configured otherwise, in r_s/c. A power of two makes step and ticks exact in binary.
pub const DEFAULT_PACE: f64 = 2.0;

/// The common clock of all ships. It counts steps and never looks at a wall clock.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    /// T of the current slice, in r_s/c.
    pub time: f64,
    /// T per fixed step, in r_s/c.
    pub step: f64,
    /// Steps taken.
    pub tick: u64,
}

impl Clock {
    /// A clock at T = 0 that advances `pace` r_s/c of T per wall second.
    pub fn with_pace(pace: f64) -> Self {
        Clock { time: 0.0, step: pace / STEPS_PER_SECOND, tick: 0 }
    }

    /// Advances by one step.
    pub fn advance(&mut self) {
        self.time += self.step;
        self.tick += 1;
    }
}

impl Default for Clock {
    fn default() -> Self {
        Clock::with_pace(DEFAULT_PACE)
    }
}
