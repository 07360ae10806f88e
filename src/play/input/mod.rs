//! From keys and mouse to the stick: bindings by name from `game.toml`, and what they mean.

pub mod action;
pub mod gaze;
pub mod lead;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use glam::{DVec2, DVec3};

use crate::play::input::action::Action;
use crate::scene::GameConfig;
use crate::scene::config::{self, Value};
use crate::sim::Hands;
use crate::sim::assist::Stick;

/// A key or a mouse button.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// On the keyboard.
    Key(KeyCode),
    /// On the mouse.
    Mouse(MouseButton),
}

/// The share of full thrust that the keys give without boost.
pub const CRUISE: f64 = 0.6;

/// Which button does what: the button bound to each [`Action`], if any.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Bindings([Option<Button>; Action::ALL.len()]);

impl Bindings {
    /// The bindings of a configuration.
    pub fn of(config: &GameConfig) -> Bindings {
        Bindings(Action::ALL.map(|action| {
            let setting = config::settings().iter().find(|setting| setting.section == "controls" && setting.key == action.key())?;
            match setting.get(config) {
                Value::Word(name) => button(&name),
                _ => None,
            }
        }))
    }

    fn find(&self, action: Action) -> Option<Button> {
        self.0[action as usize]
    }
}

/// The button that `game.toml` calls `name`; None for `None` and for what Bevy does not know.
pub fn button(name: &str) -> Option<Button> {
    match name {
        "MouseLeft" => return Some(Button::Mouse(MouseButton::Left)),
        "MouseRight" => return Some(Button::Mouse(MouseButton::Right)),
        "MouseMiddle" => return Some(Button::Mouse(MouseButton::Middle)),
        _ => (),
    }
    // Bevy names its keys as the W3C does, and so does the configuration.
    KEYS.iter().find(|key| format!("{key:?}") == name).map(|key| Button::Key(*key))
}

/// Every key that may be bound.
const KEYS: [KeyCode; 92] = {
    use KeyCode::*;
    [
        KeyA,
        KeyB,
        KeyC,
        KeyD,
        KeyE,
        KeyF,
        KeyG,
        KeyH,
        KeyI,
        KeyJ,
        KeyK,
        KeyL,
        KeyM,
        KeyN,
        KeyO,
        KeyP,
        KeyQ,
        KeyR,
        KeyS,
        KeyT,
        KeyU,
        KeyV,
        KeyW,
        KeyX,
        KeyY,
        KeyZ,
        Digit0,
        Digit1,
        Digit2,
        Digit3,
        Digit4,
        Digit5,
        Digit6,
        Digit7,
        Digit8,
        Digit9,
        F1,
        F2,
        F3,
        F4,
        F5,
        F6,
        F7,
        F8,
        F9,
        F10,
        F11,
        F12,
        Space,
        Enter,
        Escape,
        Tab,
        Backspace,
        Delete,
        Insert,
        Home,
        End,
        PageUp,
        PageDown,
        ArrowUp,
        ArrowDown,
        ArrowLeft,
        ArrowRight,
        ShiftLeft,
        ShiftRight,
        ControlLeft,
        ControlRight,
        AltLeft,
        AltRight,
        Minus,
        Equal,
        BracketLeft,
        BracketRight,
        Semicolon,
        Quote,
        Backquote,
        Backslash,
        Comma,
        Period,
        Slash,
        CapsLock,
        NumpadEnter,
        Numpad0,
        Numpad1,
        Numpad2,
        Numpad3,
        Numpad4,
        Numpad5,
        Numpad6,
        Numpad7,
        Numpad8,
        Numpad9,
    ]
};

/// The state of all buttons, through the bindings.
#[derive(SystemParam)]
pub struct PlayerInput<'w> {
    /// Which does what.
    pub bindings: Res<'w, Bindings>,
    /// The keyboard.
    pub keys: Res<'w, ButtonInput<KeyCode>>,
    /// The mouse.
    pub mouse: Res<'w, ButtonInput<MouseButton>>,
}

