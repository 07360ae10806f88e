//! Fuzzing of every place where Lensrunner reads what a person hands in. `fuzz/run DOOR SECONDS` starts it; see docs/doors.md.

pub mod doors;
mod limit;
pub mod mutate;
