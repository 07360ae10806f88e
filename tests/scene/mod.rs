//! Tests of `src/scene/`.

mod aurora;
mod config;
mod disk;
mod files;
mod models;
mod sky;
