//! Lensrunner: a chase game in the spacetime of a black hole, and the instrument that proves its picture right.
//!
//! The floors of the house, from the ground up; each knows only those before it (`docs/architecture.md` has the map).

pub mod judge;
pub mod lensing;
pub mod picture_file;
#[cfg(feature = "game")]
pub mod play;
#[cfg(feature = "game")]
pub mod render;
pub mod scene;
pub mod sim;
pub mod spacetime;
