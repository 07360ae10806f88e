//! Tests of `src/render/gpu/`.

mod branches;
mod fallbacks;
mod shaders;
mod translate;
mod types;
