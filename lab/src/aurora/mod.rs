//! The aurora's walks side by side (Sekiguchi et al.): the 3-D particle method, their linear screen walk, the exact screen walk, and the
//! exact line integral as their judge. All draw the same electrons with the same random numbers.
//!
//! The patch of sky they draw is flat: x east, y north, z up, km, the ground at z = 0; the field is straight and inclined. [`sheet`] says
//! where electrons come down, [`eye`] how a point is projected (flat space, or bent by the lensing table), [`lattice`] how a few
//! projections serve all electrons, [`collisions`] at which levels they shine, [`walk`] how luminous [`points`] come about, [`splat`] how
//! they become a picture, [`pyramid`] the same for less (with the [`shares`] of each pixel), [`truth`] what it should have been, [`tasks`]
//! how threads share it, [`experiment`] what all that took, [`race`] the same on a graphics adapter, [`chart`]
//! the picture of it.

pub mod chart;
pub mod collisions;
pub mod experiment;
pub mod eye;
pub mod lattice;
mod layers;
pub mod points;
pub mod pyramid;
pub mod race;
pub mod shares;
pub mod sheet;
pub mod splat;
pub mod tasks;
pub mod truth;
pub mod walk;
