//! Tests of `src/play/` that need no window and no GPU.

mod heard;
mod samples;
mod sound;
