//! Tests of `src/sim/`.

mod chase;
mod history;
mod missions;
mod simulate;
