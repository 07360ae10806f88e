//! Tests of `src/render/disk/`.

mod arcs;
mod rings;
