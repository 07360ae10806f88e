//! Tests of `src/render/models/`.

mod outside;
