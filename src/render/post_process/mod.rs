//! Post-processing: thin triangles laid over, bloom, exposure, reduced flashes, tone curve, outlines smoothed.

pub mod coverage;
pub mod flashes;
pub mod upscale;

use wgpu::ShaderStages;

use crate::render::Gpu;
use crate::render::geometry::thin::{ThinLists, tiles_layout};
use crate::render::gpu::layout::{HDR_FORMAT, Raster, Slot, bind, buffer, compute, layout, linear_sampler, module, new_texture, raster};
use crate::render::gpu::shaders::Pass;
use crate::render::gpu::targets::{Targets, tiles};
use crate::render::gpu::types::Adaptation;
use crate::render::passes::{Recording, colour};

use flashes::Flashes;

/// The passes after the picture is drawn.
#[derive(Debug)]
pub struct PostProcess {
    thin_layout: wgpu::BindGroupLayout,
    sampled_layout: wgpu::BindGroupLayout,
    meter_layout: wgpu::BindGroupLayout,
    tone_map_layout: wgpu::BindGroupLayout,
    smooth_layout: wgpu::BindGroupLayout,
    compose: wgpu::RenderPipeline,
    down: wgpu::RenderPipeline,
    up: wgpu::RenderPipeline,
    soften: wgpu::RenderPipeline,
    meter: wgpu::ComputePipeline,
    tone_map: wgpu::RenderPipeline,
    outlines_layout: wgpu::BindGroupLayout,
    find_outlines: wgpu::ComputePipeline,
    smooth: wgpu::RenderPipeline,
    output: wgpu::TextureFormat,
    sampler: wgpu::Sampler,
    /// [`Adaptation`] as the exposure pass left it, with the factor on the picture, for the pixels.
    adapted: wgpu::Buffer,
    flashes: Flashes,
    groups: Option<Groups>,
}

#[derive(Debug)]
struct Groups {
    thin: wgpu::BindGroup,
    /// Sampling the picture, each level of the bloom, and what is between two softenings.
    sampled: Vec<wgpu::BindGroup>,
    meter: wgpu::BindGroup,
    tone_map: wgpu::BindGroup,
    /// The picture for the eye before outlines are smoothed; tiles with outlines; the passes that find and smooth them.
    display: wgpu::Texture,
    outlines: wgpu::Buffer,
    find_outlines: wgpu::BindGroup,
    smooth: wgpu::BindGroup,
}

/// How a picture is finished.
#[derive(Clone, Copy, Debug)]
pub struct Finish {
    /// Light is spread by the lens.
    pub blooms: bool,
    /// Outlines of bodies are smoothed.
    pub smooth: bool,
    /// The player's own ship is in the picture.
    pub has_own_ship: bool,
    /// The rise of the mean brightness is bound.
    pub steady: bool,
    /// Width of the picture as a share of what it will be enlarged to: the glow keeps its width there.
    pub resolution: f32,
}

/// What a level of the bloom and all coarser ones have of the glow, beside the next finer one: a halo that falls off, so that what is dark
/// stays dark.
const WIDER: f32 = 0.5;

/// The coarsest of `levels` levels that glows, and what all but the finest have of the glow. `resolution` is that of the finest, as a share
/// of the full picture's. A level of a picture that is drawn smaller is as wide as a coarser one of the full picture: the finest stands for
/// those that are finer, too.
fn glow_levels(levels: usize, resolution: f32) -> (usize, f32) {
    let octaves = -resolution.clamp(1e-3, 1.0).log2();
    let last = levels.saturating_sub(1);
    (last.saturating_sub(octaves as usize).max(1).min(last), WIDER.powf(1.0 + octaves))
}