impl PlayerInput<'_> {
    /// Whether the button for `action` is held.
    pub fn holds(&self, action: Action) -> bool {
        match self.bindings.find(action) {
            Some(Button::Key(key)) => self.keys.pressed(key),
            Some(Button::Mouse(button)) => self.mouse.pressed(button),
            None => false,
        }
    }

    /// Whether it went down in this frame.
    pub fn pushed(&self, action: Action) -> bool {
        match self.bindings.find(action) {
            Some(Button::Key(key)) => self.keys.just_pressed(key),
            Some(Button::Mouse(button)) => self.mouse.just_pressed(button),
            None => false,
        }
    }

    /// The stick, as the keys have it.
    pub fn stick(&self) -> Stick {
        let axis = |plus: Action, minus: Action| f64::from(u8::from(self.holds(plus))) - f64::from(u8::from(self.holds(minus)));
        let strength = if self.holds(Action::Boost) { 1.0 } else { CRUISE };
        Stick {
            thrust: DVec3::new(
                axis(Action::ThrustRight, Action::ThrustLeft),
                axis(Action::ThrustUp, Action::ThrustDown),
                axis(Action::ThrustBack, Action::ThrustForward),
            ) * strength,
            turn: DVec3::new(
                axis(Action::PitchUp, Action::PitchDown),
                axis(Action::YawLeft, Action::YawRight),
                axis(Action::RollLeft, Action::RollRight),
            ),
        }
    }
}

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
        let turn = DVec2::new(pitch, -f64::from(pixels.x)) * controls.mouse_sensitivity;
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
    use crate::scene::config::is_key;

    /// What `ask` says of these keys and mouse buttons held down since this frame.
    fn with<T: 'static>(
        config: &GameConfig,
        keys: &[KeyCode],
        mouse: &[MouseButton],
        ask: impl Fn(&PlayerInput) -> T + Send + Sync + 'static,
    ) -> T {
        let mut world = World::new();
        world.insert_resource(Bindings::of(config));
        let (mut held, mut clicked) = (ButtonInput::default(), ButtonInput::default());
        keys.iter().for_each(|&key| held.press(key));
        mouse.iter().for_each(|&button| clicked.press(button));
        world.insert_resource(held);
        world.insert_resource(clicked);
        world.run_system_cached_with(move |_: In<()>, hands: PlayerInput| ask(&hands), ()).expect("all resources are there")
    }

    #[test]
    fn every_default_key_is_known() {
        let bindings = Bindings::of(&GameConfig::default());
        for action in Action::ALL {
            assert!(bindings.find(action).is_some(), "{}", action.key());
        }
    }

    #[test]
    fn every_name_that_the_configuration_allows_is_a_button() {
        for key in KEYS {
            let name = format!("{key:?}");
            assert!(is_key(&name), "{name}");
        }
        assert_eq!(button("None"), None);
        assert_eq!(button("MouseRight"), Some(Button::Mouse(MouseButton::Right)));
        assert_eq!(button("KeyQ"), Some(Button::Key(KeyCode::KeyQ)));
    }

    #[test]
    fn keys_move_the_stick_along_body_axes() {
        let config = GameConfig::default();
        let stick = |keys: &[KeyCode]| with(&config, keys, &[], |hands| hands.stick());
        let turned = stick(&[KeyCode::KeyW, KeyCode::ArrowLeft]);
        assert_eq!(turned.thrust, DVec3::new(0.0, 0.0, -CRUISE));
        assert_eq!(turned.turn, DVec3::Y);
        assert_eq!(stick(&[KeyCode::KeyW, KeyCode::ShiftLeft]).thrust.z, -1.0);
        assert_eq!(stick(&[KeyCode::KeyW, KeyCode::KeyS]).thrust.z, 0.0);
    }

    #[test]
    fn a_bound_mouse_button_thrusts() {
        let mut config = GameConfig::default();
        config.controls.thrust_forward = "MouseLeft".into();
        assert!(with(&config, &[], &[MouseButton::Left], |hands| hands.pushed(Action::ThrustForward)));
    }

    #[test]
    fn the_mouse_turns_as_far_as_it_went() {
        let config = GameConfig::default();
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
    }
}
