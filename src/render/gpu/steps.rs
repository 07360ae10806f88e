//! A frame in steps: each pass is submitted on its own and waited for.

use web_time::Instant;

use crate::render::Gpu;

/// What was recorded before the first pass: uploads and copies.
const BEFORE: &str = "copies before";

/// What each step of a frame takes by the processor's clock, from submission to the end of the device's work.
#[derive(Debug)]
pub struct Steps {
    gpu: Gpu,
    label: &'static str,
    taken: Vec<(&'static str, f32)>,
}

impl Steps {
    /// Steps on this device.
    pub fn new(gpu: &Gpu) -> Steps {
        Steps { gpu: gpu.clone(), label: BEFORE, taken: Vec::new() }
    }

    /// A new frame.
    pub fn begin(&mut self) {
        self.label = BEFORE;
        self.taken.clear();
    }

    /// A pass begins: all that was recorded before it is done first. `encoder` is a new one afterwards.
    pub fn step(&mut self, encoder: &mut wgpu::CommandEncoder, label: &'static str) {
        self.end(encoder);
        self.label = label;
    }

    /// What was recorded after the passes is a step of this name.
    pub fn last(&mut self, encoder: &mut wgpu::CommandEncoder, label: &'static str) {
        self.label = label;
        self.end(encoder);
    }

    /// The last pass has been recorded.
    pub fn end(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let recorded = std::mem::replace(encoder, self.gpu.device.create_command_encoder(&Default::default()));
        let commands = recorded.finish();
        let begin = Instant::now();
        self.gpu.queue.submit([commands]);
        // A device that is gone is reported by whoever waits for the frame.
        let _ = self.gpu.device.poll(wgpu::PollType::wait_indefinitely());
        self.taken.push((self.label, begin.elapsed().as_secs_f32() * 1e3));
    }

    /// The steps of the last frame in their order, in milliseconds; passes of one label come several times.
    pub fn taken(&self) -> &[(&'static str, f32)] {
        &self.taken
    }
}
