//! Replays: a flight as the list of the player's commands, from which it is flown again to the same bits.
//!
//! A replay is a TOML file. Its `log` holds the records, packed (column by column, DEFLATE, Base64); `check` is the CRC-32 of
//! all lines before it. The same version of the program flies it to the same end on every machine (`./test-web`).

pub mod link;
mod packing;

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use data_encoding::BASE64;
use serde::{Deserialize, Serialize};

use super::by_hand::choose_pilot;
use super::player_commands::PlayerCommands;
use super::run::{FlightReport, RunRequest, fly_to_end, state_hash};
use super::{Clock, SimSet, app_of, board, outcome};
use crate::game_files::{self, GameFile};
use crate::scene::config::{self, Value};
use crate::scene::document;
use crate::scene::mission::Difficulty;
use crate::scene::pilot_kind::PilotKind;
use crate::scene::{self, GameConfig, Scene, SceneError};
use crate::user_file::{FileFault, brief, short};
use packing::{MOST_BYTES, pack, unpack};

pub use packing::Record;

/// The version of the format.
const FORMAT: u32 = 3;
/// The most steps of a flight: up to T = 1e5 r_s/c with the usual step. Each takes some 180 bytes a ship when it is flown again.
pub const MOST_STEPS: u64 = 3_200_001;
/// The sections of `game.toml` that a flight depends on.
const SECTIONS: [&str; 5] = ["clock", "ship", "enemy", "assist", "rules"];

/// A flight, ready to be flown again.
#[derive(Clone, Debug, PartialEq)]
pub struct Replay {
    /// Name of the scene or mission.
    pub scene: String,
    /// [`Scene::fingerprint`] of its file.
    pub fingerprint: u64,
    /// Of the mission.
    pub difficulty: Difficulty,
    /// Who flies while the autopilot does.
    pub pilot: PilotKind,
    /// For everything left to chance.
    pub seed: u64,
    /// The settings that the flight depends on, before the difficulty: dotted keys and values.
    pub settings: Vec<(String, Value)>,
    /// The player's commands.
    pub records: Vec<Record>,
    /// Steps flown.
    pub ticks: u64,
    /// [`super::Outcome::name`], or "undecided".
    pub outcome: String,
    /// Of the end state.
    pub hash: String,
}

/// Why a replay cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// The file cannot be read.
    #[error("{path}: {source}")]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// It is no replay, or damaged.
    #[error("{path}: {problem}")]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// Its scene is wrong or not there.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Its scene is none of the game's.
    #[error("{path}: there is no scene or mission {scene:?} among the game's; name its file as SCENE")]
    NoScene {
        /// The replay.
        path: PathBuf,
        /// The scene's name.
        scene: String,
    },
    /// Another scene was named than the one it was flown in.
    #[error("{path}: it is a flight of {flown}, not of {named}")]
    AnotherScene {
        /// The replay.
        path: PathBuf,
        /// Its scene.
        flown: String,
        /// The one that was named.
        named: String,
    },
    /// Its scene is another one now.
    #[error("{path}: {scene} was another file when this was flown")]
    OtherScene {
        /// The replay.
        path: PathBuf,
        /// The scene.
        scene: String,
    },
    /// It was flown to another end.
    #[error("{path}: flown again it ends otherwise: {found}, not {expected}")]
    Differs {
        /// The replay.
        path: PathBuf,
        /// What came.
        found: String,
        /// What it says.
        expected: String,
    },
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ReplayFile {
    replay: u32,
    version: String,
    scene: String,
    fingerprint: String,
    difficulty: String,
    pilot: String,
    seed: u64,
    ticks: u64,
    outcome: String,
    hash: String,
    settings: toml::Table,
    log: String,
    check: String,
}

impl Replay {
    /// A flight that begins now: nothing is recorded yet.
    pub fn begin(scene: &Scene, config: &GameConfig, difficulty: Difficulty, pilot: PilotKind, seed: u64) -> Replay {
        let settings = config::settings().iter().filter(|setting| SECTIONS.contains(&setting.section));
        Replay {
            scene: scene.name.clone(),
            fingerprint: scene.fingerprint,
            difficulty,
            pilot,
            seed,
            settings: settings.map(|setting| (setting.path(), setting.get(config))).collect(),
            records: Vec::new(),
            ticks: 0,
            outcome: "undecided".into(),
            hash: String::new(),
        }
    }

    /// `game.toml` as it was flown by, but for the difficulty; what the flight does not depend on is as in `config`.
    pub fn config(&self, config: &GameConfig) -> GameConfig {
        with_settings(config.clone(), &self.settings)
    }

