//! The voices of the mix. Each has `set`, which tells it what to follow, and `next`, the next sample.

pub mod beacon;
pub mod cues;
pub mod engine;
pub mod music;
pub mod roar;
