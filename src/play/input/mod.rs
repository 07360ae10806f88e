//! From keys, mouse, gamepad and fingers to the stick: bindings by name from the configuration, and what they mean.

pub mod action;
pub mod bindings;
pub mod button;
pub mod gaze;
pub mod lead;
pub mod mouse;
pub mod response;
pub mod touch;

use bevy::ecs::message::MessageUpdateSystems;
use bevy::ecs::system::SystemParam;
use bevy::input::InputSystems;
use bevy::input::gamepad::{Gamepad, GamepadAxis, GamepadButton};
use bevy::input::mouse::AccumulatedMouseMotion;
use bevy::input::touch::TouchInput;
use bevy::prelude::*;
use glam::{DVec2, DVec3};

use crate::play::input::action::Action;
use crate::play::input::bindings::Bindings;
use crate::play::input::button::{Button, Device, STICK_WAYS};
use crate::play::input::mouse::MouseTurn;
use crate::play::input::response::Response;
use crate::play::input::touch::{TouchControls, read_touches, spread_taps};
use crate::sim::assist::Stick;

/// The share of full thrust that the keys give without boost.
pub const CRUISE: f64 = 0.6;

/// Reads the devices.
pub struct ControlsPlugin;

impl Plugin for ControlsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Bindings>()
            .init_resource::<ButtonInput<StickWay>>()
            .init_resource::<Taps>()
            .init_resource::<NextTaps>()
            .init_resource::<Device>()
            .init_resource::<MouseTurn>()
            .init_resource::<AccumulatedMouseMotion>()
            .init_resource::<TouchControls>()
            .add_message::<TouchInput>()
            .add_systems(First, spread_taps.after(MessageUpdateSystems))
            .add_systems(PreUpdate, (read_touches, note_device, note_sticks, note_taps, take_taps).chain().after(InputSystems));
    }
}

/// A way of a stick: its axis, and whether along it.
type StickWay = (GamepadAxis, bool);

/// A stick counts as pressed from this share of its way on.
const STICK_PRESSED: f32 = 0.5;

/// Sticks as buttons, one for each way.
fn note_sticks(pads: Query<&Gamepad>, mut sticks: ResMut<ButtonInput<StickWay>>) {
    sticks.clear();
    for (axis, sign) in STICK_WAYS {
        let way = (axis, sign > 0.0);
        if pads.iter().any(|pad| pad.get(axis).unwrap_or(0.0) * sign > STICK_PRESSED) {
            sticks.press(way);
        } else {
            sticks.release(way);
        }
    }
}

/// The actions that a tap has switched on.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub struct Taps([bool; Action::ALL.len()]);

/// What is switched on from this frame on.
#[derive(Resource, Clone, Copy, Debug, Default)]
struct NextTaps(Taps);

fn note_taps(input: PlayerInput, mut taps: ResMut<NextTaps>) {
    for action in Action::ALL {
        let on = input.taps.0[action as usize];
        taps.0.0[action as usize] = input.bindings.is_tapped(action) && (on != input.pushed(action));
    }
}

fn take_taps(next: Res<NextTaps>, mut taps: ResMut<Taps>) {
    *taps = next.0;
}

/// Which device was used last: prompts name its buttons.
fn note_device(
    keys: Res<ButtonInput<KeyCode>>,
    mouse: Res<ButtonInput<MouseButton>>,
    motion: Res<AccumulatedMouseMotion>,
    pads: Query<&Gamepad>,
    mut device: ResMut<Device>,
) {
    /// A stick counts from here on: at rest it may lie a little aside.
    const PUSHED: f32 = 0.4;
    /// So far the mouse moves by hand, in pixels a frame.
    const MOVED: f32 = 3.0;
    let pushed = |pad: &Gamepad| pad.left_stick().length().max(pad.right_stick().length()) > PUSHED;
    let next = if pads.iter().any(|pad| pad.get_just_pressed().next().is_some() || pushed(pad)) {
        Device::Pad
    } else if keys.get_just_pressed().next().is_some() || mouse.get_just_pressed().next().is_some() || motion.delta.length() > MOVED {
        Device::Keyboard
    } else {
        return;
    };
    device.set_if_neq(next);
}

