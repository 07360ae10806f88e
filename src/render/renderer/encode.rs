//! All passes of a prepared frame, recorded.

use std::mem::offset_of;
use web_time::Instant;

use crate::render::disk::types::DiskCounters;
use crate::render::gpu::readback::DeferredCopy;
use crate::render::gpu::types;
use crate::render::passes::{Recording, Shown};
use crate::render::renderer::{Before, Renderer};

impl Renderer {
    /// Records all passes of a prepared frame.
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder, output: &wgpu::TextureView) {
        let earlier = self.counting.then(|| self.latest_counters().0).flatten();
        self.geometry.follow(earlier.as_ref());
        let Some(frame_group) = &self.frame_group else { return };
        let begin = Instant::now();
        self.timing.begin();
        self.counted.iter_mut().for_each(DeferredCopy::begin);
        // The own ship is lit by the exposure of the frame before, and stars that would not have been visible then are left out.
        for (from, to) in [
            (offset_of!(types::Adaptation, exposure), offset_of!(types::Frame, last_exposure)),
            (offset_of!(types::Adaptation, known), offset_of!(types::Frame, exposure_known)),
        ] {
            encoder.copy_buffer_to_buffer(&self.adaptation, from as u64, &self.frame, to as u64, 4);
        }
        let disk = self.disk.as_ref().filter(|_| self.has_disk);
        let shown = Shown {
            geometry: &self.geometry,
            thin: &self.thin,
            background: &self.background,
            stars: &self.stars,
            aurora: &self.aurora,
            disk,
        };
        let mut recording = Recording { encoder: &mut *encoder, timing: &mut self.timing, frame: frame_group, targets: &self.targets };
        shown.compute(&mut recording);
        if let Some(disk) = disk.filter(|disk| disk.is_of_arcs()) {
            // Whether any of it is in the picture.
            let [from, to] = [offset_of!(DiskCounters, indices), offset_of!(types::Frame, disk_indices)].map(|offset| offset as u64);
            recording.encoder.copy_buffer_to_buffer(disk.arcs().counters(), from, &self.frame, to, 16);
        }
        shown.draw_opaque(&mut recording);
        shown.walk(&mut recording);
        // What is behind the disk is dimmed by it.
        shown.draw_aurora(&mut recording, true);
        shown.lay_over(&mut recording, |recording| self.post_process.compose(recording, &self.thin));
        shown.draw_aurora(&mut recording, false);
        shown.add_stars(&mut recording);
        let drawn = self.upscale.drawn().unwrap_or(output);
        self.post_process.run(&mut recording, &self.adaptation, self.finish, drawn);
        let own_ship = Some(&self.geometry).filter(|_| self.finish.has_own_ship);
        self.upscale.run(&mut recording, own_ship, &self.stars, output);
        self.before = if self.finish.steady { Before::Measured } else { Before::Unmeasured };
        if self.counting {
            self.counted[0].record(&self.gpu.device, encoder, self.geometry.counters());
            if let Some(disk) = disk {
                self.counted[1].record(&self.gpu.device, encoder, disk.arcs().counters());
            }
        }
        self.timing.end(encoder);
        self.timing.worked("encoding", begin);
    }
}
