//! Instruments: what the methods of the game give for the same question.

pub mod picture_file;
pub mod project;
pub mod trace;
