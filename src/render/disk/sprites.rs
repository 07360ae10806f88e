//! The disk of point sprites: projected in one stage of compute, drawn as soft spots, for each image order.

use std::ops::RangeInclusive;

use wgpu::{BufferUsages, ShaderStages};

use crate::render::Gpu;
use crate::render::gpu::layout::{HDR_FORMAT, Raster, Slot, bind, buffer, compute, layout, module, raster, storage};
use crate::render::gpu::shaders::Pass;
use crate::scene::disk::sprites::Sprites;

use crate::render::disk::drawn::DrawnDisk;
use crate::render::disk::types::{SEEN_SPRITE_BYTES, Sprite, SpriteImage};

/// Orders 1, 2 and 3 are drawn with one sprite in so many: images behind the first are many times narrower.
const SHARES: [u32; 3] = [1, 4, 4];

/// The sprites and the two passes over them.
#[derive(Debug)]
pub struct SpritePass {
    project: wgpu::ComputePipeline,
    draw: wgpu::RenderPipeline,
    /// One for each of orders 1, 2 and 3.
    images: [OrderSprites; 3],
    /// Which of them are drawn in this frame.
    drawn: [bool; 3],
}

/// The sprites of one order, and room for their seen vertices. Each sprite has its fixed place there, seen or not, so which lies over which
/// is the same in every frame.
#[derive(Debug)]
struct OrderSprites {
    count: u32,
    project: wgpu::BindGroup,
    draw: wgpu::BindGroup,
}

impl SpritePass {
    /// Uploads the sprites of `disk`; `frame` and `radial` are the buffers that all representations share.
    pub fn new(
        gpu: &Gpu,
        frame_layout: &wgpu::BindGroupLayout,
        gas_layout: &wgpu::BindGroupLayout,
        frame: &wgpu::Buffer,
        radial: &wgpu::Buffer,
        disk: &DrawnDisk,
    ) -> SpritePass {
        use Slot::{Read, Uniform, Write};
        let device = &gpu.device;
        let project_layout = layout(device, "sprites", ShaderStages::COMPUTE, &[Uniform, Read, Read, Write, Uniform]);
        let draw_layout = layout(device, "sprites draw", ShaderStages::VERTEX, &[Read]);
        let images = [1u32, 2, 3].map(|order| {
            let most = disk.config.sprites / SHARES[order as usize - 1];
            let Sprites { all, width } = Sprites::new(most, &disk.config, &disk.gas.radial);
            let sprite = |radius: f64, sigma: f64, step: f64| Sprite { radius: radius as f32, sigma: sigma as f32, step: step as f32 };
            let all: Vec<Sprite> = all.iter().map(|at| sprite(at.radius, at.sigma, at.step)).collect();
            let places = storage(gpu, "sprites", &all);
            let seen = buffer(device, "seen sprites", SEEN_SPRITE_BYTES * all.len() as u64, BufferUsages::STORAGE);
            let image = SpriteImage { order, ring_width: width as f32, count: all.len() as u32, end: disk.gas.extent()[1] as f32 };
            let told = buffer(device, "image of sprites", size_of::<SpriteImage>() as u64, BufferUsages::UNIFORM);
            gpu.queue.write_buffer(&told, 0, bytemuck::bytes_of(&image));
            let resources = [frame, radial, &places, &seen, &told].map(|buffer| buffer.as_entire_binding());
            OrderSprites {
                count: all.len() as u32,
                project: bind(device, "sprites", &project_layout, &resources),
                draw: bind(device, "sprites draw", &draw_layout, &[seen.as_entire_binding()]),
            }
        });
        let shader = module(device, "sprites draw", Pass::DiskSpritesDraw);
        let over = wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING;
        let stage = Raster { vertex: "vertex", fragment: "fragment", targets: &[(HDR_FORMAT, Some(over))], depth: Some(false) };
        let project_groups = [Some(frame_layout), Some(&project_layout), Some(gas_layout)];
        SpritePass {
            project: compute(device, "sprites", Pass::DiskSprites, "main", &project_groups),
            draw: raster(device, "sprites draw", &shader, stage, &[Some(frame_layout), Some(&draw_layout)]),
            images,
            drawn: [false; 3],
        }
    }

    /// Which of orders 1 to 3 to draw.
    pub fn prepare(&mut self, drawn: [bool; 3]) {
        self.drawn = drawn;
    }

    /// The images of these orders that are drawn, the farthest first.
    fn drawn(&self, orders: RangeInclusive<u32>) -> impl Iterator<Item = &OrderSprites> {
        let all = self.images.iter().zip(self.drawn).zip([1, 2, 3]).rev();
        all.filter_map(move |((image, drawn), order)| (drawn && orders.contains(&order)).then_some(image))
    }

    /// Projects them.
    pub fn compute(&self, pass: &mut wgpu::ComputePass) {
        pass.set_pipeline(&self.project);
        for image in self.drawn(1..=3) {
            pass.set_bind_group(1, &image.project, &[]);
            pass.dispatch_workgroups(image.count.div_ceil(64), 1, 1);
        }
    }

    /// Draws these orders, from 1 on, each over what is behind it.
    pub fn draw(&self, pass: &mut wgpu::RenderPass, orders: RangeInclusive<u32>) {
        pass.set_pipeline(&self.draw);
        for image in self.drawn(orders) {
            pass.set_bind_group(1, &image.draw, &[]);
            pass.draw(0..3 * image.count, 0..1);
        }
    }
}