/// The state of all buttons, through the bindings.
#[derive(SystemParam)]
pub struct PlayerInput<'w, 's> {
    /// Which does what.
    pub bindings: Res<'w, Bindings>,
    taps: Res<'w, Taps>,
    /// The keyboard.
    pub keys: Res<'w, ButtonInput<KeyCode>>,
    mouse: Res<'w, ButtonInput<MouseButton>>,
    pads: Query<'w, 's, &'static Gamepad>,
    sticks: Res<'w, ButtonInput<StickWay>>,
    touch: Res<'w, TouchControls>,
}

impl PlayerInput<'_, '_> {
    /// Whether the button for `action` is held, or a tap has switched it on.
    pub fn holds(&self, action: Action) -> bool {
        if self.bindings.is_tapped(action) {
            return self.taps.0[action as usize];
        }
        self.touch.holds(action) || self.bindings.buttons(action).iter().any(|button| self.is_down(*button))
    }

    fn is_down(&self, button: Button) -> bool {
        match button {
            Button::Key(key) => self.keys.pressed(key),
            Button::Mouse(button) => self.mouse.pressed(button),
            Button::Pad(button) => self.pads.iter().any(|pad| pad.pressed(button)),
            Button::Stick(axis, sign) => self.sticks.pressed((axis, sign > 0.0)),
        }
    }

    /// Whether it went down in this frame. A short press may begin and end within one, which leaves nothing that is held.
    pub fn pushed(&self, action: Action) -> bool {
        let on_device = self.bindings.buttons(action).iter().any(|button| match *button {
            Button::Key(key) => self.keys.just_pressed(key),
            Button::Mouse(button) => self.mouse.just_pressed(button),
            Button::Pad(button) => self.pads.iter().any(|pad| pad.just_pressed(button)),
            Button::Stick(axis, sign) => self.sticks.just_pressed((axis, sign > 0.0)),
        });
        on_device || self.touch.pushed(action)
    }

    /// Whether a key, or a button that is pressed or not, asks for `action`.
    fn wholly(&self, action: Action) -> bool {
        if self.bindings.is_tapped(action) {
            return self.taps.0[action as usize];
        }
        self.touch.holds(action) || self.bindings.buttons(action).iter().any(|button| !is_gradual(*button) && self.is_down(*button))
    }

    /// How far sticks and triggers ask for `action`, 0 to 1, and whether a stick does.
    fn partly(&self, action: Action) -> f64 {
        if self.bindings.is_tapped(action) {
            return 0.0;
        }
        let (left, right) = (Response::left(&self.bindings.controls), Response::right(&self.bindings.controls));
        let asks = |button: &Button, pad: &Gamepad| match *button {
            Button::Stick(axis, sign) => {
                let is_left = matches!(axis, GamepadAxis::LeftStickX | GamepadAxis::LeftStickY);
                let (way, response) = if is_left { (pad.left_stick(), left) } else { (pad.right_stick(), right) };
                let answer = response.both(DVec2::new(f64::from(way.x), f64::from(way.y)));
                let along = if matches!(axis, GamepadAxis::LeftStickX | GamepadAxis::RightStickX) { answer.x } else { answer.y };
                (along * f64::from(sign)).max(0.0)
            }
            Button::Pad(button) if is_trigger(button) => right.answer(f64::from(pad.get(button).unwrap_or(0.0))),
            _ => 0.0,
        };
        let buttons = self.bindings.buttons(action);
        self.pads.iter().flat_map(|pad| buttons.iter().map(move |button| asks(button, pad))).fold(self.touch.partly(action), f64::max)
    }

    /// The stick: keys thrust at [`CRUISE`] or, with boost, fully; a stick of the gamepad as far as it is pushed.
    pub fn stick(&self) -> Stick {
        let axis = |plus: Action, minus: Action, whole: f64, part: f64| {
            let keys = f64::from(u8::from(self.wholly(plus))) - f64::from(u8::from(self.wholly(minus)));
            (keys * whole + (self.partly(plus) - self.partly(minus)) * part).clamp(-1.0, 1.0)
        };
        let controls = &self.bindings.controls;
        let strength = if self.holds(Action::Boost) { 1.0 } else { CRUISE };
        let signed = |most: f64, inverted: bool| if inverted { -most } else { most };
        let thrust = |plus, minus| axis(plus, minus, strength, signed(controls.stick_thrust, controls.stick_invert_thrust));
        let (pitch, yaw) =
            (signed(controls.stick_pitch, controls.stick_invert_pitch), signed(controls.stick_yaw, controls.stick_invert_yaw));
        Stick {
            thrust: DVec3::new(
                thrust(Action::ThrustRight, Action::ThrustLeft),
                thrust(Action::ThrustUp, Action::ThrustDown),
                thrust(Action::ThrustBack, Action::ThrustForward),
            ),
            turn: DVec3::new(
                axis(Action::PitchUp, Action::PitchDown, 1.0, pitch),
                axis(Action::YawLeft, Action::YawRight, 1.0, yaw),
                axis(Action::RollLeft, Action::RollRight, 1.0, 1.0),
            ),
        }
    }
}

