//! Development: thin triangles laid over, bloom, exposure, tone curve, outlines smoothed.

pub mod coverage;

use wgpu::ShaderStages;

use super::Gpu;
use super::layout::{HDR_FORMAT, Raster, Slot, bind, buffer, compute, layout, module, raster};
use super::shaders::Pass;
use super::targets::{Targets, target};
use super::timing::Timing;

/// Pixels along the side of a tile in which outlines are smoothed; as in shaders/develop/smooth.wgsl.
const TILE: u32 = 16;

/// The passes after the picture is drawn.
#[derive(Debug)]
pub struct Develop {
    thin_layout: wgpu::BindGroupLayout,
    sampled_layout: wgpu::BindGroupLayout,
    meter_layout: wgpu::BindGroupLayout,
    develop_layout: wgpu::BindGroupLayout,
    smooth_layout: wgpu::BindGroupLayout,
    compose: wgpu::RenderPipeline,
    down: wgpu::RenderPipeline,
    up: wgpu::RenderPipeline,
    soften: wgpu::RenderPipeline,
    meter: wgpu::ComputePipeline,
    develop: wgpu::RenderPipeline,
    develop_twice: wgpu::RenderPipeline,
    smooth: wgpu::RenderPipeline,
    output: wgpu::TextureFormat,
    sampler: wgpu::Sampler,
    /// What the exposure pass chose, for the pixels.
    adapted: wgpu::Buffer,
    groups: Option<Groups>,
}

#[derive(Debug)]
struct Groups {
    thin: wgpu::BindGroup,
    /// Sampling the picture, each level of the bloom, and what is between two softenings.
    sampled: Vec<wgpu::BindGroup>,
    meter: wgpu::BindGroup,
    develop: wgpu::BindGroup,
    /// The picture for the eye before outlines are smoothed, and the pass that does it.
    developed: wgpu::TextureView,
    smooth: wgpu::BindGroup,
}

