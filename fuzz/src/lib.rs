//! Fuzzing of every place where Lensrunner reads untrusted input. `fuzz/run TARGET SECONDS` starts it; see docs/untrusted-input.md.

mod limit;
pub mod mutate;
pub mod untrusted_input;
