//! The relativistic renderer: everything is rasterised through the lensing table, tessellated in compute.
//!
//! [`renderer::Renderer`] is the whole of it on plain wgpu, used alike by the window, by `shot` and by the tests. The way of a frame, file
//! by file: [`instances`] (where objects are seen, f64) → [`frame`] (the uniform) → [`geometry`] (five compute stages, two draws) → [`sky`]
//! (Milky Way, stars) → [`aurora`] → [`post_process`] (bloom, exposure, tone curve).

pub mod aurora;
pub mod disk;
pub mod frame;
pub mod geometry;
pub mod gpu;
pub mod instances;
pub mod job;
pub mod models;
mod passes;
pub mod plugin;
pub mod post_process;
pub mod quality;
pub mod renderer;
mod renderer_loader;
pub mod settings;
pub mod shot;
pub mod sky;
pub mod stage;
pub mod tables;

pub use gpu::device::{DeviceError, Gpu};
pub use renderer::Renderer;
