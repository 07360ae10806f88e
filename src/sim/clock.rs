//! The game's clock: Painlevé–Gullstrand T, in fixed steps.

use bevy::prelude::Resource;

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
    /// A clock at T = 0 with steps of `step` r_s/c.
    pub fn new(step: f64) -> Self {
        Clock { time: 0.0, step, tick: 0 }
    }

    /// T after one more step: counted, not summed, so that rounding does not add up.
    pub fn next(&self) -> f64 {
        (self.tick + 1) as f64 * self.step
    }

    /// Advances by one step.
    pub fn advance(&mut self) {
        self.time = self.next();
        self.tick += 1;
    }
}

impl Default for Clock {
    fn default() -> Self {
        Clock::new(crate::scene::GameConfig::default().clock.step)
    }
}