impl Develop {
    /// Compiles the passes for an output of this format, which is to encode sRGB by itself.
    pub fn new(device: &wgpu::Device, frame_layout: &wgpu::BindGroupLayout, output: wgpu::TextureFormat) -> Self {
        let fragment = ShaderStages::FRAGMENT;
        let sampled_layout = layout(device, "sampled", fragment, &[Slot::Texture, Slot::Sampler]);
        let thin_layout = layout(device, "thin", fragment, &[Slot::Texture, Slot::Texture]);
        let meter_layout = layout(device, "meter", ShaderStages::COMPUTE, &[Slot::Texture, Slot::Write]);
        let develop_layout = layout(device, "develop", fragment, &[Slot::Texture, Slot::Sampler, Slot::Texture, Slot::Uniform]);
        let pass = |label, pass, fragment, layout: &wgpu::BindGroupLayout, format, blend| {
            let shader = module(device, label, pass);
            let stage = Raster { vertex: "vertex", fragment, targets: &[(format, blend)], depth: None };
            raster(device, label, &shader, stage, &[Some(frame_layout), None, Some(layout)])
        };
        let over = wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING;
        let mixed = wgpu::BlendState::ALPHA_BLENDING;
        let smooth_layout = layout(device, "smooth", ShaderStages::VERTEX_FRAGMENT, &[Slot::Texture, Slot::Sampler, Slot::Depth]);
        Develop {
            compose: pass("compose", Pass::Compose, "fragment", &thin_layout, HDR_FORMAT, Some(over)),
            down: pass("bloom down", Pass::Bloom, "down", &sampled_layout, HDR_FORMAT, None),
            up: pass("bloom up", Pass::Bloom, "up", &sampled_layout, HDR_FORMAT, Some(mixed)),
            // The same, and nothing to mix it with.
            soften: pass("bloom soften", Pass::Bloom, "up", &sampled_layout, HDR_FORMAT, None),
            meter: compute(device, "meter", Pass::Exposure, "main", &[Some(frame_layout), None, Some(&meter_layout)]),
            develop: pass("develop", Pass::Develop, "fragment", &develop_layout, output, None),
            develop_twice: {
                let shader = module(device, "develop", Pass::Develop);
                let stage = Raster { vertex: "vertex", fragment: "twice", targets: &[(output, None), (output, None)], depth: None };
                raster(device, "develop", &shader, stage, &[Some(frame_layout), None, Some(&develop_layout)])
            },
            smooth: pass("smooth", Pass::Smooth, "fragment", &smooth_layout, output, None),
            output,
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("linear"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
            adapted: buffer(device, "adapted", 16, wgpu::BufferUsages::UNIFORM),
            thin_layout,
            sampled_layout,
            meter_layout,
            develop_layout,
            smooth_layout,
            groups: None,
        }
    }

    /// Takes up targets of a new size. `adaptation` is what the frame's exposure is kept in.
    pub fn resize(&mut self, gpu: &Gpu, targets: &Targets, adaptation: &wgpu::Buffer) {
        use wgpu::BindingResource::{Sampler, TextureView};
        let device = &gpu.device;
        let (_, developed) = target(device, "developed", targets.size, self.output);
        let views = std::iter::once(&targets.picture).chain(&targets.bloom).chain([&targets.glow]);
        self.groups = Some(Groups {
            thin: bind(device, "thin", &self.thin_layout, &[TextureView(&targets.thin), TextureView(&targets.thin_signed)]),
            sampled: views
                .map(|view| bind(device, "sampled", &self.sampled_layout, &[TextureView(view), Sampler(&self.sampler)]))
                .collect(),
            meter: bind(
                device,
                "meter",
                &self.meter_layout,
                &[TextureView(&targets.bloom[targets.meter_level()]), adaptation.as_entire_binding()],
            ),
            develop: bind(
                device,
                "develop",
                &self.develop_layout,
                &[TextureView(&targets.picture), Sampler(&self.sampler), TextureView(&targets.bloom[0]), self.adapted.as_entire_binding()],
            ),
            smooth: bind(
                device,
                "smooth",
                &self.smooth_layout,
                &[TextureView(&developed), Sampler(&self.sampler), TextureView(&targets.depth)],
            ),
            developed,
        });
    }

    /// Lays the thin triangles over the picture.
    pub fn compose(&self, encoder: &mut wgpu::CommandEncoder, timing: &mut Timing, frame: &wgpu::BindGroup, targets: &Targets) {
        let Some(groups) = &self.groups else { return };
        screen(encoder, timing.render("compose"), "compose", &targets.picture, false, &self.compose, frame, &groups.thin);
    }

    /// Bloom, exposure, and the picture into `output`, with smooth outlines of bodies if they are asked for. `adaptation` is what the frame's exposure
    /// is kept in.
    #[allow(clippy::too_many_arguments, reason = "one call says all that development is")]
    pub fn run(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        timing: &mut Timing,
        frame: &wgpu::BindGroup,
        targets: &Targets,
        adaptation: &wgpu::Buffer,
        smooth: bool,
        output: &wgpu::TextureView,
    ) {
        let Some(groups) = &self.groups else { return };
        for (level, view) in targets.bloom.iter().enumerate() {
            screen(encoder, timing.render("bloom"), "bloom down", view, true, &self.down, frame, &groups.sampled[level]);
        }
        {
            let mut pass = encoder
                .begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some("exposure"), timestamp_writes: timing.compute("exposure") });
            pass.set_pipeline(&self.meter);
            pass.set_bind_group(0, frame, &[]);
            pass.set_bind_group(2, &groups.meter, &[]);
            pass.dispatch_workgroups(1, 1, 1);
        }
        encoder.copy_buffer_to_buffer(adaptation, 0, &self.adapted, 0, 16);
        for level in (1..targets.bloom.len()).rev() {
            screen(
                encoder,
                timing.render("bloom"),
                "bloom up",
                &targets.bloom[level - 1],
                false,
                &self.up,
                frame,
                &groups.sampled[level + 1],
            );
        }
        // There and back.
        let last = targets.bloom.len() + 1;
        for (from, to) in [(1, &targets.glow), (last, &targets.bloom[0])] {
            screen(encoder, timing.render("bloom"), "bloom soften", to, true, &self.soften, frame, &groups.sampled[from]);
        }
        if !smooth {
            screen(encoder, timing.render("develop"), "develop", output, true, &self.develop, frame, &groups.develop);
            return;
        }
        let attachment = |view, load| {
            let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
            Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
        };
        let fresh = wgpu::LoadOp::Clear(wgpu::Color::BLACK);
        let mut draw = |label, attachments: &[_], pipeline, group, corners, instances| {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(label),
                color_attachments: attachments,
                timestamp_writes: timing.render(label),
                ..Default::default()
            });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, frame, &[]);
            pass.set_bind_group(2, group, &[]);
            pass.draw(0..corners, 0..instances);
        };
        draw("develop", &[attachment(output, fresh), attachment(&groups.developed, fresh)], &self.develop_twice, &groups.develop, 3, 1);
        let tiles = targets.size.map(|side| side.div_ceil(TILE)).iter().product();
        draw("smooth", &[attachment(output, wgpu::LoadOp::Load)], &self.smooth, &groups.smooth, 6, tiles);
    }
}

/// One triangle over the whole of `view`.
#[allow(clippy::too_many_arguments, reason = "one call says all that a pass is")]
fn screen(
    encoder: &mut wgpu::CommandEncoder,
    timestamps: Option<wgpu::RenderPassTimestampWrites>,
    label: &str,
    view: &wgpu::TextureView,
    fresh: bool,
    pipeline: &wgpu::RenderPipeline,
    frame: &wgpu::BindGroup,
    group: &wgpu::BindGroup,
) {
    let load = if fresh { wgpu::LoadOp::Clear(wgpu::Color::BLACK) } else { wgpu::LoadOp::Load };
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
        })],
        timestamp_writes: timestamps,
        ..Default::default()
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, frame, &[]);
    pass.set_bind_group(2, group, &[]);
    pass.draw(0..3, 0..1);
}
