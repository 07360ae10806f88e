//! The pipelines of the stages of geometry, compiled for a method of projection and a side of the horizon. What has been compiled is kept,
//! and the other side of the horizon can be compiled meanwhile on a thread of its own: drivers take tenths of a second for it, and longer
//! at the first time.

use std::sync::Arc;
use std::thread::JoinHandle;

use crate::lensing::methods::Method;
use crate::render::gpu::layout::compute_of;
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
    /// Layouts of groups 0 to 2.
    pub frame: wgpu::BindGroupLayout,
    pub geometry: wgpu::BindGroupLayout,
    pub arguments: wgpu::BindGroupLayout,
    pub worldlines: Worldlines,
}

impl PipelineInputs {
    fn pipelines(&self, (method, inside): Side) -> GeometryPipelines {
        let device = &self.device;
        let groups = [Some(&self.frame), Some(&self.geometry)];
        let module = |pass: Pass| pass.module_along(self.worldlines, method, inside);
        let stage = |label, pass, entry| compute_of(device, label, module(pass), entry, &groups);
        let with_arguments = [Some(&self.frame), Some(&self.geometry), Some(&self.arguments)];
        let argument = |entry| compute_of(device, entry, module(Pass::Arguments), entry, &with_arguments);
        GeometryPipelines {
            vertices: stage("vertices", Pass::Vertices, "main"),
            edges: stage("edges", Pass::Edges, "main"),
            triangles: stage("triangles", Pass::Triangles, "main"),
            refine: stage("refine", Pass::Refine, "main"),
            next_pieces: argument("next_pieces"),
            last_pieces: argument("last_pieces"),
            finish: argument("finish"),
            finish_thin: argument("finish_thin"),
            mesh_vertices: stage("mesh vertices", Pass::Mesh, "vertices"),
            mesh_triangles: stage("mesh triangles", Pass::Mesh, "triangles"),
        }
    }
}

/// All that have been compiled.
#[derive(Debug)]
pub(super) struct PipelineCache {
    inputs: PipelineInputs,
    now: Arc<GeometryPipelines>,
    side: Side,
    kept: Vec<(Side, Arc<GeometryPipelines>)>,
    /// What is being compiled in the background.
    ahead: Option<(Side, JoinHandle<GeometryPipelines>)>,
}

impl PipelineCache {
    /// With the pipelines of one side.
    pub fn new(inputs: PipelineInputs, side: Side) -> PipelineCache {
        let now = Arc::new(inputs.pipelines(side));
        PipelineCache { inputs, now: now.clone(), side, kept: vec![(side, now)], ahead: None }
    }

    /// The pipelines in use.
    pub fn now(&self) -> &GeometryPipelines {
        &self.now
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
            let pipelines = Arc::new(ahead.unwrap_or_else(|| self.inputs.pipelines(side)));
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
            let inputs = self.inputs.clone();
            // Without a thread it is compiled when it is needed.
            let thread = std::thread::Builder::new().name("stages".to_owned()).spawn(move || inputs.pipelines(side));
            self.ahead = thread.ok().map(|thread| (side, thread));
        }
    }
}

impl Drop for PipelineCache {
    fn drop(&mut self) {
        // The device must stay alive while a driver compiles.
        if let Some((_, thread)) = self.ahead.take() {
            let _ = thread.join();
        }
    }
}
