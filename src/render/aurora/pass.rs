//! The passes of the aurora, and their buffers; `pipelines` compiles them.

use std::sync::Arc;

use wgpu::BufferUsages;

use crate::lensing::methods::Method;
use crate::render::Gpu;
use crate::render::aurora::animation::AuroraFrame;
use crate::render::aurora::capacities::{DRAWS_BYTES, LIT_TILES, StrokeCapacities};
use crate::render::aurora::colours::Colours;
use crate::render::aurora::levels::{Levels, PYRAMID, Ranges};
use crate::render::aurora::node_history::{NodeHistory, ROWS};
use crate::render::aurora::pipelines::{Layouts, Pipelines};
use crate::render::aurora::{AuroraSettings, BOTH_POLES, Segment};
use crate::render::gpu::layout::{Growing, bind, buffer, compute_of};
use crate::render::gpu::shaders::Pass;
use crate::render::gpu::targets::Targets;
use crate::render::gpu::timing::Timing;
use crate::render::gpu::types::Instance;
use crate::scene::blackbody::xyz_to_rgb;

/// Image orders in which an aurora may be drawn.
const ORDERS: usize = 3;
/// Bytes of `ChordEnd` in WGSL.
pub const CHORD_END_BYTES: u64 = 48;
/// Bytes of `Reference` in WGSL.
pub const REFERENCE_BYTES: u64 = 144;
/// Bytes of `Stroke` in WGSL.
pub const STROKE_BYTES: u64 = 40;

/// Number of heights at which the middle of a part of a curtain is projected, for streaks of so many chords. As in streaks.wgsl.
fn reference_capacity(chords: u32) -> u32 {
    3 * chords + 2
}

/// Room for the ends of a streak's chords; red streaks have twice as many chords. As in streaks.wgsl.
fn chord_room(chords: u32) -> u32 {
    2 * chords + 1
}

/// Pipelines, buffers and the textures in which light is added up.
#[derive(Debug)]
pub struct Aurora {
    pipelines: Pipelines,
    layouts: Layouts,
    ranges: Ranges,
    linear: wgpu::Sampler,
    settings: wgpu::Buffer,
    instances: wgpu::Buffer,
    nodes: Growing,
    segments: Growing,
    falls: Growing,
    chords: Growing,
    strokes: Growing,
    references: Growing,
    draws: wgpu::Buffer,
    colours: [wgpu::Buffer; ORDERS],
    levels: Option<Levels>,
    groups: Option<AuroraGroups>,
    /// For each image of the prepared frame: the pixels on which it may be (left, top, width, height), and whether it is behind the disk.
    images: Vec<([u32; 4], bool)>,
    /// In the prepared frame: streaks, chords of a streak, image orders. Zero orders: nothing is drawn.
    drawn: [u32; 3],
    /// Points that are projected in each order.
    projected: u32,
    /// The capacities of the prepared frame.
    capacities: StrokeCapacities,
    /// The rows and the table that are on the GPU.
    uploaded_rows: NodeHistory,
    uploaded_falls: Option<Arc<Vec<f32>>>,
}

#[derive(Debug)]
struct AuroraGroups {
    walk: wgpu::BindGroup,
    /// One group per level.
    draw: Vec<wgpu::BindGroup>,
    /// Of the next coarser level into each but the finest.
    spread: Vec<wgpu::BindGroup>,
    /// Colours and tiles, one group per image.
    tiles: Vec<wgpu::BindGroup>,
    resolve: wgpu::BindGroup,
}

