//! Buttons for one hand.

use crate::play::choices::Choices;
use crate::play::input::action::Action;
use crate::play::input::bindings::names;
use crate::play::input::bindings::setting_of;
use crate::play::input::button::{Button, Device};
use crate::scene::GameConfig;
use crate::scene::config::{self, Value};

/// A set of buttons. The gamepad's stay as they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preset {
    /// As `game.toml` has them.
    BothHands,
    /// The left half of the keyboard, no mouse.
    LeftHand,
    /// Number pad and arrow keys, no mouse.
    RightHand,
    /// The mouse alone flies; its buttons are tapped.
    Mouse,
}

impl Preset {
    /// All of them.
    pub const ALL: [Preset; 4] = [Preset::BothHands, Preset::LeftHand, Preset::RightHand, Preset::Mouse];

    /// The key of its words.
    pub fn words(self) -> &'static str {
        match self {
            Preset::BothHands => "menu-preset-both",
            Preset::LeftHand => "menu-preset-left",
            Preset::RightHand => "menu-preset-right",
            Preset::Mouse => "menu-preset-mouse",
        }
    }

    /// The keyboard's and mouse's buttons, and what is tapped; what is not named has none.
    fn buttons(self) -> Option<(&'static [(Action, &'static str)], &'static str)> {
        use Action::*;
        match self {
            Preset::BothHands => None,
            Preset::LeftHand => Some((
                &[
                    (ThrustForward, "KeyW"),
                    (ThrustBack, "KeyS"),
                    (ThrustLeft, "KeyA"),
                    (ThrustRight, "KeyD"),
                    (ThrustUp, "Space"),
                    (ThrustDown, "ControlLeft"),
                    (Boost, "ShiftLeft"),
                    (Fire, "Tab"),
                    (PitchUp, "KeyF"),
                    (PitchDown, "KeyR"),
                    (YawLeft, "KeyZ"),
                    (YawRight, "KeyX"),
                    (RollLeft, "KeyQ"),
                    (RollRight, "KeyE"),
                    (ToggleAssist, "KeyG"),
                    (ToggleAutopilot, "KeyT"),
                    (ToggleCamera, "KeyC"),
                    (LookAtTarget, "KeyV"),
                    (FaceTarget, "Digit3"),
                    (ToggleHud, "KeyB"),
                    (Slower, "Digit1"),
                    (Faster, "Digit2"),
                    (Pause, "Escape"),
                    (Restart, "Digit5"),
                    (WhatAmISeeing, "F1"),
                    (PhotoMode, "F2"),
                    (ToggleOverlay, "F3"),
                    (Mute, "Digit4"),
                    (Screenshot, "F4"),
                    (ToggleFullScreen, "F5"),
                ],
                "boost look_at_target face_target",
            )),
            Preset::RightHand => Some((
                &[
                    (ThrustForward, "Numpad8"),
                    (ThrustBack, "Numpad2"),
                    (ThrustLeft, "Numpad4"),
                    (ThrustRight, "Numpad6"),
                    (ThrustUp, "Numpad9"),
                    (ThrustDown, "Numpad3"),
                    (Boost, "Numpad0"),
                    (Fire, "NumpadEnter"),
                    (PitchUp, "ArrowDown"),
                    (PitchDown, "ArrowUp"),
                    (YawLeft, "ArrowLeft"),
                    (YawRight, "ArrowRight"),
                    (RollLeft, "Numpad7"),
                    (RollRight, "Numpad1"),
                    (LookAtTarget, "Numpad5"),
                    (FaceTarget, "Slash"),
                    (ToggleAssist, "Home"),
                    (ToggleAutopilot, "End"),
                    (ToggleCamera, "Insert"),
                    (ToggleHud, "PageUp"),
                    (Slower, "Comma"),
                    (Faster, "Period"),
                    (Pause, "Backspace"),
                    (Restart, "F9"),
                    (WhatAmISeeing, "PageDown"),
                    (PhotoMode, "F10"),
                    (Mute, "F8"),
                    (ToggleFullScreen, "F11"),
                    (Screenshot, "F12"),
                    (ToggleOverlay, "F7"),
                ],
                "boost look_at_target face_target",
            )),
            Preset::Mouse => Some((
                &[(ThrustForward, "MouseRight"), (Fire, "MouseLeft"), (LookAtTarget, "MouseMiddle"), (Pause, "Escape")],
                "thrust_forward look_at_target",
            )),
        }
    }

    /// Chooses these buttons.
    pub fn apply(self, choices: &mut Choices, file: &GameConfig, config: &mut GameConfig) {
        let Some((buttons, tapped)) = self.buttons() else {
            choices.forget(|setting| setting.allowed == config::Allowed::Buttons || setting.key == "tapped", file, config);
            return;
        };
        for action in Action::ALL {
            let Some(setting) = setting_of(action) else { continue };
            let is_on_pad = |name: &String| Button::named(name).is_some_and(|button| button.device() == Device::Pad);
            let own = buttons.iter().filter(|(bound, _)| *bound == action).map(|(_, name)| (*name).to_owned());
            let all: Vec<String> = own.chain(names(config, action).into_iter().filter(is_on_pad)).collect();
            let words = if all.is_empty() { "None".into() } else { all.join(" ") };
            choices.choose(setting, Value::Word(words), config);
        }
        if let Some(setting) = config::setting("controls.tapped") {
            choices.choose(setting, Value::Word(tapped.into()), config);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::play::input::bindings::{Bindings, conflicts};

    #[test]
    fn each_flies_without_a_conflict_and_leaves_the_pad() {
        let file = GameConfig::default();
        for preset in Preset::ALL {
            let (mut choices, mut config) = (Choices::default(), file.clone());
            preset.apply(&mut choices, &file, &mut config);
            let bindings = Bindings::of(&config);
            for action in Action::ALL {
                assert!(conflicts(&config, action).is_empty(), "{preset:?} {}", action.key());
                let on_pad = |bindings: &Bindings| bindings.buttons(action).iter().filter(|b| b.device() == Device::Pad).count();
                assert_eq!(on_pad(&bindings), on_pad(&Bindings::of(&file)), "{preset:?} {}", action.key());
            }
            for action in [Action::ThrustForward, Action::Fire, Action::LookAtTarget, Action::Pause] {
                assert!(bindings.buttons(action).iter().any(|button| button.device() == Device::Keyboard), "{preset:?} {}", action.key());
            }
            Preset::BothHands.apply(&mut choices, &file, &mut config);
            assert_eq!(config, file, "{preset:?}");
        }
    }
}
