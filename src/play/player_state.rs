//! The player at the controls.

use crate::play::camera::orbit::Orbit;
use crate::play::camera::{CameraView, Follower};
use crate::play::input::gaze::Gaze;
use crate::scene::GameConfig;
use crate::scene::pilot_kind::PilotKind;
use crate::sim::assist::AssistMode;
use bevy::prelude::*;

/// The assist's key chooses another mode if it is let go before this, in seconds; from then on it matches.
pub const TAP: f64 = 0.25;

/// How the player plays: what is not in `game.toml`.
#[derive(Resource, Clone, Debug, Default)]
pub struct PlayerState {
    /// The autopilot flies.
    pub autopilot: bool,
    /// From where one looks.
    pub view: CameraView,
    /// The HUD is off.
    pub hud_off: bool,
    /// The dev overlay is on.
    pub overlay: bool,
    /// The flight assist as the player switched it in this chase; None: as it is configured.
    pub assist: Option<AssistMode>,
    /// For how long its key has been held, in seconds of wall time; None while it is not.
    pub assist_held: Option<f64>,
    /// Who has flown in this chase.
    pub flown: Flown,
    /// Who flies instead of the player from the start, as asked for on the command line.
    pub pilot: Option<PilotKind>,
    /// How the camera follows.
    pub follower: Follower,
    /// The player has thrust, looked at the target or let the autopilot fly, as the hint of the first flight says; or had time to read it.
    pub begun: bool,
    /// The player has used a control in this chase: until then it goes slowly.
    pub touched: bool,
    /// The next flight begins as the last one did.
    pub same_start: bool,
    /// How long that hint has been shown, in seconds of wall time.
    pub hinted: f64,
    /// The key that turns the camera to the target is held.
    pub looking: bool,
    /// The key that turns the nose to where thrust leads to the target is held.
    pub facing: bool,
    /// The trigger was pulled since the last step: a click may be shorter than a frame.
    pub fired: bool,
    /// Which mission is chosen on the title.
    pub choice: usize,
    /// Which scene is chosen for free flight.
    pub free: usize,
    /// The free camera of a replay, and in flight the distance of the third-person camera.
    pub orbit: Orbit,
    /// How far the camera has turned to the target.
    pub gaze: Gaze,
    /// What is on the screen was asked for in play, where the way back leads.
    pub seeing_from_play: bool,
}

/// Who has had a ship's controls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flown {
    /// The player, by hand.
    pub by_hand: bool,
    /// The autopilot.
    pub by_autopilot: bool,
}

impl PlayerState {
    /// How the assist helps: as the player switched it, else as `config` says.
    pub fn assisted(&self, config: &GameConfig) -> AssistMode {
        self.assist.unwrap_or(AssistMode::of(config))
    }

    /// Whether the assist's key is held long enough to match the target's motion.
    pub fn matching(&self) -> bool {
        self.assist_held.is_some_and(|held| held >= TAP)
    }
}

/// The key of the words for what the assist holds to.
pub fn assist_words(mode: AssistMode) -> &'static str {
    match mode {
        AssistMode::Orbit => "hud-assist",
        AssistMode::Target => "hud-assist-target",
        AssistMode::Off => "hud-free-flight",
    }
}
