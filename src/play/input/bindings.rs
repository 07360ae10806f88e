//! Which buttons do what, and how they are changed.

use bevy::prelude::*;

use crate::play::input::action::Action;
use crate::play::input::button::{Button, Device};
use crate::scene::GameConfig;
use crate::scene::config::buttons::MOST_BUTTONS;
use crate::scene::config::{self, Controls, HELD, Setting, Value};

/// The buttons bound to each [`Action`].
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Bindings {
    buttons: [Vec<Button>; Action::ALL.len()],
    /// Actions that a tap switches on and another off.
    tapped: [bool; Action::ALL.len()],
    /// How sticks and mouse answer.
    pub controls: Controls,
}

/// The setting of an action's buttons.
pub fn setting_of(action: Action) -> Option<&'static Setting<GameConfig>> {
    config::settings().iter().find(|setting| setting.section == "controls" && setting.key == action.key())
}

/// The names of the buttons of an action in a configuration.
pub fn names(config: &GameConfig, action: Action) -> Vec<String> {
    match setting_of(action).map(|setting| setting.get(config)) {
        Some(Value::Word(names)) => names.split_whitespace().filter(|name| *name != "None").map(str::to_owned).collect(),
        _ => Vec::new(),
    }
}

/// `names` as one word for the configuration.
fn joined(names: &[String]) -> Value {
    Value::Word(if names.is_empty() { "None".into() } else { names.join(" ") })
}

/// The buttons of an action with `name` put at `slot` of its `device` (the first, the second); None for no more than one can have.
pub fn bound(config: &GameConfig, action: Action, device: Device, slot: usize, name: Option<&str>) -> Value {
    let mut all = names(config, action);
    let on_device = |name: &String| Button::named(name).is_some_and(|button| button.device() == device);
    let place = all.iter().enumerate().filter(|(_, name)| on_device(name)).map(|(k, _)| k).nth(slot);
    if let Some(name) = name {
        match place {
            Some(place) => all[place] = name.to_owned(),
            None if all.len() < MOST_BUTTONS => all.push(name.to_owned()),
            None => (),
        }
        // One name once.
        let mut seen = Vec::new();
        all.retain(|name| {
            !seen.contains(name) && {
                seen.push(name.clone());
                true
            }
        });
    } else if let Some(place) = place {
        all.remove(place);
    }
    joined(&all)
}

/// The actions that share a button with `action`.
pub fn conflicts(config: &GameConfig, action: Action) -> Vec<(String, Action)> {
    let own = names(config, action);
    let others = Action::ALL.into_iter().filter(|other| *other != action);
    others.flat_map(|other| names(config, other).into_iter().filter(|name| own.contains(name)).map(move |name| (name, other))).collect()
}

impl Bindings {
    /// The bindings of a configuration.
    pub fn of(config: &GameConfig) -> Bindings {
        let tapped: Vec<&str> = config.controls.tapped.split_whitespace().collect();
        Bindings {
            buttons: Action::ALL.map(|action| names(config, action).iter().filter_map(|name| Button::named(name)).collect()),
            tapped: Action::ALL.map(|action| HELD.contains(&action.key()) && tapped.contains(&action.key())),
            controls: config.controls.clone(),
        }
    }

    /// The buttons of an action.
    pub fn buttons(&self, action: Action) -> &[Button] {
        &self.buttons[action as usize]
    }

    /// Whether a tap switches the action.
    pub fn is_tapped(&self, action: Action) -> bool {
        self.tapped[action as usize]
    }

    /// The first button of an action on a device, else on any.
    pub fn shown(&self, action: Action, device: Device) -> Option<Button> {
        let buttons = self.buttons(action);
        buttons.iter().find(|button| button.device() == device).or(buttons.first()).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_action_has_a_key_and_the_pad_flies() {
        let bindings = Bindings::of(&GameConfig::default());
        for action in Action::ALL {
            assert!(bindings.buttons(action).iter().any(|button| button.device() == Device::Keyboard), "{}", action.key());
        }
        for action in [Action::ThrustForward, Action::YawLeft, Action::RollLeft, Action::Fire, Action::Pause, Action::LookAtTarget] {
            assert!(bindings.shown(action, Device::Pad).is_some_and(|button| button.device() == Device::Pad), "{}", action.key());
        }
    }

    #[test]
    fn a_button_is_bound_beside_unbound_and_never_twice() {
        let mut config = GameConfig::default();
        let set = |config: &mut GameConfig, value| setting_of(Action::Boost).expect("a key").set(config, value).expect("allowed");
        let first = bound(&config, Action::Boost, Device::Keyboard, 1, Some("KeyX"));
        assert_eq!(first, Value::Word("ShiftLeft PadSouth KeyX".into()));
        set(&mut config, first);
        assert_eq!(bound(&config, Action::Boost, Device::Keyboard, 0, Some("KeyX")), Value::Word("KeyX PadSouth".into()));
        assert_eq!(bound(&config, Action::Boost, Device::Pad, 0, None), Value::Word("ShiftLeft KeyX".into()));
        let alone = bound(&GameConfig::default(), Action::Mute, Device::Keyboard, 0, None);
        assert_eq!(alone, Value::Word("None".into()));
    }

    #[test]
    fn a_key_for_two_things_is_found() {
        let mut config = GameConfig::default();
        assert!(Action::ALL.iter().all(|action| conflicts(&config, *action).is_empty()));
        config.controls.mute = "KeyW".into();
        assert_eq!(conflicts(&config, Action::Mute), [("KeyW".to_owned(), Action::ThrustForward)]);
    }
}
