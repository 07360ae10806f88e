//! Tests of `src/render/instances/`.

mod bounds;
mod held;
mod hostile;
mod local_motion;
