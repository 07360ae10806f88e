//! The player's choices: settings that lie over `game.toml`, kept in the user's configuration folder.
//!
//! Only what was chosen is kept. The command line goes before the choices, the choices before the file.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use bevy::prelude::{Resource, warn};

use crate::game_files::own_folder;
use crate::play::files::{set_aside, write_whole};
use crate::scene::GameConfig;
use crate::scene::config::{self, Setting, Value, choices_text};
use crate::user_file;

/// Names another folder than the user's own.
pub const FOLDER_VARIABLE: &str = "LENSRUNNER_CONFIG";

/// The sections that are the player's.
const SECTIONS: [&str; 5] = ["video", "sound", "controls", "accessibility", "interface"];
/// Single settings of other sections that are.
const OTHERS: [&str; 4] = ["assist.enabled", "assist.reference", "assist.avoid_hole", "clock.slow_near_danger"];

/// Whether a setting is the player's to choose.
pub fn is_players(setting: &Setting<GameConfig>) -> bool {
    SECTIONS.contains(&setting.section) || OTHERS.contains(&setting.path().as_str())
}

/// What the player chose, by place in the list of all settings.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Choices {
    chosen: BTreeMap<usize, Value>,
    /// None where there is no folder: then they last as long as the game.
    file: Option<PathBuf>,
    /// Not written yet.
    changed: bool,
}

impl Choices {
    /// Those of the user, and what is to be said of them.
    pub fn load() -> (Choices, Option<String>) {
        let named = std::env::var_os(FOLDER_VARIABLE).map(PathBuf::from);
        match named.or_else(|| own_folder(|folders| folders.config_dir())) {
            Some(folder) => Choices::load_from(&folder.join("settings.toml")),
            None => (Choices::default(), Some("There is no folder for settings: they are kept until the game ends.".into())),
        }
    }

    /// Those of a file, which need not be there yet.
    pub fn load_from(file: &Path) -> (Choices, Option<String>) {
        let none = Choices { file: Some(file.to_path_buf()), ..Choices::default() };
        let text = match user_file::read(file, user_file::MOST_TEXT).map_err(std::io::Error::from) {
            Ok(bytes) => String::from_utf8_lossy(&bytes).into_owned(),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return (none, None),
            Err(error) => {
                warn!("{}: {error}", file.display());
                return (Choices::default(), Some(format!("{}: {error}. Settings are kept until the game ends.", file.display())));
            }
        };
        match config::choices(file, &text, is_players) {
            Ok(chosen) => {
                let place = |setting: &Setting<GameConfig>| config::settings().iter().position(|known| known.path() == setting.path());
                let chosen = chosen.into_iter().filter_map(|(setting, value)| Some((place(setting)?, value)));
                (Choices { chosen: chosen.collect(), ..none }, None)
            }
            Err(error) => match set_aside(file) {
                Some(aside) => (none, Some(format!("{error}\nYour settings are set aside as {}.", aside.display()))),
                None => (Choices::default(), Some(format!("{error}\nSettings are kept until the game ends."))),
            },
        }
    }

    /// Puts them over a configuration.
    pub fn over(&self, config: &mut GameConfig) {
        for (place, value) in &self.chosen {
            // What was allowed when it was chosen is allowed.
            _ = config::settings()[*place].set(config, value.clone());
        }
    }

    /// Sets a value in `config` and keeps it; what is not allowed changes nothing.
    pub fn choose(&mut self, setting: &Setting<GameConfig>, value: Value, config: &mut GameConfig) {
        let Some(place) = config::settings().iter().position(|known| known.path() == setting.path()) else { return };
        if setting.set(config, value).is_ok() {
            self.chosen.insert(place, setting.get(config));
            self.changed = true;
        }
    }

    /// Forgets the choices of these settings; `config` has what `file` says of them again.
    pub fn forget(&mut self, which: impl Fn(&Setting<GameConfig>) -> bool, file: &GameConfig, config: &mut GameConfig) {
        for (place, setting) in config::settings().iter().enumerate().filter(|(_, setting)| which(setting)) {
            self.chosen.remove(&place);
            _ = setting.set(config, setting.get(file));
        }
        self.changed = true;
    }

    /// Writes them if they have changed; what went wrong.
    pub fn write(&mut self) -> Option<String> {
        if !std::mem::take(&mut self.changed) {
            return None;
        }
        let file = self.file.as_ref()?;
        let text = choices_text(self.chosen.iter().map(|(place, value)| (&config::settings()[*place], value)));
        write_whole(file, &text).err().map(|error| format!("The settings could not be written: {error}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::config::setting;

    fn file(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("lensrunner-choices-{name}-{}", std::process::id()));
        _ = std::fs::remove_dir_all(&folder);
        folder.join("settings.toml")
    }

    #[test]
    fn what_was_chosen_is_there_again_over_the_file() {
        let file = file("kept");
        let (mut choices, said) = Choices::load_from(&file);
        assert_eq!((&said, choices.write()), (&None, None));
        let mut config = GameConfig::default();
        choices.choose(setting("video.fov").expect("a setting"), Value::Number(75.0), &mut config);
        choices.choose(setting("controls.boost").expect("a setting"), Value::Word("KeyX PadSouth".into()), &mut config);
        choices.choose(setting("sound.music").expect("a setting"), Value::Number(7.0), &mut config);
        assert_eq!((config.video.fov, config.controls.boost.as_str(), config.sound.music), (75.0, "KeyX PadSouth", 0.5));
        assert_eq!(choices.write(), None);
        let (mut again, said) = Choices::load_from(&file);
        assert_eq!((said, &again), (None, &choices));
        // The file's other values are the file's.
        let mut other = GameConfig::default();
        other.video.vsync = false;
        again.over(&mut other);
        assert_eq!((other.video.fov, other.video.vsync, other.controls.boost.as_str()), (75.0, false, "KeyX PadSouth"));
        again.forget(|setting| setting.section == "video", &GameConfig::default(), &mut other);
        assert_eq!((other.video.fov, other.controls.boost.as_str()), (60.0, "KeyX PadSouth"));
        _ = std::fs::remove_dir_all(file.parent().expect("a folder"));
    }

    /// Damaged, of another type, out of range, unknown, or not the player's: set aside, never overwritten, and the game begins.
    #[test]
    fn a_damaged_file_is_set_aside_and_said() {
        let file = file("damaged");
        std::fs::create_dir_all(file.parent().expect("a folder")).expect("a folder");
        let wrong = [
            "[video", "[video]\nfov = \"wide\"\n", "[video]\nfov = 1e9\n", "[video]\nfox = 1\n", "[ship]\nthrust = 1\n", "video = 1",
            "\u{0}",
        ];
        for (n, text) in wrong.iter().enumerate() {
            std::fs::write(&file, text).expect("a file");
            let (mut choices, said) = Choices::load_from(&file);
            let said = said.expect("a word");
            assert!(said.contains(&format!("damaged-{}", n + 1)) && (n != 2 || said.contains("video.fov")), "{text}: {said}");
            let mut config = GameConfig::default();
            choices.over(&mut config);
            assert_eq!(config, GameConfig::default());
            choices.choose(setting("video.fov").expect("a setting"), Value::Number(75.0), &mut config);
            assert_eq!(choices.write(), None);
            let aside = file.with_file_name(format!("settings.damaged-{}.toml", n + 1));
            assert_eq!(&std::fs::read_to_string(aside).expect("set aside"), text);
        }
        _ = std::fs::remove_dir_all(file.parent().expect("a folder"));
    }
}
