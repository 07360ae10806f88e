//! Tests of `src/judge/`.

mod oracles;
mod outwards;
mod picture;
mod sight;
mod trace;
mod world;
