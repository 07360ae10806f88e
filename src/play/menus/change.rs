//! Values of settings on a menu: how they are written, and stepped.

use crate::play::words::Language;
use crate::scene::GameConfig;
use crate::scene::config::{Allowed, Setting, Value};

/// The key of a setting's name: `video.frame_limit` is `setting-video-frame-limit`.
pub fn words_key(setting: &Setting<GameConfig>) -> String {
    format!("setting-{}-{}", setting.section, setting.key).replace('_', "-")
}

/// A value as the menu writes it.
pub fn written(language: Language, setting: &Setting<GameConfig>, value: &Value) -> String {
    match (value, setting.allowed) {
        (Value::Switch(on), _) => language.say(if *on { "menu-on" } else { "menu-off" }),
        (Value::Word(word), Allowed::Choice(_)) => language.say(&format!("choice-{}-{word}", setting.key.replace('_', "-"))),
        (Value::Word(word), _) => word.clone(),
        (Value::Integer(0), _) if setting.key == "frame_limit" => language.say("menu-no-limit"),
        (Value::Integer(0), _) if setting.key == "held_rate" => language.say("menu-displays-rate"),
        (Value::Integer(number), _) => number.to_string(),
        (Value::Number(number), _) if is_share(setting) => format!("{:.0} %", 100.0 * number),
        (Value::Number(number), _) if setting.unit == "degrees" => format!("{number:.0}°"),
        (Value::Number(number), Allowed::Number { max, .. }) if max < 0.1 => format!("{:.2} mrad", 1e3 * number),
        (Value::Number(number), _) => format!("{number:.2}"),
    }
}

/// Whether a number is written in per cent.
fn is_share(setting: &Setting<GameConfig>) -> bool {
    setting.section == "sound"
        || ["text_size", "left_stick_dead_zone", "right_stick_dead_zone", "stick_pitch", "stick_yaw", "stick_thrust"].contains(&setting.key)
}

/// The ends between which a number is turned on a menu: those of the setting, or narrower where beyond them nobody plays.
fn ends(setting: &Setting<GameConfig>) -> Option<(f64, f64, f64)> {
    let (min, max) = match setting.allowed {
        Allowed::Number { min, max } => (min, max),
        Allowed::Integer { min, max } => (f64::from(min), f64::from(max)),
        _ => return None,
    };
    Some(match setting.key {
        "fov" => (40.0, 110.0, 5.0),
        "text_size" => (0.8, 2.0, 0.1),
        "frame_limit" | "held_rate" => (0.0, 240.0, 30.0),
        "mouse_sensitivity" => (0.0005, 0.008, 0.0005),
        "left_stick_dead_zone" | "right_stick_dead_zone" => (0.0, 0.5, 0.02),
        "left_stick_curve" | "right_stick_curve" => (1.0, 4.0, 0.2),
        _ => (min, max, (max - min) / 20.0),
    })
}

/// Where a value lies between its ends, 0 to 1; None for what is no number.
pub fn share(setting: &Setting<GameConfig>, value: &Value) -> Option<f64> {
    let (min, max, _) = ends(setting)?;
    let number = match value {
        Value::Number(number) => *number,
        Value::Integer(number) => f64::from(*number),
        _ => return None,
    };
    Some(((number - min) / (max - min)).clamp(0.0, 1.0))
}

/// The value at a share between the ends, on the nearest step; None for what is no number.
pub fn at_share(setting: &Setting<GameConfig>, share: f64) -> Option<Value> {
    let (min, max, step) = ends(setting)?;
    let number = (min + ((max - min) * share.clamp(0.0, 1.0) / step).round() * step).clamp(min, max);
    Some(match setting.allowed {
        Allowed::Integer { .. } => Value::Integer(number as u32),
        // To the digits that are shown.
        _ => Value::Number((number * 1e6).round() / 1e6),
    })
}

/// The value one step on (`by` 1) or back (−1); switches and words go round.
pub fn stepped(setting: &Setting<GameConfig>, value: &Value, by: i32) -> Value {
    match (value, setting.allowed) {
        (Value::Switch(on), _) => Value::Switch(!on),
        (Value::Word(word), Allowed::Choice(words)) => {
            let place = words.iter().position(|known| known == word).unwrap_or(0) as i32;
            Value::Word(words[(place + by).rem_euclid(words.len() as i32) as usize].to_owned())
        }
        _ => {
            let next = ends(setting).zip(share(setting, value)).map(|((min, max, step), share)| share + f64::from(by) * step / (max - min));
            next.and_then(|share| at_share(setting, share)).unwrap_or(value.clone())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::play::choices::is_players;
    use crate::scene::config::settings;

    /// Each step of every setting is allowed, up to its ends and back.
    #[test]
    fn every_step_is_allowed() {
        for setting in settings().iter().filter(|setting| is_players(setting)) {
            let mut config = GameConfig::default();
            for by in [1, -1] {
                for _ in 0..60 {
                    let next = stepped(setting, &setting.get(&config), by);
                    assert_eq!(setting.set(&mut config, next), Ok(()), "{}", setting.path());
                }
            }
            for share in [0.0, 0.37, 1.0] {
                if let Some(value) = at_share(setting, share) {
                    assert_eq!(setting.set(&mut config, value), Ok(()), "{}", setting.path());
                }
            }
        }
    }

    #[test]
    fn a_step_there_and_back_is_none() {
        for path in ["sound.master", "video.fov", "video.frame_limit", "accessibility.text_size", "interface.language"] {
            let setting = crate::scene::config::setting(path).expect("a setting");
            let value = setting.get(&GameConfig::default());
            assert_eq!(stepped(setting, &stepped(setting, &value, 1), -1), value, "{path}");
        }
    }
}
