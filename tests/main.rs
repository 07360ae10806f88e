//! All integration tests in one binary (linking is the slow part); the modules mirror `src/`.
mod scene_config;
mod scene_files;
mod sim_chase;
mod sim_simulate;
mod spacetime_matter;
mod scene_models;
mod scene_sky;

mod reference_oracles;
mod reference_trace;
mod light_against_judge;

mod spacetime_light;
mod lensing_integrator;
mod lensing_tables;
