//! The physics of the aurora, in f64 and without graphics: where electrons come down, how deep they get, and what light they make.
//!
//! The method of Sekiguchi et al. with measured air and cross sections in place of tuned radii. The way of an electron, file by file:
//! [`curve`] (seeds along a Bézier curve with a sine, in the plane across the field; a [`motion::chain`] is several of them) → [`motion`]
//! (charge → [`motion::poisson`], and [`motion::near`] for what is finer → electric field → drift in that plane) → [`dipole`] (down the
//! field line) → [`fall`] (collisions by the density of the [`air`]) → [`lines`] (photons by line, height and delay; their colours).
//! [`curtains`] are the auroras of a planet, and [`quantiles`] the fall and its light as tables for the GPU.
//!
//! Units here are those of the field's tables: heights in km, energies in keV, densities in cm⁻³ and g cm⁻³, times in s.

pub mod air;
pub mod curtains;
pub mod curve;
pub mod dipole;
pub mod fall;
pub mod ground;
pub mod lines;
pub mod motion;
pub mod quantiles;
pub mod random;
