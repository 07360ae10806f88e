//! Frames of a disk alone: one renderer for each representation, all on one device.

use std::time::Instant;

use lensrunner::render::disk::DrawnDisk;
use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::readback::PictureError;
use lensrunner::render::gpu::targets::target;
use lensrunner::render::renderer::Surroundings;
use lensrunner::render::shot::surroundings;
use lensrunner::render::stage::settings;
use lensrunner::render::{Gpu, Renderer};
use lensrunner::scene::GameConfig;

use super::request::{DiskContestant, MeasuredView, Shown};
use crate::chart::ChartError;
use crate::offscreen::processor_time;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Renderers by representation. One for each configuration would be more shaders than a software driver keeps compiled.
#[derive(Debug)]
pub struct Bench {
    gpu: Gpu,
    size: [u32; 2],
    configs: Vec<GameConfig>,
    surroundings: Option<Surroundings>,
    renderers: Vec<Held>,
    output: wgpu::TextureView,
}

/// A renderer, what it can draw, and which configuration it has taken up.
#[derive(Debug)]
struct Held {
    representation: String,
    renderer: Renderer,
    taken_up: Option<usize>,
}

impl Bench {
    /// For frames of `size` by these contestants. Renderers are made when they are first drawn with.
    pub fn new(gpu: Gpu, contestants: &[DiskContestant], size: [u32; 2]) -> Bench {
        let configs = contestants.iter().map(|contestant| contestant.config.clone()).collect();
        let (_, output) = target(&gpu.device, "bench", size, FORMAT);
        Bench { gpu, size, configs, surroundings: None, renderers: Vec::new(), output }
    }

    /// The adapter's name.
    pub fn adapter(&self) -> &str {
        &self.gpu.adapter.name
    }

    /// Draws a frame of contestant `number` (None: no disk at all) for a view; with a size it brings linear light back, drawn at that size.
    pub fn frame(&mut self, number: Option<usize>, view: &MeasuredView, picture: Option<[u32; 2]>) -> Result<Shown, ChartError> {
        // Without a disk any of them will do; the last is the cheapest to bring its disk back.
        let config = &self.configs[number.unwrap_or(self.configs.len() - 1)];
        let representation = &config.disk.representation;
        if self.renderers.iter().all(|held| held.representation != *representation) {
            let surroundings = self.surroundings.get_or_insert_with(surroundings);
            let renderer = Renderer::new(&self.gpu, surroundings, FORMAT, self.size);
            self.renderers.push(Held { representation: representation.clone(), renderer, taken_up: None });
        }
        let held = self.renderers.iter_mut().find(|held| held.representation == *representation);
        let Some(Held { renderer, taken_up, .. }) = held else { return Err(PictureError::Nothing.into()) };
        if *taken_up != number || number.is_none() {
            *taken_up = number;
            renderer.set_disk(number.map(|_| DrawnDisk::new(config.disk.clone(), config)));
        }
        let mut settings = settings(config);
        settings.stars &= view.sky;
        settings.milky_way &= view.sky;
        let input = FrameInput { camera: view.eye, time: view.time, placed: Vec::new(), held: None, aurora: None, settings };
        if let Some(size) = picture {
            renderer.resize(size);
            let drawn = renderer.picture(&input, false);
            renderer.resize(self.size);
            return Ok(Shown { picture: drawn?.linear.iter().map(|p| [p[0], p[1], p[2]]).collect(), ..Shown::default() });
        }
        let software = self.gpu.adapter.device_type == wgpu::DeviceType::Cpu;
        let spent = processor_time().filter(|_| software);
        let begin = Instant::now();
        renderer.timing().set_counting(view.counted);
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
        Ok(Shown { whole, processor, before, passes, fragments, picture: Vec::new() })
    }

    /// A frame: the mean of two, after two that make targets and whose timestamps are another's.
    pub fn timed(&mut self, number: Option<usize>, view: &MeasuredView) -> Result<Shown, ChartError> {
        let mut frame = || self.frame(number, view, None);
        frame()?;
        frame()?;
        let (first, second) = (frame()?, frame()?);
        Ok(Shown {
            whole: 0.5 * (first.whole + second.whole),
            processor: first.processor.zip(second.processor).map(|(a, b)| 0.5 * (a + b)),
            ..second
        })
    }
}
