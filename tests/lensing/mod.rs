//! Tests of `src/lensing/`.

mod integrator;
mod methods;
mod project;
#[cfg(feature = "game")]
mod slices;
mod stability;
mod tables;
