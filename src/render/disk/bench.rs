//! Frames of a disk alone, for the chart: one renderer for each way to draw it, all on one device.

use std::time::Instant;

use crate::render::frame::{Camera, FrameInput};
use crate::render::readback::PictureError;
use crate::render::renderer::Surroundings;
use crate::render::stage::settings;
use crate::render::targets::target;
use crate::render::{Gpu, Renderer};
use crate::scene::GameConfig;

use super::Disk;

/// Renderers by number.
#[derive(Debug)]
pub struct Bench {
    gpu: Gpu,
    size: [u32; 2],
    renderers: Vec<(Renderer, GameConfig)>,
    output: wgpu::TextureView,
}

/// A frame: the whole of it on the clock and its passes by timestamps, in ms; its linear light if it was asked for.
pub type Frame = (f64, Vec<(String, f64)>, Vec<[f32; 3]>);

impl Bench {
    /// A renderer for each configuration, for frames of `size`.
    pub fn new(gpu: Gpu, surroundings: &Surroundings, configs: impl IntoIterator<Item = GameConfig>, size: [u32; 2]) -> Bench {
        let format = wgpu::TextureFormat::Rgba8UnormSrgb;
        let renderers = configs
            .into_iter()
            .map(|config| {
                let mut renderer = Renderer::new(&gpu, surroundings, format, size);
                renderer.set_disk(Some(Disk::new(config.disk.clone(), &config)));
                (renderer, config)
            })
            .collect();
        let (_, output) = target(&gpu.device, "bench", size, format);
        Bench { gpu, size, renderers, output }
    }

    /// Draws a frame of renderer `number`; with a size the disk alone before black, brought back as linear light.
    pub fn frame(&mut self, number: usize, camera: Camera, time: f64, picture: Option<[u32; 2]>) -> Result<Frame, PictureError> {
        let (renderer, config) = &mut self.renderers[number];
        let mut settings = settings(config);
        if let Some(size) = picture {
            settings.stars = false;
            settings.milky_way = false;
            renderer.resize(size);
            let drawn = renderer.picture(&FrameInput { camera, time, placed: Vec::new(), aurora: None, settings }, false);
            renderer.resize(self.size);
            return Ok((0.0, Vec::new(), drawn?.linear.iter().map(|p| [p[0], p[1], p[2]]).collect()));
        }
        let begin = Instant::now();
        renderer.prepare(&FrameInput { camera, time, placed: Vec::new(), aurora: None, settings });
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        renderer.encode(&mut encoder, &self.output);
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| PictureError::Map(error.to_string()))?;
        let whole = begin.elapsed().as_secs_f64() * 1e3;
        let passes = renderer.timing().latest().iter().map(|&(label, time)| (label.to_owned(), f64::from(time))).collect();
        Ok((whole, passes, Vec::new()))
    }
}
