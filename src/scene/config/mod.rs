//! `game.toml`: every tunable value, with unit, default and allowed range, said once in `fields.rs`.

pub mod assignment;
pub mod buttons;
pub mod edit;
mod fields;
mod setting;

use std::path::{Path, PathBuf};

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::document::error::{Complaints, ConfigError};
use super::document::fault::Fault;
use super::document::{Document, MOST_SAID, one};
use crate::game_files;
use crate::user_file::{MOST_TEXT, read_text};
pub use assignment::Assignment;
pub use fields::{
    Accessibility, Assist, AuroraConfig, Clock, Controls, Disk, Enemy, GameConfig, HELD, Hole, Interface, Render, RulesConfig, ShipConfig,
    Sky, Sound, Video, setting, settings,
};
pub use setting::{Allowed, Setting, Value};

/// The configuration's file where none is named.
pub const FILE: &str = "game.toml";

/// The file to read: the named one, else `game.toml` in the folder that the program is started in, else the one in the user's
/// folder, beside the program or in the project's folder.
pub fn file(named: Option<&Path>) -> Option<PathBuf> {
    named.map(Path::to_path_buf).or_else(|| {
        let here = Some(PathBuf::from(FILE)).filter(|file| crate::user_file::exists(file));
        here.or_else(|| game_files::find(FILE).on_disk().map(Path::to_path_buf))
    })
}

/// The file that is written where there is none yet: in the user's folder, which [`file()`] looks in.
pub fn new_file() -> PathBuf {
    game_files::user_folder().unwrap_or_default().join(FILE)
}

/// Reads the named file, or the one that [`file()`] finds; where there is none, every value is its default.
pub fn find(named: Option<&Path>) -> Result<GameConfig, ConfigError> {
    Ok(file(named).as_deref().map(load).transpose()?.unwrap_or_default())
}

/// As [`find`], with what the command line sets over it.
pub fn find_with(named: Option<&Path>, set: &[Assignment]) -> Result<GameConfig, ConfigError> {
    let mut config = find(named)?;
    assign(&mut config, set)?;
    Ok(config)
}

/// Puts what the command line sets over a configuration.
pub fn assign(config: &mut GameConfig, set: &[Assignment]) -> Result<(), ConfigError> {
    set.iter().for_each(|one| one.apply(config));
    if set.is_empty() { Ok(()) } else { check(config).map_err(ConfigError::Set) }
}

/// Reads `path`. Keys that are left out keep their default; unknown keys, wrong types and values out of range are errors.
pub fn load(path: &Path) -> Result<GameConfig, ConfigError> {
    let text = read_text(path, MOST_TEXT).map_err(|fault| ConfigError::Read { path: path.to_path_buf(), source: fault.into() })?;
    parse(path, &text).map_err(ConfigError::Invalid)
}

/// Reads the text of a `game.toml`; `file` is only named in the complaints.
pub fn parse(file: &Path, text: &str) -> Result<GameConfig, Complaints> {
    let document = Document::parse(file, text).map_err(one)?;
    let mut config = GameConfig::default();
    let known = section_names();
    let mut faults = Vec::new();
    for (section, table) in document.table() {
        let name = section.get_ref().as_ref();
        let wrong = match table.get_ref() {
            DeValue::Table(table) if known.contains(&name) => {
                faults.extend(apply_table(&mut config, name, table));
                continue;
            }
            // Those are not said any more.
            _ if faults.len() > MOST_SAID => String::new(),
            _ if known.contains(&name) => format!("must be a section, written [{name}]"),
            _ => format!("unknown section; known sections: {}", known.join(", ")),
        };
        faults.push(Fault { span: section.span(), message: wrong });
    }
    check_all(&config, faults, document.table()).map_err(|faults| document.complain(faults))?;
    Ok(config)
}

/// All that is wrong: the `faults` of single entries of `document`, or, where it has none, those of what [`apply_table`] made of them,
/// `config`, as a whole.
pub(super) fn check_all(config: &GameConfig, faults: Vec<Fault>, document: &DeTable<'_>) -> Result<(), Vec<Fault>> {
    // What is left out because it is wrong clashes with nothing.
    if faults.is_empty() { check_together(config, document).map_err(|fault| vec![fault]) } else { Err(faults) }
}

/// What [`together`] says, at the line in `document` of one of the keys that clash.
fn check_together(config: &GameConfig, document: &DeTable<'_>) -> Result<(), Fault> {
    together(config).map_err(|(keys, message)| {
        // The other of the two may be a default, which has no line.
        let span = keys.iter().find_map(|key| {
            let (section, key) = key.split_once('.')?;
            let DeValue::Table(table) = document.get(section)?.get_ref() else { return None };
            table.get(key).map(|value| value.span())
        });
        Fault { span: span.unwrap_or(0..0), message }
    })
}

/// What is wrong with a configuration as a whole whose values are each allowed.
pub fn check(config: &GameConfig) -> Result<(), String> {
    together(config).map_err(|(_, message)| message)
}

