//! The verdict on the game's picture.

mod collect;
mod displacement;
mod flight;
mod horizon;
mod metrics;
mod narrow;
mod random;
mod sight;
