//! What differs between two pictures.

mod displacement;
mod metrics;
mod narrow;
mod sight;
