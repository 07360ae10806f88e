//! What differs between a renderer's picture and the judge's.
//!
//! - [`metrics`]: displacement between the same surface points, coverage, wrong orders, holes, light in the dark.
//! - [`displacement`]: where the judge sees the surface point that the contestant shows at a pixel.
//! - [`probe`]: what the judge sees between the pixels; [`sight`]: where it sees a point, hidden or not.
//! - [`narrow`]: images a few pixels wide, seen with more rays.
//! - [`area`]: how large each image is; [`light`]: how bright; `grid`: the rays of a pixel; `drawn`: how images are drawn.

pub mod area;
pub mod displacement;
mod drawn;
mod grid;
pub mod light;
pub mod metrics;
pub mod narrow;
pub mod probe;
pub mod sight;
