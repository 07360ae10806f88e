//! Buttons in the words of a mission: `[thrust_forward]` stands for the button that the player has bound to that action.

use toml::Spanned;

use crate::scene::config::{Allowed, settings};
use crate::scene::document::fault::{Fault, fault};

/// `text` with each `[action]` replaced by what `button` writes for it; what it does not know stays as it is.
pub fn with_buttons(text: &str, button: impl Fn(&str) -> Option<String>) -> String {
    let mut parts = text.split('[');
    let mut words = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let named = part.split_once(']').and_then(|(action, rest)| Some((button(action)?, rest)));
        match named {
            Some((button, rest)) => words.extend([button.as_str(), rest]),
            None => words.extend(["[", part]),
        }
    }
    words
}

/// Refuses an `[action]` that no button can be bound to.
pub(super) fn check(text: &Spanned<String>) -> Result<(), Fault> {
    let actions = || settings().iter().filter(|setting| setting.section == "controls" && setting.allowed == Allowed::Buttons);
    for part in text.get_ref().split('[').skip(1) {
        let action = part.split(']').next().unwrap_or_default();
        if !part.contains(']') || !actions().any(|setting| setting.key == action) {
            let known: Vec<&str> = actions().map(|setting| setting.key).collect();
            return fault(text, format!("[{action}] is no action that has buttons; allowed: {}", known.join(", ")));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn actions_are_replaced_and_the_rest_stays() {
        let button = |action: &str| (action == "boost").then(|| "Shift".to_owned());
        assert_eq!(with_buttons("Hold [boost]: [fast].", button), "Hold Shift: [fast].");
        assert_eq!(with_buttons("[boost", button), "[boost");
        assert_eq!(with_buttons("", button), "");
    }

    #[test]
    fn only_actions_stand_in_brackets() {
        let text = |words: &str| Spanned::new(0..words.len(), words.to_owned());
        assert!(check(&text("Hold [boost], then [thrust_left].")).is_ok());
        for wrong in ["[fast]", "[boost", "[tapped]", "[]"] {
            let fault = check(&text(wrong)).expect_err(wrong);
            assert!(fault.message.contains("thrust_forward"), "{}", fault.message);
        }
    }
}
