//! Tests of `src/sim/`.

pub mod chase;
mod guidance;
mod history;
mod missions;
mod simulate;
mod turning;
