//! How long each pass took on the GPU, where it has timestamps, and how many fragments passes shaded, where it counts them; and what the
//! processor did before.

use web_time::Instant;

use crate::render::Gpu;
use crate::render::gpu::steps::Steps;

/// Passes that can be timed in one frame: two images of an aurora have nine each, the disk four, bloom eleven, and some twenty more.
const PASSES: u32 = 96;
/// Passes whose fragments can be counted in one frame.
const COUNTED: u32 = 8;
/// Where counts begin in the buffer, in results: after the timestamps, aligned as the copy of results must be.
const COUNTS: u64 = ((2 * PASSES as u64) * 8).next_multiple_of(wgpu::QUERY_RESOLVE_BUFFER_ALIGNMENT) / 8;

/// Timestamps around passes and counts of fragments. Results come a few frames late, and never make the processor wait.
#[derive(Debug)]
pub struct Timing {
    inner: Option<Inner>,
    /// Passes are done one by one and waited for, instead of timed by timestamps.
    steps: Option<Steps>,
    /// What the processor did for this frame, in ms.
    work: Vec<(&'static str, f32)>,
}

#[derive(Debug)]
struct Inner {
    queries: wgpu::QuerySet,
    /// Counts of fragments, where the device has them.
    fragments: Option<wgpu::QuerySet>,
    resolved: wgpu::Buffer,
    mapped: wgpu::Buffer,
    /// Nanoseconds per tick.
    period: f32,
    labels: Labels,
    /// Labels of the frame whose copy is on its way, until it has been read.
    waiting: Option<(Labels, std::sync::mpsc::Receiver<bool>)>,
    copied: Option<Labels>,
    latest: Vec<(&'static str, f32)>,
    latest_fragments: Vec<(&'static str, u64)>,
    /// Whether passes are timed: timestamps take the processor's time too.
    timing: bool,
    /// Whether fragments are counted: it takes one or two hundredths of a pass on a software driver.
    counting: bool,
    /// Whether both are done in this frame: not while the results of an earlier one are on their way.
    now: bool,
}

/// The passes of a frame, in the order of their queries.
#[derive(Clone, Debug, Default)]
struct Labels {
    timed: Vec<&'static str>,
    counted: Vec<&'static str>,
}

impl Timing {
    /// Timestamps if the device has them.
    pub fn new(gpu: &Gpu) -> Self {
        if !gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return Timing { inner: None, steps: None, work: Vec::new() };
        }
        let size = (COUNTS + u64::from(COUNTED)) * 8;
        let counts = gpu.device.features().contains(wgpu::Features::PIPELINE_STATISTICS_QUERY);
        let make =
            |label, usage| gpu.device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false });
        Timing {
            inner: Some(Inner {
                queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                    label: Some("timestamps"),
                    ty: wgpu::QueryType::Timestamp,
                    count: 2 * PASSES,
                }),
                fragments: counts.then(|| {
                    gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                        label: Some("fragments"),
                        ty: wgpu::QueryType::PipelineStatistics(wgpu::PipelineStatisticsTypes::FRAGMENT_SHADER_INVOCATIONS),
                        count: COUNTED,
                    })
                }),
                resolved: make("timestamps", wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
                mapped: make("timestamps read back", wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
                period: gpu.queue.get_timestamp_period(),
                labels: Labels::default(),
                waiting: None,
                copied: None,
                latest: Vec::new(),
                latest_fragments: Vec::new(),
                timing: true,
                counting: false,
                now: false,
            }),
            steps: None,
            work: Vec::new(),
        }
    }

    /// Submits each pass of the frames to come on its own and waits for it, or no longer. On a software driver, whose timestamps say little
    /// about passes of compute, that tells what each takes; such a frame as a whole takes longer.
    pub fn set_steps(&mut self, gpu: &Gpu, wanted: bool) {
        self.steps = wanted.then(|| Steps::new(gpu));
    }

    /// In a frame that is done in steps: what was recorded after [`end`](Timing::end) is a step of this name.
    pub fn step(&mut self, encoder: &mut wgpu::CommandEncoder, label: &'static str) {
        if let Some(steps) = &mut self.steps {
            steps.last(encoder, label);
        }
    }

    /// Durations in milliseconds of the passes of the last frame that was done in steps, those of one label added, and what was copied
    /// before them.
    pub fn stepped(&self) -> Vec<(&'static str, f32)> {
        let mut sums = Vec::new();
        for &(label, time) in self.steps.iter().flat_map(Steps::taken) {
            add(&mut sums, label, time);
        }
        sums
    }

    /// The processor begins another frame.
    pub fn begin_work(&mut self) {
        self.work.clear();
    }

    /// The processor has worked on this part of the frame since `begin`; gives the time now. What it did for one part at several times
    /// counts together.
    pub fn worked(&mut self, label: &'static str, begin: Instant) -> Instant {
        let now = Instant::now();
        add(&mut self.work, label, (now - begin).as_secs_f32() * 1e3);
        now
    }

    /// What the processor did to prepare and record the last frame, in milliseconds.
    pub fn work(&self) -> &[(&'static str, f32)] {
        &self.work
    }

    /// A new frame. The one before has been submitted by now, so that its copy may be mapped: a buffer that a command still writes must not
    /// be.
    pub fn begin(&mut self) {
        self.steps.iter_mut().for_each(Steps::begin);
        self.receive();
        let Some(inner) = &mut self.inner else { return };
        inner.labels.timed.clear();
        inner.labels.counted.clear();
        if let Some(labels) = inner.copied.take() {
            let (send, receive) = std::sync::mpsc::channel();
            inner.mapped.slice(..).map_async(wgpu::MapMode::Read, move |result| {
                // Nobody waits any more if the renderer is gone.
                let _ = send.send(result.is_ok());
            });
            inner.waiting = Some((labels, receive));
        }
        inner.now = (inner.timing || inner.counting) && inner.waiting.is_none();
    }

    /// Whether each pass of this frame is timed by itself. Else passes of compute may be recorded as one.
    pub fn separates(&self) -> bool {
        self.steps.is_some() || self.inner.as_ref().is_some_and(|inner| inner.now)
    }

    fn slot(&mut self, encoder: &mut wgpu::CommandEncoder, label: &'static str) -> Option<(&wgpu::QuerySet, u32)> {
        if let Some(steps) = &mut self.steps {
            steps.step(encoder, label);
            return None;
        }
        let inner = self.inner.as_mut().filter(|inner| inner.now)?;
        let index = inner.labels.timed.len() as u32;
        if index >= PASSES {
            return None;
        }
        inner.labels.timed.push(label);
        Some((&inner.queries, 2 * index))
    }

    /// Where a compute pass writes its times; `encoder` is what it will be recorded with.
    pub fn compute<'a>(
        &'a mut self,
        encoder: &mut wgpu::CommandEncoder,
        label: &'static str,
    ) -> Option<wgpu::ComputePassTimestampWrites<'a>> {
        self.slot(encoder, label).map(|(query_set, first)| wgpu::ComputePassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// Where a render pass writes its times; `encoder` is what it will be recorded with.
    pub fn render<'a>(
        &'a mut self,
        encoder: &mut wgpu::CommandEncoder,
        label: &'static str,
    ) -> Option<wgpu::RenderPassTimestampWrites<'a>> {
        self.slot(encoder, label).map(|(query_set, first)| wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// Times the passes of the frames to come, as from the beginning on, or no longer.
    pub fn set_timing(&mut self, timing: bool) {
        if let Some(inner) = &mut self.inner {
            if timing && !inner.timing {
                // What is known is of another time.
                inner.latest.clear();
            }
            inner.timing = timing;
        }
    }

    /// Counts fragments in the frames to come, or no longer.
    pub fn set_counting(&mut self, counting: bool) {
        if let Some(inner) = &mut self.inner {
            inner.counting = counting;
        }
    }

    /// Draws in a pass while its fragments are counted, if that is asked for and the device does it.
    pub fn count(&mut self, label: &'static str, pass: &mut wgpu::RenderPass<'_>, draw: impl FnOnce(&mut wgpu::RenderPass<'_>)) {
        let counting = self.inner.as_mut().filter(|inner| inner.counting && inner.now);
        let counted = counting.and_then(|Inner { fragments, labels, .. }| Some((fragments.as_ref()?, &mut labels.counted)));
        match counted.filter(|(_, labels)| labels.len() < COUNTED as usize) {
            Some((queries, labels)) => {
                pass.begin_pipeline_statistics_query(queries, labels.len() as u32);
                labels.push(label);
                draw(pass);
                pass.end_pipeline_statistics_query();
            }
            None => draw(pass),
        }
    }

    /// Copies the results out.
    pub fn end(&mut self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(steps) = &mut self.steps {
            steps.end(encoder);
            return;
        }
        let Some(inner) = &mut self.inner else { return };
        if inner.labels.timed.is_empty() {
            return;
        }
        encoder.resolve_query_set(&inner.queries, 0..2 * inner.labels.timed.len() as u32, &inner.resolved, 0);
        if let Some(fragments) = inner.fragments.as_ref().filter(|_| !inner.labels.counted.is_empty()) {
            encoder.resolve_query_set(fragments, 0..inner.labels.counted.len() as u32, &inner.resolved, COUNTS * 8);
        }
        encoder.copy_buffer_to_buffer(&inner.resolved, 0, &inner.mapped, 0, inner.mapped.size());
        inner.copied = Some(inner.labels.clone());
    }

    /// Durations in milliseconds of the passes of an earlier frame, those of one label added; call as often as you like.
    pub fn latest(&mut self) -> &[(&'static str, f32)] {
        self.receive();
        self.inner.as_ref().map_or(&[], |inner| &inner.latest)
    }

    /// Fragments that passes of the latest frame that was counted shaded, those of one label added; of a device that does not count them
    /// none.
    pub fn latest_fragments(&mut self) -> &[(&'static str, u64)] {
        self.receive();
        self.inner.as_ref().map_or(&[], |inner| &inner.latest_fragments)
    }

    /// Takes up what has arrived.
    fn receive(&mut self) {
        let Some(inner) = &mut self.inner else { return };
        let arrived = inner.waiting.as_ref().and_then(|(_, receive)| receive.try_recv().ok());
        if let (Some(true), Some((labels, _))) = (arrived, inner.waiting.take_if(|_| arrived.is_some())) {
            let range = inner.mapped.slice(..).get_mapped_range();
            let ticks: Vec<u64> =
                range.chunks_exact(8).map(|b| u64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]])).collect();
            drop(range);
            inner.latest.clear();
            for (&label, pair) in labels.timed.iter().zip(ticks.chunks_exact(2)) {
                add(&mut inner.latest, label, pair[1].saturating_sub(pair[0]) as f32 * inner.period * 1e-6);
            }
            if !labels.counted.is_empty() {
                inner.latest_fragments.clear();
            }
            for (&label, &count) in labels.counted.iter().zip(&ticks[COUNTS as usize..]) {
                add(&mut inner.latest_fragments, label, count);
            }
            inner.mapped.unmap();
        }
    }
}

/// Passes of one label count together.
fn add<T: std::ops::AddAssign>(sums: &mut Vec<(&'static str, T)>, label: &'static str, value: T) {
    match sums.iter_mut().find(|(known, _)| *known == label) {
        Some((_, sum)) => *sum += value,
        None => sums.push((label, value)),
    }
}
