//! Frames of a disk alone, for the chart: one renderer for each representation, all on one device.

use crate::spacetime::Observer;
use std::time::Instant;

use crate::render::bench::processor_time;
use crate::render::frame::FrameInput;
use crate::render::gpu::readback::PictureError;
use crate::render::gpu::targets::target;
use crate::render::renderer::Surroundings;
use crate::render::stage::settings;
use crate::render::{Gpu, Renderer};
use crate::scene::GameConfig;

use crate::render::disk::Disk;

/// Renderers by representation. One for each configuration would be more shaders than a software driver keeps compiled.
#[derive(Debug)]
pub struct Bench {
    gpu: Gpu,
    size: [u32; 2],
    configs: Vec<GameConfig>,
    renderers: Vec<Held>,
    output: wgpu::TextureView,
    counting: bool,
}

/// A renderer, what it can draw, and which configuration it has taken up.
#[derive(Debug)]
struct Held {
    representation: String,
    renderer: Renderer,
    taken_up: Option<usize>,
}

/// A frame drawn.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// The whole of it on the clock, in ms.
    pub whole: f64,
    /// The time that all threads spent on it, in ms, where the adapter is a software one and the system tells it.
    pub processor: Option<f64>,
    /// Until it was submitted, on the clock, in ms.
    pub before: f64,
    /// Its passes by timestamps, in ms.
    pub passes: Vec<(String, f64)>,
    /// Fragments that the disk's draw shaded, where the adapter counts them.
    pub fragments: Option<u64>,
    /// Its linear light, if it was asked for.
    pub picture: Vec<[f32; 3]>,
}

impl Bench {
    /// For frames of `size` by these configurations.
    pub fn new(gpu: Gpu, surroundings: &Surroundings, configs: Vec<GameConfig>, size: [u32; 2]) -> Bench {
        let format = wgpu::TextureFormat::Rgba8UnormSrgb;
        let mut renderers: Vec<Held> = Vec::new();
        for config in &configs {
            let representation = config.disk.representation.clone();
            if renderers.iter().all(|held| held.representation != representation) {
                let renderer = Renderer::new(&gpu, surroundings, format, size);
                renderers.push(Held { representation, renderer, taken_up: None });
            }
        }
        let (_, output) = target(&gpu.device, "bench", size, format);
        Bench { gpu, size, configs, renderers, output, counting: false }
    }

    /// Counts fragments in the frames to come, or no longer.
    pub fn set_counting(&mut self, counting: bool) {
        self.counting = counting;
    }

    /// Draws a frame by configuration `number`, the disk alone before black or before the configuration's sky; None draws no disk at all.
    /// With a size it brings linear light back, drawn at that size.
    pub fn frame(
        &mut self,
        number: Option<usize>,
        camera: Observer,
        time: f64,
        sky: bool,
        picture: Option<[u32; 2]>,
    ) -> Result<Frame, PictureError> {
        // Without a disk any of them will do; the last is the cheapest to bring its disk back.
        let config = &self.configs[number.unwrap_or(self.configs.len() - 1)];
        let held = self.renderers.iter_mut().find(|held| held.representation == config.disk.representation);
        let Some(Held { renderer, taken_up, .. }) = held else { return Err(PictureError::Nothing) };
        if *taken_up != number || number.is_none() {
            *taken_up = number;
            renderer.set_disk(number.map(|_| Disk::new(config.disk.clone(), config)));
        }
        let mut settings = settings(config);
        settings.stars &= sky;
        settings.milky_way &= sky;
        let input = FrameInput { camera, time, placed: Vec::new(), aurora: None, settings };
        if let Some(size) = picture {
            renderer.resize(size);
            let drawn = renderer.picture(&input, false);
            renderer.resize(self.size);
            return Ok(Frame { picture: drawn?.linear.iter().map(|p| [p[0], p[1], p[2]]).collect(), ..Frame::default() });
        }
        let software = self.gpu.adapter.device_type == wgpu::DeviceType::Cpu;
        let spent = processor_time().filter(|_| software);
        let begin = Instant::now();
        renderer.timing().set_counting(self.counting);
        renderer.prepare(&input);
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        renderer.encode(&mut encoder, &self.output);
        self.gpu.queue.submit([encoder.finish()]);
        let before = begin.elapsed().as_secs_f64() * 1e3;
        self.gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| PictureError::Map(error.to_string()))?;
        let whole = begin.elapsed().as_secs_f64() * 1e3;
        let processor = spent.zip(processor_time()).map(|(before, after)| after - before);
        let passes = renderer.timing().latest().iter().map(|&(label, time)| (label.to_owned(), f64::from(time))).collect();
        let fragments = renderer.timing().latest_fragments().iter().find(|(label, _)| *label == "disk").map(|&(_, count)| count);
        Ok(Frame { whole, processor, before, passes, fragments, picture: Vec::new() })
    }
}
