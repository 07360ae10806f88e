//! The disk of polygons: an annulus of triangles through the stages of geometry, as any other model.

use wgpu::ShaderStages;

use crate::render::Gpu;
use crate::render::frame::FrameInput;
use crate::render::geometry::Geometry;
use crate::render::layout::{HDR_FORMAT, Raster, Slot, bind, layout, module, raster};
use crate::render::method::Method;
use crate::render::models::{ModelRange, Models};
use crate::render::placements::Placed;
use crate::render::shaders::Pass;
use crate::render::types::{ARGUMENTS_OPAQUE, Placement};
use crate::scene::disk::polygons::model;

use super::Disk;

/// Two-sided triangles that are held in place; as in shaders/types.wgsl.
const HELD_TWO_SIDED: u32 = 3;

/// Stages of geometry of their own, and the draw.
#[derive(Debug)]
pub struct PolygonPass {
    geometry: Geometry,
    models: Models,
    range: ModelRange,
    seen_layout: wgpu::BindGroupLayout,
    draw: wgpu::RenderPipeline,
    radial: wgpu::Buffer,
    group: Option<wgpu::BindGroup>,
}

impl PolygonPass {
    /// Compiles the stages and uploads the triangles of `disk`.
    pub fn new(
        gpu: &Gpu,
        frame_layout: &wgpu::BindGroupLayout,
        gas_layout: &wgpu::BindGroupLayout,
        radial: wgpu::Buffer,
        disk: &Disk,
    ) -> PolygonPass {
        let device = &gpu.device;
        let seen_layout = layout(device, "polygons", ShaderStages::VERTEX, &[Slot::Read, Slot::Read]);
        let shader = module(device, "polygons", Pass::DiskPolygons);
        let stage = Raster { vertex: "vertex", fragment: "fragment", targets: &[(HDR_FORMAT, None)], depth: Some(true) };
        let draw = raster(device, "polygons", &shader, stage, &[Some(frame_layout), Some(&seen_layout), Some(gas_layout)]);
        let mut models = Models::new(device);
        let range = models.add(gpu, &model(&disk.config, &disk.gas.radial));
        PolygonPass { geometry: Geometry::new(device, frame_layout), models, range, seen_layout, draw, radial, group: None }
    }

    /// Compiles the stages for another method of projection.
    pub fn set_method(&mut self, gpu: &Gpu, frame_layout: &wgpu::BindGroupLayout, method: Method, inside: bool) {
        self.geometry.set_method(&gpu.device, frame_layout, method, inside);
    }

    /// Uploads what the frame needs.
    pub fn prepare(&mut self, gpu: &Gpu, input: &FrameInput) {
        let p = -input.camera.position;
        let unit = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
        let placed: Vec<Placed> = (1..=input.settings.orders.min(input.settings.method.orders()).min(3))
            .map(|order| {
                let placement = Placement {
                    offset: [p.x as f32, p.y as f32, p.z as f32, 0.0],
                    momentum: [0.0, 0.0, 0.0, 1.0],
                    shape: unit,
                    turn: unit,
                    ids: [order, 1, 0, 0],
                    triangles: [0, 0, 0, HELD_TWO_SIDED],
                    ..Placement::default()
                };
                Placed { model: self.range, placement }
            })
            .collect();
        self.geometry.prepare(gpu, &self.models, &placed, input.settings.vertex_budget);
        self.group = Some(bind(
            &gpu.device,
            "polygons",
            &self.seen_layout,
            &[self.geometry.seen().as_entire_binding(), self.radial.as_entire_binding()],
        ));
    }

    /// Vertices, edges and triangles.
    pub fn compute(&self, pass: &mut wgpu::ComputePass) {
        self.geometry.vertices(pass);
        self.geometry.edges(pass);
        self.geometry.triangles(pass);
    }

    /// Splitting and the mesh stage.
    pub fn compute_rest(&self, pass: &mut wgpu::ComputePass) {
        self.geometry.refine(pass);
        self.geometry.mesh(pass);
    }

    /// The draw.
    pub fn draw(&self, pass: &mut wgpu::RenderPass) {
        let Some(group) = &self.group else { return };
        pass.set_pipeline(&self.draw);
        pass.set_bind_group(1, group, &[]);
        pass.set_index_buffer(self.geometry.indices().slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed_indirect(self.geometry.arguments(), ARGUMENTS_OPAQUE);
    }
}
