//! The experiment's drawing on the processor: walks, and pyramids of splats.

mod pyramid;
mod walk;
