//! The passes of a frame in their order, and what they draw to; [`crate::render::post_process`] has the last of them.

use std::ops::RangeInclusive;

use crate::render::aurora::Aurora;
use crate::render::disk::DiskPasses;
use crate::render::geometry::Geometry;
use crate::render::geometry::thin::ThinLists;
use crate::render::gpu::targets::Targets;
use crate::render::gpu::timing::Timing;
use crate::render::sky::{Background, Stars};

/// What every pass of a frame needs.
pub struct Recording<'a> {
    /// Where passes are recorded.
    pub encoder: &'a mut wgpu::CommandEncoder,
    /// Where they write their times.
    pub timing: &'a mut Timing,
    /// The frame's bindings: group 0 of each.
    pub frame: &'a wgpu::BindGroup,
    /// What is drawn to.
    pub targets: &'a Targets,
}

/// Whether a stage of compute has anything to do, its name, and what it does.
type Stage<'a> = (bool, &'static str, &'a dyn Fn(&mut wgpu::ComputePass));

impl Recording<'_> {
    /// Stages one after the other: in one pass, or where passes are timed each in its own.
    fn stages(&mut self, stages: &[Stage]) {
        let stages = stages.iter().filter(|(wanted, ..)| *wanted);
        if self.timing.separates() {
            stages.for_each(|(_, label, run)| self.compute(label, run));
        } else {
            self.compute("compute", |pass| stages.for_each(|(.., run)| run(pass)));
        }
    }

    /// A compute pass of this name.
    fn compute(&mut self, label: &'static str, run: impl FnOnce(&mut wgpu::ComputePass)) {
        let timestamp_writes = self.timing.compute(self.encoder, label);
        let mut pass = self.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(label), timestamp_writes });
        pass.set_bind_group(0, self.frame, &[]);
        run(&mut pass);
    }
}

/// The passes of all that a frame shows.
pub struct Shown<'a> {
    /// Bodies.
    pub geometry: &'a Geometry,
    /// Those of their triangles that are thin.
    pub thin: &'a ThinLists,
    /// The Milky Way.
    pub background: &'a Background,
    /// Stars.
    pub stars: &'a Stars,
    /// The aurora.
    pub aurora: &'a Aurora,
    /// The disk, if there is one.
    pub disk: Option<&'a DiskPasses>,
}

