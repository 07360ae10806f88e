//! Whole frames without a window, for whoever times them.

use std::time::Duration;

use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::readback::PictureError;
use lensrunner::render::gpu::targets::target;
use lensrunner::render::shot::surroundings;
use lensrunner::render::{Gpu, Renderer};

/// The game's renderer and what it draws to.
pub struct Offscreen {
    /// The renderer.
    pub renderer: Renderer,
    view: wgpu::TextureView,
}

impl Offscreen {
    /// For frames of this width and height in pixels.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Offscreen {
        let format = wgpu::TextureFormat::Rgba8UnormSrgb;
        let (_, view) = target(&gpu.device, "offscreen", size, format);
        Offscreen { renderer: Renderer::new(gpu, &surroundings(), format, size), view }
    }

    /// Draws one frame to its end.
    pub fn draw(&mut self, frame: &FrameInput) -> Result<(), PictureError> {
        self.renderer.prepare(frame);
        let Gpu { device, queue, .. } = self.renderer.gpu().clone();
        let mut encoder = device.create_command_encoder(&Default::default());
        self.renderer.encode(&mut encoder, &self.view);
        queue.submit([encoder.finish()]);
        device.poll(wgpu::PollType::wait_indefinitely()).map(|_| ()).map_err(|error| PictureError::Map(error.to_string()))
    }
}

/// Milliseconds that all threads of this process that still run have worked so far, on Linux.
pub fn processor_time() -> Option<f64> {
    let mut sum = 0.0;
    for task in std::fs::read_dir("/proc/self/task").ok()? {
        // The first field is the time on a processor, in ns. A thread may end while we read.
        let Ok(text) = std::fs::read_to_string(task.ok()?.path().join("schedstat")) else { continue };
        sum += text.split_whitespace().next()?.parse::<f64>().ok()? * 1e-6;
    }
    Some(sum)
}

/// The milliseconds that this thread has been on a processor, where the system tells; else those that have passed.
pub fn thread_time() -> f64 {
    #[cfg(unix)]
    let time = Duration::try_from(rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime)).unwrap_or_default();
    #[cfg(not(unix))]
    let time = {
        static BEGIN: std::sync::LazyLock<std::time::Instant> = std::sync::LazyLock::new(std::time::Instant::now);
        BEGIN.elapsed()
    };
    time.as_secs_f64() * 1e3
}
