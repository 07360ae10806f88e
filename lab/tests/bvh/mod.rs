//! Straight rays through trees of boxes: the trees, the rays, and what breaks other tracers.

mod build;
mod rays;
mod robust;
mod validate;
