//! All integration tests in one binary (linking is the slow part); the modules mirror `src/`.

mod house;
mod lensing_integrator;
mod lensing_methods;
mod lensing_slices;
mod lensing_stability;
mod lensing_tables;
mod light_against_judge;
mod measure_aurora;
mod measure_aurora_pyramid;
mod measure_charts;
mod measure_compare;
mod measure_displacement;
mod measure_flight;
mod measure_narrow;
mod measure_project;
mod measure_projection;
mod measure_published;
mod measure_random;
mod measure_thin_disk;
mod measure_verdicts;
mod reference_bvh_build;
mod reference_bvh_rays;
mod reference_bvh_robust;
mod reference_judge;
mod reference_oracles;
mod reference_outwards;
mod reference_picture;
mod reference_trace;
#[cfg(feature = "game")]
mod render_aurora;
#[cfg(feature = "game")]
mod render_aurora_chords;
#[cfg(feature = "game")]
mod render_aurora_ground;
#[cfg(feature = "game")]
mod render_aurora_pictures;
#[cfg(feature = "game")]
mod render_aurora_rows;
#[cfg(feature = "game")]
mod render_aurora_sight;
#[cfg(feature = "game")]
mod render_bounds;
#[cfg(feature = "game")]
mod render_branches;
#[cfg(feature = "game")]
mod render_chords;
#[cfg(feature = "game")]
mod render_contestant;
#[cfg(feature = "game")]
mod render_develop;
#[cfg(feature = "game")]
mod render_disk;
#[cfg(feature = "game")]
mod render_disk_near;
#[cfg(feature = "game")]
mod render_disk_order;
#[cfg(feature = "game")]
mod render_disk_pictures;
#[cfg(feature = "game")]
mod render_disk_rings;
#[cfg(feature = "game")]
mod render_disk_thin;
#[cfg(feature = "game")]
mod render_engines;
#[cfg(feature = "game")]
mod render_fallbacks;
#[cfg(feature = "game")]
mod render_fragments;
#[cfg(feature = "game")]
mod render_horizon;
#[cfg(feature = "game")]
mod render_lookup;
#[cfg(feature = "game")]
mod render_methods;
#[cfg(feature = "game")]
mod render_outside;
#[cfg(feature = "game")]
mod render_pictures;
#[cfg(feature = "game")]
mod render_polygons;
#[cfg(feature = "game")]
mod render_random;
#[cfg(feature = "game")]
mod render_ration;
#[cfg(feature = "game")]
mod render_shaders;
#[cfg(feature = "game")]
mod render_shift;
#[cfg(feature = "game")]
mod render_sprites;
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
