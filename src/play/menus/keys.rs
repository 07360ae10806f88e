//! What keyboard and gamepad do to a menu. These keys are the same for everybody: whoever binds the others cannot lock himself out.

use bevy::input::ButtonState;
use bevy::input::gamepad::{Gamepad, GamepadButton};
use bevy::input::keyboard::KeyboardInput;
use bevy::prelude::*;

use crate::play::menus::entries::{Touch, Way};

/// Wall time after which a held key steps again, and between the steps that follow, in seconds.
const REPEATS: (f64, f64) = (0.4, 0.09);
/// A stick steps from this share of its way on.
const PUSHED: f32 = 0.6;

/// The way that is held, and the wall time of its next step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Held(Option<(Way, f64)>);

/// The keys that went down in this frame, each as often as it did: in a long frame one may be tapped twice.
pub fn pressed(keys: &ButtonInput<KeyCode>, messages: impl Iterator<Item = KeyboardInput>) -> Vec<KeyCode> {
    let mut found: Vec<KeyCode> =
        messages.filter(|message| message.state == ButtonState::Pressed && !message.repeat).map(|message| message.key_code).collect();
    let unsaid: Vec<KeyCode> = keys.get_just_pressed().filter(|key| !found.contains(key)).copied().collect();
    found.extend(unsaid);
    found
}

/// What is done in this frame at the wall time `now` (s), in which the keys `pressed` went down.
pub fn touches(keys: &ButtonInput<KeyCode>, pressed: &[KeyCode], pads: &[&Gamepad], now: f64, held: &mut Held) -> Vec<Touch> {
    let mut done = Vec::new();
    let on_pad = |button: GamepadButton| pads.iter().any(|pad| pad.just_pressed(button));
    for key in pressed {
        done.extend(match key {
            KeyCode::Enter | KeyCode::NumpadEnter | KeyCode::Space => Some(Touch::Confirm),
            KeyCode::Escape => Some(Touch::Back),
            KeyCode::Delete | KeyCode::Backspace => Some(Touch::Clear),
            KeyCode::Tab if keys.any_pressed([KeyCode::ShiftLeft, KeyCode::ShiftRight]) => Some(Touch::Step(Way::Up)),
            KeyCode::Tab => Some(Touch::Step(Way::Down)),
            KeyCode::ArrowUp => Some(Touch::Step(Way::Up)),
            KeyCode::ArrowDown => Some(Touch::Step(Way::Down)),
            KeyCode::ArrowLeft => Some(Touch::Step(Way::Left)),
            KeyCode::ArrowRight => Some(Touch::Step(Way::Right)),
            _ => None,
        });
    }
    for (button, touch) in [
        (GamepadButton::South, Touch::Confirm),
        (GamepadButton::East, Touch::Back),
        (GamepadButton::Start, Touch::Back),
        (GamepadButton::North, Touch::Clear),
    ] {
        done.extend(on_pad(button).then_some(touch));
    }
    let stepped = done.iter().any(|touch| matches!(touch, Touch::Step(_)));
    held.0 = match (way(keys, pads), held.0) {
        (None, _) => None,
        (Some(way), _) if stepped => Some((way, now + REPEATS.0)),
        (Some(way), Some((before, next))) if before == way && now < next => Some((way, next)),
        (Some(way), before) => {
            done.push(Touch::Step(way));
            let again = before.is_some_and(|(before, _)| before == way);
            Some((way, now + if again { REPEATS.1 } else { REPEATS.0 }))
        }
    };
    done
}

/// The way that is held.
fn way(keys: &ButtonInput<KeyCode>, pads: &[&Gamepad]) -> Option<Way> {
    let ways = [
        (KeyCode::ArrowUp, GamepadButton::DPadUp, Vec2::Y, Way::Up),
        (KeyCode::ArrowDown, GamepadButton::DPadDown, Vec2::NEG_Y, Way::Down),
        (KeyCode::ArrowLeft, GamepadButton::DPadLeft, Vec2::NEG_X, Way::Left),
        (KeyCode::ArrowRight, GamepadButton::DPadRight, Vec2::X, Way::Right),
    ];
    let pushed = |pad: &&Gamepad, button, towards: Vec2| pad.pressed(button) || pad.left_stick().dot(towards) > PUSHED;
    let found = ways.iter().find(|(key, button, towards, _)| keys.pressed(*key) || pads.iter().any(|pad| pushed(pad, *button, *towards)));
    found.map(|(.., way)| *way)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::input::keyboard::Key;

    #[test]
    fn a_held_key_steps_once_then_again_and_again() {
        let (mut keys, mut held) = (ButtonInput::default(), Held::default());
        keys.press(KeyCode::ArrowDown);
        let mut frame = |keys: &mut ButtonInput<KeyCode>, now: f64| {
            let pressed = pressed(keys, std::iter::empty());
            keys.clear();
            touches(keys, &pressed, &[], now, &mut held).len()
        };
        let steps: Vec<usize> = (0..20).map(|number| frame(&mut keys, 0.05 * f64::from(number))).collect();
        assert_eq!(steps.iter().sum::<usize>(), 7, "{steps:?}");
        assert_eq!(steps[..8], [1, 0, 0, 0, 0, 0, 0, 0]);
        keys.release(KeyCode::ArrowDown);
        assert_eq!(frame(&mut keys, 2.0), 0);
    }

    #[test]
    fn each_tap_of_a_long_frame_counts() {
        let tap = |state| KeyboardInput {
            key_code: KeyCode::ArrowUp,
            logical_key: Key::ArrowUp,
            state,
            text: None,
            repeat: false,
            window: Entity::PLACEHOLDER,
        };
        let taps = [ButtonState::Pressed, ButtonState::Released, ButtonState::Pressed, ButtonState::Released].map(tap);
        let mut keys = ButtonInput::default();
        keys.press(KeyCode::ArrowUp);
        keys.release(KeyCode::ArrowUp);
        let pressed = pressed(&keys, taps.into_iter());
        let touches = touches(&keys, &pressed, &[], 0.0, &mut Held::default());
        assert_eq!(touches, [Touch::Step(Way::Up); 2]);
    }
}
