//! Tests of `src/scene/aurora/`.

mod curve;
mod fall;
mod fang;
mod ground;
mod heights;
mod lines;
mod motion;
mod nodes;
