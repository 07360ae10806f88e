//! The pyramid of pictures in which the aurora's light is added up. A wide stroke goes to the level where its standard deviation is 0.75 to
//! 1.5 pixels. Each level is enlarged into the next finer one before the strokes of that one are added. All levels but the finest have a
//! margin of one texel on each side, so that enlarging reads no texel outside.
//!
//! Coarse levels have no depth test. Only strokes in front of everything in their box go there (shaders/aurora/walk.wgsl); [`Ranges`] tells
//! that.

use wgpu::{BufferUsages, ShaderStages};

use crate::render::Gpu;
use crate::render::gpu::layout::{Raster, Slot, bind, buffer, layout, module, new_texture, raster};
use crate::render::gpu::shaders::Pass;
use crate::render::gpu::targets::target;
use crate::render::gpu::timing::Timing;

/// Levels of the pyramid, each of half the size of the one before; as in lit_tiles.wgsl.
pub const PYRAMID: u32 = 7;
/// Texels around each level but the finest.
const MARGIN: u32 = 1;

/// The format in which light is added up: 32-bit floats where the adapter can blend and filter them. With 16-bit floats (11 bits) thousands
/// of faint strokes are rounded one by one, in the order in which threads appended them, so that the same frame drawn again varies by some
/// per cent.
pub fn light_format(device: &wgpu::Device) -> wgpu::TextureFormat {
    let full = device.features().contains(wgpu::Features::FLOAT32_BLENDABLE | wgpu::Features::FLOAT32_FILTERABLE);
    if full { wgpu::TextureFormat::Rgba32Float } else { wgpu::TextureFormat::Rgba16Float }
}

/// The levels for one size of the screen.
#[derive(Debug)]
pub struct Levels {
    /// Size of the screen.
    pub size: [u32; 2],
    /// The light of each, the finest first.
    pub lights: Vec<wgpu::TextureView>,
    /// A black texture that is enlarged where there is no coarser level.
    pub nothing: wgpu::TextureView,
    /// `Level` of draw.wgsl.
    pub places: Vec<wgpu::Buffer>,
}

/// Size of a level, without its margin.
fn inner(size: [u32; 2], level: u32) -> [u32; 2] {
    size.map(|side| side.div_ceil(1 << level))
}

/// Size of a level.
fn whole(size: [u32; 2], level: u32) -> [u32; 2] {
    let margin = if level == 0 { 0 } else { MARGIN };
    inner(size, level).map(|side| side + 2 * margin)
}

impl Levels {
    /// For a screen of a size.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        let device = &gpu.device;
        let format = light_format(device);
        let lights = (0..PYRAMID).map(|level| target(device, "aurora light", whole(size, level), format).1);
        let places = (0..PYRAMID).map(|level| {
            let place = place(size, level);
            let uniform = buffer(device, "aurora level", size_of_val(&place) as u64, BufferUsages::UNIFORM);
            gpu.queue.write_buffer(&uniform, 0, bytemuck::bytes_of(&place));
            uniform
        });
        Levels { size, lights: lights.collect(), nothing: target(device, "aurora nothing", [1, 1], format).1, places: places.collect() }
    }

    /// The pixels of a level that cover the given pixels of the screen (left, top, width, height), with a margin.
    pub fn part(&self, [left, top, width, height]: [u32; 4], level: u32) -> [u32; 4] {
        if level == 0 {
            return [left, top, width, height];
        }
        let size = whole(self.size, level);
        // Two to each side: enlarging reads one, and that one has been enlarged itself.
        let low = [left, top].map(|edge| ((edge >> level) + MARGIN).saturating_sub(2));
        let high = [left + width, top + height].map(|edge| (edge >> level) + MARGIN + 3);
        [low[0], low[1], high[0].min(size[0]) - low[0], high[1].min(size[1]) - low[1]]
    }
}

/// From normalised device coordinates of the screen to those of a level with its margin: scale and offset.
fn place(size: [u32; 2], level: u32) -> [[f32; 2]; 2] {
    let whole = whole(size, level).map(|side| side as f32);
    let margin = if level == 0 { 0.0 } else { MARGIN as f32 };
    let [width, height] = size.map(|side| side as f32 / (1u32 << level) as f32);
    let scale = [width / whole[0], height / whole[1]];
    // Rows of pixels count downwards, normalised device coordinates upwards.
    let offset = [(width + 2.0 * margin) / whole[0] - 1.0, 1.0 - (height + 2.0 * margin) / whole[1]];
    [scale, offset]
}

/// Number of sizes of depth tiles, for which the least and greatest depth are known.
const DEPTH_TILES: u32 = 6;
/// The least size of a depth tile, in pixels; as in walk.wgsl.
pub const LEAST_DEPTH_TILE: u32 = 8;

