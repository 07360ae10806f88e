//! Instruments: what the methods of the game give for the same question, and the charts that set error against time.

pub mod aurora;
pub mod chart;
pub mod disk;
pub mod picture_file;
pub mod plot;
pub mod project;
pub mod projection;
pub mod trace;
