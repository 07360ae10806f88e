//! Tests of `src/judge/`.

mod oracles;
mod outwards;
mod picture;
mod trace;
mod world;
