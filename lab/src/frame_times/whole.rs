//! One frame, drawn to its end.

use std::time::Instant;

use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::readback::PictureError;
use lensrunner::render::{Gpu, Renderer};

/// Draws one frame to its end, and says when it was handed to the GPU.
pub fn draw(gpu: &Gpu, renderer: &mut Renderer, frame: &FrameInput, view: &wgpu::TextureView) -> Result<Instant, PictureError> {
    renderer.prepare(frame);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    renderer.encode(&mut encoder, view);
    let ready = Instant::now();
    gpu.queue.submit([encoder.finish()]);
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| PictureError::Map(error.to_string()))?;
    Ok(ready)
}
