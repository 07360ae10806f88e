//! The game's methods of projection on a graphics adapter by themselves: many look-ups at once through the shipped shader functions, for
//! the chart and for the tests of twins.

use std::collections::HashMap;
use std::sync::Arc;
use std::time::Instant;

use wgpu::{BufferUsages, ShaderStages};

use lensrunner::lensing::methods::Method;
use lensrunner::lensing::{self, Slice, Table};
use lensrunner::render::Gpu;
use lensrunner::render::gpu::layout::{Slot, TableTexture, bind, buffer, compute_of, layout, storage};
use lensrunner::render::gpu::library::{File, Library, ShaderError, Values, Worldlines};
use lensrunner::render::gpu::readback::{self, PictureError};
use lensrunner::render::tables::Tables;

use crate::stopwatch::Stopwatch;

/// What calls the lookup.
const SHADER: File = ("lab/shaders/race.wgsl", include_str!("../../shaders/race.wgsl"));
/// What the lookup reads.
const BINDINGS: File = ("lab/shaders/race_bindings.wgsl", include_str!("../../shaders/race_bindings.wgsl"));

/// Threads of a workgroup.
const GROUP: usize = 64;
/// Threads and look-ups of each that are timed on a software driver and on a graphics card. There one look-up takes less time than to write
/// it down, and a dispatch of a few microseconds cannot be told from none.
const SOFTWARE: [usize; 2] = [8192, 1];
const HARDWARE: [usize; 2] = [1 << 18, 64];

/// Look-ups on the GPU.
#[derive(Debug)]
pub struct Race {
    gpu: Gpu,
    tables: Tables,
    layout: wgpu::BindGroupLayout,
    /// The look-up of each method, and the same dispatch without one.
    pipelines: HashMap<&'static str, [wgpu::ComputePipeline; 2]>,
}

impl Race {
    /// Of the game's methods; `table` is the one that it draws with.
    pub fn new(gpu: &Gpu, table: Arc<Table>) -> Race {
        let slots = [Slot::Uniform, Slot::Numbers, Slot::Read, Slot::Write];
        let layout = layout(&gpu.device, "race", ShaderStages::COMPUTE, &slots);
        Race { gpu: gpu.clone(), tables: Tables::new(table), layout, pipelines: HashMap::new() }
    }

    /// On the best adapter there is; None, and a word on stderr, where there is none.
    pub fn on_best_adapter() -> Option<Race> {
        let gpu = Gpu::headless().inspect_err(|error| eprintln!("lensrunner: {error}; the chart is drawn without a graphics adapter"));
        Some(Race::new(&gpu.ok()?, Arc::new(lensing::default_table())))
    }

    /// The tables of the methods.
    pub fn tables(&mut self) -> &mut Tables {
        &mut self.tables
    }

    /// The adapter's name and kind.
    pub fn adapter(&self) -> String {
        self.gpu.adapter_name()
    }

    /// What `method` reads for a camera at the radius `l`, r_s.
    pub fn texels(&mut self, method: Method, l: f64) -> Vec<[f32; 4]> {
        let slice = Slice::new(self.tables.small(), l);
        self.tables.texels(method, l, &slice).into_owned()
    }

    /// The rays of `rows` (along, across, height; the order, 4 more for light of any age) seen from the radius `l`: cos ψ, sin ψ, delay in
    /// r_s/c, 1 if there is one; frequency at the camera, radial momentum and frequency at the point, e.
    pub fn look_up(&mut self, method: Method, l: f64, rows: &[[f32; 4]]) -> Result<Vec<[[f32; 4]; 2]>, PictureError> {
        let (out, _) = self.dispatch(method, 0, l, rows, [rows.len(), 1])?;
        let bytes = readback::buffer(&self.gpu, &out)?;
        Ok(bytemuck::cast_slice::<u8, [[f32; 4]; 2]>(&bytes)[..rows.len()].to_vec())
    }

    /// Seconds for each of many look-ups of `rows`, what a dispatch and its rows cost by themselves taken off.
    pub fn time(&mut self, method: Method, l: f64, rows: &[[f32; 4]]) -> Result<f64, PictureError> {
        let many = if self.gpu.adapter.device_type == wgpu::DeviceType::Cpu { SOFTWARE } else { HARDWARE };
        let [threads, each] = many;
        let mut times = [0.0; 2];
        for (which, time) in times.iter_mut().enumerate() {
            *time = self.dispatch(method, which, l, rows, many)?.1;
        }
        Ok((times[0] - times[1]).max(0.0) / (threads * each) as f64)
    }

    /// Runs one pipeline on at least `threads` threads with `each` look-ups; the buffer it wrote and the seconds it took.
    fn dispatch(
        &mut self,
        method: Method,
        which: usize,
        l: f64,
        rows: &[[f32; 4]],
        [threads, each]: [usize; 2],
    ) -> Result<(wgpu::Buffer, f64), PictureError> {
        let texels = self.texels(method, l);
        let Race { gpu, layout, pipelines, .. } = self;
        let device = &gpu.device;
        let pipeline = &pipelines.entry(method.name).or_insert_with(|| {
            let shader = shader(method).unwrap_or_else(|error| panic!("{error}"));
            ["race", "idle"].map(|entry| compute_of(device, method.name, shader.clone(), entry, &[Some(layout)]))
        })[which];
        // Whole workgroups: the last row is looked up again.
        let mut padded = rows.to_vec();
        padded.resize(rows.len().next_multiple_of(GROUP).max(GROUP), rows.last().copied().unwrap_or([0.0; 4]));
        let threads = threads.next_multiple_of(GROUP).max(GROUP);
        let frame = buffer(device, "race frame", 16, BufferUsages::UNIFORM);
        gpu.queue.write_buffer(&frame, 0, bytemuck::bytes_of(&[each as f32, 0.0, 0.0, l as f32]));
        let (slice, rows) = (TableTexture::of(gpu, "race slice", &texels), storage(gpu, "race rows", &padded));
        let out = buffer(device, "race out", 32 * threads as u64, BufferUsages::STORAGE);
        let [frame, rows_in, out_to] = [&frame, &rows, &out].map(|b| b.as_entire_binding());
        let group = bind(device, "race", layout, &[frame, slice.binding(), rows_in, out_to]);
        gpu.queue.submit([]);
        wait(gpu)?;
        let watch = Stopwatch::new(gpu);
        let mut encoder = device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("race"),
                timestamp_writes: watch.as_ref().map(Stopwatch::compute),
            });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups((threads / GROUP) as u32, 1, 1);
        }
        if let Some(watch) = &watch {
            watch.stop(&mut encoder);
        }
        let start = Instant::now();
        gpu.queue.submit([encoder.finish()]);
        wait(gpu)?;
        let waited = start.elapsed().as_secs_f64();
        Ok((out, watch.map_or(Ok(waited), |watch| watch.seconds(gpu, waited))?))
    }
}

fn shader(method: Method) -> Result<wgpu::naga::Module, ShaderError> {
    let values = Values { inside: true, data_group: 1 };
    Library::new(Worldlines::Bodies, method, &[BINDINGS])?.compose(SHADER.0, SHADER.1, values)
}

fn wait(gpu: &Gpu) -> Result<(), PictureError> {
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).map(|_| ()).map_err(|error| PictureError::Map(error.to_string()))
}
