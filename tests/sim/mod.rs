//! Tests of `src/sim/`.

mod chase;
mod history;
mod simulate;
