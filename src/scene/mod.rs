//! What exists: scene files and `game.toml`, models, stars, Milky Way, black-body colours.
//!
//! [`load`] reads a scene by name or path; [`Scene::assemble`] makes its models; [`config::load`] reads `game.toml`.

pub mod assembly;
pub mod assets;
pub mod aurora;
pub mod blackbody;
pub mod camera;
pub mod config;
mod config_fields;
pub mod disk;
mod document;
pub mod error;
pub mod fault;
pub mod import;
pub mod lighting;
mod load;
pub mod milky_way;
pub mod model;
pub mod planet;
pub mod prop;
pub mod rules;
mod setting;
pub mod shapes;
pub mod ship;
pub mod stars;
pub mod texture;
pub mod viewpoint;

pub use assembly::{Assembly, Body, Object};
pub use assets::assets_folder;
pub use camera::{Mount, SceneCamera, picture_size};
pub use config::GameConfig;
pub use config_fields::METHODS;
pub use error::{Complaint, Complaints, ConfigError, SceneError};
pub use load::{Scene, help, load, names, path};
pub use model::{Image, Material, Model, Vertex};
pub use planet::{Planet, SkySwitches};
pub use prop::Prop;
pub use rules::Rules;
pub use ship::ShipSpec;
