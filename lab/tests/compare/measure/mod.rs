//! What differs between two pictures.

mod displacement;
mod light;
mod metrics;
mod narrow;
mod sight;