/// What single ranges cannot say: a lower end above its upper one, a key for two things. The keys that clash, and what is wrong.
fn together(config: &GameConfig) -> Result<(), ([String; 2], String)> {
    let below = |low: &str, a: f64, high: &str, b: f64| {
        if a < b { Ok(()) } else { Err(([low.to_owned(), high.to_owned()], format!("{low} = {a} must be less than {high} = {b}"))) }
    };
    below("render.exposure_min", config.render.exposure_min, "render.exposure_max", config.render.exposure_max)?;
    below("render.fill_least", config.render.fill_least, "render.fill_most", config.render.fill_most)?;
    below("disk.inner", config.disk.inner, "disk.outer", config.disk.outer)?;
    let mut bound: Vec<(String, String)> = Vec::new();
    for setting in settings().iter().filter(|setting| setting.allowed == Allowed::Buttons) {
        let Value::Word(names) = setting.get(config) else { continue };
        for name in names.split_whitespace().filter(|name| *name != "None") {
            if let Some((_, other)) = bound.iter().find(|(known, _)| *known == name) {
                let keys = [setting.key, other].map(|key| format!("controls.{key}"));
                return Err((keys, format!("{name} is the key of both {other} and {}", setting.key)));
            }
            bound.push((name.to_owned(), setting.key.to_owned()));
        }
    }
    Ok(())
}

/// Reads a file of choices that lie over a configuration: the form of `game.toml`, with the keys that `may` says. All that is wrong, if
/// anything is; two keys for one thing are the player's own affair.
pub fn choices(
    file: &Path,
    text: &str,
    may: impl Fn(&Setting<GameConfig>) -> bool,
) -> Result<Vec<(&'static Setting<GameConfig>, Value)>, Complaints> {
    let document = Document::parse(file, text).map_err(one)?;
    let mut config = GameConfig::default();
    let (mut chosen, mut faults) = (Vec::new(), Vec::new());
    for (section, table) in document.table() {
        let DeValue::Table(table) = table.get_ref() else {
            faults.push(Fault { span: section.span(), message: "must be a section".into() });
            continue;
        };
        faults.extend(apply_table(&mut config, section.get_ref(), table));
        for key in table.keys() {
            match setting(&format!("{}.{}", section.get_ref(), key.get_ref())) {
                Some(setting) if may(setting) => chosen.push((setting, setting.get(&config))),
                _ => faults.push(Fault { span: key.span(), message: "is no choice of the player".into() }),
            }
        }
    }
    if faults.is_empty() { Ok(chosen) } else { Err(document.complain(faults)) }
}

/// The text of such a file.
pub fn choices_text<'a>(chosen: impl IntoIterator<Item = (&'a Setting<GameConfig>, &'a Value)>) -> String {
    let mut text =
        String::from("# What the player chose in the game. It lies over game.toml; a line that is taken out is as there again.\n");
    let mut section = "";
    for (setting, value) in chosen {
        if setting.section != section {
            section = setting.section;
            text.push_str(&format!("\n[{section}]\n"));
        }
        text.push_str(&format!("{} = {}\n", setting.key, value.written()));
    }
    text
}

/// Sets every entry of `table` in `config`, as keys of `section`. Returns what is wrong with those that are left out.
pub(super) fn apply_table(config: &mut GameConfig, section: &str, table: &DeTable<'_>) -> Vec<Fault> {
    let known: Vec<&str> = settings().iter().filter(|setting| setting.section == section).map(|setting| setting.key).collect();
    let known = known.join(", ");
    let mut unknown = 0;
    let mut apply = |key: &Spanned<DeString<'_>>, value: &Spanned<DeValue<'_>>| {
        let Some(setting) = setting(&format!("{section}.{}", key.get_ref())) else {
            unknown += 1;
            // More of them are not said.
            let message = if unknown > MOST_SAID { String::new() } else { format!("unknown key; known keys: {known}") };
            return Err(Fault { span: key.span(), message });
        };
        read(value.get_ref())
            .ok_or_else(|| format!("{} has the wrong type, allowed {}", value.get_ref().type_str(), setting.allowed_text()))
            .and_then(|value| setting.set(config, value))
            .map_err(|message| Fault { span: value.span(), message })
    };
    table.iter().filter_map(|(key, value)| apply(key, value).err()).collect()
}

/// A scalar of the file; whole numbers too long for `u32` become real numbers, so that they fail by range.
fn read(value: &DeValue<'_>) -> Option<Value> {
    match value {
        DeValue::Integer(number) => {
            let digits = number.as_str().replace('_', "");
            let whole = i64::from_str_radix(&digits, number.radix()).ok();
            let large = || digits.parse().unwrap_or(f64::INFINITY);
            let small = whole.and_then(|whole| u32::try_from(whole).ok());
            Some(small.map_or(Value::Number(whole.map_or_else(large, |whole| whole as f64)), Value::Integer))
        }
        DeValue::Float(number) => number.as_str().replace('_', "").parse().ok().map(Value::Number),
        DeValue::Boolean(on) => Some(Value::Switch(*on)),
        DeValue::String(word) => Some(Value::Word(word.to_string())),
        _ => None,
    }
}

/// The sections in the order of the file.
pub fn section_names() -> Vec<&'static str> {
    let mut names: Vec<&'static str> = settings().iter().map(|setting| setting.section).collect();
    names.dedup();
    names
}

/// The text of a `game.toml` that says every value of `config`, each line with what it does, its unit and what is allowed.
pub fn template(config: &GameConfig) -> String {
    let mut text = String::from(
        "# Every tunable value of Lensrunner. A key that is left out keeps its default; a change is taken up while the game runs.\n",
    );
    let mut section = "";
    for setting in settings() {
        if setting.section != section {
            section = setting.section;
            text.push_str(&format!("\n[{section}]\n"));
        }
        let assignment = format!("{} = {}", setting.key, setting.get(config).written());
        // The names of buttons and actions are long; an error tells them.
        let allowed = match setting.allowed {
            Allowed::Buttons => "up to four buttons, or None".into(),
            Allowed::Words(_) => "some of the actions above, or None".into(),
            _ => setting.allowed_text(),
        };
        text.push_str(&format!("{assignment:<33} # {} ({allowed})\n", setting.help));
    }
    text
}
