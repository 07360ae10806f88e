//! What exists: scene files and `game.toml`, models, stars, Milky Way, black-body colours.
//!
//! [`load`] reads a scene by name or path; [`Scene::assemble`] makes its models; [`config::load`] reads `game.toml`. `document` is what
//! both files have in common: TOML, and what can be wrong with it.

pub mod assembly;
pub mod aurora;
pub mod blackbody;
pub mod camera;
pub mod config;
pub mod disk;
pub mod document;
pub mod expect;
mod free_flight;
pub mod lighting;
mod load;
pub mod mission;
pub mod model;
pub mod pilot_kind;
pub mod planet;
pub mod prop;
pub mod rules;
pub mod ship;
pub mod sky;
pub mod swarm;

pub use assembly::{Assembly, Body, Object};
pub use camera::{Mount, SceneCamera, picture_size};
pub use config::GameConfig;
pub use document::error::{Complaint, Complaints, ConfigError, SceneError};
pub use load::{Scene, file, help, load, mission_names, names};
pub use mission::{Difficulty, Mission};
pub use model::{Image, Material, Model, Vertex};
pub use planet::{Planet, SkySwitches};
pub use prop::Prop;
pub use rules::Rules;
pub use ship::ShipSpec;
