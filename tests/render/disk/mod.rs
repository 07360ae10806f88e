//! Tests of `src/render/disk/`.

mod arcs;
mod fragments;
mod rings;