/// Whether a button is pressed more or less.
fn is_gradual(button: Button) -> bool {
    match button {
        Button::Pad(button) => is_trigger(button),
        Button::Stick(..) => true,
        Button::Key(_) | Button::Mouse(_) => false,
    }
}

fn is_trigger(button: GamepadButton) -> bool {
    matches!(button, GamepadButton::LeftTrigger2 | GamepadButton::RightTrigger2)
}

#[cfg(test)]
pub(in crate::play) mod tests {
    use super::*;
    use crate::scene::GameConfig;
    use bevy::input::gamepad::{
        GamepadConnection, GamepadConnectionEvent, RawGamepadAxisChangedEvent, RawGamepadButtonChangedEvent, RawGamepadEvent,
    };
    use bevy::input::keyboard::KeyboardInput;
    use bevy::input::{ButtonState, InputPlugin};

    /// An app with nothing but its devices.
    fn devices(config: &GameConfig) -> App {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, InputPlugin, ControlsPlugin)).insert_resource(Bindings::of(config));
        app.update();
        app
    }

    /// Plugs a gamepad in: the events that the driver's plugin sends, which needs none.
    fn plug_pad(app: &mut App) -> Entity {
        let pad = app.world_mut().spawn_empty().id();
        let connection = GamepadConnection::Connected { name: "test".into(), vendor_id: None, product_id: None };
        let event = GamepadConnectionEvent { gamepad: pad, connection };
        app.world_mut().write_message(event.clone());
        app.world_mut().write_message(RawGamepadEvent::Connection(event));
        app.update();
        pad
    }

    /// Presses a key, or lets it go, as the window's events do.
    pub(in crate::play) fn press_key(app: &mut App, key: KeyCode, state: ButtonState) {
        let logical_key = bevy::input::keyboard::Key::Unidentified(bevy::input::keyboard::NativeKey::Unidentified);
        let window = Entity::PLACEHOLDER;
        app.world_mut().write_message(KeyboardInput { key_code: key, logical_key, state, text: None, repeat: false, window });
    }

    /// Pushes a stick of it.
    fn push_stick(app: &mut App, gamepad: Entity, axis: GamepadAxis, value: f32) {
        app.world_mut().write_message(RawGamepadEvent::Axis(RawGamepadAxisChangedEvent { gamepad, axis, value }));
    }

    /// Presses a button of it, or lets it go.
    fn press_pad(app: &mut App, gamepad: Entity, button: GamepadButton, value: f32) {
        app.world_mut().write_message(RawGamepadEvent::Button(RawGamepadButtonChangedEvent { gamepad, button, value }));
    }

    fn ask<T: 'static>(app: &mut App, question: impl Fn(&PlayerInput) -> T + Send + Sync + 'static) -> T {
        app.world_mut().run_system_cached_with(move |_: In<()>, input: PlayerInput| question(&input), ()).expect("all resources are there")
    }

    /// The stick with these keys held.
    fn stick(config: &GameConfig, keys: &[KeyCode]) -> Stick {
        let mut app = devices(config);
        keys.iter().for_each(|&key| press_key(&mut app, key, ButtonState::Pressed));
        app.update();
        ask(&mut app, |input| input.stick())
    }

    #[test]
    fn keys_move_the_stick_along_body_axes() {
        let config = GameConfig::default();
        let turned = stick(&config, &[KeyCode::KeyW, KeyCode::ArrowLeft]);
        assert_eq!(turned.thrust, DVec3::new(0.0, 0.0, -CRUISE));
        assert_eq!(turned.turn, DVec3::Y);
        assert_eq!(stick(&config, &[KeyCode::KeyW, KeyCode::ShiftLeft]).thrust.z, -1.0);
        assert_eq!(stick(&config, &[KeyCode::KeyW, KeyCode::KeyS]).thrust.z, 0.0);
    }

    #[test]
    fn a_bound_mouse_button_thrusts() {
        let mut config = GameConfig::default();
        config.controls.thrust_forward = "MouseLeft".into();
        let mut app = devices(&config);
        app.world_mut().resource_mut::<ButtonInput<MouseButton>>().press(MouseButton::Left);
        assert_eq!(ask(&mut app, |input| input.stick()).thrust.z, -CRUISE);
    }

    #[test]
    fn the_pad_thrusts_and_turns_as_far_as_it_is_pushed() {
        let mut app = devices(&GameConfig::default());
        let pad = plug_pad(&mut app);
        let thrust = |app: &mut App, value| {
            push_stick(app, pad, GamepadAxis::LeftStickY, value);
            app.update();
            ask(app, |input| input.stick().thrust.z)
        };
        let half = thrust(&mut app, 0.5);
        assert!(half < 0.0 && half > -0.5, "{half}");
        assert_eq!(thrust(&mut app, 1.0), -1.0);
        assert_eq!(thrust(&mut app, 0.08), 0.0, "the dead zone");
        push_stick(&mut app, pad, GamepadAxis::RightStickX, 1.0);
        app.update();
        assert_eq!(ask(&mut app, |input| input.stick().turn), DVec3::NEG_Y, "to the right");
        assert_eq!(*app.world().resource::<Device>(), Device::Pad);
        press_pad(&mut app, pad, GamepadButton::RightTrigger2, 1.0);
        app.update();
        assert!(ask(&mut app, |input| input.pushed(Action::Fire)));
        app.update();
        assert!(ask(&mut app, |input| input.holds(Action::Fire) && !input.pushed(Action::Fire)));
    }

    /// A stick that is bound to what a button does is pushed once from half of its way on, and held until it comes back.
    #[test]
    fn a_stick_is_a_button_from_half_of_its_way_on() {
        let mut config = GameConfig::default();
        config.controls.toggle_hud = "PadRightStickUp".into();
        let mut app = devices(&config);
        let pad = plug_pad(&mut app);
        let states = [0.4, 0.6, 0.9, 0.2, -1.0].map(|value| {
            push_stick(&mut app, pad, GamepadAxis::RightStickY, value);
            app.update();
            ask(&mut app, |input| [input.pushed(Action::ToggleHud), input.holds(Action::ToggleHud)])
        });
        assert_eq!(states, [[false, false], [true, true], [false, true], [false, false], [false, false]]);
    }

    #[test]
    fn inversion_and_strength_are_the_sticks_own() {
        let mut config = GameConfig::default();
        config.controls.stick_invert_pitch = true;
        config.controls.stick_pitch = 0.5;
        let mut app = devices(&config);
        let pad = plug_pad(&mut app);
        let up = |app: &mut App| {
            push_stick(app, pad, GamepadAxis::RightStickY, 1.0);
            app.update();
            ask(app, |input| input.stick().turn.x)
        };
        // Pushed forward the nose goes down, inverted up.
        assert_eq!(up(&mut app), 0.5);
        app.insert_resource(Bindings::of(&GameConfig::default()));
        assert_eq!(up(&mut app), -1.0);
    }

    /// A press that begins and ends between two slow frames counts.
    #[test]
    fn a_short_press_is_not_missed() {
        let mut app = devices(&GameConfig::default());
        press_key(&mut app, KeyCode::F1, ButtonState::Pressed);
        press_key(&mut app, KeyCode::F1, ButtonState::Released);
        app.update();
        assert!(ask(&mut app, |input| input.pushed(Action::WhatAmISeeing) && !input.holds(Action::WhatAmISeeing)));
        app.update();
        assert!(!ask(&mut app, |input| input.pushed(Action::WhatAmISeeing)));
    }

    /// One tap thrusts, the next stops.
    #[test]
    fn a_tap_switches_what_is_otherwise_held() {
        let mut config = GameConfig::default();
        config.controls.tapped = "thrust_forward boost".into();
        let mut app = devices(&config);
        let tap = |app: &mut App, key| {
            for state in [ButtonState::Pressed, ButtonState::Released] {
                press_key(app, key, state);
                app.update();
            }
            ask(app, |input| input.stick().thrust.z)
        };
        assert_eq!(tap(&mut app, KeyCode::KeyW), -CRUISE);
        assert_eq!(tap(&mut app, KeyCode::ShiftLeft), -1.0);
        assert_eq!(tap(&mut app, KeyCode::KeyW), 0.0);
    }
}
