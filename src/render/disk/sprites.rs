//! The disk of point sprites: projected in one stage of compute, drawn as spots.

use wgpu::{BufferUsages, ShaderStages};

use crate::render::Gpu;
use crate::render::layout::{HDR_FORMAT, Raster, Slot, bind, buffer, compute, layout, module, raster, storage};
use crate::render::shaders::Pass;
use crate::scene::disk::sprites::sprites;

use super::Disk;
use super::types::SEEN_SPRITE_BYTES;

/// Orders that sprites are drawn in: a third is lost among them.
const ORDERS: u32 = 2;

/// The sprites and the two passes over them.
#[derive(Debug)]
pub struct SpritePass {
    count: u32,
    project: wgpu::ComputePipeline,
    project_group: wgpu::BindGroup,
    draw: wgpu::RenderPipeline,
    draw_group: wgpu::BindGroup,
    arguments: wgpu::Buffer,
}

impl SpritePass {
    /// Uploads the sprites of `disk`; `frame` and `radial` are the buffers that all representations share.
    pub fn new(gpu: &Gpu, frame_layout: &wgpu::BindGroupLayout, frame: &wgpu::Buffer, radial: &wgpu::Buffer, disk: &Disk) -> SpritePass {
        use Slot::{Read, Write};
        let device = &gpu.device;
        let all: Vec<[f32; 2]> =
            sprites(&disk.config, &disk.gas.radial).iter().map(|sprite| [sprite.radius as f32, sprite.azimuth as f32]).collect();
        let places = storage(gpu, "sprites", &all);
        let seen = buffer(device, "seen sprites", SEEN_SPRITE_BYTES * all.len() as u64 * u64::from(ORDERS), BufferUsages::STORAGE);
        let arguments = buffer(device, "sprite draw", 16, BufferUsages::STORAGE | BufferUsages::INDIRECT);
        let project_layout = layout(device, "sprites", ShaderStages::COMPUTE, &[Slot::Uniform, Read, Read, Write, Write]);
        let resources = [frame, radial, &places, &seen, &arguments].map(|buffer| buffer.as_entire_binding());
        let draw_layout = layout(device, "sprites draw", ShaderStages::VERTEX, &[Read]);
        let shader = module(device, "sprites draw", Pass::DiskSpritesDraw);
        let over = wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING;
        let stage = Raster { vertex: "vertex", fragment: "fragment", targets: &[(HDR_FORMAT, Some(over))], depth: Some(false) };
        SpritePass {
            // What the buffer has room for; the least buffer is larger than none.
            count: all.len() as u32,
            project: compute(device, "sprites", Pass::DiskSprites, "main", &[Some(frame_layout), Some(&project_layout)]),
            project_group: bind(device, "sprites", &project_layout, &resources),
            draw: raster(device, "sprites draw", &shader, stage, &[Some(frame_layout), Some(&draw_layout)]),
            draw_group: bind(device, "sprites draw", &draw_layout, &[seen.as_entire_binding()]),
            arguments,
        }
    }

    /// Empties the list of seen sprites.
    pub fn prepare(&self, gpu: &Gpu) {
        gpu.queue.write_buffer(&self.arguments, 0, bytemuck::cast_slice(&[6u32, 0, 0, 0]));
    }

    /// Projects them.
    pub fn compute(&self, pass: &mut wgpu::ComputePass) {
        pass.set_pipeline(&self.project);
        pass.set_bind_group(1, &self.project_group, &[]);
        pass.dispatch_workgroups(self.count.div_ceil(64), ORDERS, 1);
    }

    /// Draws those that are seen.
    pub fn draw(&self, pass: &mut wgpu::RenderPass) {
        pass.set_pipeline(&self.draw);
        pass.set_bind_group(1, &self.draw_group, &[]);
        pass.draw_indirect(&self.arguments, 0);
    }
}
