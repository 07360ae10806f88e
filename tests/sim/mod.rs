//! Tests of `src/sim/`.

pub mod chase;
mod history;
mod missions;
mod simulate;
mod turning;
