//! Tests of `src/render/aurora/`.

mod chords;
mod ground;
mod history;
mod pictures;
mod ration;
mod shaders;
mod shift;
mod sight;
