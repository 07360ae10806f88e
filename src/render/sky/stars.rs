//! Stars: projected in compute, both orders, drawn as spots.

use crate::render::Gpu;
use crate::render::frame::{BLACKBODY_COLDEST, BLACKBODY_HOTTEST};
use crate::render::gpu::layout::{HDR_FORMAT, Raster, Slot, TableTexture, bind, buffer, compute, layout, module, raster, storage};
use crate::render::gpu::shaders::Pass;
use crate::render::gpu::types::{STAR_ORDERS, Star};
use crate::scene::blackbody;

use crate::render::sky::clusters::clusters;

/// Bytes of `SeenStar` in WGSL.
const SEEN_STAR_BYTES: u64 = 32;

/// The catalogue on the GPU and the passes over it.
#[derive(Debug)]
pub struct Stars {
    clusters: u32,
    cull: wgpu::ComputePipeline,
    cull_group: wgpu::BindGroup,
    /// Arguments of the dispatch over the clusters that are kept, and how many they are.
    groups: wgpu::Buffer,
    project: wgpu::ComputePipeline,
    project_group: wgpu::BindGroup,
    seen: wgpu::Buffer,
    draw: wgpu::RenderPipeline,
    /// The same where all else is drawn, dimmed by what covers the sky.
    add: wgpu::RenderPipeline,
    draw_group: wgpu::BindGroup,
    arguments: wgpu::Buffer,
    /// Whether any may be drawn in this frame.
    shown: bool,
}

/// Adds light of this share to this share of what is there, whose alpha stays.
pub fn onto(src_factor: wgpu::BlendFactor, dst_factor: wgpu::BlendFactor) -> wgpu::BlendState {
    let (zero, one, operation) = (wgpu::BlendFactor::Zero, wgpu::BlendFactor::One, wgpu::BlendOperation::Add);
    wgpu::BlendState {
        color: wgpu::BlendComponent { src_factor, dst_factor, operation },
        alpha: wgpu::BlendComponent { src_factor: zero, dst_factor: one, operation },
    }
}

/// The layout of the stars that are seen: group 1 of the passes that draw them.
pub fn seen_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    layout(device, "stars draw", wgpu::ShaderStages::VERTEX, &[Slot::Read])
}

impl Stars {
    /// Uploads the catalogue, in the order of its clusters. `table` is [`blackbody_table`](crate::render::frame::blackbody_table).
    pub fn new(gpu: &Gpu, frame_layout: &wgpu::BindGroupLayout, stars: &[Star], table: &[[f32; 4]]) -> Self {
        use wgpu::{BufferUsages, ShaderStages};
        let device = &gpu.device;
        let (clusters, mut stars) = clusters(stars);
        for star in &mut stars {
            let rgb = blackbody::lookup(table, BLACKBODY_COLDEST, BLACKBODY_HOTTEST, star.temperature);
            star.luminance = blackbody::luminance(rgb.map(f64::from)) as f32;
        }
        let catalogue = storage(gpu, "stars", &stars);
        let mut cluster_table = TableTexture::new(device, "star clusters", false);
        cluster_table.write(gpu, &clusters);
        let listed = buffer(device, "listed clusters", 4 * clusters.len() as u64 * u64::from(STAR_ORDERS), BufferUsages::STORAGE);
        let seen = buffer(device, "seen stars", SEEN_STAR_BYTES * stars.len() as u64 * u64::from(STAR_ORDERS), BufferUsages::STORAGE);
        let [groups, arguments] =
            ["star groups", "star draw"].map(|label| buffer(device, label, 16, BufferUsages::STORAGE | BufferUsages::INDIRECT));
        let stage = |label, pass, slots: &[Slot], buffers: &[&wgpu::Buffer]| {
            let layout = layout(device, label, ShaderStages::COMPUTE, slots);
            let buffers = buffers.iter().map(|buffer| buffer.as_entire_binding());
            let resources: Vec<_> = std::iter::once(cluster_table.binding()).chain(buffers).collect();
            (compute(device, label, pass, "main", &[Some(frame_layout), Some(&layout)]), bind(device, label, &layout, &resources))
        };
        let slots = [Slot::Numbers, Slot::Write, Slot::Write];
        let (cull, cull_group) = stage("stars cull", Pass::StarsCull, &slots, &[&listed, &groups]);
        let slots = [Slot::Numbers, Slot::Read, Slot::Read, Slot::Read, Slot::Write, Slot::Write];
        let buffers = [&listed, &groups, &catalogue, &seen, &arguments];
        let (project, project_group) = stage("stars project", Pass::StarsProject, &slots, &buffers);
        let draw_layout = seen_layout(device);
        let draw_group = bind(device, "stars draw", &draw_layout, &[seen.as_entire_binding()]);
        let shader = module(device, "stars draw", Pass::StarsDraw);
        let pipeline = |label, src_factor, depth| {
            let blend = onto(src_factor, wgpu::BlendFactor::One);
            let stage = Raster { vertex: "vertex", fragment: "fragment", targets: &[(HDR_FORMAT, Some(blend))], depth };
            raster(device, label, &shader, stage, &[Some(frame_layout), Some(&draw_layout)])
        };
        let draw = pipeline("stars draw", wgpu::BlendFactor::One, Some(false));
        let add = pipeline("stars add", wgpu::BlendFactor::OneMinusDstAlpha, None);
        let clusters = clusters.len() as u32;
        Stars { clusters, cull, cull_group, groups, project, project_group, seen, draw, add, draw_group, arguments, shown: false }
    }

    /// Empties the lists, before [`Stars::project`]; `shown` is whether this frame has stars.
    pub fn prepare(&mut self, gpu: &Gpu, shown: bool) {
        self.shown = shown && self.clusters > 0;
        gpu.queue.write_buffer(&self.groups, 0, bytemuck::cast_slice(&[0u32, 1, 1, 0]));
        gpu.queue.write_buffer(&self.arguments, 0, bytemuck::cast_slice(&[0u32, 1, 0, 0]));
    }

    /// Lists the clusters that may be on the screen, and projects their stars.
    pub fn project(&self, pass: &mut wgpu::ComputePass) {
        if !self.shown {
            return;
        }
        pass.set_pipeline(&self.cull);
        pass.set_bind_group(1, &self.cull_group, &[]);
        pass.dispatch_workgroups(self.clusters.div_ceil(64), 1, 1);
        pass.set_pipeline(&self.project);
        pass.set_bind_group(1, &self.project_group, &[]);
        pass.dispatch_workgroups_indirect(&self.groups, 0);
    }

    /// For tests that read them: arguments of the dispatch over the clusters that are kept and how many they are, the stars seen, and the
    /// arguments of their draw.
    pub fn lists(&self) -> [&wgpu::Buffer; 3] {
        [&self.groups, &self.seen, &self.arguments]
    }

    /// Draws those that are seen, behind what has depth.
    pub fn draw(&self, pass: &mut wgpu::RenderPass) {
        pass.set_pipeline(&self.draw);
        self.draw_by(pass);
    }

    /// Adds those that are seen to a picture in which all else is drawn.
    pub fn add(&self, pass: &mut wgpu::RenderPass) {
        pass.set_pipeline(&self.add);
        self.draw_by(pass);
    }

    /// Draws those that are seen, by the pipeline that is set.
    pub fn draw_by(&self, pass: &mut wgpu::RenderPass) {
        pass.set_bind_group(1, &self.draw_group, &[]);
        pass.draw_indirect(&self.arguments, 0);
    }
}
