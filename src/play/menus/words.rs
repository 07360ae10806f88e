//! What the menus say of a flight, in words.

use super::lists::action_words;
use crate::play::hud::instruments::Scale;
use crate::play::input::action::Action;
use crate::play::input::bindings::Bindings;
use crate::play::input::button::Device;
use crate::play::session::Session;
use crate::play::words::{self, Language, together};
use crate::scene::mission::ScoredBy;

/// What the chase is about, in a sentence.
pub(super) fn goal(session: &Session) -> String {
    let rules = session.scene.rules(&session.config);
    let scale = Scale::of(session);
    let within = together(&format!("{} r_s", rules.capture_radius));
    let hold = together(&format!("{} r_s/c ({})", rules.hold_time, scale.span(rules.hold_time)));
    let before = together(&format!("T = {} r_s/c ({})", rules.time_limit, scale.span(rules.time_limit)));
    session.language().fill("flight-goal", &[("within", within.as_str()), ("hold", hold.as_str()), ("before", before.as_str())])
}

/// What r_s is, in a sentence.
pub(super) fn measure(session: &Session) -> String {
    let scale = Scale::of(session);
    let [radius, light] = [scale.kilometres(1.0), scale.span(1.0)].map(|words| together(&words));
    session.language().fill("flight-measure", &[("radius", radius.as_str()), ("light", light.as_str())])
}

/// The buttons of the device in use.
#[derive(Clone, Copy)]
pub(super) struct Prompts<'a> {
    pub(super) language: Language,
    pub(super) bindings: &'a Bindings,
    pub(super) device: Device,
}

impl Prompts<'_> {
    /// The button of an action, as it is written on the device.
    pub(super) fn button(&self, action: Action) -> String {
        words::buttons::of(self.language, self.bindings, self.device, action)
    }

    fn with(&self, key: &str, actions: [(&str, Action); 1]) -> String {
        let values = actions.map(|(name, action)| (name, self.button(action)));
        together(&self.language.fill(key, &values.each_ref().map(|(name, button)| (*name, button.as_str()))))
    }
}

/// What to begin with, for the first flight.
pub(super) fn hint(session: &Session, prompts: Prompts) -> String {
    let mut parts = vec![prompts.with("hint-thrust", [("button", Action::ThrustForward)])];
    let chases = session.target().is_some();
    for (key, action) in [("hint-look", Action::LookAtTarget), ("hint-face", Action::FaceTarget)] {
        parts.extend(chases.then(|| prompts.with(key, [("button", action)])));
    }
    parts.push(prompts.with("hint-seeing", [("button", Action::WhatAmISeeing)]));
    parts.push(prompts.with("hint-autopilot", [("button", Action::ToggleAutopilot)]));
    // A mission says by itself where to fly.
    parts.extend((session.scene.mission.is_none() && chases).then(|| together(&prompts.language.say("hint-now"))));
    parts.join("  ·  ")
}

/// What a pilot presses most, for the pause.
pub(super) fn keys_of_flight(prompts: Prompts) -> String {
    const KEYS: [Action; 10] = [
        Action::ThrustForward,
        Action::ThrustBack,
        Action::Boost,
        Action::LookAtTarget,
        Action::FaceTarget,
        Action::ToggleAssist,
        Action::Slower,
        Action::Faster,
        Action::WhatAmISeeing,
        Action::ToggleAutopilot,
    ];
    let key = |action: Action| together(&format!("{}: {}", prompts.button(action), action_words(prompts.language, action)));
    KEYS.map(key).join("  ·  ")
}

/// What leads the camera of a replay.
pub(super) fn camera_hint(prompts: Prompts) -> String {
    let [near, far, back, slow, fast] = [Action::ThrustForward, Action::ThrustBack, Action::LookAtTarget, Action::Slower, Action::Faster]
        .map(|action| prompts.button(action));
    let language = prompts.language;
    let by_finger = prompts.device == Device::Touch;
    let nearer = language.fill("replay-nearer", &[("near", near.as_str()), ("far", far.as_str())]);
    let words = [
        language.say(if by_finger { "replay-round-touch" } else { "replay-round" }),
        if by_finger { language.say("replay-pinch") } else { nearer },
        language.fill("replay-back", &[("button", back.as_str())]),
        language.fill("replay-pace", &[("slow", slow.as_str()), ("fast", fast.as_str())]),
    ];
    words.map(|words| together(&words)).join("  ·  ")
}

/// The unit of a score.
pub(super) fn unit(language: Language, scored: ScoredBy) -> String {
    match scored {
        ScoredBy::Far | ScoredBy::Own => "r_s/c".into(),
        ScoredBy::Fuel => language.say("score-unit-fuel"),
    }
}

/// Stars that were won, of three.
pub(super) fn stars(won: u32) -> String {
    (1..=3).map(|star| if star <= won { '★' } else { '☆' }).collect()
}
