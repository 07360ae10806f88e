//! Tests of `src/spacetime/`.

mod light;
mod light_against_judge;
mod matter;
pub mod oracles;
