//! The disk of arcs: four stages of compute and a draw for each image order.

use std::ops::RangeInclusive;

use wgpu::{BufferUsages, ShaderStages};

use crate::render::Gpu;
use crate::render::gpu::layout::{Growing, HDR_FORMAT, Raster, Slot, TableTexture, bind, buffer, compute, layout, module, raster_of};
use crate::render::gpu::shaders::Pass;

use crate::render::disk::types::{self, DiskCounters, DiskFrame, DiskVertex};
use crate::render::disk::view::DiskView;

/// Room for the vertices of segments.
const EXTRA: u32 = 250_000;
/// Room for indices of orders 1, 2 and 3, and of the part of order 1 that is far from a close camera.
const INDICES: [u32; 4] = [1_500_000, 600_000, 600_000, 1_500_000];
/// Number of the last of these lists.
const BEYOND: u64 = 3;

/// The stages, their buffers and the draws.
#[derive(Debug)]
pub struct ArcPass {
    group_layout: wgpu::BindGroupLayout,
    vertices: wgpu::ComputePipeline,
    segments: wgpu::ComputePipeline,
    strips: wgpu::ComputePipeline,
    before_mesh: wgpu::ComputePipeline,
    before_draw: wgpu::ComputePipeline,
    far: wgpu::RenderPipeline,
    thin: wgpu::RenderPipeline,
    near: wgpu::RenderPipeline,
    beyond: wgpu::RenderPipeline,
    circles: Growing,
    cuts: Growing,
    rings: TableTexture,
    bends: TableTexture,
    seen: Growing,
    segment_buffer: Growing,
    jobs: wgpu::Buffer,
    indices: wgpu::Buffer,
    counters: wgpu::Buffer,
    arguments: wgpu::Buffer,
    arguments_group: wgpu::BindGroup,
    group: Option<wgpu::BindGroup>,
    /// Threads of the stages over grid, segments, arcs.
    threads: [u32; 3],
    /// Orders up to this one have a close look.
    close: u32,
}

/// [`DiskVertex`] as a vertex buffer, `SeenDisk` of WGSL.
fn vertex_layout() -> wgpu::VertexBufferLayout<'static> {
    const ATTRIBUTES: [wgpu::VertexAttribute; 15] = wgpu::vertex_attr_array![
        0 => Float32x3, 1 => Float32, 2 => Float32, 3 => Float32, 4 => Float32, 5 => Float32, 6 => Float32, 7 => Float32, 8 => Float32,
        9 => Float32, 10 => Float32, 11 => Float32, 12 => Float32, 13 => Float32, 14 => Float32
    ];
    wgpu::VertexBufferLayout {
        array_stride: size_of::<DiskVertex>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &ATTRIBUTES,
    }
}

impl ArcPass {
    /// Compiles the stages.
    pub fn new(gpu: &Gpu, frame_layout: &wgpu::BindGroupLayout, gas_layout: &wgpu::BindGroupLayout) -> ArcPass {
        use Slot::{Read, Write};
        let device = &gpu.device;
        let group_layout = layout(
            device,
            "disk",
            ShaderStages::COMPUTE,
            &[Slot::Uniform, Read, Read, Slot::Words, Slot::Numbers, Write, Write, Write, Write, Write],
        );
        let arguments_layout = layout(device, "disk arguments", ShaderStages::COMPUTE, &[Write]);
        let stage = |label, pass| compute(device, label, pass, "main", &[Some(frame_layout), Some(&group_layout)]);
        let argument = |entry| {
            let groups = [Some(frame_layout), Some(&group_layout), Some(&arguments_layout)];
            compute(device, entry, Pass::DiskArguments, entry, &groups)
        };
        let shader = module(device, "disk draw", Pass::DiskDraw);
        let over = wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING;
        let draw = |label, vertex, fragment| {
            let stage = Raster { vertex, fragment, targets: &[(HDR_FORMAT, Some(over))], depth: Some(false) };
            raster_of(device, label, &shader, stage, &[Some(frame_layout), None, Some(gas_layout)], &[vertex_layout()])
        };
        let storage = BufferUsages::STORAGE;
        let arguments = buffer(device, "disk arguments", types::ARGUMENTS_BYTES, storage | BufferUsages::INDIRECT);
        let total: u32 = INDICES.iter().sum();
        ArcPass {
            vertices: stage("disk vertices", Pass::DiskVertices),
            segments: stage("disk segments", Pass::DiskSegments),
            strips: stage("disk strips", Pass::DiskStrips),
            before_mesh: argument("before_mesh"),
            before_draw: argument("before_draw"),
            far: draw("disk far", "vertex", "far_fragment"),
            thin: draw("disk thin", "vertex", "thin_fragment"),
            near: draw("disk near", "vertex", "near_fragment"),
            beyond: draw("disk beyond", "vertex", "beyond_fragment"),
            circles: Growing::new(device, "disk circles", storage),
            cuts: Growing::new(device, "disk cuts", storage),
            rings: TableTexture::new(device, "disk rings", true),
            bends: TableTexture::new(device, "disk bends", false),
            seen: Growing::new(device, "disk vertices", storage | BufferUsages::VERTEX),
            segment_buffer: Growing::new(device, "disk segments", storage),
            jobs: buffer(device, "disk jobs", types::JOB_BYTES * u64::from(EXTRA), storage),
            indices: buffer(device, "disk indices", 4 * u64::from(total), storage | BufferUsages::INDEX),
            counters: buffer(device, "disk counters", size_of::<DiskCounters>() as u64, storage),
            arguments_group: bind(device, "disk arguments", &arguments_layout, &[arguments.as_entire_binding()]),
            arguments,
            group: None,
            threads: [0; 3],
            close: 0,
            group_layout,
        }
    }

