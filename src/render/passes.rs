//! The render passes that lay the disk and the aurora over the picture and sum thin images, and what passes draw to.

use std::ops::RangeInclusive;

use crate::render::aurora::Aurora;
use crate::render::disk::DiskPasses;
use crate::render::geometry::Geometry;
use crate::render::gpu::targets::Targets;
use crate::render::gpu::timing::Timing;

/// Lays these orders of the disk over the picture, if there are any.
pub fn draw_disk(
    disk: Option<&DiskPasses>,
    orders: RangeInclusive<u32>,
    timing: &mut Timing,
    encoder: &mut wgpu::CommandEncoder,
    group: &wgpu::BindGroup,
    targets: &Targets,
) {
    let Some(disk) = disk.filter(|_| !orders.is_empty()) else { return };
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("disk"),
        color_attachments: &[Some(colour(&targets.picture, false))],
        // Polygons write it.
        depth_stencil_attachment: Some(if disk.is_laid_over() { tested_depth(&targets.depth) } else { depth(&targets.depth, false) }),
        timestamp_writes: timing.render("disk"),
        ..Default::default()
    });
    pass.set_bind_group(0, group, &[]);
    timing.count("disk", &mut pass, |pass| disk.draw(pass, orders));
}

/// Sums thin images: all, or those whose light crosses the disk's plane so often.
pub fn draw_thin(
    geometry: &Geometry,
    crossings: Option<u32>,
    timestamp_writes: Option<wgpu::RenderPassTimestampWrites>,
    encoder: &mut wgpu::CommandEncoder,
    group: &wgpu::BindGroup,
    targets: &Targets,
) {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("thin"),
        color_attachments: &[Some(colour(&targets.thin, true)), Some(colour(&targets.thin_signed, true))],
        depth_stencil_attachment: Some(tested_depth(&targets.depth)),
        timestamp_writes,
        ..Default::default()
    });
    pass.set_bind_group(0, group, &[]);
    geometry.draw_thin(&mut pass, crossings);
}

/// Adds the images of the aurora that are behind the disk, or the others.
pub fn draw_aurora(
    aurora: &Aurora,
    behind: bool,
    timing: &mut Timing,
    encoder: &mut wgpu::CommandEncoder,
    group: &wgpu::BindGroup,
    targets: &Targets,
) {
    for image in aurora.images_behind(behind) {
        let mut draw = |label, target, fresh, tested: bool, run: &dyn Fn(&mut wgpu::RenderPass)| {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(label),
                color_attachments: &[Some(colour(target, fresh))],
                depth_stencil_attachment: tested.then(|| tested_depth(&targets.depth)),
                timestamp_writes: timing.render(label),
                ..Default::default()
            });
            pass.set_bind_group(0, group, &[]);
            run(&mut pass);
        };
        // The finest level is cleared only where it has light.
        for (level, light) in aurora.levels() {
            draw("aurora strokes", light, level > 0, level == 0, &|pass| aurora.draw(pass, image, level));
        }
        draw("aurora resolve", &targets.picture, false, false, &|pass| aurora.resolve(pass, image));
    }
}

/// A target of colours, drawn from nothing where it is `fresh`, else onto what is there.
pub fn colour(view: &wgpu::TextureView, fresh: bool) -> wgpu::RenderPassColorAttachment<'_> {
    let load = if fresh { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) } else { wgpu::LoadOp::Load };
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
    }
}

/// Depth that is written, reversed: infinity is 0.
pub fn depth(view: &wgpu::TextureView, fresh: bool) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    let load = if fresh { wgpu::LoadOp::Clear(0.0) } else { wgpu::LoadOp::Load };
    let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
    wgpu::RenderPassDepthStencilAttachment { view, depth_ops: Some(ops), stencil_ops: None }
}

/// Depth that is only tested, so that passes one after the other need not wait for it.
pub fn tested_depth(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment { view, depth_ops: None, stencil_ops: None }
}