impl PostProcess {
    /// Compiles the passes for an output of this format, which is to encode sRGB by itself.
    pub fn new(device: &wgpu::Device, frame_layout: &wgpu::BindGroupLayout, output: wgpu::TextureFormat) -> Self {
        let fragment = ShaderStages::FRAGMENT;
        let sampled_layout = layout(device, "sampled", fragment, &[Slot::Texture, Slot::Sampler]);
        let thin_layout = layout(device, "thin", fragment, &[Slot::Numbers, Slot::Numbers]);
        let meter_layout = layout(device, "meter", ShaderStages::COMPUTE, &[Slot::Texture, Slot::Texture, Slot::Write]);
        let tone_map_layout = layout(device, "tone map", fragment, &[Slot::Texture, Slot::Sampler, Slot::Texture, Slot::Uniform]);
        let pass = |label, pass, fragment, layout: &wgpu::BindGroupLayout, format, blend| {
            let shader = module(device, label, pass);
            let stage = Raster { vertex: "vertex", fragment, targets: &[(format, blend)], depth: None };
            raster(device, label, &shader, stage, &[Some(frame_layout), None, Some(layout)])
        };
        let over = wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING;
        // By the constant that the pass is given.
        let (new, old, add) = (wgpu::BlendFactor::Constant, wgpu::BlendFactor::OneMinusConstant, wgpu::BlendOperation::Add);
        let mix = wgpu::BlendComponent { src_factor: new, dst_factor: old, operation: add };
        let mixed = wgpu::BlendState { color: mix, alpha: mix };
        let slots = [Slot::Texture, Slot::Sampler, Slot::Depth, Slot::Read];
        let smooth_layout = layout(device, "smooth", ShaderStages::VERTEX_FRAGMENT, &slots);
        let outlines_layout = layout(device, "outlines", ShaderStages::COMPUTE, &[Slot::Depth, Slot::Write]);
        PostProcess {
            compose: {
                let shader = module(device, "compose", Pass::Compose);
                let stage = Raster { vertex: "vertex", fragment: "fragment", targets: &[(HDR_FORMAT, Some(over))], depth: None };
                let groups = [Some(frame_layout), Some(&tiles_layout(device)), Some(&thin_layout)];
                raster(device, "compose", &shader, stage, &groups)
            },
            down: pass("bloom down", Pass::Bloom, "down", &sampled_layout, HDR_FORMAT, None),
            up: pass("bloom up", Pass::Bloom, "up", &sampled_layout, HDR_FORMAT, Some(mixed)),
            // The same, and nothing to mix it with.
            soften: pass("bloom soften", Pass::Bloom, "up", &sampled_layout, HDR_FORMAT, None),
            meter: compute(device, "meter", Pass::Exposure, "main", &[Some(frame_layout), None, Some(&meter_layout)]),
            tone_map: pass("tone map", Pass::ToneMap, "fragment", &tone_map_layout, output, None),
            find_outlines: compute(device, "outlines", Pass::Outlines, "main", &[Some(frame_layout), None, Some(&outlines_layout)]),
            smooth: pass("smooth", Pass::Smooth, "fragment", &smooth_layout, output, None),
            output,
            sampler: linear_sampler(device),
            flashes: Flashes::new(device, frame_layout),
            adapted: buffer(device, "adapted", size_of::<Adaptation>() as u64, wgpu::BufferUsages::UNIFORM),
            thin_layout,
            sampled_layout,
            meter_layout,
            tone_map_layout,
            smooth_layout,
            outlines_layout,
            groups: None,
        }
    }

