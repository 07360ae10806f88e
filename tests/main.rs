//! All integration tests in one binary (linking is the slow part); the modules mirror `src/`.
mod scene_config;
mod scene_files;

mod reference_oracles;
mod reference_trace;
mod light_against_judge;

mod lensing_integrator;
mod lensing_tables;
