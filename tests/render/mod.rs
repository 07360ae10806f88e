//! Tests of `src/render/`.

mod aurora;
mod bounds;
mod branches;
mod chords;
mod disk;
mod engines;
mod fallbacks;
mod fragments;
mod lookup;
mod outside;
mod pictures;
mod post_process;
mod ration;
mod shaders;
mod shift;
mod stars;
mod support;
mod swing;
mod trouble;
mod types;