/// The least and the greatest depth of what is drawn, by depth tiles.
#[derive(Debug)]
pub struct Ranges {
    first: wgpu::RenderPipeline,
    next: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    nearest: wgpu::Sampler,
    /// The depth texture for which the rest was made.
    depth: Option<wgpu::TextureView>,
    texture: wgpu::Texture,
    /// Those of its levels that are made in a frame.
    made: wgpu::TextureView,
    levels: u32,
    steps: Vec<(wgpu::TextureView, wgpu::BindGroup)>,
}

impl Ranges {
    /// Compiles the passes.
    pub fn new(device: &wgpu::Device, frame_layout: &wgpu::BindGroupLayout) -> Self {
        let layout = layout(device, "aurora ranges", ShaderStages::FRAGMENT, &[Slot::Depth, Slot::Numbers, Slot::Nearest]);
        let draw = |fragment| {
            let stage = Raster { vertex: "vertex", fragment, targets: &[(FORMAT, None)], depth: None };
            let module = module(device, "aurora ranges", Pass::AuroraRanges);
            raster(device, "aurora ranges", &module, stage, &[Some(frame_layout), Some(&layout)])
        };
        let texture = texture(device, [1, 1]);
        let made = texture.create_view(&Default::default());
        let nearest = device.create_sampler(&wgpu::SamplerDescriptor::default());
        Ranges { first: draw("first"), next: draw("next"), layout, nearest, depth: None, texture, made, levels: 0, steps: Vec::new() }
    }

    /// Takes the depth texture of a screen of a size, for images of up to so many pixels a side. True if the texture of ranges was
    /// replaced.
    pub fn prepare(&mut self, device: &wgpu::Device, depth: &wgpu::TextureView, size: [u32; 2], widest: u32) -> bool {
        // Tiles as wide as the largest box: it touches two of them a side.
        let levels = (widest / LEAST_DEPTH_TILE).max(1).ilog2() + 2;
        let is_new = self.depth.as_ref() != Some(depth);
        if is_new {
            self.make(device, depth, size);
        }
        let replaced = is_new || self.levels != levels.min(DEPTH_TILES);
        if replaced {
            self.levels = levels.min(DEPTH_TILES);
            let made = wgpu::TextureViewDescriptor { mip_level_count: Some(self.levels), ..Default::default() };
            self.made = self.texture.create_view(&made);
        }
        replaced
    }

    fn make(&mut self, device: &wgpu::Device, depth: &wgpu::TextureView, size: [u32; 2]) {
        let texture = texture(device, size);
        let one = |step| {
            let only = wgpu::TextureViewDescriptor { base_mip_level: step, mip_level_count: Some(1), ..Default::default() };
            texture.create_view(&only)
        };
        let mut nothing = self::texture(device, [1, 1]).create_view(&Default::default());
        self.steps.clear();
        for step in 0..DEPTH_TILES {
            let (own, finer) = (one(step), nothing);
            let textures = [depth, &finer].map(wgpu::BindingResource::TextureView);
            let resources = [&textures[..], &[wgpu::BindingResource::Sampler(&self.nearest)]].concat();
            let group = bind(device, "aurora ranges", &self.layout, &resources);
            nothing = own.clone();
            self.steps.push((own, group));
        }
        self.texture = texture;
        self.depth = Some(depth.clone());
    }

    /// The texture: the sizes of depth tiles that are made, a level each.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.made
    }

    /// Finds the ranges, after everything with depth has been drawn. `frame` is the bind group of the frame.
    pub fn encode(&self, encoder: &mut wgpu::CommandEncoder, timing: &mut Timing, frame: &wgpu::BindGroup) {
        for (step, (view, group)) in self.steps.iter().enumerate().take(self.levels as usize) {
            let timestamp_writes = timing.render(encoder, "aurora ranges");
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("aurora ranges"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store },
                })],
                timestamp_writes,
                ..Default::default()
            });
            pass.set_pipeline(if step == 0 { &self.first } else { &self.next });
            pass.set_bind_group(0, frame, &[]);
            pass.set_bind_group(1, group, &[]);
            pass.draw(0..3, 0..1);
        }
    }
}

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Float;

/// The texture of ranges for a screen of a size, one mip level per size of depth tiles; its sides are whole numbers of the largest tiles.
fn texture(device: &wgpu::Device, size: [u32; 2]) -> wgpu::Texture {
    let [width, height] = size.map(|side| side.next_multiple_of(LEAST_DEPTH_TILE << (DEPTH_TILES - 1)) / LEAST_DEPTH_TILE);
    new_texture(
        device,
        "aurora ranges",
        [width, height],
        [1, DEPTH_TILES],
        FORMAT,
        wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
    )
}
