//! A value given to a setting in one word, as on the command line: `render.orders=3`.

use std::fmt;
use std::str::FromStr;

use super::fields::{GameConfig, setting};
use super::setting::{Allowed, Setting, Value};
use crate::user_file::short;

/// A setting and a value that it may have.
#[derive(Clone, Debug)]
pub struct Assignment {
    /// The setting.
    pub setting: &'static Setting<GameConfig>,
    /// Its value, checked.
    pub value: Value,
}

impl Assignment {
    /// Gives the setting its value.
    pub fn apply(&self, config: &mut GameConfig) {
        // It was checked when it was read.
        let _ = self.setting.set(config, self.value.clone());
    }
}

impl FromStr for Assignment {
    type Err = String;

    fn from_str(text: &str) -> Result<Assignment, String> {
        let usage = "written KEY=VALUE, as render.orders=3";
        let (path, word) = text.split_once('=').ok_or_else(|| format!("{:?} must be {usage}", short(text)))?;
        let setting = setting(path.trim()).ok_or_else(|| format!("{:?} is no setting of game.toml", short(path)))?;
        Ok(Assignment { setting, value: setting.read(word)? })
    }
}

impl fmt::Display for Assignment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.value {
            Value::Word(word) => write!(f, "{}={word}", self.setting.path()),
            value => write!(f, "{}={}", self.setting.path(), value.written()),
        }
    }
}

impl Setting<GameConfig> {
    /// A value in words as this setting may have it, or what is wrong.
    pub fn read(&self, word: &str) -> Result<Value, String> {
        let (path, word) = (self.path(), word.trim());
        let wrong = |kind: &str| format!("{path}: {:?} is {kind}, allowed {}", short(word), self.allowed_text());
        let value = match self.allowed {
            Allowed::Number { .. } => Value::Number(word.parse().map_err(|_| wrong("no number"))?),
            Allowed::Integer { .. } => Value::Integer(word.parse().map_err(|_| wrong("no such whole number"))?),
            Allowed::Switch => Value::Switch(word.parse().map_err(|_| wrong("no switch"))?),
            Allowed::Choice(_) | Allowed::Buttons | Allowed::Words(_) => Value::Word(word.into()),
        };
        self.check(value).map_err(|wrong| format!("{path} = {wrong}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::config::settings;

    #[test]
    fn each_setting_is_read_as_it_is_written() {
        let config = GameConfig::default();
        for setting in settings() {
            let before = Assignment { setting, value: setting.get(&config) };
            let after: Assignment = before.to_string().parse().unwrap_or_else(|wrong| panic!("{before}: {wrong}"));
            assert_eq!((after.setting.path(), after.value), (setting.path(), before.value));
        }
    }

    #[test]
    fn what_is_wrong_is_said() {
        for (text, said) in [
            ("render.orders", "KEY=VALUE"),
            ("render.order=2", "no setting"),
            ("render.orders=7", "1 to 3"),
            ("render.orders=two", "no such whole number, allowed whole numbers 1 to 3"),
            ("render.bloom=much", "no number, allowed 0 to"),
            ("render.orders=99999999999", "99999999999"),
            ("render.doppler=yes", "true or false"),
            ("render.method=magic", "paper1-128"),
        ] {
            let wrong = text.parse::<Assignment>().expect_err(text);
            assert!(wrong.contains(said), "{text}: {wrong}");
        }
    }
}
