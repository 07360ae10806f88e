//! Tests of `src/render/gpu/`.

mod branches;
mod fallbacks;
mod readback;
mod shaders;
mod translate;
mod types;
