//! Reduced flashes: the mean brightness of the picture as shown rises no faster than it may. The picture is dimmed where it would.

use std::mem::offset_of;

use wgpu::{BindingResource, BufferUsages, ShaderStages};

use crate::render::gpu::layout::{Slot, bind, buffer, compute, layout};
use crate::render::gpu::shaders::Pass;
use crate::render::gpu::targets::Targets;
use crate::render::gpu::types::Adaptation;
use crate::render::passes::Recording;

/// Workgroups that share the pixels; as in shaders/post_process/flashes.wgsl.
pub const GROUPS: u32 = 256;

/// The passes that measure the mean brightness, and what they keep from frame to frame.
#[derive(Debug)]
pub struct Flashes {
    layout: wgpu::BindGroupLayout,
    sum: wgpu::ComputePipeline,
    settle: wgpu::ComputePipeline,
    sums: wgpu::Buffer,
    /// `Shown` of flashes.wgsl.
    shown: wgpu::Buffer,
    group: Option<wgpu::BindGroup>,
}

impl Flashes {
    /// Compiles the passes.
    pub fn new(device: &wgpu::Device, frame_layout: &wgpu::BindGroupLayout) -> Self {
        let slots = [Slot::Texture, Slot::Sampler, Slot::Texture, Slot::Uniform, Slot::Write, Slot::Write];
        let layout = layout(device, "flashes", ShaderStages::COMPUTE, &slots);
        let pass = |entry| compute(device, "flashes", Pass::Flashes, entry, &[Some(frame_layout), None, Some(&layout)]);
        Flashes {
            sum: pass("sum"),
            settle: pass("settle"),
            sums: buffer(device, "flashes sums", 4 * u64::from(GROUPS), BufferUsages::STORAGE),
            shown: buffer(device, "flashes shown", 8, BufferUsages::STORAGE),
            layout,
            group: None,
        }
    }

    /// Takes up targets of a new size. `adapted` is what tone mapping reads.
    pub fn resize(&mut self, device: &wgpu::Device, targets: &Targets, sampler: &wgpu::Sampler, adapted: &wgpu::Buffer) {
        use BindingResource::{Sampler, TextureView};
        let resources = [
            TextureView(&targets.picture),
            Sampler(sampler),
            TextureView(&targets.bloom[0]),
            adapted.as_entire_binding(),
            self.sums.as_entire_binding(),
            self.shown.as_entire_binding(),
        ];
        self.group = Some(bind(device, "flashes", &self.layout, &resources));
    }

    /// Writes the factor on the picture into `adapted`, once picture, glow and exposure are known.
    pub fn run(&self, recording: &mut Recording, adapted: &wgpu::Buffer) {
        {
            let timestamp_writes = recording.timing.compute(recording.encoder, "flashes");
            let mut pass = recording.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some("flashes"), timestamp_writes });
            pass.set_bind_group(0, recording.frame, &[]);
            pass.set_bind_group(2, &self.group, &[]);
            pass.set_pipeline(&self.sum);
            pass.dispatch_workgroups(GROUPS, 1, 1);
            pass.set_pipeline(&self.settle);
            pass.dispatch_workgroups(1, 1, 1);
        }
        recording.encoder.copy_buffer_to_buffer(&self.shown, 0, adapted, offset_of!(Adaptation, steadied) as u64, 4);
    }
}
