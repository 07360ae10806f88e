//! Scene files: name or path to a checked [`Scene`].

use std::collections::HashSet;
use std::path::Path;
use std::sync::Arc;

use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::camera::{CameraEntry, SceneCamera, check_camera};
use super::config::{self, GameConfig};
use super::document::error::{Complaints, SceneError};
use super::document::fault::{Fault, fault};
use super::document::{Document, one};
use super::expect::{Expect, ExpectEntry, check_expect};
use super::mission::{Difficulty, GateEntry, GoalEntry, Mission, MissionEntry, check_mission, levels};
use super::planet::{Planet, PlanetEntry, SkyEntry, SkySwitches, check_planet, check_sky};
use super::prop::{Prop, PropEntry, check_props};
use super::rules::{Rules, RulesEntry};
use super::ship::{ShipEntry, ShipSpec, check_ships};
use super::swarm::{SwarmEntry, check_swarms};
use crate::game_files::{self, GameFile};
use crate::user_file::{FileFault, MOST_TEXT};

/// Where the scenes lie.
const SCENES: &str = "assets/scenes";
/// Where the missions lie.
const MISSIONS: &str = "assets/missions";

/// Everything a scene file says.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The file's name without its ending.
    pub name: String,
    /// From where it is seen.
    pub camera: SceneCamera,
    /// The ships, in the order of the file, those of swarms last.
    pub ships: Vec<ShipSpec>,
    /// The things held in place.
    pub props: Vec<Prop>,
    /// The planet, if there is one.
    pub planet: Option<Planet>,
    /// What shines at infinity.
    pub sky: SkySwitches,
    /// `[disk]`: present if the scene has a disk. Its keys are those of `[disk]` in `game.toml` and go before them.
    disk: Option<DiskKeys>,
    rules: RulesEntry,
    /// Goals and limits, if it is a mission.
    pub mission: Option<Arc<Mission>>,
    /// What must become of it.
    pub expect: Option<Expect>,
    /// The file's text.
    pub text: Arc<str>,
    /// A fingerprint of the text.
    pub fingerprint: u64,
    /// It is no file of the game's own: another may have its name.
    pub foreign: bool,
}

/// The text of a `[disk]` section, checked once, applied to a configuration that may change while the game runs.
#[derive(Debug, Clone, PartialEq)]
struct DiskKeys(Vec<(String, config::Value)>);

/// A scene file as it stands, before any check.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneFile {
    camera: Option<Spanned<CameraEntry>>,
    #[serde(default)]
    ship: Vec<Spanned<ShipEntry>>,
    #[serde(default)]
    swarm: Vec<SwarmEntry>,
    #[serde(default)]
    prop: Vec<Spanned<PropEntry>>,
    /// Read from the document, as its keys are those of `game.toml`; so is `difficulty`.
    disk: Option<toml::Table>,
    planet: Option<PlanetEntry>,
    #[serde(default)]
    sky: SkyEntry,
    #[serde(default)]
    rules: RulesEntry,
    mission: Option<MissionEntry>,
    #[serde(default)]
    goal: Vec<Spanned<GoalEntry>>,
    #[serde(default)]
    gate: Vec<Spanned<GateEntry>>,
    difficulty: Option<toml::Table>,
    expect: Option<ExpectEntry>,
}

impl Scene {
    /// The name under which scores are kept: those of another file of the same name are others.
    pub fn record_name(&self) -> String {
        if self.foreign { format!("{}-{:016x}", self.name, self.fingerprint) } else { self.name.clone() }
    }

    /// The disk of this scene: the scene's own keys over those of `game.toml`; `None` for a scene without a disk.
    pub fn disk(&self, config: &GameConfig) -> Option<config::Disk> {
        let keys = self.disk.as_ref()?;
        let mut config = config.clone();
        for (path, value) in &keys.0 {
            if let Some(setting) = config::setting(path) {
                // Checked when the scene was loaded.
                let _ = setting.set(&mut config, value.clone());
            }
        }
        Some(config.disk)
    }

    /// `game.toml` as this scene's mission has it on a difficulty; as it is for a scene that is no mission.
    pub fn config(&self, config: &GameConfig, difficulty: Difficulty) -> GameConfig {
        let mut config = config.clone();
        if let Some(mission) = &self.mission {
            // Its own limit, unless a difficulty has another.
            config.rules.time_limit = mission.time_limit;
            mission.levels[difficulty as usize].apply(&mut config);
        }
        config
    }

    /// The rules of this scene: the scene's own keys over those of `game.toml`.
    pub fn rules(&self, config: &GameConfig) -> Rules {
        let base = Rules::from(&config.rules);
        // Checked when the scene was loaded.
        let rules = self.rules.check(base).unwrap_or(base);
        // A mission's limit is that of its difficulty.
        if self.mission.is_some() { Rules { time_limit: base.time_limit, ..rules } } else { rules }
    }

    /// Reads the text of a scene file; `file` names it in complaints and gives the scene its name.
    pub fn from_toml(file: &Path, text: &str) -> Result<Scene, Complaints> {
        let document = Document::parse(file, text).map_err(one)?;
        let entry: SceneFile = document.read().map_err(one)?;
        let mut scene = check(&entry).map_err(|fault| document.complain(vec![fault]))?;
        let mission = mission(document.table(), &entry, &scene.ships).map_err(|faults| document.complain(faults))?;
        scene.mission = mission.map(Arc::new);
        (scene.text, scene.fingerprint) = (text.into(), fingerprint(text));
        let name = file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let disk = entry.disk.is_some().then(|| disk_keys(document.table())).transpose().map_err(|faults| document.complain(faults))?;
        Ok(Scene { name, disk, ..scene })
    }
}

