//! Lensrunner: a chase game in the spacetime of a black hole, and the instrument that proves its picture right.
//!
//! Seven floors; each knows only those below it (`docs/architecture.md` has the map, `docs/glossary.md` the words):
//!
//! | floor | what to read first |
//! |---|---|
//! | `play` | `play::window::run`: the App that is the game |
//! | `render` | `render::renderer::Renderer`: one frame; `render::plugin`: the same inside Bevy |
//! | [`judge`] | [`judge::case`]: the exact picture of a scene |
//! | [`sim`] | [`sim::SimulationPlugins`]: ships, pilots and rules as ECS systems |
//! | [`scene`] | [`scene::load`]: scene files and `game.toml` |
//! | [`lensing`] | [`lensing::lookup`]: where a point is seen, from the table |
//! | [`spacetime`] | [`spacetime::metric`], then [`spacetime::light`] and [`spacetime::matter`] |
//!
//! Three ways in, each a short program in `examples/`:
//!
//! - `orbit`: a ship's path, from [`spacetime::matter::step`] alone;
//! - `judge`: one exact picture, by [`judge::to_file::trace_to_file`];
//! - `lensed_model`: a glTF model on the screen of an App of one's own. It adds Bevy's `DefaultPlugins` and
//!   `render::plugin::RelativisticRenderPlugin`, makes a `render::stage::Stage` from a scene, and hands on a frame each time. Ships that
//!   fly need [`sim::SimulationPlugins`] too, and [`sim::start`] with a scene.
//!
//! Units are r_s = c = 1 throughout; T is Painlevé–Gullstrand time.

pub mod argument;
pub mod breath;
pub mod game_files;
pub mod judge;
pub mod lensing;
#[cfg(all(target_family = "wasm", feature = "game"))]
pub mod page;
pub mod picture_file;
#[cfg(feature = "game")]
pub mod play;
#[cfg(feature = "game")]
pub mod render;
pub mod scene;
pub mod sim;
pub mod spacetime;
pub mod user_file;
