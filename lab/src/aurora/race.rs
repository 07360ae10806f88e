//! The experiment of Sekiguchi et al. on the GPU: the particle method in space and the exact walk on the screen, then the same splats for
//! both. By itself, for the chart `aurora`: it draws the experiment's scenes and not the game's.

use std::time::Instant;

use bytemuck::{Pod, Zeroable};
use wgpu::{BufferUsages, ShaderStages};

use lensrunner::render::Gpu;
use lensrunner::render::gpu::layout::{Raster, Slot, TableTexture, bind, buffer, compute_of, layout, module_of, raster, storage};
use lensrunner::render::gpu::library::{File, Library, Values, Worldlines};
use lensrunner::render::gpu::readback::{self, PictureError};
use lensrunner::render::gpu::targets::target;
use lensrunner::render::method::Method;

use crate::stopwatch::Stopwatch;

const EXPERIMENT: File = ("lab/shaders/aurora/experiment.wgsl", include_str!("../../shaders/aurora/experiment.wgsl"));
const FLAT: File = ("lab/shaders/aurora/experiment_flat.wgsl", include_str!("../../shaders/aurora/experiment_flat.wgsl"));
const BENT: File = ("lab/shaders/aurora/experiment_bent.wgsl", include_str!("../../shaders/aurora/experiment_bent.wgsl"));
const WALKS: File = ("lab/shaders/aurora/experiment_walks.wgsl", include_str!("../../shaders/aurora/experiment_walks.wgsl"));
const SPLAT: File = ("lab/shaders/aurora/experiment_splat.wgsl", include_str!("../../shaders/aurora/experiment_splat.wgsl"));
const BINDINGS: File = ("lab/shaders/aurora/experiment_bindings.wgsl", include_str!("../../shaders/aurora/experiment_bindings.wgsl"));

/// `Experiment` in WGSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in lab/shaders/aurora/experiment.wgsl")]
pub struct Experiment {
    pub origin: [f32; 4],
    pub place: [[f32; 4]; 3],
    pub axes: [[f32; 4]; 3],
    pub across: [[f32; 4]; 2],
    pub across_seen: [[f32; 4]; 2],
    pub screen: [f32; 4],
    pub various: [f32; 4],
    pub lattice: [f32; 4],
    pub cells: [u32; 4],
}

/// `Electron` in WGSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in lab/shaders/aurora/experiment.wgsl")]
pub struct Electron {
    pub top: [f32; 4],
    pub end: [f32; 4],
    pub numbers: [u32; 4],
}

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// Camera, lattice and numbers.
    pub uniform: Experiment,
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// What the lookup reads, where light is bent.
    pub slice: Option<&'a [[f32; 4]]>,
    /// The electrons.
    pub electrons: &'a [Electron],
    /// Apparent places on the lattice.
    pub nodes: &'a [[f32; 4]],
    /// Of each level, as lab/shaders/aurora/experiment_walks.wgsl reads them.
    pub air: &'a [[f32; 4]],
    /// The table of falls, as it reads it.
    pub falls: &'a [[f32; 4]],
    /// Photons per collision by line at each level.
    pub light: &'a [[f32; 4]],
}

/// The two walks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Walk {
    /// Every collision happens in space and is projected from there.
    Particles,
    /// Ends of chords are projected, the rest is on the screen.
    Exact,
}

/// A picture and what it took, in seconds: of its passes on the GPU, where the device tells, else from handing work to it until that is
/// done. A graphics card's passes take less than handing them over.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// Photons by line, row by row.
    pub pixels: Vec<[f32; 4]>,
    /// From electrons to points.
    pub walk: f64,
    /// From points to the picture.
    pub splat: f64,
}

/// Most points of an electron: one at every level.
const POINTS: u64 = 160;
/// The picture is added up in full floats: halves would lose the faint edges of splats where much has been added already.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// A shader of the experiment with the modules that it imports.
fn shader((path, source): File, others: &[File]) -> wgpu::naga::Module {
    let library = Library::new(Worldlines::Bodies, Method::Table, others);
    let shader = library.and_then(|mut library| library.compose(path, source, Values { inside: false, data_group: 1 }));
    shader.unwrap_or_else(|error| panic!("{error}"))
}

