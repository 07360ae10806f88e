//! The aurora's physics, in f64 and without graphics: where electrons come down, how deep they get, and what light they leave.
//!
//! The method of Sekiguchi et al. (*Fast Simulation and Rendering of Aurora Using Screen Space*) with measured air and cross
//! sections in place of tuned radii. The way of an electron, file by file: [`curve`] (seeds along a Bézier curve with a sine in the plane
//! across the field; a [`chain`] is several of them) → [`motion`] (charge → [`poisson`], and [`near`] what is finer → electric field → drift in that plane) → [`dipole`] (the field line down) →
//! [`fall`] (collisions by the density of the [`air`]) → [`lines`] (photons by line, height and delay; their colours). [`deposition`] is
//! the judge of the fall: the parameterisation of Fang and others (2010). [`curtains`] are the auroras of a planet, and [`quantiles`] the
//! fall and its light as tables for the GPU.
//!
//! Units here are those of the field's tables: heights in km, energies in keV, densities in cm⁻³ and g cm⁻³, times in s.

pub mod air;
pub mod chain;
pub mod curtains;
pub mod curve;
pub mod deposition;
pub mod dipole;
pub mod fall;
pub mod ground;
pub mod lines;
pub mod motion;
pub mod near;
pub mod poisson;
pub mod quantiles;
pub mod random;
