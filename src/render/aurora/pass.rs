//! The passes of the aurora, and their buffers.

use wgpu::{BufferUsages, ShaderStages};

use super::show::AuroraFrame;
use super::{AuroraSettings, Segment};
use crate::render::Gpu;
use crate::render::layout::{Growing, HDR_FORMAT, Raster, Slot, bind, buffer, compute, compute_of, layout, module, raster, storage};
use crate::render::method::Method;
use crate::render::shaders::Pass;
use crate::render::targets::{Targets, target};
use crate::render::types::Placement;
use crate::scene::aurora::quantiles::Quantiles;

/// Image orders that may show it.
const ORDERS: usize = 3;
/// Bytes of `ChordEnd` and `Splat` in WGSL.
const CHORD_END_BYTES: u64 = 48;
const SPLAT_BYTES: u64 = 48;
/// Bytes between the draw arguments of two orders, and between their splats: bindings start at multiples of this.
const ALIGNMENT: u64 = 256;
/// Entries of the tabulated Gaussian, for r²/σ² from 0 to 9.
const GAUSSIAN: usize = 256;

/// Room for the ends of a streak's chords, as in streaks.wgsl: red ones have twice as many.
fn chord_room(chords: u32) -> u32 {
    2 * chords + 1
}

/// Pipelines, buffers and the texture in which light is added up.
#[derive(Debug)]
pub struct Aurora {
    project: wgpu::ComputePipeline,
    walk: wgpu::ComputePipeline,
    splat: wgpu::RenderPipeline,
    resolve: wgpu::RenderPipeline,
    walk_layout: wgpu::BindGroupLayout,
    splat_layout: wgpu::BindGroupLayout,
    resolve_layout: wgpu::BindGroupLayout,
    settings: wgpu::Buffer,
    placements: wgpu::Buffer,
    nodes: Growing,
    segments: Growing,
    falls: wgpu::Buffer,
    chords: Growing,
    splats: Growing,
    draws: wgpu::Buffer,
    gaussian: wgpu::Buffer,
    colours: [wgpu::Buffer; ORDERS],
    accumulation: Option<([u32; 2], wgpu::TextureView)>,
    groups: Option<Groups>,
    /// Of the prepared frame: pixels that each image may be on (left, top, width, height), and whether it is behind the disk.
    images: Vec<([u32; 4], bool)>,
    /// Of the prepared frame: streaks, chords of a streak, orders; nothing is drawn where there are none.
    drawn: [u32; 3],
    /// Room for splats of one order.
    room: u64,
    uploaded: Option<std::sync::Arc<Vec<[f32; 4]>>>,
}

#[derive(Debug)]
struct Groups {
    walk: wgpu::BindGroup,
    splat: Vec<wgpu::BindGroup>,
    resolve: Vec<wgpu::BindGroup>,
}

impl Aurora {
    /// Compiles the passes.
    pub fn new(gpu: &Gpu, frame_layout: &wgpu::BindGroupLayout) -> Self {
        use Slot::{Read, Uniform, Write};
        let device = &gpu.device;
        let walk_layout = layout(device, "aurora walk", ShaderStages::COMPUTE, &[Uniform, Read, Read, Read, Read, Write, Write, Write]);
        let splat_layout = layout(device, "aurora splat", ShaderStages::VERTEX_FRAGMENT, &[Read, Read]);
        let resolve_layout = layout(device, "aurora resolve", ShaderStages::FRAGMENT, &[Slot::Numbers, Uniform]);
        let one = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::One,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        let sum = Some(wgpu::BlendState { color: one, alpha: one });
        let draw = |label, pass, targets: &[_], depth, own| {
            let stage = Raster { vertex: "vertex", fragment: "fragment", targets, depth };
            raster(device, label, &module(device, label, pass), stage, &[Some(frame_layout), Some(own)])
        };
        let groups = [Some(frame_layout), Some(&walk_layout)];
        let uniform = |label, size| buffer(device, label, size, BufferUsages::UNIFORM);
        let gaussian: Vec<f32> = (0..GAUSSIAN).map(|k| (-4.5 * k as f32 / (GAUSSIAN - 1) as f32).exp()).collect();
        Aurora {
            project: compute(device, "aurora project", Pass::AuroraProject, "main", &groups),
            walk: compute(device, "aurora walk", Pass::AuroraWalk, "main", &groups),
            splat: draw("aurora splat", Pass::AuroraSplat, &[(HDR_FORMAT, sum)], Some(false), &splat_layout),
            resolve: draw("aurora resolve", Pass::AuroraResolve, &[(HDR_FORMAT, sum)], None, &resolve_layout),
            settings: uniform("aurora", size_of::<AuroraSettings>() as u64),
            placements: buffer(device, "aurora placements", (ORDERS * size_of::<Placement>()) as u64, BufferUsages::STORAGE),
            nodes: Growing::new(device, "aurora nodes", BufferUsages::STORAGE),
            segments: Growing::new(device, "aurora segments", BufferUsages::STORAGE),
            falls: storage(gpu, "aurora falls", &fall_table()),
            chords: Growing::new(device, "aurora chords", BufferUsages::STORAGE),
            splats: Growing::new(device, "aurora splats", BufferUsages::STORAGE),
            draws: buffer(device, "aurora draws", 16 * ORDERS as u64, BufferUsages::STORAGE | BufferUsages::INDIRECT),
            gaussian: storage(gpu, "aurora gaussian", &gaussian),
            colours: std::array::from_fn(|_| uniform("aurora colours", 64)),
            accumulation: None,
            groups: None,
            images: Vec::new(),
            drawn: [0; 3],
            room: 0,
            uploaded: None,
            walk_layout,
            splat_layout,
            resolve_layout,
        }
    }

