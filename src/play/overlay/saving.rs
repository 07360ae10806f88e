//! What was changed goes to `game.toml`, or into a command.

use std::io::ErrorKind;

use bevy::prelude::*;

use crate::play::choices::{Choices, is_players};
use crate::play::files::write_whole;
use crate::play::menus::navigate::{FileConfig, with_choices};
use crate::play::overlay::state::Overlay;
use crate::play::session::{SCENE, Session};
use crate::scene::config::edit::edited;
use crate::scene::config::{self, Assignment, Setting};
use crate::scene::{self, Difficulty, GameConfig};
use crate::user_file::{MOST_TEXT, read_text};

/// What the game would begin with: the file, and the player's choices over it.
pub fn begun(world: &World) -> GameConfig {
    let mut config = world.get_resource::<FileConfig>().map_or_else(GameConfig::default, |file| file.0.clone());
    if let Some(choices) = world.get_resource::<Choices>() {
        choices.over(&mut config);
    }
    config
}

/// Settings that are otherwise in `config` than in `than`.
fn other<'a>(config: &'a GameConfig, than: &'a GameConfig) -> impl Iterator<Item = (usize, Assignment)> + 'a {
    let all = config::settings().iter().enumerate();
    all.map(|(place, setting)| (place, Assignment { setting, value: setting.get(config) }))
        .filter(|(_, one)| one.value != one.setting.get(than))
}

/// Writes what was changed in the overlay to `game.toml`, and says what came of it. A choice of the player, which would lie over what is
/// written, is forgotten where it is written.
pub fn save(world: &mut World) -> Result<String, String> {
    let (session, overlay) = (world.resource::<Session>(), world.resource::<Overlay>());
    let begun = begun(world);
    let changed = other(&session.config, &begun).filter(|(place, _)| overlay.history.has_touched(*place)).map(|(_, one)| one);
    let changed: Vec<Assignment> = changed.collect();
    if changed.is_empty() {
        return Err("nothing was changed here that the file does not say".into());
    }
    let file = session.config_file.clone().unwrap_or_else(config::new_file);
    // Where a link leads the file is, not the link.
    let place = file.canonicalize().unwrap_or_else(|_| file.clone());
    let named = |error: std::io::Error| format!("{}: {error}", file.display());
    let text = match read_text(&place, MOST_TEXT).map_err(std::io::Error::from) {
        Ok(text) => text,
        Err(error) if error.kind() == ErrorKind::NotFound => String::new(),
        Err(error) => return Err(format!("not saved: {}", named(error))),
    };
    if std::fs::metadata(&place).is_ok_and(|data| data.permissions().readonly()) {
        return Err(format!("not saved: {} may only be read", file.display()));
    }
    let text = edited(&file, &text, &changed).map_err(|wrong| format!("not saved: {wrong}"))?;
    write_whole(&place, &text).map_err(|error| format!("not saved: {error}"))?;
    world.resource_mut::<Session>().config_file = Some(file.clone());
    if let Some(mut known) = world.get_resource_mut::<FileConfig>() {
        changed.iter().for_each(|one| one.apply(&mut known.0));
    }
    let is_saved = |setting: &Setting<GameConfig>| changed.iter().any(|one| one.setting.path() == setting.path());
    if changed.iter().any(|one| is_players(one.setting)) {
        with_choices(world, |choices, file, config| choices.forget(|setting| is_players(setting) && is_saved(setting), file, config));
    }
    let names: Vec<String> = changed.iter().map(Assignment::to_string).collect();
    Ok(format!("{}: {}", file.display(), names.join(", ")))
}

/// A command that starts the game as it is set, where the same file and choices are.
pub fn command_line(session: &Session, begun: &GameConfig) -> String {
    let mut words = vec!["lensrunner".to_owned(), "play".to_owned()];
    let mut add = |option: &str, value: &str| words.extend([option.to_owned(), quoted(value)]);
    if let Some(file) = session.config_file.as_ref().filter(|file| config::file(None).as_ref() != Some(file)) {
        add("--config", &file.display().to_string());
    }
    if session.scene.name != SCENE {
        let name = &session.scene.name;
        // A file that is named by its path may have the name of another one.
        let is_known = scene::load(name).is_ok_and(|known| known.fingerprint == session.scene.fingerprint);
        add("--scene", &if is_known { name.clone() } else { format!("{name}.toml") });
    }
    if session.scene.mission.is_some() && session.difficulty != Difficulty::default() {
        add("--difficulty", &session.difficulty.to_string());
    }
    if session.seed != 0 {
        add("--seed", &session.seed.to_string());
    }
    other(&session.config, begun).for_each(|(_, one)| add("--set", &one.to_string()));
    words.join(" ")
}

/// A word as a shell takes it whole.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        play: crate::play::PlayArgs,
    }

    #[test]
    fn a_command_gives_the_settings_back() {
        let mut session = Session::load(None, Some("02-first-pursuit"), Some(7)).expect("the game's own files");
        let begun = session.config.clone();
        session.difficulty = Difficulty::Hard;
        session.config.render.orders = 3;
        session.config.hole.mass_solar = 4.3e6;
        session.config.controls.boost = "KeyX PadSouth".into();
        let line = command_line(&session, &begun);
        assert!(line.ends_with("--set hole.mass_solar=4300000.0 --set render.orders=3 --set 'controls.boost=KeyX PadSouth'"), "{line}");
        // As a shell hands it on.
        let words = line
            .split('\'')
            .enumerate()
            .flat_map(|(k, part)| if k % 2 == 1 { vec![part.to_owned()] } else { part.split_whitespace().map(String::from).collect() });
        let args = Line::parse_from(words.skip(1)).play;
        let mut again = begun.clone();
        config::assign(&mut again, &args.set).expect("allowed");
        assert_eq!(again, session.config);
        assert_eq!((args.scene.as_deref(), args.seed, args.difficulty), (Some("02-first-pursuit"), Some(7), Some(Difficulty::Hard)));
        assert_eq!(quoted("it's"), "'it'\\''s'");
    }
}
