//! A picture that was drawn smaller than the output, enlarged to it: `shaders/post_process/upscale.wgsl`. Two things are as in a picture
//! of the full size: the outline of the own ship (`own_outline.wgsl`), and stars, which are laid over it (`shaders/sky/stars_over.wgsl`).

use wgpu::BindingResource::TextureView;
use wgpu::ShaderStages;

use crate::render::geometry::Geometry;
use crate::render::gpu::layout::{MASK_FORMAT, Raster, Slot, bind, layout, linear_sampler, module, raster};
use crate::render::gpu::shaders::Pass;
use crate::render::gpu::targets::{Targets, target};
use crate::render::passes::{Recording, colour};
use crate::render::post_process::begin;
use crate::render::sky::{Stars, onto, seen_layout};

/// The passes that enlarge, for an output of one format.
#[derive(Debug)]
pub struct Upscale {
    layout: wgpu::BindGroupLayout,
    rows: wgpu::RenderPipeline,
    columns: wgpu::RenderPipeline,
    outline_layout: wgpu::BindGroupLayout,
    outline: wgpu::RenderPipeline,
    sampler: wgpu::Sampler,
    stars_layout: wgpu::BindGroupLayout,
    stars: wgpu::RenderPipeline,
    format: wgpu::TextureFormat,
    targets: Option<UpscaleTargets>,
}

/// What they read and write, for one pair of sizes.
#[derive(Debug)]
struct UpscaleTargets {
    sizes: [[u32; 2]; 2],
    drawn: wgpu::TextureView,
    wide: wgpu::TextureView,
    groups: [wgpu::BindGroup; 2],
    /// Where the own ship is, in pixels of the output.
    mask: wgpu::TextureView,
    outline_group: wgpu::BindGroup,
    stars_group: wgpu::BindGroup,
}

/// The size of the picture that is drawn for an output of this size, in pixels. `resolution`: its share of the width and height.
pub fn drawn_size(output: [u32; 2], resolution: f32) -> [u32; 2] {
    output.map(|side| ((side as f32 * resolution).round() as u32).clamp(1, side.max(1)))
}

impl Upscale {
    /// Compiles the passes.
    pub fn new(device: &wgpu::Device, frame_layout: &wgpu::BindGroupLayout, format: wgpu::TextureFormat) -> Self {
        let layout = layout(device, "upscale", ShaderStages::FRAGMENT, &[Slot::Texture]);
        let shader = module(device, "upscale", Pass::Upscale);
        let pass = |label, fragment| {
            let stage = Raster { vertex: "vertex", fragment, targets: &[(format, None)], depth: None };
            raster(device, label, &shader, stage, &[Some(frame_layout), None, Some(&layout)])
        };
        let outline_layout = self::layout(device, "own outline", ShaderStages::FRAGMENT, &[Slot::Texture, Slot::Texture, Slot::Sampler]);
        let stage = Raster { vertex: "vertex", fragment: "fragment", targets: &[(format, None)], depth: None };
        let shader = module(device, "own outline", Pass::OwnOutline);
        let outline = raster(device, "own outline", &shader, stage, &[Some(frame_layout), None, Some(&outline_layout)]);
        let sampler = linear_sampler(device);
        let stars_layout = self::layout(device, "stars over", ShaderStages::VERTEX_FRAGMENT, &[Slot::Numbers, Slot::Uniform]);
        let blend = onto(wgpu::BlendFactor::One, wgpu::BlendFactor::OneMinusSrcAlpha);
        let stage = Raster { vertex: "vertex", fragment: "fragment", targets: &[(format, Some(blend))], depth: None };
        let groups = [Some(frame_layout), Some(&seen_layout(device)), Some(&stars_layout)];
        let stars = raster(device, "stars over", &module(device, "stars over", Pass::StarsOver), stage, &groups);
        let [rows, columns] = [pass("upscale rows", "rows"), pass("upscale columns", "columns")];
        Upscale { rows, columns, outline_layout, outline, sampler, stars_layout, stars, layout, format, targets: None }
    }

    /// Takes up targets of a new size. `adapted` is the exposure of the picture.
    pub fn resize(&mut self, device: &wgpu::Device, targets: &Targets, adapted: &wgpu::Buffer) {
        let [drawn, output] = [targets.size, targets.output];
        if drawn == output {
            self.targets = None;
        } else if self.targets.as_ref().is_none_or(|own| own.sizes != [drawn, output]) {
            let [small, wide] =
                [("drawn", drawn), ("wide", [output[0], drawn[1]])].map(|(label, size)| target(device, label, size, self.format).1);
            let mask = target(device, "own ship", output, MASK_FORMAT).1;
            let masked = [TextureView(&small), TextureView(&mask), wgpu::BindingResource::Sampler(&self.sampler)];
            let outline_group = bind(device, "own outline", &self.outline_layout, &masked);
            let group = |view| bind(device, "upscale", &self.layout, &[TextureView(view)]);
            let seen = [TextureView(&targets.picture), adapted.as_entire_binding()];
            let stars_group = bind(device, "stars over", &self.stars_layout, &seen);
            let groups = [group(&small), group(&wide)];
            self.targets = Some(UpscaleTargets { sizes: [drawn, output], groups, mask, outline_group, stars_group, drawn: small, wide });
        }
    }

    /// Where the picture is to be drawn; None where the output itself is as large.
    pub fn drawn(&self) -> Option<&wgpu::TextureView> {
        self.targets.as_ref().map(|targets| &targets.drawn)
    }

    /// Enlarges what was drawn, into `output`, sharpens the outline of the own ship, if there is one, and lays stars over it; nothing where
    /// that is as large.
    pub fn run(&self, recording: &mut Recording, own_ship: Option<&Geometry>, stars: &Stars, output: &wgpu::TextureView) {
        let Some(targets) = &self.targets else { return };
        for (pipeline, group, to) in [(&self.rows, &targets.groups[0], &targets.wide), (&self.columns, &targets.groups[1], output)] {
            begin(recording, ["upscale"; 2], &[Some(colour(to, true))], pipeline, group).draw(0..3, 0..1);
        }
        let over = &[Some(colour(output, false))];
        if let Some(geometry) = own_ship {
            {
                let timestamp_writes = recording.timing.render(recording.encoder, "own outline");
                let mut pass = recording.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some("own ship"),
                    color_attachments: &[Some(colour(&targets.mask, true))],
                    timestamp_writes,
                    ..Default::default()
                });
                pass.set_bind_group(0, recording.frame, &[]);
                geometry.draw_own(&mut pass);
            }
            begin(recording, ["own outline"; 2], over, &self.outline, &targets.outline_group).draw(0..6, 0..1);
        }
        stars.draw_by(&mut begin(recording, ["stars over"; 2], over, &self.stars, &targets.stars_group));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_of_a_size_is_a_size() {
        assert_eq!(drawn_size([1280, 720], 0.5), [640, 360]);
        assert_eq!(drawn_size([1280, 720], 1.0), [1280, 720]);
        assert_eq!(drawn_size([1, 3], 0.25), [1, 1]);
        assert_eq!(drawn_size([1280, 720], 2.0), [1280, 720]);
    }
}