    /// Uploads what the frame needs and fills in the places in its buffers.
    pub fn prepare(&mut self, gpu: &Gpu, view: &mut DiskView) {
        let DiskFrame { columns, arcs, rows, rings, .. } = view.frame;
        let grid = columns * rows;
        view.frame.vertex_room = grid + EXTRA;
        view.frame.regions = ArcPass::lists();
        view.frame.regions_end = INDICES.iter().sum();
        self.threads = [grid, arcs * rows, arcs * rings];
        self.close = view.frame.near_orders;
        let device = &gpu.device;
        let mut replaced = false;
        if std::mem::take(&mut view.has_moved) {
            replaced |= self.circles.write(gpu, &view.circles);
            replaced |= self.cuts.write(gpu, &view.cuts);
        }
        if std::mem::take(&mut view.is_new) {
            replaced |= self.rings.write(gpu, &view.rings);
            replaced |= self.bends.write(gpu, &view.bends);
        }
        replaced |= self.seen.reserve(device, u64::from(view.frame.vertex_room) * size_of::<DiskVertex>() as u64);
        replaced |= self.segment_buffer.reserve(device, types::SEGMENTS_BYTES * u64::from(arcs * rows));
        gpu.queue.write_buffer(&self.counters, 0, bytemuck::bytes_of(&DiskCounters::default()));
        if replaced {
            self.group = None;
        }
    }

    /// Makes the bind group of a prepared frame, where buffers are others than before. `frame` is the uniform buffer of the shaders.
    pub fn bind(&mut self, device: &wgpu::Device, frame: &wgpu::Buffer) {
        if self.group.is_some() {
            return;
        }
        let read = [frame, &self.circles.buffer, &self.cuts.buffer].map(wgpu::Buffer::as_entire_binding);
        let tables = [self.rings.binding(), self.bends.binding()];
        let written = [&self.seen.buffer, &self.segment_buffer.buffer, &self.jobs, &self.indices, &self.counters];
        let resources: Vec<_> = read.into_iter().chain(tables).chain(written.map(wgpu::Buffer::as_entire_binding)).collect();
        self.group = Some(bind(device, "disk", &self.group_layout, &resources));
    }

    /// The stages.
    pub fn compute(&self, pass: &mut wgpu::ComputePass) {
        let Some(group) = &self.group else { return };
        pass.set_bind_group(1, group, &[]);
        pass.set_bind_group(2, &self.arguments_group, &[]);
        let [grid, segments, _] = self.threads.map(|threads| threads.div_ceil(64));
        pass.set_pipeline(&self.vertices);
        pass.dispatch_workgroups(grid, 1, 1);
        pass.set_pipeline(&self.segments);
        pass.dispatch_workgroups(segments, 1, 1);
        pass.set_pipeline(&self.before_mesh);
        pass.dispatch_workgroups(1, 1, 1);
    }

    /// The stages whose number of threads the first ones decide.
    pub fn compute_rest(&self, pass: &mut wgpu::ComputePass) {
        let Some(group) = &self.group else { return };
        pass.set_bind_group(1, group, &[]);
        pass.set_pipeline(&self.vertices);
        pass.dispatch_workgroups_indirect(&self.arguments, 0);
        pass.set_pipeline(&self.strips);
        pass.dispatch_workgroups(self.threads[2].div_ceil(64), 1, 1);
        pass.set_bind_group(2, &self.arguments_group, &[]);
        pass.set_pipeline(&self.before_draw);
        pass.dispatch_workgroups(1, 1, 1);
    }

    /// Draws these orders, from 1 on: the farthest first.
    pub fn draw(&self, pass: &mut wgpu::RenderPass, orders: RangeInclusive<u32>) {
        if self.group.is_none() {
            return;
        }
        pass.set_vertex_buffer(0, self.seen.buffer.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        for order in orders.rev().map(|order| u64::from(order) - 1) {
            pass.set_pipeline(match order {
                order if order < u64::from(self.close) => &self.near,
                0 => &self.far,
                _ => &self.thin,
            });
            self.draw_list(pass, order);
            if order == 0 && self.close > 0 {
                pass.set_pipeline(&self.beyond);
                self.draw_list(pass, BEYOND);
            }
        }
    }

    fn draw_list(&self, pass: &mut wgpu::RenderPass, list: u64) {
        pass.draw_indexed_indirect(&self.arguments, types::ARGUMENTS_DRAW + list * types::ARGUMENTS_DRAW_STEP);
    }

    /// What was counted, for reading back.
    pub fn counters(&self) -> &wgpu::Buffer {
        &self.counters
    }

    /// Seen vertices: the grid of circles and cuts, then those of segments.
    pub fn seen(&self) -> &wgpu::Buffer {
        &self.seen.buffer
    }

    /// Where the indices of each list of triangles begin: orders 1 to 3, and the part of order 1 that is far from a close camera.
    pub fn lists() -> [u32; 4] {
        std::array::from_fn(|list| INDICES[..list].iter().sum())
    }

    /// Indices of the triangles, list by list.
    pub fn indices(&self) -> &wgpu::Buffer {
        &self.indices
    }
}
