//! Instruments: what the methods of the game give for the same question, and the charts that set error against time.

pub mod bvh;
pub mod chart;
pub mod plot;
pub mod project;
pub mod projection;
