//! Tests of `src/scene/aurora/`.

mod curtains;
mod fang;
mod ground;
mod heights;
mod lines;
mod nodes;
