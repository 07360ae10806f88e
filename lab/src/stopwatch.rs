//! How long one pass took on the GPU, for contests: waited for, unlike the times of a frame ([`lensrunner::render::gpu::timing`]).

use wgpu::BufferUsages;

use lensrunner::render::Gpu;
use lensrunner::render::gpu::layout::buffer;
use lensrunner::render::gpu::readback::{self, PictureError};

/// Two timestamps.
#[derive(Debug)]
pub struct Stopwatch {
    set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
}

impl Stopwatch {
    /// None where the device has no timestamps.
    pub fn new(gpu: &Gpu) -> Option<Stopwatch> {
        if !gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let descriptor = wgpu::QuerySetDescriptor { label: Some("stopwatch"), ty: wgpu::QueryType::Timestamp, count: 2 };
        let resolved = buffer(&gpu.device, "stopwatch", 16, BufferUsages::QUERY_RESOLVE);
        Some(Stopwatch { set: gpu.device.create_query_set(&descriptor), resolved })
    }

    /// Where a compute pass writes its times.
    pub fn compute(&self) -> wgpu::ComputePassTimestampWrites<'_> {
        wgpu::ComputePassTimestampWrites { query_set: &self.set, beginning_of_pass_write_index: Some(0), end_of_pass_write_index: Some(1) }
    }

    /// After the pass.
    pub fn stop(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.resolve_query_set(&self.set, 0..2, &self.resolved, 0);
    }

    /// Seconds that the pass took, once it has been submitted; waits for it. They are `waited`, from handing it over until it was done,
    /// where the clock did not go on from its beginning to its end, or by more than that: such a clock stands, or was set.
    pub fn seconds(&self, gpu: &Gpu, waited: f64) -> Result<f64, PictureError> {
        let bytes = readback::buffer(gpu, &self.resolved)?;
        let ticks: &[u64] = bytemuck::cast_slice(&bytes[..16]);
        let told = ticks[1].saturating_sub(ticks[0]) as f64 * f64::from(gpu.queue.get_timestamp_period()) * 1e-9;
        Ok(if told > 0.0 && told <= waited { told } else { waited })
    }
}