    /// Takes up targets of a new size. `adaptation` is what the frame's exposure is kept in.
    pub fn resize(&mut self, gpu: &Gpu, targets: &Targets, adaptation: &wgpu::Buffer) {
        use wgpu::BindingResource::{Sampler, TextureView};
        let device = &gpu.device;
        self.flashes.resize(device, targets, &self.sampler, &self.adapted);
        let display = display(device, targets.size, self.output);
        let outlines = outlines(gpu, targets.size);
        let [finer, coarser] = targets.metered_levels();
        let shown = targets.starless.as_ref().map_or(&targets.picture, |(_, view)| view);
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
                &[TextureView(&targets.bloom[finer]), TextureView(&targets.bloom[coarser]), adaptation.as_entire_binding()],
            ),
            tone_map: bind(
                device,
                "tone map",
                &self.tone_map_layout,
                &[TextureView(shown), Sampler(&self.sampler), TextureView(&targets.bloom[0]), self.adapted.as_entire_binding()],
            ),
            smooth: bind(
                device,
                "smooth",
                &self.smooth_layout,
                &[
                    TextureView(&display.create_view(&Default::default())),
                    Sampler(&self.sampler),
                    TextureView(&targets.depth),
                    outlines.as_entire_binding(),
                ],
            ),
            find_outlines: bind(device, "outlines", &self.outlines_layout, &[TextureView(&targets.depth), outlines.as_entire_binding()]),
            display,
            outlines,
        });
    }

    /// The exposure of the picture, and the factor on it: an [`Adaptation`].
    pub fn adapted(&self) -> &wgpu::Buffer {
        &self.adapted
    }

    /// Lays the thin triangles over the picture, in the tiles that have some.
    pub fn compose(&self, recording: &mut Recording, thin: &ThinLists) {
        let Some(groups) = &self.groups else { return };
        let over = [Some(colour(&recording.targets.picture, false))];
        thin.draw_tiles(&mut begin(recording, ["compose"; 2], &over, &self.compose, &groups.thin));
    }

    /// Bloom, exposure, and the picture into `output`. `adaptation` is what the frame's exposure is kept in. `output` can be copied from.
    pub fn run(&self, recording: &mut Recording, adaptation: &wgpu::Buffer, finish: Finish, output: &wgpu::TextureView) {
        let Some(groups) = &self.groups else { return };
        let targets = recording.targets;
        for (view, level) in targets.bloom.iter().zip(&groups.sampled) {
            begin(recording, ["bloom", "bloom down"], &[Some(colour(view, true))], &self.down, level).draw(0..3, 0..1);
        }
        {
            let timestamp_writes = recording.timing.compute(recording.encoder, "exposure");
            let mut pass = recording.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some("exposure"), timestamp_writes });
            pass.set_pipeline(&self.meter);
            pass.set_bind_group(0, recording.frame, &[]);
            pass.set_bind_group(2, &groups.meter, &[]);
            pass.dispatch_workgroups(1, 1, 1);
        }
        recording.encoder.copy_buffer_to_buffer(adaptation, 0, &self.adapted, 0, size_of::<Adaptation>() as u64);
        if finish.blooms {
            self.mix_levels(recording, groups, finish.resolution);
        }
        if finish.steady {
            self.flashes.run(recording, &self.adapted);
        }
        begin(recording, ["tone map"; 2], &[Some(colour(output, true))], &self.tone_map, &groups.tone_map).draw(0..3, 0..1);
        if finish.smooth {
            self.smooth(recording, groups, output);
        }
    }

    /// Mixes the levels of the bloom into the finest.
    fn mix_levels(&self, recording: &mut Recording, groups: &Groups, resolution: f32) {
        let targets = recording.targets;
        let finest = 4.0 * targets.bloom[0].texture().width() as f32 / targets.size[0] as f32;
        let (coarsest, first) = glow_levels(targets.bloom.len(), resolution * finest);
        for level in (1..coarsest + 1).rev() {
            let (from, to) = (&groups.sampled[level + 1], &[Some(colour(&targets.bloom[level - 1], false))]);
            let mut pass = begin(recording, ["bloom", "bloom up"], to, &self.up, from);
            let share = f64::from(if level == 1 { first } else { WIDER });
            pass.set_blend_constant(wgpu::Color { r: share, g: share, b: share, a: share });
            pass.draw(0..3, 0..1);
        }
        // Down the levels and up again.
        let last = targets.bloom.len() + 1;
        for (from, to) in [(1, &targets.glow), (last, &targets.bloom[0])] {
            let (from, to) = (&groups.sampled[from], &[Some(colour(to, true))]);
            begin(recording, ["bloom", "bloom soften"], to, &self.soften, from).draw(0..3, 0..1);
        }
    }

    /// Smooths outlines of bodies in the finished picture, in the tiles that have some.
    fn smooth(&self, recording: &mut Recording, groups: &Groups, output: &wgpu::TextureView) {
        let size = recording.targets.size;
        recording.encoder.clear_buffer(&groups.outlines, 4, Some(4));
        {
            let timestamp_writes = recording.timing.compute(recording.encoder, "smooth");
            let mut pass = recording.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some("outlines"), timestamp_writes });
            pass.set_pipeline(&self.find_outlines);
            pass.set_bind_group(0, recording.frame, &[]);
            pass.set_bind_group(2, &groups.find_outlines, &[]);
            pass.dispatch_workgroups(tiles(size).div_ceil(64), 1, 1);
        }
        // A copy of the picture is read while it is drawn over.
        let extent = wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 };
        recording.encoder.copy_texture_to_texture(output.texture().as_image_copy(), groups.display.as_image_copy(), extent);
        let onto = &[Some(colour(output, false))];
        begin(recording, ["smooth"; 2], onto, &self.smooth, &groups.smooth).draw_indirect(&groups.outlines, 0);
    }
}

