//! What the passes of the aurora are bound to, and their pipelines.

use wgpu::ShaderStages;

use crate::render::aurora::levels::light_format;
use crate::render::gpu::layout::{HDR_FORMAT, Raster, Slot, compute, layout, module, raster};
use crate::render::gpu::shaders::Pass;

/// Layouts of the groups that passes bind, besides the frame's.
#[derive(Debug)]
pub(super) struct Layouts {
    /// Of the compute passes.
    pub walk: wgpu::BindGroupLayout,
    /// Of strokes.
    pub draw: wgpu::BindGroupLayout,
    /// Of a level and the next coarser.
    pub spread: wgpu::BindGroupLayout,
    /// Of one image's tiles.
    pub tiles: wgpu::BindGroupLayout,
    /// Of the light as it is added up.
    pub resolve: wgpu::BindGroupLayout,
}

impl Layouts {
    /// All of them.
    pub fn new(device: &wgpu::Device) -> Layouts {
        use Slot::{Read, Uniform, Write};
        let walk = [Uniform, Read, Read, Read, Read, Write, Write, Write, Write, Slot::Numbers];
        Layouts {
            walk: layout(device, "aurora walk", ShaderStages::COMPUTE, &walk),
            draw: layout(device, "aurora strokes", ShaderStages::VERTEX, &[Uniform, Read]),
            spread: layout(device, "aurora spread", ShaderStages::VERTEX_FRAGMENT, &[Slot::Texture, Slot::Sampler, Read]),
            tiles: layout(device, "aurora tiles", ShaderStages::VERTEX, &[Uniform, Read]),
            resolve: layout(device, "aurora resolve", ShaderStages::FRAGMENT, &[Slot::Numbers, Slot::Texture, Slot::Sampler]),
        }
    }
}

/// The passes, compiled.
#[derive(Debug)]
pub(super) struct Pipelines {
    /// Projects the middles of the parts of curtains through the lensing lookup.
    pub project: wgpu::ComputePipeline,
    /// From there to the ends of chords.
    pub ends: wgpu::ComputePipeline,
    /// Walks along the chords and makes strokes.
    pub walk: wgpu::ComputePipeline,
    /// Draws strokes into the finest level, with depth test, and into the others.
    pub draw: [wgpu::RenderPipeline; 2],
    /// From a level into the next finer.
    pub spread: wgpu::RenderPipeline,
    /// Clears the tiles of the finest level that get light.
    pub wipe: wgpu::RenderPipeline,
    /// Three pipelines, for tiles with light in the finest level alone, in coarser ones alone, in both.
    pub resolve: [wgpu::RenderPipeline; 3],
}

impl Pipelines {
    /// Compiles them.
    pub fn new(device: &wgpu::Device, frame_layout: &wgpu::BindGroupLayout, layouts: &Layouts) -> Pipelines {
        let one = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::One,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        let sum = Some(wgpu::BlendState { color: one, alpha: one });
        let light = light_format(device);
        let stage = |fragment, targets, depth| Raster { vertex: "vertex", fragment, targets, depth };
        let add = [(light, sum)];
        let set = [(light, None)];
        let picture = [(HDR_FORMAT, sum)];
        let groups = [Some(frame_layout), Some(&layouts.walk)];
        let draw_module = module(device, "aurora strokes", Pass::AuroraDraw);
        let draw_groups = [Some(frame_layout), Some(&layouts.draw)];
        let draw_strokes = |depth| raster(device, "aurora strokes", &draw_module, stage("fragment", &add, depth), &draw_groups);
        let spread_module = module(device, "aurora spread", Pass::AuroraSpread);
        let spread_groups = [Some(frame_layout), Some(&layouts.spread)];
        let resolve_module = module(device, "aurora resolve", Pass::AuroraResolve);
        let wipe_module = module(device, "aurora wipe", Pass::AuroraWipe);
        let resolve_groups = [Some(frame_layout), Some(&layouts.tiles), Some(&layouts.resolve)];
        let resolve = |fragment| raster(device, "aurora resolve", &resolve_module, stage(fragment, &picture, None), &resolve_groups);
        Pipelines {
            project: compute(device, "aurora project", Pass::AuroraProject, "main", &groups),
            ends: compute(device, "aurora ends", Pass::AuroraEnds, "main", &groups),
            walk: compute(device, "aurora walk", Pass::AuroraWalk, "main", &groups),
            draw: [Some(false), None].map(draw_strokes),
            spread: raster(device, "aurora spread", &spread_module, stage("fragment", &set, None), &spread_groups),
            wipe: raster(device, "aurora wipe", &wipe_module, stage("fragment", &set, Some(false)), &resolve_groups[..2]),
            resolve: ["finest", "coarser", "both"].map(resolve),
        }
    }
}
