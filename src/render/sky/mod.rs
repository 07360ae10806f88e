//! The sky: the Milky Way behind everything, and the stars, both by the one-dimensional table of light from infinity.

mod background;
mod clusters;
mod stars;
pub mod table;

pub use background::{Background, Panorama};
pub use stars::{Stars, onto, seen_layout};