    /// Its text.
    pub fn to_text(&self) -> String {
        let quoted = |word: &str| toml::Value::String(word.to_owned()).to_string();
        let text = format!(
            "replay = {FORMAT}\nversion = {}\nscene = {}\nfingerprint = \"{:016x}\"\ndifficulty = \"{}\"\npilot = \"{}\"\nseed = {}\nticks = {}\n\
             outcome = {}\nhash = {}\nsettings = {}\nlog = \"{}\"\n",
            quoted(env!("CARGO_PKG_VERSION")),
            quoted(&self.scene),
            self.fingerprint,
            self.difficulty,
            self.pilot,
            self.seed,
            self.ticks,
            quoted(&self.outcome),
            quoted(&self.hash),
            settings_text(&self.settings),
            BASE64.encode(&pack(&self.records)),
        );
        let check = crc32fast::hash(text.as_bytes());
        text + &format!("check = \"{check:08x}\"\n")
    }

    /// The flight up to its step `ticks`, with the hash of its state there if `world` is that far.
    pub fn up_to(&self, ticks: u64, world: &World) -> Replay {
        let hash = world.get_resource::<Clock>().filter(|clock| clock.tick == ticks).map(|_| state_hash(world).to_string());
        Replay {
            records: self.records.iter().take_while(|record| record.tick < ticks).copied().collect(),
            ticks,
            outcome: "undecided".into(),
            hash: hash.unwrap_or_default(),
            ..self.clone()
        }
    }

    /// Reads the text of a replay; `path` is only named in complaints.
    pub fn from_text(path: &Path, text: &str) -> Result<Replay, ReplayError> {
        let damaged = |problem: String| ReplayError::Damaged { path: path.to_path_buf(), problem };
        let file: ReplayFile = document::parse(path, text).map_err(|wrong| {
            let line = wrong.line.map_or_else(String::new, |line| format!(": line {line}"));
            let key = if wrong.key.is_empty() { String::new() } else { format!(": {}", wrong.key) };
            damaged(format!("it is no replay, or damaged{line}{key}: {}", wrong.problem))
        })?;
        if file.replay != FORMAT || file.version != env!("CARGO_PKG_VERSION") {
            let made = format!(
                "it was made by version {} (format {}), this is {} ({FORMAT})",
                short(&file.version),
                file.replay,
                env!("CARGO_PKG_VERSION")
            );
            return Err(damaged(made));
        }
        let before = text.find("check = ").map_or(text, |end| &text[..end]);
        if file.check != format!("{:08x}", crc32fast::hash(before.as_bytes())) {
            return Err(damaged("it is damaged: its checksum is another one".into()));
        }
        // It would be flown for years.
        if file.ticks > MOST_STEPS {
            return Err(damaged(format!("ticks = {}, allowed 0 to {MOST_STEPS}", file.ticks)));
        }
        let log = BASE64.decode(file.log.as_bytes()).map_err(|_| damaged("its log is damaged".into()))?;
        Ok(Replay {
            scene: file.scene,
            fingerprint: u64::from_str_radix(&file.fingerprint, 16).map_err(|_| damaged("its fingerprint is damaged".into()))?,
            difficulty: file.difficulty.parse().map_err(damaged)?,
            pilot: file.pilot.parse().map_err(damaged)?,
            seed: file.seed,
            settings: settings(file.settings).map_err(|wrong| damaged(brief(&wrong)))?,
            records: unpack(&log).ok_or_else(|| damaged("its log is damaged".into()))?,
            ticks: file.ticks,
            outcome: file.outcome,
            hash: file.hash,
        })
    }

    /// Reads a file, or the replay of this name that the game comes with; or a link.
    pub fn load(path: &Path) -> Result<Replay, ReplayError> {
        if let Some(address) = path.to_str().filter(|text| text.contains(link::MARK)) {
            return Replay::from_link(address);
        }
        let file = path.to_str().map_or_else(|| GameFile::at(path), |name| game_files::named(&["assets/replays"], name));
        let read = |fault: FileFault| ReplayError::Read { path: file.path.clone(), source: fault.into() };
        let text = file.read_text(MOST_BYTES).map_err(read)?;
        Replay::from_text(&file.path, &text)
    }

    /// Its scene, if that is still the same file: `named`, by name or path, or the one of the game that has its name.
    pub fn scene(&self, path: &Path, named: Option<&str>) -> Result<Scene, ReplayError> {
        let scene = match named {
            Some(named) => scene::load(named)?,
            None if !scene::file(&self.scene).is_there() => {
                return Err(ReplayError::NoScene { path: path.to_path_buf(), scene: short(&self.scene) });
            }
            None => scene::load(&self.scene)?,
        };
        if scene.name != self.scene {
            Err(ReplayError::AnotherScene { path: path.to_path_buf(), flown: short(&self.scene), named: scene.name })
        } else if scene.fingerprint == self.fingerprint {
            Ok(scene)
        } else {
            Err(ReplayError::OtherScene { path: path.to_path_buf(), scene: self.scene.clone() })
        }
    }