impl Shown<'_> {
    /// The compute passes before anything is drawn.
    pub fn compute(&self, recording: &mut Recording) {
        let geometry = self.geometry;
        let (bodies, aurora) = (!geometry.is_empty(), self.aurora.images() > 0);
        let thin = geometry.has_thin();
        if thin {
            self.thin.clear(recording.encoder);
        }
        recording.stages(&[
            (geometry.has_held(), "place", &|pass| geometry.place(pass)),
            (bodies, "vertices", &|pass| geometry.vertices(pass)),
            (bodies, "edges", &|pass| geometry.edges(pass)),
            (bodies, "triangles", &|pass| geometry.triangles(pass)),
            (bodies, "refine", &|pass| geometry.refine(pass)),
            (bodies, "mesh", &|pass| geometry.mesh(pass)),
            (thin, "thin lists", &|pass| self.thin.list(pass, geometry.arguments())),
            (true, "sky", &|pass| self.background.cells(pass)),
            (true, "stars", &|pass| self.stars.project(pass)),
            (aurora, "aurora project", &|pass| self.aurora.project(pass)),
            (aurora, "aurora ends", &|pass| self.aurora.ends(pass)),
            (self.disk.is_some(), "disk arcs", &|pass| self.disk.iter().for_each(|disk| disk.compute(pass))),
            (self.disk.is_some(), "disk mesh", &|pass| self.disk.iter().for_each(|disk| disk.compute_rest(pass))),
        ]);
    }

    /// Draws what has depth, and the sky behind it.
    pub fn draw_opaque(&self, recording: &mut Recording) {
        let Recording { encoder, timing, frame, targets } = recording;
        let timestamp_writes = timing.render(encoder, "draw");
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("draw"),
            color_attachments: &[Some(colour(&targets.picture, true))],
            depth_stencil_attachment: Some(depth(&targets.depth, true)),
            timestamp_writes,
            ..Default::default()
        });
        pass.set_bind_group(0, *frame, &[]);
        timing.count("draw", &mut pass, |pass| {
            self.geometry.draw_opaque(pass);
            self.background.draw(pass);
            if targets.starless.is_none() {
                self.stars.draw(pass);
            }
        });
    }

    /// Adds the stars to a picture that is to be enlarged, once all else is drawn and kept without them: glow, exposure and mean brightness
    /// are those of the whole.
    pub fn add_stars(&self, recording: &mut Recording) {
        let Recording { encoder, timing, frame, targets } = recording;
        let Some((starless, _)) = &targets.starless else { return };
        encoder.copy_texture_to_texture(targets.picture_texture.as_image_copy(), starless.as_image_copy(), starless.size());
        let timestamp_writes = timing.render(encoder, "draw");
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("stars"),
            color_attachments: &[Some(colour(&targets.picture, false))],
            timestamp_writes,
            ..Default::default()
        });
        pass.set_bind_group(0, *frame, &[]);
        self.stars.add(&mut pass);
    }

    /// The aurora's walk on the screen, once all that has depth has been drawn: it asks what is before and behind of it.
    pub fn walk(&self, recording: &mut Recording) {
        if self.aurora.images() > 0 {
            self.aurora.ranges(recording.encoder, recording.timing, recording.frame);
            recording.compute("aurora walk", |pass| self.aurora.walk(pass));
        }
    }

    /// Lays images of the disk over the picture from the farthest on, each over what is behind it, with thin images among them; `compose`
    /// lays those over the picture once they are summed. Thin images have no depth: they come among those of the disk, by how often their
    /// light crosses its plane. Polygons have depth.
    pub fn lay_over(&self, recording: &mut Recording, compose: impl Fn(&mut Recording)) {
        let geometry = self.geometry;
        let laid_over = self.disk.is_some_and(DiskPasses::is_laid_over);
        let among = |crossings: u32| if laid_over { geometry.has_thin_across(crossings) } else { crossings == 0 && geometry.has_thin() };
        let mut left = 3;
        for crossings in (0..=3).rev().filter(|crossings| among(*crossings)) {
            self.draw_disk(recording, crossings + 1..=left);
            left = crossings;
            let Recording { encoder, timing, frame, targets } = &mut *recording;
            let timestamp_writes = timing.render(encoder, "thin");
            let mut pass = begin_thin(false, timestamp_writes, encoder, frame, targets);
            self.thin.wipe(&mut pass);
            if !laid_over {
                geometry.draw_thin(&mut pass);
            } else if geometry.begin_thin_across(&mut pass, crossings) {
                self.thin.draw_across(&mut pass, crossings);
            }
            drop(pass);
            compose(recording);
        }
        self.draw_disk(recording, 1..=left);
    }

    /// Lays these orders of the disk over the picture, if there are any.
    fn draw_disk(&self, recording: &mut Recording, orders: RangeInclusive<u32>) {
        let Recording { encoder, timing, frame, targets } = recording;
        let Some(disk) = self.disk.filter(|_| !orders.is_empty()) else { return };
        let timestamp_writes = timing.render(encoder, "disk");
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("disk"),
            color_attachments: &[Some(colour(&targets.picture, false))],
            // Polygons write it.
            depth_stencil_attachment: Some(if disk.is_laid_over() { tested_depth(&targets.depth) } else { depth(&targets.depth, false) }),
            timestamp_writes,
            ..Default::default()
        });
        pass.set_bind_group(0, *frame, &[]);
        timing.count("disk", &mut pass, |pass| disk.draw(pass, orders));
    }

    /// Adds the images of the aurora that are behind the disk, or the others.
    pub fn draw_aurora(&self, recording: &mut Recording, behind: bool) {
        let aurora = self.aurora;
        let Recording { encoder, timing, frame, targets } = recording;
        for image in aurora.images_behind(behind) {
            let mut draw = |label, target, fresh, tested: bool, run: &dyn Fn(&mut wgpu::RenderPass)| {
                let timestamp_writes = timing.render(encoder, label);
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some(label),
                    color_attachments: &[Some(colour(target, fresh))],
                    depth_stencil_attachment: tested.then(|| tested_depth(&targets.depth)),
                    timestamp_writes,
                    ..Default::default()
                });
                pass.set_bind_group(0, *frame, &[]);
                run(&mut pass);
            };
            // The finest level is cleared only where it has light.
            for (level, light) in aurora.levels() {
                draw("aurora strokes", light, level > 0, level == 0, &|pass| aurora.draw(pass, image, level));
            }
            draw("aurora resolve", &targets.picture, false, false, &|pass| aurora.resolve(pass, image));
        }
    }
}

/// A pass that sums thin images, from nothing if it is `fresh`.
pub fn begin_thin<'p>(
    fresh: bool,
    timestamp_writes: Option<wgpu::RenderPassTimestampWrites>,
    encoder: &'p mut wgpu::CommandEncoder,
    group: &wgpu::BindGroup,
    targets: &Targets,
) -> wgpu::RenderPass<'p> {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("thin"),
        color_attachments: &[Some(colour(&targets.thin, fresh)), Some(colour(&targets.thin_signed, fresh))],
        depth_stencil_attachment: Some(tested_depth(&targets.depth)),
        timestamp_writes,
        ..Default::default()
    });
    pass.set_bind_group(0, group, &[]);
    pass
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
fn tested_depth(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment { view, depth_ops: None, stencil_ops: None }
}
