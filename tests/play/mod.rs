//! Tests of `src/play/` that need no window and no GPU.

mod heard;
mod interface;
mod samples;
mod sound;