    /// An app in which it is flown again: run `FixedUpdate` to go on.
    pub fn app(&self, scene: &Scene, config: &GameConfig) -> App {
        let config = scene.config(&self.config(config), self.difficulty);
        let mut app = app_of(scene, &config, self.seed);
        app.insert_resource(Playback::of(self));
        board(app.world_mut(), self.pilot);
        app
    }

    /// Flies it again, without graphics, and sees whether it comes to the same end.
    pub fn verify(&self, path: &Path, named: Option<&str>, config: &GameConfig) -> Result<FlightReport, ReplayError> {
        let scene = self.scene(path, named)?;
        let mut app = self.app(&scene, config);
        let step = app.world().resource::<Clock>().step;
        let report = fly_to_end(app.world_mut(), (self.ticks as f64 - 0.5) * step);
        let end = |hash: &str, ticks: u64, outcome: &str| format!("{outcome} after {ticks} steps, state {hash}");
        let found = end(&report.hash.to_string(), report.steps, report.outcome.map_or("undecided", super::Outcome::name));
        let expected = end(&short(&self.hash), self.ticks, &short(&self.outcome));
        if found == expected { Ok(report) } else { Err(ReplayError::Differs { path: path.to_path_buf(), found, expected }) }
    }

    /// Closes the log of the flight in `world`.
    pub fn finish(&mut self, world: &World) {
        self.ticks = world.resource::<Clock>().tick;
        self.outcome = outcome(world).map_or("undecided", |(outcome, _)| outcome.name()).into();
        self.hash = state_hash(world).to_string();
    }
}

/// As [`run`](super::run::run), and the flight as a replay.
pub fn record(scene: &Scene, config: &GameConfig, request: &RunRequest) -> (FlightReport, Replay) {
    let begun = Replay::begin(scene, config, request.difficulty, request.pilot, request.seed);
    let config = scene.config(config, request.difficulty);
    let until = request.until.unwrap_or(scene.rules(&config).time_limit);
    let mut app = app_of(scene, &config, request.seed);
    app.insert_resource(ReplayLog(begun.clone()));
    board(app.world_mut(), request.pilot);
    let report = fly_to_end(app.world_mut(), until);
    let mut replay = app.world_mut().remove_resource::<ReplayLog>().map_or(begun, |recording| recording.0);
    replay.finish(app.world());
    (report, replay)
}

/// `config` with these values, which were checked as they were read.
pub(in crate::sim) fn with_settings(mut config: GameConfig, settings: &[(String, Value)]) -> GameConfig {
    for (path, value) in settings {
        if let Some(setting) = config::setting(path) {
            let _ = setting.set(&mut config, value.clone());
        }
    }
    config
}

/// Settings as a table, inline.
pub(in crate::sim) fn settings_text(settings: &[(String, Value)]) -> String {
    let value = |value: &Value| match value.clone() {
        Value::Number(number) => toml::Value::Float(number),
        Value::Integer(number) => toml::Value::Integer(number.into()),
        Value::Switch(on) => toml::Value::Boolean(on),
        Value::Word(word) => toml::Value::String(word),
    };
    let settings: Vec<String> = settings.iter().map(|(path, found)| format!("\"{path}\" = {}", value(found))).collect();
    format!("{{ {} }}", settings.join(", "))
}

/// Checked settings of a file.
pub(in crate::sim) fn settings(table: toml::Table) -> Result<Vec<(String, Value)>, String> {
    let one = |(path, value): (String, toml::Value)| {
        let setting = config::setting(&path).ok_or_else(|| format!("{path}: unknown setting"))?;
        let value = match value {
            toml::Value::Float(number) => Value::Number(number),
            toml::Value::Integer(number) => {
                Value::Integer(u32::try_from(number).map_err(|_| format!("{path} = {number} is out of range"))?)
            }
            toml::Value::Boolean(on) => Value::Switch(on),
            toml::Value::String(word) => Value::Word(word),
            _ => return Err(format!("{path} has the wrong type")),
        };
        let value = setting.check(value).map_err(|problem| format!("{path}: {problem}"))?;
        Ok((path, value))
    };
    table.into_iter().map(one).collect()
}

/// Records the player's commands, as a [`Replay`] that grows.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct ReplayLog(pub Replay);

impl ReplayLog {
    fn note(&mut self, tick: u64, commands: &PlayerCommands) {
        if self.0.records.last().is_none_or(|last| last.commands != *commands) {
            self.0.records.push(Record { tick, commands: *commands });
        }
    }
}

/// A replay that is flown: its commands are the player's.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct Playback {
    records: Vec<Record>,
    next: usize,
}

impl Playback {
    /// From the beginning.
    pub fn of(replay: &Replay) -> Playback {
        Playback { records: replay.records.clone(), next: 0 }
    }
}

