//! The stage that places what is held: its pipelines, and what it reads (`shaders/geometry/place.wgsl`).

use wgpu::{BufferUsages, ShaderStages};

use crate::render::Gpu;
use crate::render::geometry::pipelines::{PipelineCache, PipelineInputs, Side};
use crate::render::gpu::layout::{Growing, Slot, bind, buffer, compute_of, layout};
use crate::render::gpu::shaders::Pass;
use crate::render::gpu::types::{CHUNK, HeldFrame};
use crate::render::instances::held::{HeldBodies, HeldCount};

/// Groups along the first dimension of its dispatch (65,535 is the limit).
const GROUPS: u32 = 32_768;

/// What is held, on the card.
#[derive(Debug)]
pub(super) struct Placing {
    layout: wgpu::BindGroupLayout,
    /// None until a scene holds something.
    pipelines: Option<PipelineCache<PlacePipelines>>,
    bodies: Growing,
    models: Growing,
    frame: wgpu::Buffer,
    count: HeldCount,
    group: Option<wgpu::BindGroup>,
}

#[derive(Debug)]
struct PlacePipelines {
    main: wgpu::ComputePipeline,
    finish: wgpu::ComputePipeline,
}

impl PlacePipelines {
    fn new(inputs: &PipelineInputs, (method, inside): Side) -> PlacePipelines {
        let stage = |entry| {
            let module = Pass::Place.shader_along(inputs.worldlines, method, inside);
            compute_of(&inputs.device, "place", module, entry, &[Some(&inputs.frame), Some(&inputs.geometry)])
        };
        PlacePipelines { main: stage("main"), finish: stage("finish") }
    }
}

impl Placing {
    /// Of nothing.
    pub fn new(device: &wgpu::Device) -> Placing {
        use Slot::{Read, Write, WritePairs, WriteWords};
        let slots = [Read, Read, Read, Write, Write, WriteWords, WritePairs, WritePairs, WritePairs];
        Placing {
            layout: layout(device, "place", ShaderStages::COMPUTE, &slots),
            pipelines: None,
            bodies: Growing::new(device, "held bodies", BufferUsages::STORAGE),
            models: Growing::new(device, "models of held bodies", BufferUsages::STORAGE),
            frame: buffer(device, "frame of held bodies", size_of::<HeldFrame>() as u64, BufferUsages::STORAGE),
            count: HeldCount::default(),
            group: None,
        }
    }

    /// Takes what a scene holds in place of what was held. `inputs` are those of the other stages, on the side that they are used on.
    pub fn set(&mut self, gpu: &Gpu, held: &HeldBodies, inputs: &PipelineInputs, side: Side) {
        self.count = held.count();
        self.group = None;
        if held.bodies().is_empty() {
            return;
        }
        self.bodies.write(gpu, held.bodies());
        self.models.write(gpu, held.models());
        if self.pipelines.is_none() {
            let inputs = PipelineInputs { geometry: self.layout.clone(), ..inputs.clone() };
            self.pipelines = Some(PipelineCache::new(inputs, PlacePipelines::new, side));
        }
    }

    /// How much is held.
    pub fn count(&self) -> HeldCount {
        self.count
    }

    /// Uses the pipelines of this side from now on, once something was held.
    pub fn choose(&mut self, side: Side) {
        self.pipelines.iter_mut().for_each(|pipelines| pipelines.choose(side));
    }

    /// This side will be needed: compiles it in the background.
    pub fn precompile(&mut self, side: Side) {
        self.pipelines.iter_mut().for_each(|pipelines| pipelines.precompile(side));
    }

    /// Writes what a frame asks for.
    pub fn write(&self, gpu: &Gpu, frame: &HeldFrame) {
        gpu.queue.write_buffer(&self.frame, 0, bytemuck::bytes_of(frame));
    }

    /// Makes the bind group: counters and arguments, then the tables of instances and chunks.
    pub fn bind(&mut self, device: &wgpu::Device, buffers: [&wgpu::Buffer; 2], tables: [wgpu::BindingResource; 4]) {
        if self.pipelines.is_none() {
            return;
        }
        let own = [&self.frame, &self.bodies.buffer, &self.models.buffer].into_iter().chain(buffers);
        let resources: Vec<_> = own.map(|buffer| buffer.as_entire_binding()).chain(tables).collect();
        self.group = Some(bind(device, "place", &self.layout, &resources));
    }

    /// Places the images of a frame.
    pub fn run(&self, pass: &mut wgpu::ComputePass, frame: &HeldFrame) {
        let (Some(pipelines), Some(group)) = (&self.pipelines, &self.group) else { return };
        let groups = (frame.bodies * frame.images).div_ceil(CHUNK);
        pass.set_bind_group(1, group, &[]);
        pass.set_pipeline(&pipelines.now().main);
        pass.dispatch_workgroups(groups.min(GROUPS), groups.div_ceil(GROUPS), 1);
        pass.set_pipeline(&pipelines.now().finish);
        pass.dispatch_workgroups(1, 1, 1);
    }
}
