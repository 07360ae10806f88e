//! All that is needed to make a picture of a flight again, as plain data, and its text, which a picture carries in itself.
//!
//! The text is TOML. The flight in it is a whole replay with a checksum of its own; numbers are written so that they come back to the same
//! bits. What is read is checked: unknown keys, numbers out of range and other versions are errors.

use std::path::{Path, PathBuf};

use bevy::prelude::World;
use glam::{DQuat, DVec3};
use serde::Deserialize;

use super::replay::{Replay, ReplayError, settings, settings_text, with_settings};
use super::ship::Player;
use super::{Fleet, Moment};
use crate::scene::config::{self, Value};
use crate::scene::model::import::model_file;
use crate::scene::{GameConfig, Scene};
use crate::spacetime::Observer;
use crate::user_file::{brief, short};

/// The version of the format.
const FORMAT: u32 = 1;
/// The sections of `game.toml` that a picture depends on beyond its flight.
const SECTIONS: [&str; 5] = ["hole", "render", "sky", "disk", "aurora"];
/// The one key of another section.
const FIELD_OF_VIEW: &str = "video.fov";
/// The latest T, in r_s/c: as of `--at`.
const LATEST: f64 = 1e5;
/// The nearest and the farthest camera, in r_s: a ship ends at 0.01, and scenes put ships up to 1e6 away.
const RADII: (f64, f64) = (1e-3, 1e7);
/// The greatest momentum per mass of a camera, in c: ships start with 1e6 at most.
const MOST_MOMENTUM: f64 = 1e7;
/// Least and greatest field of view, in radians: 1 and 170 degrees, as in a scene file.
const FIELDS_OF_VIEW: (f64, f64) = (0.017, 2.97);
/// The longest side of a picture, in pixels.
const LONGEST: u32 = 16384;

/// The camera of a frame, and what it does to the ships.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameCamera {
    /// Who looks.
    pub camera: Observer,
    /// The ship that is not drawn: the cockpit's own.
    pub hidden: Option<usize>,
    /// The ship that is lit so that it is seen.
    pub lit: Option<usize>,
}

/// One frame of a flight.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// The flight up to the step at or after `time`.
    pub flight: Replay,
    /// The ship that the player flies, by its number in the scene; None if the player flies none.
    pub player: Option<usize>,
    /// T of the frame, in r_s/c: at the flight's last step or between that and the one before.
    pub time: f64,
    /// From where it is seen.
    pub shot: FrameCamera,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// What of `game.toml` the picture depends on beyond the flight, where it is not the default: dotted keys and values.
    pub settings: Vec<(String, Value)>,
    /// The whole text of a scene that does not come with the game.
    pub scene: Option<String>,
    /// The model files that such a scene is made of.
    pub models: Vec<String>,
}

/// The number of the step at or after T = `time` (r_s/c); a quotient is rounded, by less than 1e-12 of it.
pub fn step_after(time: f64, step: f64) -> f64 {
    (time / step * (1.0 - 1e-12)).ceil()
}

