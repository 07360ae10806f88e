//! What a player can do with a button: the actions that `[controls]` of `game.toml` binds.

/// One entry for each key of `[controls]` that names a button.
macro_rules! actions {
    ($($(#[$doc:meta])* $name:ident = $key:literal,)*) => {
        /// What a button does.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Action {
            $($(#[$doc])* $name,)*
        }

        impl Action {
            /// All of them, in the order of `[controls]`.
            pub const ALL: [Action; [$($key),*].len()] = [$(Action::$name),*];

            /// Its key in `[controls]`.
            pub const fn key(self) -> &'static str {
                match self {
                    $(Action::$name => $key,)*
                }
            }
        }
    };
}

actions! {
    /// Thrust along the nose.
    ThrustForward = "thrust_forward",
    /// Thrust against it.
    ThrustBack = "thrust_back",
    /// Thrust to the left.
    ThrustLeft = "thrust_left",
    /// Thrust to the right.
    ThrustRight = "thrust_right",
    /// Thrust upwards.
    ThrustUp = "thrust_up",
    /// Thrust downwards.
    ThrustDown = "thrust_down",
    /// Full thrust while held.
    Boost = "boost",
    /// Fire a bolt.
    Fire = "fire",
    /// Nose up.
    PitchUp = "pitch_up",
    /// Nose down.
    PitchDown = "pitch_down",
    /// Nose left.
    YawLeft = "yaw_left",
    /// Nose right.
    YawRight = "yaw_right",
    /// Roll left.
    RollLeft = "roll_left",
    /// Roll right.
    RollRight = "roll_right",
    /// Flight assistance on or off.
    ToggleAssist = "toggle_assist",
    /// Autopilot on or off.
    ToggleAutopilot = "toggle_autopilot",
    /// Cockpit or third person.
    ToggleCamera = "toggle_camera",
    /// Look at the target while held.
    LookAtTarget = "look_at_target",
    /// Turn the nose to the target while held.
    FaceTarget = "face_target",
    /// HUD on or off.
    ToggleHud = "toggle_hud",
    /// Dev overlay on or off.
    ToggleOverlay = "toggle_overlay",
    /// Write a picture.
    Screenshot = "screenshot",
    /// Halve the pace.
    Slower = "slower",
    /// Double the pace.
    Faster = "faster",
    /// Pause and menu.
    Pause = "pause",
    /// Start the chase again.
    Restart = "restart",
    /// Name what is on the screen.
    WhatAmISeeing = "what_am_i_seeing",
    /// Photo mode.
    PhotoMode = "photo_mode",
    /// Full screen or window.
    ToggleFullScreen = "toggle_full_screen",
    /// Sound off or on.
    Mute = "mute",
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::GameConfig;
    use crate::scene::config::{self, Allowed};

    /// Every key of `[controls]` that names a button is an action, and nothing else is.
    #[test]
    fn actions_are_the_keys_of_controls() {
        let is_button = |setting: &&config::Setting<GameConfig>| setting.section == "controls" && setting.allowed == Allowed::Buttons;
        let keys: Vec<_> = config::settings().iter().filter(is_button).map(|setting| setting.key).collect();
        assert_eq!(keys, Action::ALL.map(Action::key));
    }
}
