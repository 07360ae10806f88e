//! The verdict on the game's picture.

mod collect;
mod flight;
mod horizon;
mod measure;
mod random;
