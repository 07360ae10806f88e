//! A frame as a picture: drawn, and brought back.

use crate::render::disk::DiskPasses;
use crate::render::frame::FrameInput;
use crate::render::gpu::device::wait;
use crate::render::gpu::readback::{self, PictureError, ReadbackPicture};
use crate::render::gpu::targets::target;
use crate::render::passes::{begin_thin, colour, depth};
use crate::render::post_process::coverage::covered;
use crate::render::renderer::Renderer;

impl Renderer {
    /// Draws one frame into a texture of its own and brings it back. The exposure settles first: the frame is drawn twice. Of a frame that
    /// is drawn smaller than the output there is the finished picture alone.
    pub fn picture(&mut self, input: &FrameInput, layers: bool) -> Result<ReadbackPicture, PictureError> {
        wait(self.picture_later(input, layers))
    }

    /// The same, where one cannot wait.
    pub async fn picture_later(&mut self, input: &FrameInput, layers: bool) -> Result<ReadbackPicture, PictureError> {
        let format = wgpu::TextureFormat::Rgba8UnormSrgb;
        let (texture, view) = target(&self.gpu.device, "output", self.output.0, format);
        // A picture does not depend on those before it.
        self.disk.iter_mut().for_each(DiskPasses::forget);
        for _ in 0..2 {
            if !self.prepare(input) {
                return Err(self.gpu.watch.complaint().map_or(PictureError::Nothing, PictureError::Device));
            }
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            self.encode(&mut encoder, &view);
            if layers {
                self.geometry.prepare_layers(&self.gpu.device, &self.frame_layout);
                self.encode_layers(&mut encoder);
            }
            self.gpu.queue.submit([encoder.finish()]);
        }
        let display = readback::texture_later(&self.gpu, &texture, 4).await?;
        if self.upscale.drawn().is_some() {
            return Ok(ReadbackPicture { size: self.output.0, display, ..ReadbackPicture::default() });
        }
        let numbers = readback::numbers(&self.gpu, &self.targets.picture_texture).await?;
        let linear = numbers.chunks_exact(4).map(|texel| [texel[0], texel[1], texel[2], texel[3]]).collect();
        let (layers, surface) = match &self.targets.layers {
            Some(targets) if layers => {
                (readback::floats(&self.gpu, &targets.what.0).await?, readback::floats(&self.gpu, &targets.surface.0).await?)
            }
            _ => Default::default(),
        };
        let thin = if !layers.is_empty() && self.geometry.has_thin() {
            let sums = readback::numbers(&self.gpu, &self.targets.thin_texture).await?;
            let signed = readback::numbers(&self.gpu, &self.targets.thin_signed_texture).await?;
            sums.chunks_exact(4).zip(signed.chunks_exact(2)).map(|(sum, signed)| covered(sum[3], signed[0])).collect()
        } else {
            Vec::new()
        };
        Ok(ReadbackPicture { size: self.targets.size, display, linear, layers, surface, thin })
    }

    fn encode_layers(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let Some(frame_group) = &self.frame_group else { return };
        if self.geometry.has_thin() {
            // The sum of all: among images of the disk they are drawn in parts.
            self.geometry.draw_thin(&mut begin_thin(true, None, encoder, frame_group, &self.targets));
        }
        let targets = self.targets.layers(&self.gpu.device);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("layers"),
            color_attachments: &[Some(colour(&targets.what.1, true)), Some(colour(&targets.surface.1, true))],
            depth_stencil_attachment: Some(depth(&targets.depth, true)),
            ..Default::default()
        });
        pass.set_bind_group(0, frame_group, &[]);
        self.geometry.draw_layers(&mut pass);
    }
}