    /// Projects by another method from now on.
    pub fn set_method(&mut self, device: &wgpu::Device, frame_layout: &wgpu::BindGroupLayout, method: Method) {
        let groups = [Some(frame_layout), Some(&self.walk_layout)];
        self.project = compute_of(device, "aurora project", &Pass::AuroraProject.source_by(method, false), "main", &groups);
    }

    /// Uploads what the frame needs; None draws nothing.
    pub fn prepare(&mut self, gpu: &Gpu, frame: Option<&AuroraFrame>, targets: &Targets) {
        self.drawn = [0; 3];
        let Some(frame) = frame else { return };
        let device = &gpu.device;
        let orders = frame.placements.len().min(ORDERS);
        let mut settings = frame.settings;
        let [streaks, chords, ..] = settings.counts;
        // Splats of each order start at a multiple of the alignment: 16 splats are three of it.
        settings.history[2] = settings.history[2].next_multiple_of(16);
        let room = u64::from(settings.history[2]) * SPLAT_BYTES;
        debug_assert_eq!(room % ALIGNMENT, 0);
        let mut replaced = self.groups.is_none() || room != self.room;
        self.room = room;
        // The history changes only when the curtains have moved a step.
        if self.uploaded.as_ref().is_none_or(|nodes| !std::sync::Arc::ptr_eq(nodes, &frame.nodes)) {
            replaced |= self.nodes.write(gpu, &frame.nodes);
            self.uploaded = Some(frame.nodes.clone());
        }
        replaced |= self.segments.write::<Segment>(gpu, &frame.segments);
        replaced |= self.chords.reserve(device, CHORD_END_BYTES * u64::from(streaks) * u64::from(chord_room(chords)) * orders as u64);
        replaced |= self.splats.reserve(device, room * ORDERS as u64);
        if self.accumulation.as_ref().is_none_or(|(size, _)| *size != targets.size) {
            self.accumulation = Some((targets.size, target(device, "aurora light", targets.size, HDR_FORMAT).1));
            replaced = true;
        }
        if replaced {
            self.groups = self.make_groups(device);
        }
        gpu.queue.write_buffer(&self.settings, 0, bytemuck::bytes_of(&settings));
        gpu.queue.write_buffer(&self.placements, 0, bytemuck::cast_slice(&frame.placements[..orders]));
        gpu.queue.write_buffer(&self.draws, 0, bytemuck::cast_slice(&[[6u32, 0, 0, 0]; ORDERS]));
        for (buffer, colours) in self.colours.iter().zip(&frame.colours) {
            gpu.queue.write_buffer(buffer, 0, bytemuck::cast_slice(colours));
        }
        self.images = frame.parts.iter().map(|part| pixels(*part, targets.size)).zip(frame.behind.iter().copied()).take(orders).collect();
        self.drawn = [streaks, chords, orders as u32];
    }

