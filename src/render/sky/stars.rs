//! Stars: projected in compute, both orders, drawn as spots.

use crate::render::Gpu;
use crate::render::frame::{BLACKBODY_COLDEST, BLACKBODY_HOTTEST};
use crate::render::gpu::layout::{Growing, HDR_FORMAT, Raster, Slot, bind, buffer, compute, layout, module, raster, storage};
use crate::render::gpu::shaders::Pass;
use crate::render::gpu::types::Star;
use crate::scene::blackbody;

use crate::render::sky::clusters::{CLUSTERS, ORDERS};

/// Bytes of `SeenStar` in WGSL.
const SEEN_STAR_BYTES: u64 = 32;
/// The catalogue on the GPU and the two passes over it.
#[derive(Debug)]
pub struct Stars {
    /// Clusters that may be on the screen: first star, how many, order.
    listed: Growing,
    groups: u32,
    project_layout: wgpu::BindGroupLayout,
    catalogue: wgpu::Buffer,
    seen: wgpu::Buffer,
    project: wgpu::ComputePipeline,
    /// None where it is to be made.
    project_group: Option<wgpu::BindGroup>,
    draw: wgpu::RenderPipeline,
    draw_group: wgpu::BindGroup,
    arguments: wgpu::Buffer,
}

impl Stars {
    /// Uploads the catalogue, in the order of its clusters. `table` is [`blackbody_table`](crate::render::frame::blackbody_table).
    pub fn new(gpu: &Gpu, frame_layout: &wgpu::BindGroupLayout, mut stars: Vec<Star>, table: &[[f32; 4]]) -> Self {
        let device = &gpu.device;
        for star in &mut stars {
            let rgb = blackbody::lookup(table, BLACKBODY_COLDEST, BLACKBODY_HOTTEST, star.temperature);
            star.luminance = blackbody::luminance(rgb.map(f64::from)) as f32;
        }
        let catalogue = storage(gpu, "stars", &stars);
        let listed = Growing::new(device, "star clusters", wgpu::BufferUsages::STORAGE);
        let seen =
            buffer(device, "seen stars", SEEN_STAR_BYTES * (stars.len().max(1) as u64) * u64::from(ORDERS), wgpu::BufferUsages::STORAGE);
        let arguments = buffer(device, "star draw", 16, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT);
        let project_layout =
            layout(device, "stars project", wgpu::ShaderStages::COMPUTE, &[Slot::Read, Slot::Write, Slot::Write, Slot::Read]);
        let project = compute(device, "stars project", Pass::StarsProject, "main", &[Some(frame_layout), Some(&project_layout)]);
        let draw_layout = layout(device, "stars draw", wgpu::ShaderStages::VERTEX, &[Slot::Read]);
        let draw_group = bind(device, "stars draw", &draw_layout, &[seen.as_entire_binding()]);
        let shader = module(device, "stars draw", Pass::StarsDraw);
        let add = wgpu::BlendState {
            color: wgpu::BlendComponent {
                src_factor: wgpu::BlendFactor::One,
                dst_factor: wgpu::BlendFactor::One,
                operation: wgpu::BlendOperation::Add,
            },
            alpha: wgpu::BlendComponent {
                src_factor: wgpu::BlendFactor::Zero,
                dst_factor: wgpu::BlendFactor::One,
                operation: wgpu::BlendOperation::Add,
            },
        };
        let stage = Raster { vertex: "vertex", fragment: "fragment", targets: &[(HDR_FORMAT, Some(add))], depth: Some(false) };
        let draw = raster(device, "stars draw", &shader, stage, &[Some(frame_layout), Some(&draw_layout)]);
        Stars { listed, groups: 0, project_layout, catalogue, seen, project, project_group: None, draw, draw_group, arguments }
    }

    /// Uploads the clusters that may be on the screen, and empties the list of seen stars; before [`Stars::project`].
    pub fn prepare(&mut self, gpu: &Gpu, listed: &[[u32; 4]]) {
        self.groups = listed.len() as u32 / CLUSTERS;
        if self.listed.write(gpu, listed) {
            self.project_group = None;
        }
        gpu.queue.write_buffer(&self.arguments, 0, bytemuck::cast_slice(&[0u32, 1, 0, 0]));
    }

    /// Makes the bind group of a prepared frame, where buffers are others than before.
    pub fn bind(&mut self, device: &wgpu::Device) {
        if self.project_group.is_none() {
            let buffers = [&self.catalogue, &self.seen, &self.arguments, &self.listed.buffer];
            let resources = buffers.map(|buffer| buffer.as_entire_binding());
            self.project_group = Some(bind(device, "stars project", &self.project_layout, &resources));
        }
    }

    /// Projects the stars that may be seen.
    pub fn project(&self, pass: &mut wgpu::ComputePass) {
        let Some(group) = self.project_group.as_ref().filter(|_| self.groups > 0) else { return };
        pass.set_pipeline(&self.project);
        pass.set_bind_group(1, group, &[]);
        pass.dispatch_workgroups(self.groups, 1, 1);
    }

    /// Draws those that are seen.
    pub fn draw(&self, pass: &mut wgpu::RenderPass) {
        pass.set_pipeline(&self.draw);
        pass.set_bind_group(1, &self.draw_group, &[]);
        pass.draw_indirect(&self.arguments, 0);
    }
}
