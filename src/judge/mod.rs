//! The judge of light: null geodesics integrated step by step in f64, sharing no code with the closed form of
//! `spacetime::light` nor with the tables of `lensing`.
//!
//! - [`geodesic`]: one step of the equations of motion, a Taylor series with error control that is its own dense output.
//! - `taylor`, `segments`: its coefficients, and steps of several rays side by side.
//! - [`ray`]: the light that reaches a camera from one look direction, followed back until it escapes or is captured.
//! - [`mod@shoot`]: the look direction at which a given point is seen (boundary value).
//! - [`trace`]: a camera, and where a ray meets what it shows.
//! - [`picture`]: whole pictures of a scene, with a tree.
//! - [`case`]: the world that the judge sees of a simulated scene. The one file here that knows `sim`.
//! - [`to_file`]: `lensrunner trace`.
//! - [`bvh`]: trees of boxes over what a scene holds.
//!
//! Units r_s = c = 1, Painlevé–Gullstrand time and rain-frame momenta throughout.

pub mod bvh;
pub mod case;
pub mod geodesic;
pub mod picture;
pub mod ray;
mod segments;
pub mod shoot;
mod taylor;
pub mod to_file;
pub mod trace;

pub use ray::{End, RayFate, RaySample, Stop, TracedRay, fate};
pub use shoot::{EnergySign, Sighting, shoot, shoot_sky};
