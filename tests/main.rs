//! All integration tests in one binary (linking is the slow part); the modules mirror `src/`.

#[cfg(feature = "game")]
mod gpu;
mod house;
mod judge_oracles;
mod judge_outwards;
mod judge_picture;
mod judge_trace;
mod judge_world;
mod lensing_integrator;
mod lensing_methods;
mod lensing_project;
mod lensing_slices;
mod lensing_stability;
mod lensing_tables;
mod light_against_judge;
#[cfg(feature = "game")]
mod render_aurora_chords;
#[cfg(feature = "game")]
mod render_aurora_ground;
#[cfg(feature = "game")]
mod render_aurora_history;
#[cfg(feature = "game")]
mod render_aurora_pictures;
#[cfg(feature = "game")]
mod render_aurora_sight;
#[cfg(feature = "game")]
mod render_bounds;
#[cfg(feature = "game")]
mod render_branches;
#[cfg(feature = "game")]
mod render_chords;
#[cfg(feature = "game")]
mod render_disk;
#[cfg(feature = "game")]
mod render_disk_rings;
#[cfg(feature = "game")]
mod render_engines;
#[cfg(feature = "game")]
mod render_fallbacks;
#[cfg(feature = "game")]
mod render_fragments;
#[cfg(feature = "game")]
mod render_lookup;
#[cfg(feature = "game")]
mod render_outside;
#[cfg(feature = "game")]
mod render_pictures;
#[cfg(feature = "game")]
mod render_post_process;
#[cfg(feature = "game")]
mod render_ration;
#[cfg(feature = "game")]
mod render_shaders;
#[cfg(feature = "game")]
mod render_shift;
#[cfg(feature = "game")]
mod render_stars;
#[cfg(feature = "game")]
mod render_support;
#[cfg(feature = "game")]
mod render_swing;
#[cfg(feature = "game")]
mod render_trouble;
#[cfg(feature = "game")]
mod render_types;
mod scene_aurora;
mod scene_aurora_ground;
mod scene_aurora_heights;
mod scene_aurora_lines;
mod scene_aurora_nodes;
mod scene_config;
mod scene_disk;
mod scene_files;
mod scene_models;
mod scene_sky;
mod sim_chase;
mod sim_history;
mod sim_simulate;
mod spacetime_light;
mod spacetime_matter;
mod support;
#[cfg(feature = "game")]
mod twin;