/// Gives the commands of a [`Playback`], and keeps them in a [`ReplayLog`], where there is one.
pub struct PlaybackPlugin;

impl Plugin for PlaybackPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            FixedUpdate,
            (
                play_back.run_if(resource_exists::<Playback>).before(choose_pilot).in_set(SimSet::Input),
                record_commands.run_if(resource_exists::<ReplayLog>).after(choose_pilot).in_set(SimSet::Input),
            ),
        );
    }
}

/// The commands of this step.
fn play_back(clock: Res<Clock>, mut playback: ResMut<Playback>, mut commands: ResMut<PlayerCommands>) {
    while let Some(record) = playback.records.get(playback.next).filter(|record| record.tick <= clock.tick).copied() {
        *commands = record.commands;
        playback.next += 1;
    }
}

fn record_commands(clock: Res<Clock>, commands: Res<PlayerCommands>, mut recording: ResMut<ReplayLog>) {
    recording.note(clock.tick, &commands);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assist::AssistMode;
    use rand::{RngExt, SeedableRng, rngs::StdRng};

    fn replay(records: Vec<Record>) -> Replay {
        let scene = scene::load("02-first-pursuit").expect("a mission of the game");
        let mut replay = Replay::begin(&scene, &GameConfig::default(), Difficulty::Hard, PilotKind::Naive, 7);
        replay.records = records;
        replay.hash = "0123456789abcdef".into();
        replay
    }

    /// Ten minutes with the mouse never at rest.
    fn restless() -> Vec<Record> {
        let mut chance = StdRng::seed_from_u64(1);
        let mut turn = [0f64; 2];
        let ticks = (600.0 * 1.5 / GameConfig::default().clock.step) as u64;
        let one = |tick: u64| {
            for axis in &mut turn {
                *axis = 0.9 * *axis + chance.random_range(-12.0..12.0);
            }
            let thrust = [0, 0, if (tick / 200).is_multiple_of(3) { -76 } else { 0 }];
            Record {
                tick,
                commands: PlayerCommands {
                    thrust,
                    turn: [turn[0] as i8, turn[1] as i8, 0],
                    assist: AssistMode::Orbit,
                    ..PlayerCommands::default()
                },
            }
        };
        (0..ticks).map(one).collect()
    }

    #[test]
    fn a_text_gives_the_replay_back() {
        let mut records = restless();
        records.truncate(500);
        let all = PlayerCommands { pace: 0.375, fire: true, looking: true, autopilot: true, ..records[300].commands };
        records[300].commands = PlayerCommands { assist: AssistMode::Target, matching: true, facing: true, ..all };
        records[301].commands.assist = AssistMode::Off;
        let before = replay(records);
        assert_eq!(Replay::from_text(Path::new("x"), &before.to_text()).expect("a replay"), before);
        let empty = replay(vec![]);
        assert_eq!(Replay::from_text(Path::new("x"), &empty.to_text()).expect("a replay"), empty);
    }

    /// Measured 67 kB.
    #[test]
    fn ten_minutes_take_less_than_200_kib() {
        let text = replay(restless()).to_text();
        println!("{} bytes", text.len());
        assert!(text.len() < 200 << 10, "{}", text.len());
    }

    #[test]
    fn a_damaged_or_foreign_file_is_refused_in_a_sentence() {
        let good = replay(restless()).to_text();
        let middle = good.len() / 2;
        let mut wrong = vec![String::new(), "x".into(), good[..middle].to_owned(), good.replace("seed = 7", "seed = 8")];
        wrong.push(good.replace("version = \"", "version = \"9"));
        wrong.push(good.replace("replay = 3", "replay = 2"));
        for (place, text) in wrong.iter().enumerate() {
            let said = Replay::from_text(Path::new("a.toml"), text).expect_err("refused").to_string();
            assert!(said.starts_with("a.toml: ") && !said.contains('\n'), "{place}: {said}");
        }
        for (ticks, is_right) in [(MOST_STEPS, true), (MOST_STEPS + 1, false), (i64::MAX as u64, false)] {
            let text = Replay { ticks, ..replay(vec![]) }.to_text();
            let said = Replay::from_text(Path::new("a.toml"), &text).err().map(|wrong| wrong.to_string());
            let wanted = format!("a.toml: ticks = {ticks}, allowed 0 to 3200001");
            assert_eq!(said, (!is_right).then_some(wanted));
        }
        // Any byte of the log.
        let at = good.find("log = ").expect("a log") + 40;
        let mut flipped = good.into_bytes();
        flipped[at] = if flipped[at] == b'A' { b'B' } else { b'A' };
        assert!(Replay::from_text(Path::new("a.toml"), &String::from_utf8(flipped).expect("ASCII")).is_err());
    }
}
