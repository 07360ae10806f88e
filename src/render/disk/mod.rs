//! The accretion disk on the GPU: arcs by default, polygons and sprites for comparison.
//!
//! [`view`] computes in f64 what a frame needs: which circles, how they are seen, which generations of streaks; it keeps circles while the
//! camera hardly moves. [`arcs`] runs the stages of `shaders/disk/` on it. [`polygons`] and [`sprites`] are the two other representations of
//! Yamashita 2025. [`textures`] holds the pattern of the gas.

pub mod arcs;
pub mod circles;
mod drawn;
pub mod polygons;
pub mod sigma;
pub mod sprites;
pub mod textures;
pub mod types;
pub mod view;

use std::ops::RangeInclusive;

use wgpu::{BufferUsages, ShaderStages};

use crate::lensing::Slice;
use crate::render::Gpu;
use crate::render::frame::FrameInput;
use crate::render::gpu::layout::{Slot, bind, buffer, layout, storage};
use arcs::ArcPass;
pub use drawn::DrawnDisk;
use polygons::PolygonPass;
use sprites::SpritePass;
use textures::Textures;
use types::DiskFrame;
use view::{DiskView, drawn_orders};

/// How the disk is drawn.
#[derive(Debug)]
enum Representation {
    Arcs,
    Polygons(Box<PolygonPass>),
    Sprites(SpritePass),
}

/// The passes of the disk, made when a scene first has one.
#[derive(Debug)]
pub struct DiskPasses {
    disk: DrawnDisk,
    view: DiskView,
    frame: wgpu::Buffer,
    gas_layout: wgpu::BindGroupLayout,
    gas_group: wgpu::BindGroup,
    arcs: ArcPass,
    representation: Representation,
    /// Polygons at rest, which are drawn in its place while lensing is off: arcs and sprites know bent light only. Made when first needed.
    straight: Option<Box<PolygonPass>>,
    /// Whether light is drawn straight.
    is_straight: bool,
}

impl DiskPasses {
    /// Compiles the passes.
    pub fn new(gpu: &Gpu, frame_layout: &wgpu::BindGroupLayout, disk: DrawnDisk) -> DiskPasses {
        use wgpu::BindingResource::TextureView;
        let slots = [Slot::Uniform, Slot::Texture, Slot::Texture];
        let gas_layout = layout(&gpu.device, "gas", ShaderStages::VERTEX_FRAGMENT | ShaderStages::COMPUTE, &slots);
        let (textures, arcs) = rayon::join(|| Textures::new(gpu), || ArcPass::new(gpu, frame_layout, &gas_layout));
        let frame = buffer(&gpu.device, "disk frame", size_of::<DiskFrame>() as u64, BufferUsages::UNIFORM);
        let resources = [frame.as_entire_binding(), TextureView(&textures.far), TextureView(&textures.near)];
        let gas_group = bind(&gpu.device, "gas", &gas_layout, &resources);
        let representation = Representation::Arcs;
        let (view, straight) = (DiskView::of(&disk), None);
        let mut passes =
            DiskPasses { disk: disk.clone(), view, frame, gas_layout, gas_group, arcs, representation, straight, is_straight: false };
        passes.set(gpu, frame_layout, disk);
        passes
    }

    /// Takes up another disk and its representation.
    pub fn set(&mut self, gpu: &Gpu, frame_layout: &wgpu::BindGroupLayout, disk: DrawnDisk) {
        let radial = || storage(gpu, "radial", &disk.radial_table());
        self.representation = match disk.config.representation.as_str() {
            kind @ ("polygons" | "polygons-at-rest") => {
                let turn = kind == "polygons";
                Representation::Polygons(Box::new(PolygonPass::new(gpu, frame_layout, &self.gas_layout, radial(), &disk, turn)))
            }
            "sprites" => Representation::Sprites(SpritePass::new(gpu, frame_layout, &self.gas_layout, &self.frame, &radial(), &disk)),
            // "arcs": the reader of `game.toml` lets only these four in.
            _ => Representation::Arcs,
        };
        self.straight = None;
        self.view = DiskView::of(&disk);
        self.disk = disk;
    }

    /// The disk that is drawn.
    pub fn disk(&self) -> &DrawnDisk {
        &self.disk
    }

    /// The arcs and their buffers.
    pub fn arcs(&self) -> &ArcPass {
        &self.arcs
    }