/// `Outlines` of outlines.wgsl for a picture of `size` pixels: the arguments of a draw of no tiles, and room for all of them.
fn outlines(gpu: &Gpu, size: [u32; 2]) -> wgpu::Buffer {
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT;
    let outlines = buffer(&gpu.device, "outlines", 16 + 4 * u64::from(tiles(size)), usage);
    gpu.queue.write_buffer(&outlines, 0, bytemuck::cast_slice(&[6u32, 0, 0, 0]));
    outlines
}

/// A texture that the finished picture is copied into.
fn display(device: &wgpu::Device, size: [u32; 2], format: wgpu::TextureFormat) -> wgpu::Texture {
    new_texture(device, "display", size, [1, 1], format, wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST)
}

/// Begins a pass that draws to `targets`, with everything set but its triangles: most passes have one, over the whole picture. It is timed
/// under the first name.
fn begin<'r>(
    recording: &'r mut Recording,
    [timed, label]: [&'static str; 2],
    targets: &[Option<wgpu::RenderPassColorAttachment>],
    pipeline: &wgpu::RenderPipeline,
    group: &wgpu::BindGroup,
) -> wgpu::RenderPass<'r> {
    let timestamp_writes = recording.timing.render(recording.encoder, timed);
    let mut pass = recording.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: targets,
        timestamp_writes,
        ..Default::default()
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, recording.frame, &[]);
    pass.set_bind_group(2, group, &[]);
    pass
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What each level has of the glow.
    fn shares(levels: usize, resolution: f32) -> Vec<f32> {
        let (coarsest, first) = glow_levels(levels, resolution);
        let mut left = 1.0;
        let mut shares = Vec::new();
        for level in 0..=coarsest {
            let coarser = if level == coarsest {
                0.0
            } else if level == 0 {
                first
            } else {
                WIDER
            };
            shares.push(left * (1.0 - coarser));
            left *= coarser;
        }
        shares
    }

    #[test]
    fn at_half_the_resolution_the_finest_level_glows_for_two() {
        let (full, half) = (shares(5, 1.0), shares(5, 0.5));
        assert_eq!(full, [0.5, 0.25, 0.125, 0.0625, 0.0625]);
        assert_eq!(half, [full[0] + full[1], full[2], full[3], full[4]]);
        assert_eq!(shares(5, 0.25), [0.875, 0.0625, 0.0625]);
        assert_eq!(shares(1, 0.25), [1.0]);
        assert!((shares(3, 0.7).iter().sum::<f32>() - 1.0).abs() < 1e-6);
    }
}
