//! The aurora's walks side by side (Sekiguchi et al.): the 3-D particle method, their linear screen walk, the exact screen walk, and the
//! exact line integral as their judge. All draw the same electrons with the same random numbers.
//!
//! The patch of sky they draw is flat: x east, y north, z up, km, the ground at z = 0; the field is straight and inclined.
//!
//! - [`sheet`]: where electrons come down; [`eye`]: how a point is projected (flat space, or bent by the lensing table).
//! - [`walk`]: from electrons to luminous points, by the chords of a [`lattice`] where light is bent; [`splat`]: from points to a picture.
//! - [`truth`]: what the picture should be; [`experiment`]: what all that took; [`chart`]: the picture of it.

pub mod chart;
pub mod experiment;
pub mod eye;
pub mod lattice;
pub mod sheet;
pub mod splat;
pub mod truth;
pub mod walk;
