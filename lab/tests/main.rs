//! All tests of the laboratory in one binary; what they share with those of the game is read from there.

mod aurora;
mod aurora_pyramid;
mod aurora_shaders;
mod bvh_build;
mod bvh_rays;
mod bvh_robust;
mod charts;
mod command_line;
mod compare;
mod contestant;
mod disk_near;
mod disk_order;
mod disk_pictures;
mod disk_polygons;
mod disk_sprites;
mod disk_thin;
mod displacement;
mod flight;
mod horizon;
mod methods;
mod narrow;
mod projection;
mod projection_methods;
mod published;
mod random;
mod random_pictures;
mod sight;
mod thin_disk;
mod verdicts;

#[path = "../../tests/gpu.rs"]
mod gpu;
#[path = "../../tests/projector.rs"]
mod projector;
#[allow(dead_code, reason = "the tests of the game use the rest")]
#[path = "../../tests/render/support.rs"]
mod render_support;
#[allow(dead_code, reason = "the tests of the game use the rest")]
#[path = "../../tests/support.rs"]
mod support;
#[allow(dead_code, reason = "the tests of the game use the rest")]
#[path = "../../tests/twin.rs"]
mod twin;