    fn make_groups(&self, device: &wgpu::Device) -> Option<Groups> {
        let (_, light) = self.accumulation.as_ref()?;
        let walk = [
            &self.settings,
            &self.placements,
            &self.nodes.buffer,
            &self.segments.buffer,
            &self.falls,
            &self.chords.buffer,
            &self.splats.buffer,
            &self.draws,
        ];
        let splat = (0..ORDERS as u64).map(|order| {
            let range =
                wgpu::BufferBinding { buffer: &self.splats.buffer, offset: order * self.room, size: std::num::NonZeroU64::new(self.room) };
            bind(device, "aurora splat", &self.splat_layout, &[wgpu::BindingResource::Buffer(range), self.gaussian.as_entire_binding()])
        });
        let resolve = self.colours.iter().map(|colours| {
            let resources = [wgpu::BindingResource::TextureView(light), colours.as_entire_binding()];
            bind(device, "aurora resolve", &self.resolve_layout, &resources)
        });
        Some(Groups {
            walk: bind(device, "aurora walk", &self.walk_layout, &walk.map(|buffer| buffer.as_entire_binding())),
            splat: splat.collect(),
            resolve: resolve.collect(),
        })
    }

    /// How many images of it the prepared frame has.
    pub fn images(&self) -> u32 {
        self.drawn[2]
    }

    /// Those of them that are behind the disk, or the others.
    pub fn images_behind(&self, behind: bool) -> Vec<u32> {
        let all = 0..self.images();
        all.zip(&self.images).filter(|(_, (_, is_behind))| *is_behind == behind).map(|(image, _)| image).collect()
    }

    /// The ends of the chords, through the lookup.
    pub fn project(&self, pass: &mut wgpu::ComputePass) {
        let [streaks, chords, orders] = self.drawn;
        self.compute(pass, &self.project, (streaks * chord_room(chords)).div_ceil(64), orders);
    }

    /// From chords to splats.
    pub fn walk(&self, pass: &mut wgpu::ComputePass) {
        let [streaks, _, orders] = self.drawn;
        self.compute(pass, &self.walk, streaks.div_ceil(64), orders);
    }

    fn compute(&self, pass: &mut wgpu::ComputePass, pipeline: &wgpu::ComputePipeline, groups: u32, orders: u32) {
        let Some(bound) = self.groups.as_ref().filter(|_| orders > 0) else { return };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(1, &bound.walk, &[]);
        pass.dispatch_workgroups(groups, orders, 1);
    }

    /// The texture in which light is added up.
    pub fn light(&self) -> Option<&wgpu::TextureView> {
        self.accumulation.as_ref().map(|(_, view)| view)
    }

    /// Adds up the splats of one image.
    pub fn splat(&self, pass: &mut wgpu::RenderPass, image: u32) {
        let Some(bound) = &self.groups else { return };
        pass.set_pipeline(&self.splat);
        pass.set_bind_group(1, &bound.splat[image as usize], &[]);
        self.within(pass, image);
        pass.draw_indirect(&self.draws, 16 * u64::from(image));
    }

    /// Adds the colour of what was added up to the picture.
    pub fn resolve(&self, pass: &mut wgpu::RenderPass, image: u32) {
        let Some(bound) = &self.groups else { return };
        pass.set_pipeline(&self.resolve);
        pass.set_bind_group(1, &bound.resolve[image as usize], &[]);
        self.within(pass, image);
        pass.draw(0..3, 0..1);
    }

    /// Only where the image may be.
    fn within(&self, pass: &mut wgpu::RenderPass, image: u32) {
        if let Some(([left, top, width, height], _)) = self.images.get(image as usize) {
            pass.set_scissor_rect(*left, *top, *width, *height);
        }
    }

    /// Splats drawn in the last frame, by image: for tests and the overlay.
    pub fn draws(&self) -> &wgpu::Buffer {
        &self.draws
    }
}

/// Pixels that splats reach over the edge of where their middles are.
const EDGE: f64 = 16.0;

/// The pixels of a part of the screen: left, top, width, height.
fn pixels([left, top, right, bottom]: [f64; 4], [width, height]: [u32; 2]) -> [u32; 4] {
    let pixel = |share: f64, edge: f64, side: u32| (share * f64::from(side) + edge).clamp(0.0, f64::from(side)) as u32;
    let (x0, x1) = (pixel(left, -EDGE, width), pixel(right, EDGE, width));
    let (y0, y1) = (pixel(top, -EDGE, height), pixel(bottom, EDGE, height));
    [x0, y0, x1 - x0, y1 - y0]
}

/// The tables of the fall in the order that shaders/aurora/streaks.wgsl reads them.
pub fn fall_table() -> Vec<f32> {
    let tables = Quantiles::new();
    let photons = tables.photons.iter().flatten();
    photons.chain(tables.delays.iter().flatten()).chain(&tables.heights).copied().collect()
}
