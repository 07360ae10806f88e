//! Tests of `src/render/geometry/`.

mod chords;
