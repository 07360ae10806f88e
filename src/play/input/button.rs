//! Keys and buttons by the names that the configuration has for them.

use bevy::input::gamepad::{GamepadAxis, GamepadButton};
use bevy::prelude::*;

use crate::scene::config::buttons::{PAD, STICKS};

/// Something that is pressed or pushed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Button {
    /// On the keyboard.
    Key(KeyCode),
    /// On the mouse.
    Mouse(MouseButton),
    /// On the gamepad.
    Pad(GamepadButton),
    /// A stick of the gamepad, pushed along an axis (x right, y up) or, with the sign −1, against it.
    Stick(GamepadAxis, f32),
}

/// What moves the game.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Resource)]
pub enum Device {
    /// Keyboard and mouse.
    #[default]
    Keyboard,
    /// The gamepad.
    Pad,
    /// Fingers on the screen.
    Touch,
}

/// The gamepad's buttons, in the order of [`PAD`].
const PAD_BUTTONS: [GamepadButton; 16] = [
    GamepadButton::South,
    GamepadButton::East,
    GamepadButton::North,
    GamepadButton::West,
    GamepadButton::LeftTrigger,
    GamepadButton::RightTrigger,
    GamepadButton::LeftTrigger2,
    GamepadButton::RightTrigger2,
    GamepadButton::Select,
    GamepadButton::Start,
    GamepadButton::LeftThumb,
    GamepadButton::RightThumb,
    GamepadButton::DPadUp,
    GamepadButton::DPadDown,
    GamepadButton::DPadLeft,
    GamepadButton::DPadRight,
];

/// The sticks' ways, in the order of [`STICKS`].
pub(super) const STICK_WAYS: [(GamepadAxis, f32); 8] = [
    (GamepadAxis::LeftStickY, 1.0),
    (GamepadAxis::LeftStickY, -1.0),
    (GamepadAxis::LeftStickX, -1.0),
    (GamepadAxis::LeftStickX, 1.0),
    (GamepadAxis::RightStickY, 1.0),
    (GamepadAxis::RightStickY, -1.0),
    (GamepadAxis::RightStickX, -1.0),
    (GamepadAxis::RightStickX, 1.0),
];

impl Button {
    /// The button that `game.toml` calls `name`; None for `None` and for what is unknown.
    pub fn named(name: &str) -> Option<Button> {
        match name {
            "MouseLeft" => return Some(Button::Mouse(MouseButton::Left)),
            "MouseRight" => return Some(Button::Mouse(MouseButton::Right)),
            "MouseMiddle" => return Some(Button::Mouse(MouseButton::Middle)),
            _ => (),
        }
        if let Some(k) = PAD.iter().position(|known| *known == name) {
            return Some(Button::Pad(PAD_BUTTONS[k]));
        }
        if let Some(k) = STICKS.iter().position(|known| *known == name) {
            return Some(Button::Stick(STICK_WAYS[k].0, STICK_WAYS[k].1));
        }
        KEYS.iter().find(|key| format!("{key:?}") == name).map(|key| Button::Key(*key))
    }

    /// Its name in `game.toml`; None where none is known.
    pub fn name(self) -> Option<String> {
        match self {
            Button::Key(key) => KEYS.contains(&key).then(|| format!("{key:?}")),
            Button::Mouse(MouseButton::Left) => Some("MouseLeft".into()),
            Button::Mouse(MouseButton::Right) => Some("MouseRight".into()),
            Button::Mouse(MouseButton::Middle) => Some("MouseMiddle".into()),
            Button::Mouse(_) => None,
            Button::Pad(button) => PAD_BUTTONS.iter().position(|known| *known == button).map(|k| PAD[k].to_owned()),
            Button::Stick(axis, sign) => STICK_WAYS.iter().position(|known| *known == (axis, sign)).map(|k| STICKS[k].to_owned()),
        }
    }

    /// The device that it is on.
    pub fn device(self) -> Device {
        match self {
            Button::Key(_) | Button::Mouse(_) => Device::Keyboard,
            Button::Pad(_) | Button::Stick(..) => Device::Pad,
        }
    }
}

/// Every key that may be bound; Bevy names its keys as the W3C does, and so does the configuration.
pub(super) const KEYS: [KeyCode; 92] = {
    use KeyCode::*;
    [
        KeyA, KeyB, KeyC, KeyD, KeyE, KeyF, KeyG, KeyH, KeyI, KeyJ, KeyK, KeyL, KeyM, KeyN, KeyO, KeyP, KeyQ, KeyR, KeyS, KeyT, KeyU, KeyV,
        KeyW, KeyX, KeyY, KeyZ, Digit0, Digit1, Digit2, Digit3, Digit4, Digit5, Digit6, Digit7, Digit8, Digit9, F1, F2, F3, F4, F5, F6, F7,
        F8, F9, F10, F11, F12, Space, Enter, Escape, Tab, Backspace, Delete, Insert, Home, End, PageUp, PageDown, ArrowUp, ArrowDown,
        ArrowLeft, ArrowRight, ShiftLeft, ShiftRight, ControlLeft, ControlRight, AltLeft, AltRight, Minus, Equal, BracketLeft,
        BracketRight, Semicolon, Quote, Backquote, Backslash, Comma, Period, Slash, CapsLock, NumpadEnter, Numpad0, Numpad1, Numpad2,
        Numpad3, Numpad4, Numpad5, Numpad6, Numpad7, Numpad8, Numpad9,
    ]
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::config::buttons::{MOUSE, is_button};

    #[test]
    fn every_button_is_found_by_its_name() {
        let keys = KEYS.iter().map(|key| format!("{key:?}"));
        for name in keys.chain([&MOUSE[..], &PAD, &STICKS].concat().into_iter().map(str::to_owned)) {
            assert!(is_button(&name), "{name}");
            assert_eq!(Button::named(&name).and_then(Button::name), Some(name));
        }
        assert_eq!(Button::named("None"), None);
    }
}
