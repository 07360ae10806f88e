//! The accretion disk on the GPU: arcs by default, polygons and sprites for comparison.
//!
//! [`view`] says in f64 what a frame needs to know (which circles, seen from where, which generations of streaks); [`arcs`] runs the stages of
//! `shaders/disk/` over it; [`textures`] holds the pattern of the gas and the colours of black bodies.

pub mod arcs;
pub mod textures;
pub mod types;
pub mod view;

use crate::lensing::Slice;
use crate::scene::GameConfig;
use crate::scene::config;
use crate::scene::disk::Gas;
use crate::scene::disk::arcs::Arcs;

use super::Gpu;
use super::frame::FrameInput;
use arcs::ArcPass;
use textures::Textures;

/// A disk ready to be drawn.
#[derive(Clone, Debug)]
pub struct Disk {
    /// The gas.
    pub gas: Gas,
    /// Its arcs.
    pub arcs: Arcs,
    /// What `game.toml` and the scene say.
    pub config: config::Disk,
    /// Least width of thin images, in pixels.
    pub min_width: f64,
}

impl Disk {
    /// The disk of `disk` around the hole of `config`.
    pub fn new(disk: config::Disk, config: &GameConfig) -> Disk {
        let gas = Gas::new(&disk, config.hole.mass_solar);
        let arcs = Arcs::new(&disk, &gas.radial);
        Disk { gas, arcs, config: disk, min_width: config.render.min_width }
    }
}

/// The passes of the disk, made when a scene first has one.
#[derive(Debug)]
pub struct DiskPasses {
    disk: Disk,
    arcs: ArcPass,
}

impl DiskPasses {
    /// Compiles the passes.
    pub fn new(gpu: &Gpu, frame_layout: &wgpu::BindGroupLayout, disk: Disk) -> DiskPasses {
        let textures = Textures::new(gpu);
        DiskPasses { arcs: ArcPass::new(gpu, frame_layout, textures), disk }
    }

    /// Takes up another disk.
    pub fn set(&mut self, disk: Disk) {
        self.disk = disk;
    }

    /// The disk that is drawn.
    pub fn disk(&self) -> &Disk {
        &self.disk
    }

    /// The arcs and their buffers.
    pub fn arcs(&self) -> &ArcPass {
        &self.arcs
    }

    /// Uploads what the frame needs.
    pub fn prepare(&mut self, gpu: &Gpu, input: &FrameInput, slice: &Slice, width: u32) {
        self.arcs.prepare(gpu, &self.disk, input, slice, width);
    }

    /// The stages of compute.
    pub fn compute(&self, pass: &mut wgpu::ComputePass) {
        self.arcs.compute(pass);
    }

    /// The stages whose size the first ones decide; in a pass of their own.
    pub fn compute_rest(&self, pass: &mut wgpu::ComputePass) {
        self.arcs.compute_rest(pass);
    }

    /// The draws.
    pub fn draw(&self, pass: &mut wgpu::RenderPass) {
        self.arcs.draw(pass);
    }
}
