//! What is played: a scene, the configuration and where it came from, a seed.

use std::path::{Path, PathBuf};

use bevy::prelude::Resource;
use thiserror::Error;

use crate::play::words::Language;
use crate::scene::config::Assignment;
use crate::scene::ship::Ai;
use crate::scene::{self, ConfigError, Difficulty, GameConfig, Scene, SceneError};

/// The scene where none is named.
pub const SCENE: &str = "chase";

/// Why nothing can be played: all of it is wrong input.
#[derive(Debug, Error)]
pub enum SessionError {
    /// The scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// `game.toml` is wrong.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// There is nobody to fly.
    #[error("scene {0}: the game needs at least one [[ship]] beside a planet; `shot` draws the scene without")]
    NoShip(String),
}

/// A scene, its configuration, a seed.
#[derive(Resource, Clone, Debug)]
pub struct Session {
    /// What exists.
    pub scene: Scene,
    /// Every tunable number.
    pub config: GameConfig,
    /// The file it was read from, if any.
    pub config_file: Option<PathBuf>,
    /// For everything left to chance.
    pub seed: u64,
    /// The seed was asked for: it stays. Otherwise each flight has the next.
    pub seed_stays: bool,
    /// Of a mission.
    pub difficulty: Difficulty,
    /// What the command line sets: it goes before the player's choices and the file.
    pub set: Vec<Assignment>,
}

impl Session {
    /// Reads configuration and scene. Without a named configuration, `game.toml` is read where there is one.
    pub fn load(config: Option<&Path>, scene: Option<&str>, seed: Option<u64>) -> Result<Session, SessionError> {
        let config_file = scene::config::file(config);
        let config = config_file.as_deref().map(scene::config::load).transpose()?.unwrap_or_default();
        let scene = scene::load(scene.unwrap_or(SCENE))?.with_a_ship();
        if scene.ships.is_empty() {
            return Err(SessionError::NoShip(scene.name));
        }
        Ok(Session {
            scene,
            config,
            config_file,
            seed: seed.unwrap_or(0),
            seed_stays: seed.is_some(),
            difficulty: Difficulty::default(),
            set: Vec::new(),
        })
    }

    /// Puts what the command line sets over the configuration.
    pub fn put_set(&mut self) {
        self.set.iter().for_each(|one| one.apply(&mut self.config));
    }

    /// The language of all words.
    pub fn language(&self) -> Language {
        Language::of(&self.config.interface.language)
    }

    /// The configuration as the mission has it on the chosen difficulty.
    pub fn effective(&self) -> GameConfig {
        self.scene.config(&self.config, self.difficulty)
    }

    /// Index of the ship that the player flies: the one marked so, else the first.
    pub fn player(&self) -> usize {
        self.scene.ships.iter().position(|ship| ship.player).unwrap_or(0)
    }

    /// A ship's length, in r_s.
    pub fn length(&self, ship: usize) -> f64 {
        if self.scene.ships[ship].ai == Ai::Flee { self.config.enemy.size } else { self.config.ship.size }
    }

    /// Index of the ship that the player is after: the one its entry names, else the first other; None for a lone ship.
    pub fn target(&self) -> Option<usize> {
        let player = self.player();
        let named = self.scene.ships[player].target.as_ref();
        let ships = &self.scene.ships;
        named.and_then(|name| ships.iter().position(|ship| &ship.name == name)).or_else(|| (0..ships.len()).find(|&other| other != player))
    }
}
