//! Tests of `src/lensing/`.

mod integrator;
mod methods;
mod project;
mod slices;
mod stability;
mod tables;
