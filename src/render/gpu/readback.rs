//! Bringing pictures and buffers back from the GPU, and writing pictures to files.

use std::path::Path;
use std::sync::mpsc::TryRecvError;

use thiserror::Error;

use crate::breath::breath;
use crate::picture_file;
use crate::render::Gpu;
use crate::render::gpu::device::wait;
use crate::user_file::write_whole;

/// Why a picture could not be written.
#[derive(Debug, Error)]
pub enum PictureError {
    /// The GPU did not hand the data over.
    #[error("the GPU did not return the picture: {0}")]
    Map(String),
    /// The device is gone, or refuses.
    #[error("{0}")]
    Device(String),
    /// There is nothing to draw.
    #[error("nothing was drawn: the camera's numbers are not finite, or the picture has no size")]
    Nothing,
    /// The file could not be written.
    #[error("cannot write {path}: {reason}")]
    Write {
        /// The file.
        path: String,
        /// What went wrong.
        reason: String,
    },
    /// The name says nothing known.
    #[error("cannot write {0}: the name must end in .png or .exr")]
    Format(String),
}

/// The bytes of a buffer.
pub fn buffer(gpu: &Gpu, source: &wgpu::Buffer) -> Result<Vec<u8>, PictureError> {
    wait(buffer_later(gpu, source))
}

/// The same, where one cannot wait.
pub async fn buffer_later(gpu: &Gpu, source: &wgpu::Buffer) -> Result<Vec<u8>, PictureError> {
    let copy = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size: source.size(),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_buffer_to_buffer(source, 0, &copy, 0, source.size());
    gpu.queue.submit([encoder.finish()]);
    map(gpu, &copy).await
}

/// The texels of a texture of `bytes` bytes a texel, row by row from the top.
pub fn texture(gpu: &Gpu, source: &wgpu::Texture, bytes: u32) -> Result<Vec<u8>, PictureError> {
    wait(texture_later(gpu, source, bytes))
}

/// The same, where one cannot wait.
pub async fn texture_later(gpu: &Gpu, source: &wgpu::Texture, bytes: u32) -> Result<Vec<u8>, PictureError> {
    let (width, height) = (source.width(), source.height());
    // Rows of a copy start at multiples of 256 bytes.
    let row = (width * bytes).next_multiple_of(256);
    let copy = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size: u64::from(row) * u64::from(height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        source.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &copy,
            layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None },
        },
        source.size(),
    );
    gpu.queue.submit([encoder.finish()]);
    let padded = map(gpu, &copy).await?;
    Ok(padded.chunks_exact(row as usize).flat_map(|line| &line[..(width * bytes) as usize]).copied().collect())
}

/// The numbers of a texture of floats of 16 or 32 bits, all channels of a texel together.
pub async fn numbers(gpu: &Gpu, source: &wgpu::Texture) -> Result<Vec<f32>, PictureError> {
    let format = source.format();
    let texel = format.block_copy_size(None).unwrap_or_default();
    let bytes = texture_later(gpu, source, texel).await?;
    Ok(if texel == 2 * u32::from(format.components()) {
        bytes.chunks_exact(2).map(|number| half::f16::from_le_bytes([number[0], number[1]]).to_f32()).collect()
    } else {
        bytes.chunks_exact(4).map(bytemuck::pod_read_unaligned).collect()
    })
}

/// The texels of a texture of four 32-bit floats a texel.
pub async fn floats(gpu: &Gpu, source: &wgpu::Texture) -> Result<Vec<[f32; 4]>, PictureError> {
    let bytes = texture_later(gpu, source, 16).await?;
    Ok(bytes.chunks_exact(16).map(bytemuck::pod_read_unaligned).collect())
}

async fn map(gpu: &Gpu, copy: &wgpu::Buffer) -> Result<Vec<u8>, PictureError> {
    mapped(gpu, copy).await.map_err(|error| gpu.watch.complaint().map_or(error, PictureError::Device))
}

async fn mapped(gpu: &Gpu, copy: &wgpu::Buffer) -> Result<Vec<u8>, PictureError> {
    if let Some(complaint) = gpu.watch.complaint() {
        return Err(PictureError::Device(complaint));
    }
    let (send, receive) = std::sync::mpsc::channel();
    copy.slice(..).map_async(wgpu::MapMode::Read, move |result| {
        // The receiver waits below; if it is gone there is nobody to tell.
        let _ = send.send(result);
    });
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| PictureError::Map(error.to_string()))?;
    // A page does not wait in `poll`. Elsewhere another thread's `poll` may have taken the answer and be about to hand it over.
    let come = loop {
        match receive.try_recv() {
            Err(TryRecvError::Empty) if cfg!(target_family = "wasm") => breath().await,
            Err(TryRecvError::Empty) => std::thread::yield_now(),
            other => break other.map_err(|error| PictureError::Map(error.to_string()))?,
        }
    };
    come.map_err(|error| PictureError::Map(error.to_string()))?;
    let bytes = copy.slice(..).get_mapped_range().to_vec();
    copy.unmap();
    Ok(bytes)
}

