//! Instruments: what the methods of the game give for the same question.

pub mod aurora;
pub mod project;
