//! The names of keys and buttons, of which `[controls]` binds up to four to an action.

/// Most names for one action.
pub const MOST_BUTTONS: usize = 4;

/// Keys beside letters, digits and function keys, as the W3C UI Events `code` values (and Bevy's `KeyCode`) name them.
const KEYS: [&str; 34] = [
    "Space", "Enter", "Escape", "Tab", "Backspace", "Delete", "Insert", "Home", "End", "PageUp", "PageDown", "ArrowUp", "ArrowDown",
    "ArrowLeft", "ArrowRight", "ShiftLeft", "ShiftRight", "ControlLeft", "ControlRight", "AltLeft", "AltRight", "Minus", "Equal",
    "BracketLeft", "BracketRight", "Semicolon", "Quote", "Backquote", "Backslash", "Comma", "Period", "Slash", "CapsLock", "NumpadEnter",
];

/// The buttons of a mouse.
pub const MOUSE: [&str; 3] = ["MouseLeft", "MouseRight", "MouseMiddle"];

/// The buttons of a gamepad, by place: `PadSouth` is the lowest of the four on the right, `PadUp` is on the directional pad.
pub const PAD: [&str; 16] = [
    "PadSouth", "PadEast", "PadNorth", "PadWest", "PadLeftBumper", "PadRightBumper", "PadLeftTrigger", "PadRightTrigger", "PadSelect",
    "PadStart", "PadLeftThumb", "PadRightThumb", "PadUp", "PadDown", "PadLeft", "PadRight",
];

/// The ways in which the sticks of a gamepad are pushed.
pub const STICKS: [&str; 8] = [
    "PadLeftStickUp", "PadLeftStickDown", "PadLeftStickLeft", "PadLeftStickRight", "PadRightStickUp", "PadRightStickDown",
    "PadRightStickLeft", "PadRightStickRight",
];

/// Whether `name` is a key or button.
pub fn is_button(name: &str) -> bool {
    let letter = |rest: &str| rest.len() == 1 && rest.as_bytes()[0].is_ascii_uppercase();
    let digit = |rest: &str| rest.len() == 1 && rest.as_bytes()[0].is_ascii_digit();
    [&KEYS[..], &MOUSE, &PAD, &STICKS].iter().any(|names| names.contains(&name))
        || name.strip_prefix("Key").is_some_and(letter)
        || name.strip_prefix("Digit").is_some_and(digit)
        || name.strip_prefix("Numpad").is_some_and(digit)
        || name.strip_prefix('F').is_some_and(|rest| (1..=12).any(|number| rest == number.to_string()))
}

/// Whether `text` is `None` or one to [`MOST_BUTTONS`] names with spaces between, each once.
pub fn are_buttons(text: &str) -> bool {
    let names: Vec<&str> = text.split_whitespace().collect();
    let once = |(k, name): (usize, &&str)| is_button(name) && !names[..k].contains(name);
    text == "None" || ((1..=MOST_BUTTONS).contains(&names.len()) && names.iter().enumerate().all(once))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_buttons() {
        for right in ["None", "KeyW", "KeyW PadLeftStickUp", "F12 Numpad3 MouseLeft PadUp"] {
            assert!(are_buttons(right), "{right}");
        }
        for wrong in ["", "None KeyW", "KeyW KeyW", "W", "F13", "KeyA KeyB KeyC KeyD KeyE", "Key1", "PadSouth,PadEast"] {
            assert!(!are_buttons(wrong), "{wrong}");
        }
    }
}
