//! All integration tests in one binary (linking is the slow part); the folders mirror `src/`.

#[cfg(feature = "game")]
mod gpu;
mod house;
mod judge;
#[cfg(feature = "game")]
mod layout;
mod lensing;
mod package;
#[cfg(feature = "game")]
mod photo;
#[cfg(feature = "game")]
mod play;
mod projector;
#[cfg(feature = "game")]
mod render;
mod scene;
mod sim;
mod spacetime;
mod support;
#[cfg(feature = "game")]
mod twin;
mod untrusted_input;
#[cfg(feature = "game")]
mod window;
#[cfg(feature = "game")]
mod words;