/// Brings a small buffer back some frames late and never makes the processor wait: the copy is recorded with a frame, mapped once that
/// frame has been submitted, and read when the device is done with it.
#[derive(Debug, Default)]
pub struct DeferredCopy {
    copy: Option<wgpu::Buffer>,
    /// A copy has been recorded and not been mapped.
    recorded: bool,
    /// Tells when the mapping that is on its way is done, and whether it went well.
    waiting: Option<std::sync::mpsc::Receiver<bool>>,
    latest: Option<Vec<u8>>,
}

impl DeferredCopy {
    /// A new frame begins: all that was recorded has been submitted.
    pub fn begin(&mut self) {
        let Some(copy) = self.copy.as_ref().filter(|_| self.recorded) else { return };
        let (send, receive) = std::sync::mpsc::channel();
        copy.slice(..).map_async(wgpu::MapMode::Read, move |result| {
            // Nobody waits any more if the renderer is gone.
            let _ = send.send(result.is_ok());
        });
        (self.recorded, self.waiting) = (false, Some(receive));
    }

    /// Records a copy of `source` at the end of a frame, unless an earlier one is still on its way.
    pub fn record(&mut self, device: &wgpu::Device, encoder: &mut wgpu::CommandEncoder, source: &wgpu::Buffer) {
        if self.recorded || self.waiting.is_some() {
            return;
        }
        if self.copy.as_ref().is_none_or(|copy| copy.size() != source.size()) {
            self.copy = Some(device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("deferred copy"),
                size: source.size(),
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            }));
        }
        if let Some(copy) = &self.copy {
            encoder.copy_buffer_to_buffer(source, 0, copy, 0, source.size());
            self.recorded = true;
        }
    }

    /// What came back last; None before anything has.
    pub fn latest(&mut self) -> Option<&[u8]> {
        let arrived = self.waiting.as_ref().and_then(|waiting| waiting.try_recv().ok());
        if let (Some(went_well), Some(copy)) = (arrived, &self.copy) {
            self.waiting = None;
            if went_well {
                let latest = self.latest.get_or_insert_default();
                latest.clear();
                latest.extend_from_slice(&copy.slice(..).get_mapped_range());
                copy.unmap();
            }
        }
        self.latest.as_deref()
    }
}

/// A picture on the processor.
#[derive(Clone, Debug, Default)]
pub struct ReadbackPicture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// After post-processing: sRGB, 4 bytes a pixel.
    pub display: Vec<u8>,
    /// Linear light before post-processing, RGBA.
    pub linear: Vec<[f32; 4]>,
    /// Object id, image order, travel time, g of the nearest surface; empty unless asked for.
    pub layers: Vec<[f32; 4]>,
    /// Texture coordinates and coverage of that surface; as `layers`.
    pub surface: Vec<[f32; 4]>,
    /// The part of each pixel that thin images cover together, whatever of the disk is before them; as `layers`, and empty where there are
    /// none.
    pub thin: Vec<f32>,
}

impl ReadbackPicture {
    /// Writes the finished picture (.png) or the linear light and layers (.exr).
    pub fn write(&self, path: &Path) -> Result<(), PictureError> {
        self.write_with_text(path, None)
    }

    /// The same; a PNG carries `text`, if that is given.
    pub fn write_with_text(&self, path: &Path, text: Option<&str>) -> Result<(), PictureError> {
        let failed = |reason: String| PictureError::Write { path: path.display().to_string(), reason };
        match path.extension().and_then(|extension| extension.to_str()) {
            Some("png") => {
                let opaque: Vec<u8> = self.display.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
                let bytes = picture_file::png(&opaque, self.size, false, text).map_err(failed)?;
                write_whole(path, &bytes).map_err(|error| failed(error.to_string()))
            }
            Some("exr") => self.write_exr(path).map_err(|error| failed(error.to_string())),
            _ => Err(PictureError::Format(path.display().to_string())),
        }
    }

    fn write_exr(&self, path: &Path) -> exr::error::UnitResult {
        use exr::prelude::*;
        let channel =
            |name: &str, data: &[[f32; 4]], k: usize| AnyChannel::new(name, FlatSamples::F32(data.iter().map(|p| p[k]).collect()));
        let mut channels: SmallVec<[AnyChannel<FlatSamples>; 4]> =
            ["R", "G", "B"].iter().enumerate().map(|(k, name)| channel(name, &self.linear, k)).collect();
        if !self.layers.is_empty() {
            let names = ["object.id", "image.order", "travel.time", "frequency.ratio"];
            channels.extend(names.iter().enumerate().map(|(k, name)| channel(name, &self.layers, k)));
            channels.extend(["texture.u", "texture.v"].iter().enumerate().map(|(k, name)| channel(name, &self.surface, k)));
        }
        let size = (self.size[0] as usize, self.size[1] as usize);
        let layer = Layer::new(size, LayerAttributes::named("lensrunner"), Encoding::SMALL_LOSSLESS, AnyChannels::sort(channels));
        let mut bytes = std::io::Cursor::new(Vec::new());
        Image::from_layer(layer).write().to_buffered(&mut bytes)?;
        Ok(write_whole(path, bytes.get_ref())?)
    }
}
