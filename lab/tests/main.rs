//! All tests of the laboratory in one binary; the folders mirror `lab/src/`. What they share with those of the game is read from there.

mod aurora;
mod bodies;
mod bvh;
#[cfg(unix)]
mod card;
mod chart;
mod command_line;
mod compare;
mod contestant;
mod disk;
mod flight;
mod plot;
mod products;
mod projection;
mod published;
mod thin_disk;

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
