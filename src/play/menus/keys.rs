//! What keyboard and gamepad do to a menu. These keys are the same for everybody: whoever binds the others cannot lock himself out.

use bevy::input::gamepad::{Gamepad, GamepadButton};
use bevy::prelude::*;

use crate::play::menus::entries::{Touch, Way};

/// Wall time after which a held key steps again, and between the steps that follow, in seconds.
const REPEATS: (f64, f64) = (0.4, 0.09);
/// A stick steps from this share of its way on.
const PUSHED: f32 = 0.6;

/// The way that is held, and the wall time of its next step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Held(Option<(Way, f64)>);

/// What is done in this frame at the wall time `now` (s).
pub fn touches(keys: &ButtonInput<KeyCode>, pads: &[&Gamepad], now: f64, held: &mut Held) -> Vec<Touch> {
    let mut done = Vec::new();
    let on_pad = |button: GamepadButton| pads.iter().any(|pad| pad.just_pressed(button));
    if keys.any_just_pressed([KeyCode::Enter, KeyCode::NumpadEnter, KeyCode::Space]) || on_pad(GamepadButton::South) {
        done.push(Touch::Confirm);
    }
    if keys.just_pressed(KeyCode::Escape) || on_pad(GamepadButton::East) || on_pad(GamepadButton::Start) {
        done.push(Touch::Back);
    }
    if keys.just_pressed(KeyCode::Delete) || keys.just_pressed(KeyCode::Backspace) || on_pad(GamepadButton::North) {
        done.push(Touch::Clear);
    }
    if keys.just_pressed(KeyCode::Tab) {
        let back = keys.any_pressed([KeyCode::ShiftLeft, KeyCode::ShiftRight]);
        done.push(Touch::Step(if back { Way::Up } else { Way::Down }));
    }
    let way = way(keys, pads);
    held.0 = match (way, held.0) {
        (None, _) => None,
        (Some(way), Some((before, next))) if before == way && now < next => held.0.map(|_| (way, next)),
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
    let found = ways.iter().find(|(key, button, towards, _)| {
        // A key that went down and up within one frame counts as well.
        keys.pressed(*key) || keys.just_pressed(*key) || pads.iter().any(|pad| pushed(pad, *button, *towards))
    });
    found.map(|(.., way)| *way)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_held_key_steps_once_then_again_and_again() {
        let (mut keys, mut held) = (ButtonInput::default(), Held::default());
        keys.press(KeyCode::ArrowDown);
        let steps: Vec<usize> = (0..20).map(|frame| touches(&keys, &[], 0.05 * f64::from(frame), &mut held).len()).collect();
        assert_eq!(steps.iter().sum::<usize>(), 7, "{steps:?}");
        assert_eq!(steps[..8], [1, 0, 0, 0, 0, 0, 0, 0]);
        keys.release(KeyCode::ArrowDown);
        keys.clear();
        assert!(touches(&keys, &[], 2.0, &mut held).is_empty());
    }
}