/// The most names of models that a scene has: each is a file that is read.
const MOST_MODELS: usize = 100;
/// The most bytes of such a name.
const MOST_NAME: usize = 1024;

/// Refuses more models, and longer names, than are read.
fn check_models(entry: &SceneFile) -> Result<(), Fault> {
    let ships = entry.ship.iter().filter_map(|ship| ship.get_ref().model());
    let swarms = entry.swarm.iter().filter_map(SwarmEntry::model);
    let mut known = HashSet::new();
    for model in ships.chain(swarms).chain(entry.prop.iter().filter_map(|prop| prop.get_ref().file())) {
        let length = model.get_ref().len();
        if !(1..=MOST_NAME).contains(&length) {
            return fault(model, format!("the model's name has {length} bytes, allowed 1 to {MOST_NAME}"));
        }
        known.insert(model.get_ref());
        if known.len() > MOST_MODELS {
            return fault(model, format!("up to here the scene names {} models, allowed {MOST_MODELS}", known.len()));
        }
    }
    Ok(())
}

fn check(entry: &SceneFile) -> Result<Scene, Fault> {
    check_models(entry)?;
    let ships = check_ships(&entry.ship, check_swarms(&entry.swarm, entry.ship.len())?)?;
    entry.rules.check(Rules::default())?;
    let planet = entry.planet.as_ref().map(check_planet).transpose()?;
    Ok(Scene {
        name: String::new(),
        camera: entry.camera.as_ref().map_or(Ok(SceneCamera::default()), |camera| check_camera(camera, &ships, planet.as_ref()))?,
        props: check_props(&entry.prop)?,
        planet,
        sky: check_sky(&entry.sky)?,
        disk: None,
        rules: entry.rules.clone(),
        mission: None,
        expect: entry.expect.as_ref().map(|expect| check_expect(expect, entry.mission.is_some())).transpose()?,
        text: "".into(),
        fingerprint: 0,
        foreign: false,
        ships,
    })
}

/// The mission of a file, checked; None for a scene that is none.
fn mission(document: &DeTable<'_>, entry: &SceneFile, ships: &[ShipSpec]) -> Result<Option<Mission>, Vec<Fault>> {
    let Some(mission) = &entry.mission else {
        let parts = entry.goal.first().map(Spanned::span).or(entry.gate.first().map(Spanned::span));
        let message = "[[goal]], [[gate]] and [difficulty] need a [mission]";
        return match parts.or(entry.difficulty.as_ref().map(|_| 0..0)) {
            Some(span) => Err(vec![Fault { span, message: message.into() }]),
            None => Ok(None),
        };
    };
    let levels = levels(document)?;
    check_mission(mission, &entry.goal, &entry.gate, ships, levels).map(Some).map_err(|fault| vec![fault])
}

/// FNV-1a, 64 bits (Fowler, Noll, Vo), of a text.
fn fingerprint(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

/// The keys of `[disk]`, checked by the table of `game.toml`.
fn disk_keys(document: &DeTable<'_>) -> Result<DiskKeys, Vec<Fault>> {
    let Some(DeValue::Table(table)) = document.get("disk").map(Spanned::get_ref) else { return Ok(DiskKeys(Vec::new())) };
    let mut checked = GameConfig::default();
    let faults = config::apply_table(&mut checked, "disk", table);
    config::check_all(&checked, faults, document)?;
    let given = |key: &str| table.iter().any(|(name, _)| name.get_ref() == key);
    Ok(DiskKeys(
        config::settings()
            .iter()
            .filter(|setting| setting.section == "disk" && given(setting.key))
            .map(|setting| (setting.path(), setting.get(&checked)))
            .collect(),
    ))
}

/// Loads a scene by name (`chase`) or by path (anything that ends in `.toml` or holds a separator).
pub fn load(name_or_path: &str) -> Result<Scene, SceneError> {
    let file = file(name_or_path);
    let text = file.read_text(MOST_TEXT).map_err(|fault| match fault {
        FileFault::Nowhere { .. } => not_found(name_or_path, fault.to_string()),
        _ if !file.is_there() => not_found(name_or_path, format!("{} is no file", file.path.display())),
        fault => SceneError::Read { path: file.path.clone(), source: fault.into() },
    })?;
    let scene = Scene::from_toml(&file.path, &text).map_err(SceneError::Invalid)?;
    Ok(Scene { foreign: !game_files::is_own(&file), ..scene })
}

fn not_found(name: &str, tried: String) -> SceneError {
    SceneError::NotFound { name: name.into(), tried, known: [names(), mission_names()].concat().join(", ") }
}

/// The file that a name or path stands for, whether it exists or not.
pub fn file(name_or_path: &str) -> GameFile {
    game_files::named(&[SCENES, MISSIONS], name_or_path)
}

/// The names of the scenes, sorted.
pub fn names() -> Vec<String> {
    game_files::names(SCENES)
}

/// The names of the missions, sorted.
pub fn mission_names() -> Vec<String> {
    game_files::names(MISSIONS)
}

/// Help for an argument that takes a scene: what it is, and the names there are.
pub fn help(what: &str) -> String {
    format!("{what}\n\nScenes: {}\n\nMissions: {}", names().join(", "), mission_names().join(", "))
}