/// Why a picture cannot be made again.
#[derive(Debug, thiserror::Error)]
pub enum SnapshotError {
    /// What it carries is damaged or of another version.
    #[error("{}: {problem}", path.display())]
    Damaged {
        /// The picture.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// Its flight cannot be flown.
    #[error(transparent)]
    Flight(#[from] ReplayError),
    /// A model of its scene is not there.
    #[error("{}: the scene {scene:?} needs the model {}, which is not there", path.display(), brief(&model.to_string_lossy()))]
    NoModel {
        /// The picture.
        path: PathBuf,
        /// The scene's name.
        scene: String,
        /// The model's file.
        model: PathBuf,
    },
    /// Flown again it comes elsewhere.
    #[error("{}: flown again, the flight comes elsewhere: this program or machine is not like the one that made the picture", .0.display())]
    Differs(PathBuf),
}

#[derive(Deserialize)]
struct Head {
    snapshot: u32,
    version: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SnapshotFile {
    #[serde(rename = "snapshot")]
    _snapshot: u32,
    #[serde(rename = "version")]
    _version: String,
    time: f64,
    size: [u32; 2],
    player: Option<usize>,
    hidden: Option<usize>,
    lit: Option<usize>,
    camera: CameraFile,
    settings: toml::Table,
    #[serde(default)]
    models: Vec<String>,
    scene: Option<String>,
    flight: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CameraFile {
    position: [f64; 3],
    momentum: [f64; 3],
    attitude: [f64; 4],
    field_of_view: f64,
}

impl Snapshot {
    /// Of the frame at T = `time` in `world`, after the `flight` up to the step at or after it. `config` is `game.toml` before the
    /// difficulty.
    pub fn new(
        flight: Replay,
        scene: &Scene,
        config: &GameConfig,
        world: &World,
        time: f64,
        shot: FrameCamera,
        size: [u32; 2],
    ) -> Snapshot {
        let matters = |section: &str, path: &str| SECTIONS.contains(&section) || path == FIELD_OF_VIEW;
        let usual = GameConfig::default();
        let settings = config::settings().iter().filter(|setting| matters(setting.section, &setting.path()));
        let own = Some(scene).filter(|scene| scene.foreign);
        Snapshot {
            flight,
            player: world.get_resource::<Fleet>().and_then(|fleet| fleet.0.iter().position(|&ship| world.get::<Player>(ship).is_some())),
            time,
            shot,
            size,
            settings: settings
                .map(|setting| (setting.path(), setting.get(config), setting.get(&usual)))
                .filter(|(_, value, usual)| value != usual)
                .map(|(path, value, _)| (path, value))
                .collect(),
            scene: own.map(|scene| scene.text.to_string()),
            models: own.map(Scene::model_files).unwrap_or_default(),
        }
    }

    /// The same frame in a picture of another size.
    pub fn resized(&self, size: [u32; 2]) -> Snapshot {
        Snapshot { size, ..self.clone() }
    }

    /// `game.toml` as it was when the picture was made, before the difficulty; what neither picture nor flight depends on is the default.
    pub fn config(&self) -> GameConfig {
        with_settings(self.flight.config(&GameConfig::default()), &self.settings)
    }

    /// The same as the mission of `scene` has it on the difficulty of the flight.
    pub fn levelled(&self, scene: &Scene) -> GameConfig {
        scene.config(&self.config(), self.flight.difficulty)
    }

    /// Flies it again up to its frame: its scene, with a ship where it was flown freely, and the worldlines. `path` is the picture that it
    /// came from. The ghost of an earlier flight is left out: the picture does not carry that flight.
    pub fn fly(&self, path: &Path) -> Result<Moment, SnapshotError> {
        let flight = &self.flight;
        let damaged = |problem: String| SnapshotError::Damaged { path: path.to_path_buf(), problem };
        let scene = match &self.scene {
            Some(text) => {
                let name = format!("{}.toml", flight.scene);
                let mut scene =
                    Scene::from_toml(Path::new(&name), text).map_err(|wrong| damaged(format!("the scene that it carries: {wrong}")))?;
                if scene.fingerprint != flight.fingerprint {
                    return Err(damaged("the scene that it carries is not the one of its flight".into()));
                }
                scene.foreign = true;
                scene
            }
            None => flight.scene(path, None)?,
        };
        let scene = scene.with_a_ship();
        let missing = self.models.iter().map(|model| model_file(model)).find(|model| !model.is_there());
        if let Some(model) = missing {
            return Err(SnapshotError::NoModel { path: path.to_path_buf(), scene: scene.name, model: model.path });
        }
        let named = [self.player, self.shot.hidden, self.shot.lit];
        if let Some(ship) = named.into_iter().flatten().find(|ship| *ship >= scene.ships.len()) {
            return Err(damaged(format!("the scene {:?} has no ship number {ship}", scene.name)));
        }
        let moment = Moment::flown(&scene, &self.levelled(&scene), flight, self.player);
        if !flight.hash.is_empty() && flight.hash != moment.hash() {
            return Err(SnapshotError::Differs(path.to_path_buf()));
        }
        Ok(moment)
    }

    /// Its text.
    pub fn to_text(&self) -> String {
        let number = |x: f64| toml::Value::Float(x).to_string();
        let numbers = |all: &[f64]| all.iter().map(|x| number(*x)).collect::<Vec<_>>().join(", ");
        let quoted = |word: &str| toml::Value::String(word.to_owned()).to_string();
        let [width, height] = self.size;
        let FrameCamera { camera, hidden, lit } = &self.shot;
        let mut text = format!(
            "snapshot = {FORMAT}\nversion = {}\ntime = {}\nsize = [{width}, {height}]\n",
            quoted(env!("CARGO_PKG_VERSION")),
            number(self.time)
        );
        for (key, ship) in [("player", self.player), ("hidden", *hidden), ("lit", *lit)] {
            text += &ship.map_or(String::new(), |ship| format!("{key} = {ship}\n"));
        }
        text += &format!(
            "camera = {{ position = [{}], momentum = [{}], attitude = [{}], field_of_view = {} }}\nsettings = {}\n",
            numbers(&camera.position.to_array()),
            numbers(&camera.momentum.to_array()),
            numbers(&camera.attitude.to_array()),
            number(camera.field_of_view),
            settings_text(&self.settings),
        );
        if let Some(scene) = &self.scene {
            let models: Vec<String> = self.models.iter().map(|model| quoted(model)).collect();
            text += &format!("models = [{}]\nscene = {}\n", models.join(", "), quoted(scene));
        }
        text + &format!("flight = {}\n", quoted(&self.flight.to_text()))
    }

    /// Reads its text; `path` is the picture that it came from, which complaints name.
    pub fn from_text(path: &Path, text: &str) -> Result<Snapshot, SnapshotError> {
        let damaged = |problem: String| SnapshotError::Damaged { path: path.to_path_buf(), problem };
        let no_text = || damaged("what it carries of its flight is damaged".into());
        let head: Head = toml::from_str(text).map_err(|_| no_text())?;
        let version = env!("CARGO_PKG_VERSION");
        if head.snapshot != FORMAT || head.version != version {
            let made = format!("it was made by version {} (format {}), this is {version} ({FORMAT})", short(&head.version), head.snapshot);
            return Err(damaged(made));
        }
        let file: SnapshotFile = toml::from_str(text).map_err(|error| {
            let named = error.message().starts_with("unknown field") || error.message().starts_with("missing field");
            if named { damaged(brief(&format!("what it carries of its flight: {}", error.message()))) } else { no_text() }
        })?;
        let settings = settings(file.settings).map_err(|wrong| damaged(brief(&wrong)))?;
        let is_ours = |path: &str| path == FIELD_OF_VIEW || path.split_once('.').is_some_and(|(section, _)| SECTIONS.contains(&section));
        if let Some((path, _)) = settings.iter().find(|(path, _)| !is_ours(path)) {
            return Err(damaged(format!("{path} is no setting of a picture")));
        }
        let camera = Observer {
            position: DVec3::from_array(file.camera.position),
            momentum: DVec3::from_array(file.camera.momentum),
            attitude: DQuat::from_array(file.camera.attitude),
            field_of_view: file.camera.field_of_view,
        };
        let snapshot = Snapshot {
            flight: Replay::from_text(path, &file.flight)?,
            player: file.player,
            time: file.time,
            shot: FrameCamera { camera, hidden: file.hidden, lit: file.lit },
            size: file.size,
            settings,
            scene: file.scene,
            models: file.models,
        };
        snapshot.fault().map_or(Ok(snapshot), |problem| Err(damaged(problem)))
    }

    /// What is wrong with its numbers, if anything is.
    fn fault(&self) -> Option<String> {
        let Snapshot { time, shot: FrameCamera { camera, .. }, size, flight, .. } = self;
        let out = |what: &str, value: &dyn std::fmt::Debug, allowed: String| Some(format!("its {what}, {value:?}, must be {allowed}"));
        let config = self.config();
        // Not negated comparisons: what is not a number is in no range.
        if !(0.0..=LATEST).contains(time) {
            return out("time", time, format!("from 0 to {LATEST} r_s/c"));
        }
        let steps = step_after(*time, config.clock.step);
        // A frame may be at the step before the last.
        if !(steps..=steps + 1.0).contains(&(flight.ticks as f64)) {
            return out("number of steps", &flight.ticks, format!("that of its time, {steps}"));
        }
        if flight.records.iter().any(|record| record.tick >= flight.ticks) {
            return Some("its flight goes on after its last step".into());
        }
        let (radius, momentum) = (camera.position.length(), camera.momentum.length());
        if !(RADII.0..=RADII.1).contains(&radius) {
            return out("camera's radius", &radius, format!("from {} to {:e} r_s", RADII.0, RADII.1));
        }
        if !(0.0..=MOST_MOMENTUM).contains(&momentum) {
            return out("camera's momentum", &momentum, format!("up to {MOST_MOMENTUM:e} c"));
        }
        // A product of unit quaternions is one within a few ulp.
        if !(-1e-9..=1e-9).contains(&(camera.attitude.length() - 1.0)) {
            return out("camera's attitude", &camera.attitude.to_array(), "a unit quaternion".into());
        }
        if !(FIELDS_OF_VIEW.0..=FIELDS_OF_VIEW.1).contains(&camera.field_of_view) {
            return out("field of view", &camera.field_of_view, format!("from {} to {} radians", FIELDS_OF_VIEW.0, FIELDS_OF_VIEW.1));
        }
        if !size.iter().all(|side| (1..=LONGEST).contains(side)) {
            return out("size", size, format!("from 1 to {LONGEST} pixels"));
        }
        // A name, not a path into the reader's files.
        if flight.scene.contains(['/', '\\']) || flight.scene.ends_with(".toml") {
            return out("scene", &short(&flight.scene), "a name".into());
        }
        config::check(&config).err()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;
    use crate::scene::mission::Difficulty;
    use crate::scene::pilot_kind::PilotKind;
    use crate::sim::player_commands::PlayerCommands;
    use crate::sim::replay::Record;

    /// A frame with numbers that no decimal fraction is.
    fn snapshot() -> Snapshot {
        let mut scene = scene::load("02-first-pursuit").expect("a mission of the game");
        scene.foreign = true;
        let mut config = GameConfig::default();
        (config.render.orders, config.sky.star_size, config.video.fov) = (3, 0.1 + 0.7, 47.3);
        config.controls.mouse_sensitivity = 0.003;
        let mut flight = Replay::begin(&scene, &config, Difficulty::Hard, PilotKind::Apprentice, 7);
        flight.records = (0..9)
            .map(|k| Record { tick: 3 * k, commands: PlayerCommands { thrust: [0, -3, k as i8], ..PlayerCommands::default() } })
            .collect();
        let camera = Observer {
            position: DVec3::new(0.1, -1.0 / 3.0, 1e-17) * 30.0,
            momentum: DVec3::new(-0.0, 2.0 / 3.0, f64::EPSILON),
            attitude: DQuat::from_scaled_axis(DVec3::new(0.1, 0.7, -2.0)),
            field_of_view: 47.3f64.to_radians(),
        };
        let (world, shot) = (World::new(), FrameCamera { camera, hidden: Some(0), lit: None });
        Snapshot::new(flight.up_to(21, &world), &scene, &config, &world, 20.4 / 32.0, shot, [641, 359])
    }

    #[test]
    fn a_text_gives_the_snapshot_back() {
        let before = snapshot();
        assert_eq!((before.flight.ticks, before.flight.records.len()), (21, 7), "up to the step after the frame");
        let keys: Vec<&str> = before.settings.iter().map(|(path, _)| path.as_str()).collect();
        assert_eq!(keys, ["render.orders", "sky.star_size", "video.fov"], "what differs and matters");
        assert!(before.scene.as_ref().is_some_and(|text| text.contains("[mission]")) && !before.models.is_empty());
        let text = before.to_text();
        let after = Snapshot::from_text(Path::new("x.png"), &text).expect("a snapshot");
        assert_eq!(after, before);
        // Equal numbers may have other bits: −0.
        assert_eq!(after.shot.camera.momentum.x.to_bits(), before.shot.camera.momentum.x.to_bits());
        assert_eq!(after.to_text(), text);
    }

    #[test]
    fn a_damaged_or_foreign_text_is_refused_in_a_sentence() {
        let good = snapshot().to_text();
        let with = |from: &str, to: &str| {
            assert!(good.contains(from), "{from}");
            good.replacen(from, to, 1)
        };
        let camera = snapshot().shot.camera;
        let [x, turn, fov] = [camera.position.x, camera.attitude.x, camera.field_of_view].map(|x| toml::Value::Float(x).to_string());
        let wrong = [
            (String::new(), "damaged"),
            (good[..good.floor_char_boundary(good.len() / 2)].to_owned(), "damaged"),
            (with("snapshot = 1", "snapshot = 2"), "format 2"),
            (with("version = \"", "version = \"9"), "version 9"),
            (with("time = ", "colour = 1\ntime = "), "unknown field `colour`"),
            (with("time = 0.6375", "time = nan"), "time"),
            (with("time = 0.6375", "time = -0.1"), "time"),
            (with("time = 0.6375", "time = 0.7"), "steps"),
            (with("time = 0.6375", "time = 1e300"), "time"),
            (with("size = [641, 359]", "size = [641, 0]"), "size"),
            (with(&format!("position = [{x}"), "position = [inf"), "radius"),
            (with("momentum = [-0.0", "momentum = [nan"), "momentum"),
            (with(&format!("attitude = [{turn}"), "attitude = [2.0"), "attitude"),
            (with(&format!("field_of_view = {fov}"), "field_of_view = 3.2"), "field of view"),
            (with("\"render.orders\" = 3", "\"render.orders\" = 4"), "render.orders"),
            (with("\"render.orders\" = 3", "\"ship.fuel\" = 3"), "ship.fuel"),
            (with("\"render.orders\" = 3", "\"disk.inner\" = 20.0"), "disk.inner"),
            (with("seed = 7", "seed = 8"), "checksum"),
        ];
        for (text, told) in &wrong {
            let said = Snapshot::from_text(Path::new("a.png"), text).expect_err(told).to_string();
            assert!(said.starts_with("a.png: ") && said.contains(told) && !said.contains('\n'), "{told}: {said}");
        }
    }
}
