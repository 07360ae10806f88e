//! What exists: ships and the rules of the chase, as scene files describe them.

pub mod rules;
pub mod ship;
