//! One tunable value of `game.toml`: its name, unit, allowed range, and how to read and set it in a configuration `C`.

use std::fmt;

use super::buttons::are_buttons;
use crate::scene::document::fault::{plain, range_text};
use crate::user_file::short;

/// A value of one setting.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A real number.
    Number(f64),
    /// A whole number.
    Integer(u32),
    /// On or off.
    Switch(bool),
    /// A word from a list, or the name of a key.
    Word(String),
}

impl Value {
    /// As TOML; a real number always has a point or an exponent, so that it stays one.
    pub fn written(&self) -> String {
        match self {
            Value::Number(number) if number.abs() >= 1e7 => format!("{number:e}"),
            Value::Number(number) => format!("{number:?}"),
            other => other.to_string(),
        }
    }
}

/// What values a setting may take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Allowed {
    /// Real numbers from `min` to `max`.
    Number {
        /// The smallest.
        min: f64,
        /// The largest.
        max: f64,
    },
    /// Whole numbers from `min` to `max`.
    Integer {
        /// The smallest.
        min: u32,
        /// The largest.
        max: u32,
    },
    /// true or false.
    Switch,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// Names of keys and buttons, see [`buttons`](super::buttons).
    Buttons,
    /// Some of these words, with spaces between, or `None`.
    Words(&'static [&'static str]),
}

/// One line of `game.toml`.
#[derive(Debug, Clone, Copy)]
pub struct Setting<C: 'static> {
    /// The section in square brackets.
    pub section: &'static str,
    /// The key in that section.
    pub key: &'static str,
    /// The unit; empty for a pure number, a switch or a word.
    pub unit: &'static str,
    /// What it does, in one line.
    pub help: &'static str,
    /// The values it may take.
    pub allowed: Allowed,
    pub(super) get: fn(&C) -> Value,
    pub(super) set: fn(&mut C, Value),
}

impl<C> Setting<C> {
    /// `section.key`.
    pub fn path(&self) -> String {
        format!("{}.{}", self.section, self.key)
    }

    /// The value in `config`.
    pub fn get(&self, config: &C) -> Value {
        (self.get)(config)
    }

    /// Sets the value in `config`, or says what is wrong with it and leaves `config` as it was.
    pub fn set(&self, config: &mut C, value: Value) -> Result<(), String> {
        let value = self.check(value)?;
        (self.set)(config, value);
        Ok(())
    }

    /// `value` in the setting's own type if it is allowed, or what is wrong.
    pub fn check(&self, value: Value) -> Result<Value, String> {
        let refuse = |shown: &dyn fmt::Display, why: &str| Err(format!("{shown} {why}, allowed {}", self.allowed_text()));
        match (self.allowed, value) {
            (Allowed::Number { min, max }, Value::Number(number)) if (min..=max).contains(&number) => Ok(Value::Number(number)),
            (Allowed::Number { min, max }, Value::Integer(number)) if (min..=max).contains(&f64::from(number)) => {
                Ok(Value::Number(f64::from(number)))
            }
            (Allowed::Integer { min, max }, Value::Integer(number)) if (min..=max).contains(&number) => Ok(Value::Integer(number)),
            (Allowed::Switch, Value::Switch(on)) => Ok(Value::Switch(on)),
            (Allowed::Choice(words), Value::Word(word)) if words.contains(&word.as_str()) => Ok(Value::Word(word)),
            (Allowed::Buttons, Value::Word(word)) if are_buttons(&word) => Ok(Value::Word(word)),
            (Allowed::Words(known), Value::Word(word)) if are_words(known, &word) => Ok(Value::Word(word)),
            (Allowed::Number { .. }, Value::Number(number)) => refuse(&number, "is out of range"),
            (Allowed::Number { .. } | Allowed::Integer { .. }, Value::Integer(number)) => refuse(&number, "is out of range"),
            (Allowed::Integer { .. }, Value::Number(number)) => refuse(&number, "is no such whole number"),
            (Allowed::Choice(_) | Allowed::Buttons | Allowed::Words(_), Value::Word(word)) => {
                refuse(&format!("{:?}", short(&word)), "is not known")
            }
            (_, Value::Word(word)) => refuse(&format!("{:?}", short(&word)), "has the wrong type"),
            (_, Value::Switch(on)) => refuse(&on, "has the wrong type"),
            (_, Value::Number(number)) => refuse(&number, "has the wrong type"),
            (_, Value::Integer(number)) => refuse(&number, "has the wrong type"),
        }
    }

    /// What is allowed, for a person: `0.1 to 20 r_s/c per second`, `true or false`, `one of "table", "newton"`.
    pub fn allowed_text(&self) -> String {
        match self.allowed {
            Allowed::Number { min, max } => range_text(min, max, self.unit),
            Allowed::Integer { min, max } => format!("whole numbers {}", range_text(f64::from(min), f64::from(max), self.unit)),
            Allowed::Switch => "true or false".into(),
            Allowed::Choice(words) => format!("one of {}", words.iter().map(|word| format!("{word:?}")).collect::<Vec<_>>().join(", ")),
            Allowed::Buttons => "up to four of KeyA, Digit0, F1, Space, MouseLeft, PadSouth, … or None".into(),
            Allowed::Words(words) => format!("some of {}, or None", words.join(" ")),
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Number(number) => f.write_str(&plain(*number)),
            Value::Integer(number) => write!(f, "{number}"),
            Value::Switch(on) => write!(f, "{on}"),
            Value::Word(word) => write!(f, "{word:?}"),
        }
    }
}

/// Whether `text` is `None` or some of the `known` words, each once.
fn are_words(known: &[&str], text: &str) -> bool {
    let words: Vec<&str> = text.split_whitespace().collect();
    let once = |(k, word): (usize, &&str)| known.contains(word) && !words[..k].contains(word);
    text == "None" || (!words.is_empty() && words.iter().enumerate().all(once))
}
