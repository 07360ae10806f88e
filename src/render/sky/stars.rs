//! Stars: projected in compute, both orders, drawn as spots.

use crate::render::Gpu;
use crate::render::layout::{HDR_FORMAT, Raster, Slot, bind, buffer, compute, layout, module, raster, storage};
use crate::render::shaders::Pass;
use crate::render::types::Star;

/// Bytes of `SeenStar` in WGSL.
const SEEN_STAR_BYTES: u64 = 32;
/// Orders in which stars are projected: the third is within a ten-thousandth of the shadow's edge and carries as little of the light.
const ORDERS: u32 = 2;

/// The stars so that neighbours in the list are neighbours on the sky: threads of one group are then off the screen together, and end early.
fn arranged(stars: &[Star]) -> Vec<Star> {
    // Cells of a cube's faces, 16 × 16 each: about 75 stars a cell.
    let cell = |star: &Star| {
        let d = star.direction;
        let axis = (0..3).max_by(|&a, &b| d[a].abs().total_cmp(&d[b].abs())).unwrap_or(0);
        let face = |k: usize| ((d[(axis + k) % 3] / d[axis].abs().max(1e-9) * 8.0 + 8.0) as u32).min(15);
        (axis as u32 * 2 + u32::from(d[axis] < 0.0)) << 8 | face(1) << 4 | face(2)
    };
    let mut sorted = stars.to_vec();
    sorted.sort_by_cached_key(cell);
    sorted
}

/// The catalogue on the GPU and the two passes over it.
#[derive(Debug)]
pub struct Stars {
    count: u32,
    project: wgpu::ComputePipeline,
    project_group: wgpu::BindGroup,
    draw: wgpu::RenderPipeline,
    draw_group: wgpu::BindGroup,
    arguments: wgpu::Buffer,
}

impl Stars {
    /// Uploads the catalogue.
    pub fn new(gpu: &Gpu, frame_layout: &wgpu::BindGroupLayout, stars: &[Star]) -> Self {
        let device = &gpu.device;
        let catalogue = storage(gpu, "stars", &arranged(stars));
        let seen =
            buffer(device, "seen stars", SEEN_STAR_BYTES * (stars.len().max(1) as u64) * u64::from(ORDERS), wgpu::BufferUsages::STORAGE);
        let arguments = buffer(device, "star draw", 16, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT);
        let project_layout = layout(device, "stars project", wgpu::ShaderStages::COMPUTE, &[Slot::Read, Slot::Write, Slot::Write]);
        let project_group = bind(
            device,
            "stars project",
            &project_layout,
            &[catalogue.as_entire_binding(), seen.as_entire_binding(), arguments.as_entire_binding()],
        );
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
        Stars { count: stars.len() as u32, project, project_group, draw, draw_group, arguments }
    }

    /// Number of stars in the catalogue.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// Empties the list of seen stars; before [`Stars::project`].
    pub fn reset(&self, gpu: &Gpu) {
        gpu.queue.write_buffer(&self.arguments, 0, bytemuck::cast_slice(&[6u32, 0, 0, 0]));
    }

    /// Projects the catalogue.
    pub fn project(&self, pass: &mut wgpu::ComputePass) {
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
