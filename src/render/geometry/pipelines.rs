//! The pipelines of the stages of geometry, compiled for a method of projection and a side of the horizon. What has been compiled is kept,
//! and the other side of the horizon can be compiled meanwhile on a thread of its own: drivers take tenths of a second for it, and longer
//! at the first time.

use std::sync::Arc;
use std::thread::JoinHandle;

use crate::lensing::methods::Method;
use crate::render::gpu::layout::{compute_in, module_of};
use crate::render::gpu::library::Worldlines;
use crate::render::gpu::shaders::Pass;

/// A method of projection, and whether the camera is inside the horizon.
pub(super) type Side = (Method, bool);

/// The pipelines, by the file of `shaders/geometry/` that they are from.
#[derive(Debug)]
pub(super) struct GeometryPipelines {
    pub vertices: wgpu::ComputePipeline,
    pub edges: wgpu::ComputePipeline,
    pub triangles: wgpu::ComputePipeline,
    pub refine: wgpu::ComputePipeline,
    pub next_pieces: wgpu::ComputePipeline,
    pub last_pieces: wgpu::ComputePipeline,
    pub finish: wgpu::ComputePipeline,
    pub finish_thin: wgpu::ComputePipeline,
    pub mesh_vertices: wgpu::ComputePipeline,
    pub mesh_triangles: wgpu::ComputePipeline,
}

/// What stages are compiled with.
#[derive(Clone, Debug)]
pub(super) struct PipelineInputs {
    pub device: wgpu::Device,
    /// Layouts of groups 0 to 2; group 1 is the stages' own.
    pub frame: wgpu::BindGroupLayout,
    pub geometry: wgpu::BindGroupLayout,
    pub arguments: wgpu::BindGroupLayout,
    pub worldlines: Worldlines,
}

impl GeometryPipelines {
    /// Compiles them.
    pub fn new(inputs: &PipelineInputs, (method, inside): Side) -> GeometryPipelines {
        let device = &inputs.device;
        let groups = [Some(&inputs.frame), Some(&inputs.geometry)];
        let with_arguments = [Some(&inputs.frame), Some(&inputs.geometry), Some(&inputs.arguments)];
        let module = |label, pass: Pass| module_of(device, label, pass.shader_along(inputs.worldlines, method, inside));
        let stage = |label, pass| compute_in(device, label, &module(label, pass), "main", &groups);
        let arguments = || {
            let arguments = module("arguments", Pass::Arguments);
            ["next_pieces", "last_pieces", "finish", "finish_thin"]
                .map(|entry| compute_in(device, entry, &arguments, entry, &with_arguments))
        };
        let mesh = || {
            let mesh = module("mesh", Pass::Mesh);
            let entry = |label, entry| compute_in(device, label, &mesh, entry, &groups);
            rayon::join(|| entry("mesh vertices", "vertices"), || entry("mesh triangles", "triangles"))
        };
        let first = || rayon::join(|| stage("vertices", Pass::Vertices), || stage("edges", Pass::Edges));
        let second = || rayon::join(|| stage("triangles", Pass::Triangles), || stage("refine", Pass::Refine));
        // Drivers compile on the thread that asks: on as many as there are.
        let (((vertices, edges), (triangles, refine)), ((mesh_vertices, mesh_triangles), [next_pieces, last_pieces, finish, finish_thin])) =
            rayon::join(|| rayon::join(first, second), || rayon::join(mesh, arguments));
        GeometryPipelines {
            vertices,
            edges,
            triangles,
            refine,
            next_pieces,
            last_pieces,
            finish,
            finish_thin,
            mesh_vertices,
            mesh_triangles,
        }
    }
}

/// All pipelines of a kind that have been compiled.
#[derive(Debug)]
pub(super) struct PipelineCache<P> {
    inputs: PipelineInputs,
    compile: fn(&PipelineInputs, Side) -> P,
    now: Arc<P>,
    side: Side,
    kept: Vec<(Side, Arc<P>)>,
    /// What is being compiled in the background.
    ahead: Option<(Side, JoinHandle<P>)>,
}

impl<P: Send + 'static> PipelineCache<P> {
    /// With the pipelines of one side.
    pub fn new(inputs: PipelineInputs, compile: fn(&PipelineInputs, Side) -> P, side: Side) -> PipelineCache<P> {
        let now = Arc::new(compile(&inputs, side));
        PipelineCache { inputs, compile, now: now.clone(), side, kept: vec![(side, now)], ahead: None }
    }

    /// The pipelines in use.
    pub fn now(&self) -> &P {
        &self.now
    }

    /// What they are compiled with.
    pub fn inputs(&self) -> &PipelineInputs {
        &self.inputs
    }

    /// The side that they are for.
    pub fn side(&self) -> Side {
        self.side
    }

    /// Uses the pipelines of this side from now on.
    pub fn choose(&mut self, side: Side) {
        if side == self.side {
            return;
        }
        self.side = side;
        let kept = self.kept.iter().find(|kept| kept.0 == side).map(|kept| kept.1.clone());
        self.now = kept.unwrap_or_else(|| {
            let ahead = self.ahead.take_if(|ahead| ahead.0 == side).and_then(|(_, thread)| thread.join().ok());
            let pipelines = Arc::new(ahead.unwrap_or_else(|| (self.compile)(&self.inputs, side)));
            self.kept.push((side, pipelines.clone()));
            pipelines
        });
    }

    /// This side will be needed: compiles it in the background, unless it is there or another is being compiled.
    pub fn precompile(&mut self, side: Side) {
        // What was compiled in advance and not used is kept as well.
        if let Some((other, thread)) = self.ahead.take_if(|ahead| ahead.1.is_finished())
            && let Ok(pipelines) = thread.join()
        {
            self.kept.push((other, Arc::new(pipelines)));
        }
        if self.ahead.is_none() && self.kept.iter().all(|kept| kept.0 != side) {
            let (inputs, compile) = (self.inputs.clone(), self.compile);
            let compile = move || {
                // The threads that frames are made on are left alone.
                match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
                    Ok(pool) => pool.install(|| compile(&inputs, side)),
                    Err(_) => compile(&inputs, side),
                }
            };
            // Without a thread it is compiled when it is needed.
            let thread = std::thread::Builder::new().name("stages".to_owned()).spawn(compile);
            self.ahead = thread.ok().map(|thread| (side, thread));
        }
    }
}

impl<P> Drop for PipelineCache<P> {
    fn drop(&mut self) {
        // The device must stay alive while a driver compiles.
        if let Some((_, thread)) = self.ahead.take() {
            let _ = thread.join();
        }
    }
}
