//! The aurora's light on the ground, as the surfaces read it (`shaders/shading/aurora_light.wgsl`).

use std::sync::Arc;

use wgpu::BufferUsages;

use crate::render::Gpu;
use crate::render::aurora::ground::{GroundFrame, GroundLight};
use crate::render::gpu::layout::{buffer, new_texture};

/// The map and its numbers on the GPU.
#[derive(Debug)]
pub(super) struct GroundBuffers {
    pub light: wgpu::Buffer,
    pub view: wgpu::TextureView,
    texture: wgpu::Texture,
    /// What is on the GPU.
    written: GroundLight,
    uploaded: Arc<Vec<[u16; 2]>>,
}

impl GroundBuffers {
    /// One that lights nothing.
    pub fn new(device: &wgpu::Device) -> GroundBuffers {
        let light = buffer(device, "ground light", size_of::<GroundLight>() as u64, BufferUsages::UNIFORM);
        let (texture, view) = map(device, 1);
        GroundBuffers { light, view, texture, written: GroundLight::default(), uploaded: Arc::default() }
    }

    /// Writes what has changed. True if the texture was replaced, so that bind groups must be made anew.
    pub fn write(&mut self, gpu: &Gpu, frame: Option<&GroundFrame>) -> bool {
        let light = frame.map_or(GroundLight::default(), |frame| frame.light);
        if light != self.written {
            gpu.queue.write_buffer(&self.light, 0, bytemuck::bytes_of(&light));
            self.written = light;
        }
        let Some(frame) = frame.filter(|frame| frame.size > 0 && frame.texels.len() == (frame.size * frame.size) as usize) else {
            return false;
        };
        if Arc::ptr_eq(&self.uploaded, &frame.texels) {
            return false;
        }
        let replaced = self.texture.width() != frame.size;
        if replaced {
            (self.texture, self.view) = map(&gpu.device, frame.size);
        }
        gpu.queue.write_texture(
            self.texture.as_image_copy(),
            bytemuck::cast_slice(&frame.texels),
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * frame.size), rows_per_image: None },
            self.texture.size(),
        );
        self.uploaded = frame.texels.clone();
        replaced
    }
}

/// A square map of 16-bit floats: all adapters can interpolate them.
fn map(device: &wgpu::Device, size: u32) -> (wgpu::Texture, wgpu::TextureView) {
    let texture = new_texture(
        device,
        "ground light",
        [size, size],
        [1, 1],
        wgpu::TextureFormat::Rg16Float,
        wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
    );
    let view = texture.create_view(&Default::default());
    (texture, view)
}
