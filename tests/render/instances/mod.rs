//! Tests of `src/render/instances/`.

mod bounds;
mod hostile;
mod local_motion;
