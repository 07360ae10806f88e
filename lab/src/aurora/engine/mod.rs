//! The experiment's own drawing on the processor, with vector instructions: streaks to points, points to pictures.
//!
//! - [`tasks`]: streaks shared among threads; [`walk`]: electrons down a streak, by [`collisions`].
//! - [`lattice`]: streaks by a lattice of directions; [`points`]: where they give light.
//! - [`splat`]: a point as a Gaussian; [`pyramid`], [`layers`], [`shares`]: all of them, in pictures of halved size.
//! - [`draw`](mod@draw): all of that for one picture, on one thread or on all.

pub mod collisions;
pub mod draw;
pub mod lattice;
pub mod layers;
pub mod points;
pub mod pyramid;
pub mod shares;
pub mod splat;
pub mod tasks;
pub mod walk;
