//! The disk measured: an exact picture of the gas, and how far a drawn one is from it.

pub mod bench;
pub mod chart;
mod chase;
mod draw;
pub mod error;
pub mod exact;
pub mod flight;
pub mod places;
pub mod request;
pub mod script;

pub use error::{DiskPictureError, compare, peak};
pub use exact::{part, picture};
