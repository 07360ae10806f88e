//! How much of the model a frame is drawn with: [`options`] that each save time and cost accuracy, their measured [`costs`], the [`ladder`]
//! of rungs from the finest picture to the fastest, and the [`governor`] that holds a frame time by moving along it.
//!
//! Errors are mean FLIP (Andersson et al. 2020) against the finest picture of the same size, 0 to 1.

pub mod costs;
pub mod governor;
pub mod ladder;
pub mod options;