/// Pipelines of the experiment.
#[derive(Debug)]
pub struct Race {
    gpu: Gpu,
    walk_layout: wgpu::BindGroupLayout,
    splat_layout: wgpu::BindGroupLayout,
    /// Particles and exact, in flat space and through the table.
    walks: [[wgpu::ComputePipeline; 2]; 2],
    splat: wgpu::RenderPipeline,
    /// Kept from draw to draw: a new one is filled with zeros before it is used, which took as long as a walk.
    points: wgpu::Buffer,
    watch: Option<Stopwatch>,
    /// Which walks have run once: a driver compiles them then.
    warm: [[bool; 2]; 2],
}

/// A scene as the passes read it.
struct Bound {
    walk: wgpu::BindGroup,
    splat: wgpu::BindGroup,
    /// How many points are drawn, which the walk says.
    draws: wgpu::Buffer,
}

impl Race {
    /// Compiles the passes; None if the adapter cannot add up full floats.
    pub fn new(gpu: &Gpu) -> Option<Race> {
        if !gpu.device.features().contains(wgpu::Features::FLOAT32_BLENDABLE) {
            return None;
        }
        let device = &gpu.device;
        let slots = [Slot::Uniform, Slot::Numbers, Slot::Read, Slot::Uniform, Slot::Numbers, Slot::Numbers, Slot::Write, Slot::Write];
        let walk_layout = layout(device, "aurora race walk", ShaderStages::COMPUTE, &slots);
        let slots = [Slot::Uniform, Slot::Read, Slot::Uniform];
        let splat_layout = layout(device, "aurora race splat", ShaderStages::VERTEX_FRAGMENT, &slots);
        let walks = [false, true].map(|bent| {
            let shader = shader(WALKS, &[EXPERIMENT, BINDINGS, if bent { BENT } else { FLAT }]);
            ["particles", "exact"].map(|entry| compute_of(device, entry, shader.clone(), entry, &[Some(&walk_layout)]))
        });
        let module = module_of(device, "aurora race splat", shader(SPLAT, &[EXPERIMENT]));
        let one = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::One,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        let sum = Some(wgpu::BlendState { color: one, alpha: one });
        let stage = Raster { vertex: "vertex", fragment: "fragment", targets: &[(FORMAT, sum)], depth: None };
        let splat = raster(device, "aurora race splat", &module, stage, &[Some(&splat_layout)]);
        let points = buffer(device, "aurora race points", 0, BufferUsages::STORAGE);
        Some(Race { gpu: gpu.clone(), watch: Stopwatch::new(gpu), points, walk_layout, splat_layout, walks, splat, warm: [[false; 2]; 2] })
    }

    /// The adapter's name and kind.
    pub fn adapter(&self) -> String {
        self.gpu.adapter_name()
    }

    /// Draws the scene. What is there before the walk (electrons, tables, lattice) is not in the times.
    pub fn draw(&mut self, scene: &Scene, walk: Walk) -> Result<Drawn, PictureError> {
        let which = (usize::from(scene.slice.is_some()), usize::from(walk == Walk::Exact));
        if !std::mem::replace(&mut self.warm[which.0][which.1], true) {
            self.draw(scene, walk)?;
        }
        self.make_room(scene.electrons.len())?;
        let bound = self.bind(scene);
        let (texture, view) = target(&self.gpu.device, "aurora race light", scene.size, FORMAT);
        let walk = self.walk(&self.walks[which.0][which.1], &bound, scene.electrons.len())?;
        let splat = self.splat(&bound, &view)?;
        Ok(Drawn { pixels: readback::floats(&self.gpu, &texture)?, walk, splat })
    }

