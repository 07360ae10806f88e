//! Tests of `src/judge/`.

pub mod brute;
mod oracles;
mod outwards;
mod picture;
mod seeing;
mod trace;
mod world;
