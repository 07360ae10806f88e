//! Tests of `src/play/` that need no window.

mod heard;
mod interface;
mod overlay;
mod samples;
mod sound;
mod trailer;
