//! Instruments: what the methods of the game give for the same question, and the charts that set error against time.

pub mod aurora;
pub mod bvh;
pub mod chart;
pub mod compare;
pub mod disk;
pub mod flip;
pub mod methods;
pub mod picture_file;
pub mod plot;
pub mod project;
pub mod projection;
pub mod thin_disk;
pub mod trace;