    /// The polygons, if it is drawn from them.
    pub fn polygons(&self) -> Option<&PolygonPass> {
        match &self.representation {
            Representation::Polygons(polygons) => Some(polygons),
            _ => None,
        }
    }

    /// Works out what the frame needs, for a picture `width` pixels wide, and touches nothing of the device; `slice` is that of the camera's
    /// radius.
    pub fn plan(&mut self, input: &FrameInput, slice: &Slice, width: u32) {
        self.is_straight = !input.settings.method.bends;
        if self.is_of_arcs() {
            self.view.follow(&self.disk, input, slice, width);
        } else {
            self.view.look_on(&self.disk, input);
            if self.is_laid_over() {
                self.view.drawn = drawn_orders(&self.disk, input, slice, width);
            }
        }
    }

    /// Lets the next plan be made as if it were the first.
    pub fn forget(&mut self) {
        self.view.forget();
    }

    /// Uploads what is planned.
    pub fn prepare(&mut self, gpu: &Gpu, frame_layout: &wgpu::BindGroupLayout, input: &FrameInput, width: u32) {
        if self.is_straight && self.straight.is_none() {
            let radial = storage(gpu, "radial", &self.disk.radial_table());
            let mut polygons = PolygonPass::new(gpu, frame_layout, &self.gas_layout, radial, &self.disk, false);
            // Straight light is the same on both sides of the horizon.
            polygons.set_method(input.settings.method, false);
            self.straight = Some(Box::new(polygons));
        }
        match &mut self.representation {
            _ if self.is_straight => self.straight.iter_mut().for_each(|polygons| polygons.prepare(gpu, input, width)),
            Representation::Arcs => self.arcs.prepare(gpu, &mut self.view),
            Representation::Polygons(polygons) => polygons.prepare(gpu, input, width),
            Representation::Sprites(sprites) => sprites.prepare(self.view.drawn),
        }
        gpu.queue.write_buffer(&self.frame, 0, bytemuck::bytes_of(&self.view.frame));
    }

    /// Makes the bind groups of a prepared frame, where buffers are others than before.
    pub fn bind(&mut self, device: &wgpu::Device) {
        match &mut self.representation {
            _ if self.is_straight => self.straight.iter_mut().for_each(|polygons| polygons.bind(device)),
            Representation::Arcs => self.arcs.bind(device, &self.frame),
            Representation::Polygons(polygons) => polygons.bind(device),
            Representation::Sprites(_) => {}
        }
    }

    /// The stages of compute.
    pub fn compute(&self, pass: &mut wgpu::ComputePass) {
        match &self.representation {
            _ if self.is_straight => self.straight.iter().for_each(|polygons| polygons.compute(pass)),
            Representation::Arcs => self.arcs.compute(pass),
            Representation::Polygons(polygons) => polygons.compute(pass),
            Representation::Sprites(sprites) => {
                pass.set_bind_group(2, &self.gas_group, &[]);
                sprites.compute(pass);
            }
        }
    }

    /// The stages whose size the first ones decide; in a pass of their own.
    pub fn compute_rest(&self, pass: &mut wgpu::ComputePass) {
        match &self.representation {
            _ if self.is_straight => self.straight.iter().for_each(|polygons| polygons.compute_rest(pass)),
            Representation::Arcs => self.arcs.compute_rest(pass),
            Representation::Polygons(polygons) => polygons.compute_rest(pass),
            Representation::Sprites(_) => {}
        }
    }

    /// Whether it is drawn from arcs, whose stages count what is in the picture.
    pub fn is_of_arcs(&self) -> bool {
        !self.is_straight && matches!(self.representation, Representation::Arcs)
    }

    /// Whether its image orders are blended one by one over what is behind them and leave no depth.
    pub fn is_laid_over(&self) -> bool {
        !self.is_straight && !matches!(self.representation, Representation::Polygons(_))
    }

    /// Draws these of its orders, from 1 on; polygons are drawn all at once.
    pub fn draw(&self, pass: &mut wgpu::RenderPass, orders: RangeInclusive<u32>) {
        pass.set_bind_group(2, &self.gas_group, &[]);
        match &self.representation {
            _ if self.is_straight => self.straight.iter().for_each(|polygons| polygons.draw(pass)),
            Representation::Arcs => self.arcs.draw(pass, orders),
            Representation::Polygons(polygons) => polygons.draw(pass),
            Representation::Sprites(sprites) => sprites.draw(pass, orders),
        }
    }
}
