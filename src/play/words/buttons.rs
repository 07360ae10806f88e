//! Buttons as they are written on the device.

use super::Language;
use crate::play::input::action::Action;
use crate::play::input::bindings::Bindings;
use crate::play::input::button::{Button, Device};
use crate::play::input::touch::word_of;

/// What a button is called; `—` for none.
pub fn written(language: Language, button: Option<Button>) -> String {
    let Some(name) = button.and_then(Button::name) else { return "—".into() };
    let short = name.strip_prefix("Key").or_else(|| name.strip_prefix("Digit")).filter(|rest| rest.len() == 1);
    if let Some(short) = short {
        return short.to_owned();
    }
    // Names on the keyboard that are the same everywhere stand as they are.
    let key = format!("button-{}", dashed(&name));
    let said = language.say(&key);
    if said == key { name } else { said }
}

/// The button of an action on the device in use, as it is written there.
pub fn of(language: Language, bindings: &Bindings, device: Device, action: Action) -> String {
    if device == Device::Touch {
        return word_of(action).map_or_else(|| "—".into(), |word| language.say(word));
    }
    written(language, bindings.shown(action, device))
}

/// `MouseLeft` as `mouse-left`.
fn dashed(name: &str) -> String {
    let mut dashed = String::new();
    for (k, letter) in name.chars().enumerate() {
        if letter.is_uppercase() && k > 0 {
            dashed.push('-');
        }
        dashed.extend(letter.to_lowercase());
    }
    dashed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_as_written_on_the_keyboard() {
        let written = |name: &str| written(Language::English, Button::named(name));
        assert_eq!(["KeyW", "Digit4", "ControlLeft", "F3", "Space"].map(written), ["W", "4", "Ctrl", "F3", "Space"]);
        assert_eq!(["PadSouth", "PadLeftStickUp", "MouseLeft", "None"].map(written), ["Ⓐ", "L stick ↑", "left mouse button", "—"]);
    }
}
