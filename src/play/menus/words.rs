//! What the menus say of a flight, in words.

use crate::play::hud::instruments::Scale;
use crate::play::session::Session;
use crate::scene::mission::ScoredBy;

/// A number and its unit, which stay on one line.
pub(super) fn together(words: &str) -> String {
    words.replace(' ', "\u{a0}")
}

/// What the chase is about, in a sentence.
pub(super) fn goal(session: &Session) -> String {
    let rules = session.scene.rules(&session.config);
    let scale = Scale::of(session.config.hole.mass_solar);
    let within = together(&format!("{} r_s", rules.capture_radius));
    let hold = together(&format!("{} r_s/c ({})", rules.hold_time, scale.span(rules.hold_time)));
    let before = together(&format!("T = {} r_s/c ({})", rules.time_limit, scale.span(rules.time_limit)));
    format!("Catch the quarry: stay within {within} of it for {hold}, before {before}, and do not fall into the hole.")
}

/// What r_s is, in a sentence.
pub(super) fn measure(session: &Session) -> String {
    let scale = Scale::of(session.config.hole.mass_solar);
    let [radius, light] = [scale.kilometres(1.0), scale.span(1.0)].map(|words| together(&words));
    format!("r_s is the hole's radius, {radius}; light goes as far in r_s/c, {light}.")
}

/// What to begin with, for the first flight.
pub(super) fn hint(session: &Session) -> String {
    let keys = &session.config.controls;
    let [thrust, look, pilot] = [&keys.thrust_forward, &keys.look_at_target, &keys.toggle_autopilot].map(|name| key(name));
    let [thrust, look, pilot] =
        [format!("{thrust} thrusts"), format!("hold {look} to look at the target"), format!("{pilot}: the autopilot flies")]
            .map(|words| together(&words));
    let keys = if session.target().is_some() { format!("{thrust}  ·  {look}  ·  {pilot}") } else { format!("{thrust}  ·  {pilot}") };
    // A mission says by itself where to fly.
    if session.scene.mission.is_some() || session.target().is_none() {
        keys
    } else {
        format!("{keys}  ·  fly to the dashed ring “now”")
    }
}

/// What leads the camera of a replay.
pub(super) fn camera_hint(session: &Session) -> String {
    let keys = &session.config.controls;
    let [near, far, look, slow, fast] =
        [&keys.thrust_forward, &keys.thrust_back, &keys.look_at_target, &keys.slower, &keys.faster].map(|name| key(name));
    let words = [
        "mouse: round the ship".to_owned(),
        format!("{near} {far}: nearer, farther"),
        format!("{look}: back"),
        format!("{slow} {fast}: pace"),
    ];
    words.map(|words| together(&words)).join("  ·  ")
}

/// A key as it is written on the keyboard.
pub(super) fn key(name: &str) -> &str {
    let name = name.strip_prefix("Key").or_else(|| name.strip_prefix("Digit")).unwrap_or(name);
    match name {
        "ControlLeft" => "Ctrl",
        "ShiftLeft" => "Shift",
        "Escape" => "Esc",
        "Comma" => ", (comma)",
        "Period" => ". (period)",
        "MouseLeft" => "left mouse button",
        "MouseRight" => "right mouse button",
        "MouseMiddle" => "middle mouse button",
        other => other,
    }
}

/// The unit of a score.
pub(super) fn unit(scored: ScoredBy) -> &'static str {
    match scored {
        ScoredBy::Far | ScoredBy::Own => "r_s/c",
        ScoredBy::Fuel => "c of Δv",
    }
}

/// Stars that were won, of three.
pub(super) fn stars(won: u32) -> String {
    (1..=3).map(|star| if star <= won { '★' } else { '☆' }).collect()
}
