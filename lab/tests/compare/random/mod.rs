//! Scenes that nobody chose.

mod pictures;
mod scenes;