    /// Makes the buffer of points large enough for so many electrons.
    fn make_room(&mut self, electrons: usize) -> Result<(), PictureError> {
        let device = &self.gpu.device;
        let room = 16 * POINTS * electrons as u64;
        let most = device.limits().max_storage_buffer_binding_size;
        if room > most {
            let asked = format!("the points of {electrons} electrons take {room} bytes, a buffer of this adapter {most} at most");
            return Err(PictureError::Device(asked));
        }
        if self.points.size() < room {
            self.points = buffer(device, "aurora race points", room, BufferUsages::STORAGE);
        }
        Ok(())
    }

    /// A uniform buffer with these bytes.
    fn uniform(&self, label: &str, bytes: &[u8]) -> wgpu::Buffer {
        let uniform = buffer(&self.gpu.device, label, bytes.len() as u64, BufferUsages::UNIFORM);
        self.gpu.queue.write_buffer(&uniform, 0, bytes);
        uniform
    }

    /// Hands the scene to the adapter.
    fn bind(&self, scene: &Scene) -> Bound {
        let gpu = &self.gpu;
        let device = &gpu.device;
        let uniform = self.uniform("aurora race", bytemuck::bytes_of(&scene.uniform));
        let slice = TableTexture::of(gpu, "aurora race slice", scene.slice.unwrap_or(&[[0.0; 4]]));
        let electrons = storage(gpu, "aurora race electrons", scene.electrons);
        let air = self.uniform("aurora race air", bytemuck::cast_slice(scene.air));
        let light = self.uniform("aurora race light", bytemuck::cast_slice(scene.light));
        let falls = TableTexture::of(gpu, "aurora race falls", scene.falls);
        let nodes = TableTexture::of(gpu, "aurora race nodes", scene.nodes);
        let draws = buffer(device, "aurora race draws", 16, BufferUsages::STORAGE | BufferUsages::INDIRECT);
        gpu.queue.write_buffer(&draws, 0, bytemuck::cast_slice(&[3u32, 0, 0, 0]));
        let resources = [
            uniform.as_entire_binding(),
            slice.binding(),
            electrons.as_entire_binding(),
            air.as_entire_binding(),
            falls.binding(),
            nodes.binding(),
            self.points.as_entire_binding(),
            draws.as_entire_binding(),
        ];
        let walk = bind(device, "aurora race walk", &self.walk_layout, &resources);
        let resources = [&uniform, &self.points, &light].map(|buffer| buffer.as_entire_binding());
        let splat = bind(device, "aurora race splat", &self.splat_layout, &resources);
        Bound { walk, splat, draws }
    }

    /// Seconds from electrons to points.
    fn walk(&self, pipeline: &wgpu::ComputePipeline, bound: &Bound, electrons: usize) -> Result<f64, PictureError> {
        self.run(|encoder, watch| {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("aurora race walk"),
                timestamp_writes: watch.map(Stopwatch::compute),
            });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &bound.walk, &[]);
            pass.dispatch_workgroups(electrons.div_ceil(64) as u32, 1, 1);
        })
    }

    /// Seconds from points to the picture in `view`.
    fn splat(&self, bound: &Bound, view: &wgpu::TextureView) -> Result<f64, PictureError> {
        self.run(|encoder, watch| {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("aurora race splat"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store },
                })],
                timestamp_writes: watch.map(Stopwatch::render),
                ..Default::default()
            });
            pass.set_pipeline(&self.splat);
            pass.set_bind_group(0, &bound.splat, &[]);
            pass.draw_indirect(&bound.draws, 0);
        })
    }

    /// Seconds that the one pass takes which `record` records.
    fn run(&self, record: impl FnOnce(&mut wgpu::CommandEncoder, Option<&Stopwatch>)) -> Result<f64, PictureError> {
        let gpu = &self.gpu;
        let wait = || gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| PictureError::Map(error.to_string()));
        // What has been written to buffers is not in the time.
        gpu.queue.submit([]);
        wait()?;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        record(&mut encoder, self.watch.as_ref());
        if let Some(watch) = &self.watch {
            watch.stop(&mut encoder);
        }
        let start = Instant::now();
        gpu.queue.submit([encoder.finish()]);
        wait()?;
        let waited = start.elapsed().as_secs_f64();
        self.watch.as_ref().map_or(Ok(waited), |watch| watch.seconds(gpu, waited))
    }
}