impl Aurora {
    /// Compiles the passes.
    pub fn new(gpu: &Gpu, frame_layout: &wgpu::BindGroupLayout) -> Self {
        let device = &gpu.device;
        let layouts = Layouts::new(device);
        let uniform = |label, size| buffer(device, label, size, BufferUsages::UNIFORM);
        let growing = |label| Growing::new(device, label, BufferUsages::STORAGE);
        Aurora {
            pipelines: Pipelines::new(device, frame_layout, &layouts),
            layouts,
            ranges: Ranges::new(device, frame_layout),
            linear: device.create_sampler(&wgpu::SamplerDescriptor {
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
            settings: uniform("aurora", size_of::<AuroraSettings>() as u64),
            instances: buffer(device, "aurora instances", (ORDERS * size_of::<Instance>()) as u64, BufferUsages::STORAGE),
            nodes: growing("aurora nodes"),
            segments: growing("aurora segments"),
            falls: growing("aurora falls"),
            chords: growing("aurora chords"),
            strokes: growing("aurora strokes"),
            references: growing("aurora references"),
            draws: buffer(device, "aurora draws", DRAWS_BYTES * ORDERS as u64, BufferUsages::STORAGE | BufferUsages::INDIRECT),
            colours: std::array::from_fn(|_| uniform("aurora colours", size_of::<Colours>() as u64)),
            levels: None,
            groups: None,
            images: Vec::new(),
            drawn: [0; 3],
            projected: 0,
            capacities: StrokeCapacities::default(),
            uploaded_rows: NodeHistory::default(),
            uploaded_falls: None,
        }
    }

    /// Projects by another method from now on.
    pub fn set_method(&mut self, device: &wgpu::Device, frame_layout: &wgpu::BindGroupLayout, method: Method) {
        let groups = [Some(frame_layout), Some(&self.layouts.walk)];
        self.pipelines.project = compute_of(device, "aurora project", Pass::AuroraProject.shader_by(method, false), "main", &groups);
    }

    /// Uploads what the frame needs; None draws nothing.
    pub fn prepare(&mut self, gpu: &Gpu, frame: Option<&AuroraFrame>, targets: &Targets) {
        self.drawn = [0; 3];
        let Some(frame) = frame else { return };
        let device = &gpu.device;
        let orders = frame.instances.len().min(ORDERS);
        let mut settings = frame.settings;
        let AuroraSettings { streaks, chords, .. } = settings;
        // All of them must fit into a buffer, with the quarter more that it grows by.
        let most = device.limits().max_storage_buffer_binding_size * 4 / 5 / (STROKE_BYTES * orders as u64 * 2);
        // Parts of coarser levels are half as large each, so all of them together are less than twice the finest.
        settings.capacity = (u64::from(settings.capacity).min(most) as u32).next_multiple_of(8);
        settings.levels = settings.levels.clamp(1, PYRAMID);
        let capacities = StrokeCapacities { finest: u64::from(settings.capacity), levels: settings.levels };
        let mut replaced = capacities.levels != self.capacities.levels;
        self.capacities = capacities;
        replaced |= self.write_rows(gpu, &frame.rows);
        // They change only with the keys of the spectrum.
        if self.uploaded_falls.as_ref().is_none_or(|falls| !Arc::ptr_eq(falls, &frame.falls)) {
            replaced |= self.falls.write(gpu, &frame.falls);
            self.uploaded_falls = Some(frame.falls.clone());
        }
        replaced |= self.segments.write::<Segment>(gpu, &frame.segments);
        replaced |= self.chords.reserve(device, CHORD_END_BYTES * u64::from(streaks) * u64::from(chord_room(chords)) * orders as u64);
        replaced |= self.strokes.reserve(device, STROKE_BYTES * capacities.all() * orders as u64);
        let poles = if settings.flags & BOTH_POLES != 0 { 2 } else { 1 };
        self.projected = settings.segments * poles * reference_capacity(chords);
        replaced |= self.references.reserve(device, REFERENCE_BYTES * u64::from(self.projected) * orders as u64);
        if self.levels.as_ref().is_none_or(|levels| levels.size != targets.size) {
            self.levels = Some(Levels::new(gpu, targets.size));
            replaced = true;
        }
        self.images.clear();
        self.images.extend(frame.parts.iter().map(|part| pixels(*part, targets.size)).zip(frame.behind.iter().copied()).take(orders));
        let widest = self.images.iter().map(|([.., width, height], _)| (*width).max(*height)).max();
        replaced |= self.ranges.prepare(device, &targets.depth, targets.size, widest.unwrap_or(0));
        if replaced {
            self.groups = None;
        }
        gpu.queue.write_buffer(&self.settings, 0, bytemuck::bytes_of(&settings));
        gpu.queue.write_buffer(&self.instances, 0, bytemuck::cast_slice(&frame.instances[..orders]));
        let empty: [_; ORDERS] = std::array::from_fn(|image| capacities.empty(image as u32));
        gpu.queue.write_buffer(&self.draws, 0, bytemuck::cast_slice(&empty[..orders]));
        let tile = [0, 1].map(|axis| targets.size[axis].div_ceil(LIT_TILES[axis]) as f32 * 2.0 / targets.size[axis] as f32);
        for (buffer, colours) in self.colours.iter().zip(&frame.colours) {
            let rgb = |[x, y, z, _]: [f32; 4]| {
                let [r, g, b] = xyz_to_rgb([x, y, z].map(f64::from));
                [r as f32, g as f32, b as f32, 0.0]
            };
            let colours = Colours { lines: colours.lines.map(|lines| lines.map(rgb)), tile, ..*colours };
            gpu.queue.write_buffer(buffer, 0, bytemuck::bytes_of(&colours));
        }
        self.drawn = [streaks, chords, orders as u32];
    }

    /// Writes the rows that are not on the GPU yet, one of a step. True if the buffer was replaced.
    fn write_rows(&mut self, gpu: &Gpu, rows: &NodeHistory) -> bool {
        let bytes = size_of_val(rows.ago(0)) as u64;
        let replaced = self.nodes.reserve(&gpu.device, bytes * ROWS as u64);
        if replaced {
            self.uploaded_rows = NodeHistory::default();
        }
        for (slot, row) in rows.changed(&self.uploaded_rows) {
            gpu.queue.write_buffer(&self.nodes.buffer, bytes * slot as u64, bytemuck::cast_slice(row));
        }
        self.uploaded_rows = rows.clone();
        replaced
    }

    /// Makes the bind groups of a prepared frame, where buffers are others than before.
    pub fn bind(&mut self, device: &wgpu::Device) {
        if self.groups.is_none() {
            self.groups = self.make_groups(device);
        }
    }

    fn make_groups(&self, device: &wgpu::Device) -> Option<AuroraGroups> {
        let levels = self.levels.as_ref()?;
        let walk = [
            &self.settings, &self.instances, &self.nodes.buffer, &self.segments.buffer, &self.falls.buffer, &self.chords.buffer,
            &self.strokes.buffer, &self.draws, &self.references.buffer,
        ];
        let walk = walk.iter().map(|buffer| buffer.as_entire_binding());
        let walk: Vec<_> = walk.chain([wgpu::BindingResource::TextureView(self.ranges.view())]).collect();
        let draw_strokes = levels.places.iter().map(|place| {
            bind(device, "aurora strokes", &self.layouts.draw, &[place, &self.strokes.buffer].map(|buffer| buffer.as_entire_binding()))
        });
        // A level, or black where it is not in use.
        let light = |level: u32| {
            let coarse = levels.lights.get(level as usize).filter(|_| level < self.capacities.levels);
            wgpu::BindingResource::TextureView(coarse.unwrap_or(&levels.nothing))
        };
        let linear = || wgpu::BindingResource::Sampler(&self.linear);
        let spread = (1..self.capacities.levels).map(|level| {
            bind(device, "aurora spread", &self.layouts.spread, &[light(level + 1), linear(), self.draws.as_entire_binding()])
        });
        let tiles = self.colours.iter().map(|colours| {
            bind(device, "aurora tiles", &self.layouts.tiles, &[colours.as_entire_binding(), self.draws.as_entire_binding()])
        });
        Some(AuroraGroups {
            walk: bind(device, "aurora walk", &self.layouts.walk, &walk),
            draw: draw_strokes.collect(),
            spread: spread.collect(),
            tiles: tiles.collect(),
            resolve: bind(device, "aurora resolve", &self.layouts.resolve, &[light(0), light(1), linear()]),
        })
    }

    /// Number of images of the aurora in the prepared frame.
    pub fn images(&self) -> u32 {
        self.drawn[2]
    }

    /// The images that are behind the disk, or the others.
    pub fn images_behind(&self, behind: bool) -> impl Iterator<Item = u32> {
        let all = 0..self.images();
        all.zip(&self.images).filter(move |(_, (_, is_behind))| *is_behind == behind).map(|(image, _)| image)
    }

    /// Projects the middles of the parts of curtains through the lensing lookup.
    pub fn project(&self, pass: &mut wgpu::ComputePass) {
        self.compute(pass, &self.pipelines.project, self.projected.div_ceil(64), self.drawn[2]);
    }

    /// Finds the ends of the chords from them.
    pub fn ends(&self, pass: &mut wgpu::ComputePass) {
        let [streaks, chords, orders] = self.drawn;
        self.compute(pass, &self.pipelines.ends, (streaks * chord_room(chords)).div_ceil(64), orders);
    }

    /// Walks along the chords and makes strokes.
    pub fn walk(&self, pass: &mut wgpu::ComputePass) {
        let [streaks, _, orders] = self.drawn;
        self.compute(pass, &self.pipelines.walk, streaks.div_ceil(64), orders);
    }

    fn compute(&self, pass: &mut wgpu::ComputePass, pipeline: &wgpu::ComputePipeline, groups: u32, orders: u32) {
        let Some(bound) = self.groups.as_ref().filter(|_| orders > 0) else { return };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(1, &bound.walk, &[]);
        pass.dispatch_workgroups(groups, orders, 1);
    }

    /// Finds the range of depths per tile, which the walk needs, once everything with depth has been drawn.
    pub fn ranges(&self, encoder: &mut wgpu::CommandEncoder, timing: &mut Timing, frame: &wgpu::BindGroup) {
        self.ranges.encode(encoder, timing, frame);
    }

    /// The textures in which light is added up, the coarsest first, with their levels.
    pub fn levels(&self) -> impl Iterator<Item = (u32, &wgpu::TextureView)> {
        let lights = self.levels.as_ref().map_or(&[][..], |levels| &levels.lights[..self.capacities.levels as usize]);
        lights.iter().enumerate().rev().map(|(level, light)| (level as u32, light))
    }

    /// Adds up the strokes of one image in a level, after those of coarser levels. The finest level has the frame's depth.
    pub fn draw(&self, pass: &mut wgpu::RenderPass, image: u32, level: u32) {
        let Some((bound, levels)) = self.groups.as_ref().zip(self.levels.as_ref()) else { return };
        self.within(pass, image, |part| levels.part(part, level));
        // The coarsest level has no coarser one to enlarge.
        if level > 0 && level + 1 < self.capacities.levels {
            pass.set_pipeline(&self.pipelines.spread);
            pass.set_bind_group(1, &bound.spread[level as usize - 1], &[]);
            let instance = 8 * image + level;
            pass.draw(0..3, instance..instance + 1);
        } else if level == 0 {
            pass.set_pipeline(&self.pipelines.wipe);
            pass.set_bind_group(1, &bound.tiles[image as usize], &[]);
            draw_tiles(pass, image, 1);
            draw_tiles(pass, image, 3);
        }
        pass.set_pipeline(&self.pipelines.draw[usize::from(level > 0)]);
        pass.set_bind_group(1, &bound.draw[level as usize], &[]);
        pass.draw_indirect(&self.draws, DRAWS_BYTES * u64::from(image) + 16 * u64::from(level));
    }

    /// Adds the colour of the light that was added up to the picture.
    pub fn resolve(&self, pass: &mut wgpu::RenderPass, image: u32) {
        let Some(bound) = &self.groups else { return };
        pass.set_bind_group(1, &bound.tiles[image as usize], &[]);
        pass.set_bind_group(2, &bound.resolve, &[]);
        self.within(pass, image, |part| part);
        for (kind, pipeline) in (1..).zip(&self.pipelines.resolve) {
            pass.set_pipeline(pipeline);
            draw_tiles(pass, image, kind);
        }
    }

    /// Restricts drawing to where the image may be; `level` takes pixels of the screen to those of a level.
    fn within(&self, pass: &mut wgpu::RenderPass, image: u32, level: impl FnOnce([u32; 4]) -> [u32; 4]) {
        if let Some((part, _)) = self.images.get(image as usize) {
            let [left, top, width, height] = level(*part);
            pass.set_scissor_rect(left, top, width, height);
        }
    }

    /// The projected middles of the parts of curtains at each height of chord ends (`Reference` in streaks.wgsl), as the last frame's
    /// camera sees them, by image, part and pole. For tests.
    pub fn references(&self) -> &wgpu::Buffer {
        &self.references.buffer
    }

    /// Strokes of the last frame by image and level, as in [`StrokeCapacities::empty`].
    pub fn draws(&self) -> &wgpu::Buffer {
        &self.draws
    }
}

/// Draws the tiles of an image that are of one kind; as in lit_corners.wgsl.
fn draw_tiles(pass: &mut wgpu::RenderPass, image: u32, kind: u32) {
    let instance = 4 * image + kind;
    pass.draw(0..6 * LIT_TILES[0] * LIT_TILES[1], instance..instance + 1);
}

/// By how many pixels strokes may reach beyond the part of the screen where their middles are.
const EDGE: f64 = 16.0;

/// The pixels of a part of the screen: left, top, width, height.
fn pixels([left, top, right, bottom]: [f64; 4], [width, height]: [u32; 2]) -> [u32; 4] {
    let pixel = |share: f64, edge: f64, side: u32| (share * f64::from(side) + edge).clamp(0.0, f64::from(side)) as u32;
    let (x0, x1) = (pixel(left, -EDGE, width), pixel(right, EDGE, width));
    let (y0, y1) = (pixel(top, -EDGE, height), pixel(bottom, EDGE, height));
    [x0, y0, x1 - x0, y1 - y0]
}
