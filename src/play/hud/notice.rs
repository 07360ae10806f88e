//! Words shown for a while.

use bevy::prelude::*;

/// A line for the player, and the wall time (s) at which it fades.
#[derive(Resource, Clone, Debug, Default)]
pub struct Notice {
    /// The line.
    pub text: String,
    /// Until when it is shown.
    pub until: f64,
    /// The share of something that is done so far, 0 to 1, shown as a bar.
    pub share: Option<f64>,
}
