//! The relativistic renderer: everything is rasterised through the lensing table, tessellated in compute.
//!
//! [`renderer::Renderer`] is the whole of it on plain wgpu, used alike by the window, by `shot` and by the tests. The way of a frame, file by
//! file: [`placements`] (where objects are seen, f64) → [`frame`] (the uniform) → [`geometry`] (five compute stages, two draws) → [`sky`]
//! (Milky Way, stars) → [`aurora`] → [`develop`] (bloom, exposure, tone curve).

pub mod aurora;
pub mod bench;
mod bounds;
pub mod coarse;
pub mod develop;
pub mod device;
pub mod disk;
pub mod frame;
pub mod geometry;
pub mod hiding;
pub mod layout;
pub mod method;
pub mod models;
pub mod outside;
mod passes;
pub mod placements;
pub mod plugin;
pub mod race;
pub mod readback;
pub mod renderer;
pub mod settings;
pub mod shaders;
pub mod shot;
pub mod sky;
pub mod stage;
mod stopwatch;
pub mod swing;
pub mod tables;
pub mod targets;
pub mod timing;
pub mod types;
pub mod visibility;

pub use device::{DeviceError, Gpu};
pub use renderer::Renderer;
