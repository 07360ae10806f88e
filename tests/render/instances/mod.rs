//! Tests of `src/render/instances/`.

mod bounds;
mod swing;
