//! Places where no other method is set beside ours, from `held.toml`.

use serde::Deserialize;

/// One place.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Held {
    /// What part of the game.
    pub part: String,
    /// Where.
    pub place: String,
    /// What must hold.
    pub must: String,
    /// The file of the test, from the root of the project, and its name.
    pub test: [String; 2],
    /// The file of a fault that it finds, put in on purpose, from the root of the project.
    pub file: String,
    /// What stands there, once,
    pub right: String,
    /// and what is put there.
    pub wrong: String,
}

#[derive(Deserialize)]
struct Table {
    held: Vec<Held>,
}

/// All of them.
pub fn held() -> Result<Vec<Held>, toml::de::Error> {
    toml::from_str(include_str!("held.toml")).map(|table: Table| table.held)
}
