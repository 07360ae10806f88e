//! The spacetime of the hole in pure f64: metric, light, matter, frames.

pub mod frames;
pub mod light;
pub mod matter;
pub mod metric;
pub mod observer;
pub mod orbit;
pub mod tableau;

pub use observer::Observer;
