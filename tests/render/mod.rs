//! Tests of `src/render/`.

mod allocations;
mod aurora;
mod disk;
mod engines;
mod flashes;
mod geometry;
mod gpu;
mod instances;
mod lookup;
mod models;
mod pictures;
mod post_process;
mod stars;
mod steady;
mod support;
mod trouble;
mod upscale;
