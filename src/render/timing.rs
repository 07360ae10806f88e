//! How long each pass took on the GPU, where it has timestamps.

use super::Gpu;

/// Passes that can be timed in one frame.
const PASSES: u32 = 40;

/// Timestamps around passes. Results come a few frames late, and never make the processor wait.
#[derive(Debug)]
pub struct Timing {
    inner: Option<Inner>,
}

#[derive(Debug)]
struct Inner {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    mapped: wgpu::Buffer,
    /// Nanoseconds per tick.
    period: f32,
    labels: Vec<&'static str>,
    /// Labels of the frame whose copy is on its way, until it has been read.
    waiting: Option<(Vec<&'static str>, std::sync::mpsc::Receiver<bool>)>,
    copied: Option<Vec<&'static str>>,
    latest: Vec<(&'static str, f32)>,
}

impl Timing {
    /// Timestamps if the device has them.
    pub fn new(gpu: &Gpu) -> Self {
        if !gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return Timing { inner: None };
        }
        let size = u64::from(2 * PASSES * 8);
        let make =
            |label, usage| gpu.device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false });
        Timing {
            inner: Some(Inner {
                queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                    label: Some("timestamps"),
                    ty: wgpu::QueryType::Timestamp,
                    count: 2 * PASSES,
                }),
                resolved: make("timestamps", wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
                mapped: make("timestamps read back", wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
                period: gpu.queue.get_timestamp_period(),
                labels: Vec::new(),
                waiting: None,
                copied: None,
                latest: Vec::new(),
            }),
        }
    }

    /// A new frame. The one before has been submitted by now, so that its copy may be mapped: a buffer that a command still writes must not be.
    pub fn begin(&mut self) {
        let Some(inner) = &mut self.inner else { return };
        inner.labels.clear();
        if let Some(labels) = inner.copied.take() {
            let (send, receive) = std::sync::mpsc::channel();
            inner.mapped.slice(..).map_async(wgpu::MapMode::Read, move |result| {
                // Nobody waits any more if the renderer is gone.
                let _ = send.send(result.is_ok());
            });
            inner.waiting = Some((labels, receive));
        }
    }

    fn slot(&mut self, label: &'static str) -> Option<(&wgpu::QuerySet, u32)> {
        let inner = self.inner.as_mut()?;
        let index = inner.labels.len() as u32;
        if index >= PASSES {
            return None;
        }
        inner.labels.push(label);
        Some((&inner.queries, 2 * index))
    }

    /// Where a compute pass writes its times.
    pub fn compute(&mut self, label: &'static str) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        self.slot(label).map(|(query_set, first)| wgpu::ComputePassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// Where a render pass writes its times.
    pub fn render(&mut self, label: &'static str) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        self.slot(label).map(|(query_set, first)| wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// Copies the times out, unless an earlier copy is still on its way.
    pub fn end(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let Some(inner) = &mut self.inner else { return };
        if inner.waiting.is_some() || inner.copied.is_some() || inner.labels.is_empty() {
            return;
        }
        encoder.resolve_query_set(&inner.queries, 0..2 * inner.labels.len() as u32, &inner.resolved, 0);
        encoder.copy_buffer_to_buffer(&inner.resolved, 0, &inner.mapped, 0, inner.mapped.size());
        inner.copied = Some(inner.labels.clone());
    }

    /// Durations in milliseconds of the passes of an earlier frame, those of one label added; call as often as you like.
    pub fn latest(&mut self) -> &[(&'static str, f32)] {
        let Some(inner) = &mut self.inner else { return &[] };
        let arrived = inner.waiting.as_ref().and_then(|(_, receive)| receive.try_recv().ok());
        if let (Some(ok), Some((labels, _))) = (arrived, inner.waiting.as_ref().map(|w| (w.0.clone(), ()))) {
            inner.waiting = None;
            if ok {
                let range = inner.mapped.slice(..).get_mapped_range();
                let ticks: Vec<u64> =
                    range.chunks_exact(8).map(|b| u64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]])).collect();
                drop(range);
                inner.latest.clear();
                for (&label, pair) in labels.iter().zip(ticks.chunks_exact(2)) {
                    let time = pair[1].saturating_sub(pair[0]) as f32 * inner.period * 1e-6;
                    match inner.latest.iter_mut().find(|(known, _)| *known == label) {
                        Some((_, sum)) => *sum += time,
                        None => inner.latest.push((label, time)),
                    }
                }
                inner.mapped.unmap();
            }
        }
        &inner.latest
    }
}
