//! A snapshot made into what a renderer needs: the scene, the worldlines up to the frame, its time and camera.

use std::path::Path;

use super::snapshot::{Snapshot, SnapshotError};
use super::{History, Moment};
use crate::scene::model::import::model_file;
use crate::scene::{GameConfig, Scene};

/// A snapshot, flown again.
pub struct Restored {
    /// What it was made from.
    pub snapshot: Snapshot,
    /// The scene, with a ship where it was flown freely.
    pub scene: Scene,
    /// `game.toml`, before the difficulty.
    pub config: GameConfig,
    moment: Moment,
    nobody: History,
}

impl Restored {
    /// Flies the snapshot of the picture `path` up to its frame.
    pub fn of(path: &Path, snapshot: &Snapshot) -> Result<Restored, SnapshotError> {
        let flight = &snapshot.flight;
        let damaged = |problem: String| SnapshotError::Damaged { path: path.to_path_buf(), problem };
        let scene = match &snapshot.scene {
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
        let missing = snapshot.models.iter().map(|model| model_file(model)).find(|model| !model.is_there());
        if let Some(model) = missing {
            return Err(SnapshotError::NoModel { path: path.to_path_buf(), scene: scene.name, model: model.path });
        }
        if let Some(ship) = [snapshot.player, snapshot.hidden, snapshot.lit].into_iter().flatten().find(|ship| *ship >= scene.ships.len()) {
            return Err(damaged(format!("the scene {:?} has no ship number {ship}", scene.name)));
        }
        let config = snapshot.config();
        let moment = Moment::flown(&scene, &scene.config(&config, flight.difficulty), flight, snapshot.player);
        if !flight.hash.is_empty() && flight.hash != moment.hash() {
            return Err(SnapshotError::Differs(path.to_path_buf()));
        }
        Ok(Restored { snapshot: snapshot.clone(), scene, config, moment, nobody: History::nobody() })
    }

    /// `game.toml` as the mission has it on the difficulty of the flight.
    pub fn levelled(&self) -> GameConfig {
        self.scene.config(&self.config, self.snapshot.flight.difficulty)
    }

    /// The worldlines of the ships in scene order, then nobody's in the ghost's place, then those of the bolts. The ghost of an earlier
    /// flight is left out: the picture does not carry that flight.
    pub fn histories(&self) -> Vec<&History> {
        self.moment.histories().into_iter().chain([&self.nobody]).chain(self.moment.bolts()).collect()
    }
}
