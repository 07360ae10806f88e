//! The race of the projections.

mod chart;
mod methods;
mod shaders;
