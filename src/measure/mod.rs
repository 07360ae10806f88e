//! Instruments: what the methods of the game give for the same question.

pub mod project;
