//! The player's best scores and the replays of them, kept in the user's data folder.
//!
//! Everything is written at once and whole: to a file beside, which then takes the place of the old one. A file that cannot be read is set
//! aside, never overwritten.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use bevy::prelude::{Resource, warn};
use serde::{Deserialize, Serialize};

use crate::game_files::user_folder;
use crate::play::files::{set_aside, write_whole};
use crate::scene::Difficulty;
use crate::scene::document::{self, error::Complaint};
use crate::sim::replay::Replay;
use crate::user_file::{self, short};

/// The best flight of a mission on a difficulty.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Best {
    /// What the mission scores: r_s/c, or c of Δv.
    pub score: f64,
    /// One to three.
    pub stars: u32,
}

/// All best flights: by mission, then by difficulty.
type BestTable = BTreeMap<String, BTreeMap<String, Best>>;

/// The best flights in a text that came from `file`.
fn read(file: &Path, text: &str) -> Result<BestTable, Complaint> {
    let table: BestTable = document::parse(file, text)?;
    for (mission, levels) in &table {
        for (difficulty, Best { score, stars }) in levels {
            let wrong = |key: &str, problem: String| {
                Err(Complaint { file: file.to_path_buf(), line: None, key: short(&format!("{mission}.{difficulty}.{key}")), problem })
            };
            if !(score.is_finite() && *score >= 0.0) {
                return wrong("score", format!("{score}, allowed is a number from 0 on"));
            }
            if !(1..=3).contains(stars) {
                return wrong("stars", format!("{stars}, allowed 1 to 3"));
            }
        }
    }
    Ok(table)
}

/// The best flights, and where they are kept.
#[derive(Resource, Clone, Debug, Default)]
pub struct Records {
    table: BestTable,
    /// None where there is no folder to write to: then they last as long as the game.
    folder: Option<PathBuf>,
}

impl Records {
    /// Those of the user, and what is to be said of them.
    pub fn load() -> (Records, Option<String>) {
        match user_folder() {
            Some(folder) => Records::load_from(&folder),
            None => (Records::default(), Some("There is no folder for best scores: they are kept until the game ends.".into())),
        }
    }

    /// Those of a folder, which need not be there yet.
    pub fn load_from(folder: &Path) -> (Records, Option<String>) {
        let file = folder.join("records.toml");
        let records = |table| Records { table, folder: Some(folder.to_path_buf()) };
        let text = match user_file::read(&file, user_file::MOST_TEXT).map_err(std::io::Error::from) {
            Ok(bytes) => String::from_utf8_lossy(&bytes).into_owned(),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return (records(BestTable::new()), None),
            Err(error) => {
                warn!("{}: {error}", file.display());
                return (Records::default(), Some(format!("{}: {error}. New scores are kept until the game ends.", file.display())));
            }
        };
        match read(&file, &text) {
            Ok(table) => (records(table), None),
            Err(wrong) => match set_aside(&file) {
                Some(aside) => {
                    warn!("{wrong}");
                    let said = format!("{} was damaged; it is set aside as {}.", file.display(), aside.display());
                    (records(BestTable::new()), Some(said))
                }
                None => (Records::default(), Some(format!("{} is damaged. New scores are kept until the game ends.", file.display()))),
            },
        }
    }

    /// The best flight of a mission.
    pub fn best(&self, mission: &str, difficulty: Difficulty) -> Option<Best> {
        self.table.get(mission)?.get(difficulty.name()).copied()
    }

    /// The replay of it, if it is there and can be flown.
    pub fn replay(&self, mission: &str, difficulty: Difficulty) -> Option<Replay> {
        Replay::load(&self.replay_file(mission, difficulty)?).ok()
    }

    fn replay_file(&self, mission: &str, difficulty: Difficulty) -> Option<PathBuf> {
        Some(self.folder.as_ref()?.join("replays").join(format!("{mission}-{difficulty}.toml")))
    }

    /// Takes a won flight. Whether it is the best so far, which is then written; and what went wrong.
    pub fn take(&mut self, mission: &str, difficulty: Difficulty, won: Best, replay: &Replay) -> (bool, Option<String>) {
        let is_best = self.best(mission, difficulty).is_none_or(|best| won.score < best.score);
        if !is_best {
            return (false, None);
        }
        self.table.entry(mission.to_owned()).or_default().insert(difficulty.name().to_owned(), won);
        let written = self.write().and_then(|()| match self.replay_file(mission, difficulty) {
            Some(file) => write_whole(&file, &replay.to_text()),
            None => Ok(()),
        });
        (true, written.err().map(|error| format!("The score could not be written: {error}")))
    }

    fn write(&self) -> std::io::Result<()> {
        let Some(folder) = &self.folder else { return Ok(()) };
        let text = toml::to_string(&self.table).map_err(std::io::Error::other)?;
        write_whole(&folder.join("records.toml"), &text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::pilot_kind::PilotKind;
    use crate::scene::{self, GameConfig};

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("lensrunner-records-{name}-{}", std::process::id()));
        _ = std::fs::remove_dir_all(&folder);
        folder
    }

    fn flight() -> Replay {
        let scene = scene::load("01-training").expect("a mission of the game");
        Replay::begin(&scene, &GameConfig::default(), Difficulty::Easy, PilotKind::Expert, 1)
    }

    #[test]
    fn a_better_score_is_kept_and_found_again() {
        let folder = folder("kept");
        let (mut records, said) = Records::load_from(&folder);
        assert_eq!(said, None);
        let best = |score| Best { score, stars: 2 };
        assert_eq!(records.take("01-training", Difficulty::Easy, best(50.0), &flight()), (true, None));
        assert_eq!(records.take("01-training", Difficulty::Easy, best(60.0), &flight()), (false, None));
        let (again, said) = Records::load_from(&folder);
        assert_eq!(said, None);
        assert_eq!(again.best("01-training", Difficulty::Easy), Some(best(50.0)));
        assert_eq!(again.best("01-training", Difficulty::Hard), None);
        assert_eq!(again.replay("01-training", Difficulty::Easy), Some(flight()));
        _ = std::fs::remove_dir_all(&folder);
    }

    #[test]
    fn a_damaged_file_is_set_aside_and_said() {
        let folder = folder("damaged");
        std::fs::create_dir_all(&folder).expect("a folder");
        // No score is better than one that is no number.
        let wrong: [&[u8]; 4] = [
            b"[broken 1",
            b"[\"01-training\".easy]\nscore = nan\nstars = 3",
            b"[\"01-training\".easy]\nscore = 1.0\nstars = 9",
            b"# no UTF-8: \xff\n[\xff]",
        ];
        for (n, wrong) in (1..).zip(wrong) {
            std::fs::write(folder.join("records.toml"), wrong).expect("a file");
            let (records, said) = Records::load_from(&folder);
            assert!(said.is_some_and(|said| said.contains(&format!("damaged-{n}"))));
            assert_eq!(records.best("01-training", Difficulty::Easy), None);
            let aside = std::fs::read(folder.join(format!("records.damaged-{n}.toml"))).expect("set aside");
            assert_eq!(aside, wrong);
        }
        _ = std::fs::remove_dir_all(&folder);
    }
}
