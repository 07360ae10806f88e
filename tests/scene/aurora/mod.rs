//! Tests of `src/scene/aurora/`.

mod curtains;
mod ground;
mod heights;
mod lines;
mod nodes;
