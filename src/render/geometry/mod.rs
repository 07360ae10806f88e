//! Geometry: models projected through the table, tessellated in two stages of compute in the manner of mesh shaders, and drawn.
//!
//! One file of `shaders/geometry/` a stage: place, vertices, edges, triangles (the object stage), refine, mesh, draw. They hand to each
//! other through the buffers of group 1; the processor only says which objects there are.

mod ground;
pub mod lists;
mod pipelines;
mod place;
pub mod thin;

use crate::render::gpu::targets::LAYERS_FORMAT;
use wgpu::{BufferUsages, ShaderStages};

use ground::GroundBuffers;
use lists::BodyLists;
use pipelines::{GeometryPipelines, PipelineCache, PipelineInputs};
use place::Placing;

use crate::lensing::methods::Method;
use crate::render::Gpu;
use crate::render::aurora::ground::GroundFrame;
use crate::render::gpu::layout::{
    Growing, HDR_FORMAT, MASK_FORMAT, Raster, Slot, TableTexture, bind, buffer, layout, module, raster_of, thin_formats,
};
use crate::render::gpu::library::Worldlines;
use crate::render::gpu::shaders::Pass;
use crate::render::gpu::types::{self, Capacity, Counters, SeenVertex};
use crate::render::instances::held::{HeldBodies, HeldImages};
use crate::render::models::Models;
use crate::render::settings::Settings;
use crate::spacetime::Observer;

/// Passes of splitting: one for each depth, and one for those at the last depth.
const REFINE_PASSES: u32 = 25;
/// Passes of splitting beyond those that an earlier frame needed. Each halves edges: in a frame an image does not become four times as large.
const MORE_PASSES: u32 = 2;

/// The stages of geometry and the buffers between them.
#[derive(Debug)]
pub struct Geometry {
    group_layout: wgpu::BindGroupLayout,
    draw_layout: wgpu::BindGroupLayout,
    pipelines: PipelineCache<GeometryPipelines>,
    placing: Placing,
    draws: Draws,
    /// Made when layers are first asked for.
    layer_draws: Option<LayerDraws>,
    /// Those of the prepared frame.
    lists: BodyLists,
    /// Passes of splitting in the frame that is recorded.
    refine_passes: u32,
    instances: TableTexture,
    chunks: [TableTexture; 3],
    seen: Growing,
    states: Growing,
    pieces: Growing,
    work: Growing,
    indices: Growing,
    thin: Growing,
    counters: wgpu::Buffer,
    arguments: wgpu::Buffer,
    arguments_group: wgpu::BindGroup,
    sampler: wgpu::Sampler,
    ground: GroundBuffers,
    /// None where they are to be made.
    groups: Option<([wgpu::BindGroup; 3], wgpu::BindGroup)>,
}

#[derive(Debug)]
struct Draws {
    opaque: wgpu::RenderPipeline,
    thin: wgpu::RenderPipeline,
    /// Thin images whose light crosses the disk's plane never, once, twice, three times.
    thin_across: [wgpu::RenderPipeline; 4],
    /// A mask of the own ship.
    own: wgpu::RenderPipeline,
}

/// What draws the layers of a picture.
#[derive(Debug)]
struct LayerDraws {
    opaque: wgpu::RenderPipeline,
    thin: wgpu::RenderPipeline,
}

/// Compiles pipelines of opaque or thin triangles, each by its name.
fn draw_pipeline<'d>(
    device: &'d wgpu::Device,
    frame_layout: &'d wgpu::BindGroupLayout,
    draw_layout: &'d wgpu::BindGroupLayout,
) -> impl Fn(&str, Raster) -> wgpu::RenderPipeline + use<'d> {
    let shader = module(device, "draw", Pass::Draw);
    move |label, stage| {
        let buffers = if stage.vertex.starts_with("thin") { &[thin_layout()] } else { &[seen_layout()] };
        raster_of(device, label, &shader, stage, &[Some(frame_layout), None, Some(draw_layout)], buffers)
    }
}

impl Draws {
    /// Compiles what draws the triangles that the stages make.
    fn new(device: &wgpu::Device, frame_layout: &wgpu::BindGroupLayout, draw_layout: &wgpu::BindGroupLayout) -> Draws {
        let pipeline = draw_pipeline(device, frame_layout, draw_layout);
        let one = |operation| wgpu::BlendComponent { src_factor: wgpu::BlendFactor::One, dst_factor: wgpu::BlendFactor::One, operation };
        let sum = wgpu::BlendState { color: one(wgpu::BlendOperation::Add), alpha: one(wgpu::BlendOperation::Add) };
        let sums = thin_formats(device).map(|format| (format, Some(sum)));
        let thin = |vertex| pipeline(vertex, Raster { vertex, fragment: "thin_fragment", targets: &sums, depth: Some(false) });
        let picture = [(HDR_FORMAT, None)];
        let opaque = Raster { vertex: "opaque_vertex", fragment: "opaque_fragment", targets: &picture, depth: Some(true) };
        let mask = [(MASK_FORMAT, None)];
        Draws {
            opaque: pipeline("opaque", opaque),
            own: pipeline("own", Raster { vertex: "own_vertex", fragment: "own_fragment", targets: &mask, depth: None }),
            thin: thin("thin_vertex"),
            // A name that ends in a digit is another one in a page.
            thin_across: ["thin_vertex_uncrossed", "thin_vertex_once", "thin_vertex_twice", "thin_vertex_thrice"].map(thin),
        }
    }
}

/// How surfaces are sampled.
fn surface_sampler(device: &wgpu::Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("surface"),
        address_mode_u: wgpu::AddressMode::Repeat,
        address_mode_v: wgpu::AddressMode::Repeat,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    })
}

/// [`SeenVertex`] as a vertex buffer, `SeenInput` of WGSL.
fn seen_layout() -> wgpu::VertexBufferLayout<'static> {
    const ATTRIBUTES: [wgpu::VertexAttribute; 12] = wgpu::vertex_attr_array![
        0 => Float32x3, 1 => Float32, 2 => Float32x3, 3 => Float32, 4 => Float32x3, 5 => Float32, 6 => Float32x2, 7 => Uint32, 8 => Uint32,
        9 => Float32x2, 10 => Float32, 11 => Float32
    ];
    wgpu::VertexBufferLayout {
        array_stride: size_of::<SeenVertex>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &ATTRIBUTES,
    }
}

/// `ThinVertex` as a vertex buffer, `ThinInput` of WGSL.
fn thin_layout() -> wgpu::VertexBufferLayout<'static> {
    const ATTRIBUTES: [wgpu::VertexAttribute; 5] =
        wgpu::vertex_attr_array![0 => Float32x4, 1 => Uint32, 2 => Float32, 3 => Uint32, 4 => Float32];
    wgpu::VertexBufferLayout { array_stride: types::THIN_BYTES, step_mode: wgpu::VertexStepMode::Vertex, attributes: &ATTRIBUTES }
}

impl Geometry {
    /// Compiles the stages, for models whose points have such worldlines.
    pub fn new(device: &wgpu::Device, frame_layout: &wgpu::BindGroupLayout, worldlines: Worldlines) -> Self {
        use Slot::{Read, Write};
        let group_layout = layout(
            device,
            "geometry",
            ShaderStages::COMPUTE,
            &[Slot::Words, Slot::Words, Slot::Words, Slot::Words, Slot::Words, Write, Write, Write, Write, Write, Write, Write],
        );
        let arguments_layout = layout(device, "arguments", ShaderStages::COMPUTE, &[Write]);
        let draw_layout = layout(
            device,
            "draw",
            ShaderStages::VERTEX_FRAGMENT,
            &[Slot::Words, Read, Read, Slot::TextureArray, Slot::Sampler, Slot::Uniform, Slot::Texture],
        );
        let inputs = PipelineInputs {
            device: device.clone(),
            frame: frame_layout.clone(),
            geometry: group_layout.clone(),
            arguments: arguments_layout.clone(),
            worldlines,
        };
        let (pipelines, draws) = rayon::join(
            || PipelineCache::new(inputs, GeometryPipelines::new, (Method::default(), false)),
            || Draws::new(device, frame_layout, &draw_layout),
        );
        let storage = BufferUsages::STORAGE;
        let arguments = buffer(device, "arguments", types::ARGUMENTS_BYTES, storage | BufferUsages::INDIRECT);
        let arguments_group = bind(device, "arguments", &arguments_layout, &[arguments.as_entire_binding()]);
        Geometry {
            group_layout,
            draws,
            layer_draws: None,
            draw_layout,
            pipelines,
            placing: Placing::new(device),
            lists: BodyLists::default(),
            refine_passes: REFINE_PASSES,
            instances: TableTexture::written(device, "instances", wgpu::TextureFormat::Rgba32Uint),
            chunks: ["vertex chunks", "edge chunks", "triangle chunks"]
                .map(|label| TableTexture::written(device, label, wgpu::TextureFormat::Rg32Uint)),
            seen: Growing::new(device, "seen vertices", storage | BufferUsages::VERTEX),
            states: Growing::new(device, "states", storage),
            pieces: Growing::new(device, "pieces", storage),
            work: Growing::new(device, "work", storage),
            indices: Growing::new(device, "indices", storage | BufferUsages::INDEX),
            thin: Growing::new(device, "thin", storage | BufferUsages::VERTEX),
            counters: buffer(device, "counters", size_of::<Counters>() as u64, storage),
            arguments,
            arguments_group,
            sampler: surface_sampler(device),
            ground: GroundBuffers::new(device),
            groups: None,
        }
    }

    /// Takes the stages of this method of projection, for a camera inside the horizon or outside; compiles them if need be.
    pub fn set_method(&mut self, method: Method, inside: bool) {
        self.pipelines.choose((method, inside));
        self.placing.choose((method, inside));
    }

    /// The camera may soon be on the other side of the horizon: compiles its stages in the background.
    pub fn precompile(&mut self, method: Method, inside: bool) {
        self.pipelines.precompile((method, inside));
        self.placing.precompile((method, inside));
    }

    /// Takes what a scene holds in place of what was held; the first compiles the stage that places it.
    pub fn set_held(&mut self, gpu: &Gpu, held: &HeldBodies) {
        self.groups = None;
        self.placing.set(gpu, held, self.pipelines.inputs(), self.pipelines.side());
    }

    /// What is held, as seen by a camera; each image gets `flags` besides. None if there is nothing.
    pub fn held_images(&self, camera: &Observer, settings: &Settings, flags: u32) -> Option<HeldImages> {
        self.placing.count().images(camera, settings, flags)
    }

    /// Whether anything is held in the prepared frame.
    pub fn has_held(&self) -> bool {
        self.lists.held.is_some()
    }

    /// Whether nothing is placed in the prepared frame: there is nothing to do or to draw.
    pub fn is_empty(&self) -> bool {
        self.lists.dispatch[2][0] == 0 && !self.has_held()
    }

    /// Whether any image of the prepared frame is thin: else two passes over the whole screen have nothing to do.
    pub fn has_thin(&self) -> bool {
        self.lists.thin_across.contains(&true)
    }

    /// Whether any of them may be thin and have light that crosses the disk's plane this often, up to three times.
    pub fn has_thin_across(&self, crossings: u32) -> bool {
        self.lists.thin_across.get(crossings as usize).is_some_and(|any| *any)
    }

    /// Room in the buffers, as given to the shaders.
    pub fn capacity(&self) -> Capacity {
        self.lists.capacity
    }

    /// Bind groups are made anew at the next [`Geometry::bind`]: call after models changed.
    pub fn models_changed(&mut self) {
        self.groups = None;
    }

    /// Uploads the lists of this frame, and makes room for what the stages make of them. `ground` is the aurora's light on its planet. The
    /// lists are kept: those of the frame before are given for them.
    pub fn prepare(&mut self, gpu: &Gpu, lists: &mut BodyLists, ground: Option<&GroundFrame>) {
        let (device, capacity) = (&gpu.device, lists.capacity);
        let [instances, chunks @ ..] = lists.texels_with_room();
        let mut replaced = self.instances.reserve(device, instances);
        replaced |= self.instances.write(gpu, &lists.texels);
        replaced |= self.ground.write(gpu, ground);
        for ((list, table), texels) in lists.chunks.iter().zip(&mut self.chunks).zip(chunks) {
            replaced |= table.reserve(device, texels);
            replaced |= table.write(gpu, list);
        }
        replaced |= self.seen.reserve(device, u64::from(capacity.vertices) * size_of::<SeenVertex>() as u64);
        let work = u64::from(capacity.work);
        replaced |= self.pieces.reserve(device, 2 * types::PIECE_BYTES * work);
        replaced |= self.work.reserve(device, types::WORK_BYTES * work);
        replaced |= self.indices.reserve(device, 4 * u64::from(capacity.indices));
        replaced |= self.thin.reserve(device, types::THIN_BYTES * u64::from(capacity.thin));
        replaced |= self.states.reserve(device, u64::from(lists.states) * 16);
        if replaced {
            self.groups = None;
        }
        gpu.queue.write_buffer(&self.counters, 0, bytemuck::bytes_of(&lists.counters));
        if let Some(held) = &lists.held {
            self.placing.write(gpu, held);
        }
        std::mem::swap(&mut self.lists, lists);
    }

    /// Makes the bind groups of a prepared frame, where buffers or the `models` are others than before.
    pub fn bind(&mut self, device: &wgpu::Device, models: &Models) {
        if self.groups.is_none() {
            self.groups = Some(self.make_groups(device, models));
            let [vertices, edges, triangles] = self.chunks.each_ref().map(TableTexture::binding);
            let tables = [self.instances.binding(), vertices, edges, triangles];
            self.placing.bind(device, [&self.counters, &self.arguments], tables);
        }
    }

    fn make_groups(&self, device: &wgpu::Device, models: &Models) -> ([wgpu::BindGroup; 3], wgpu::BindGroup) {
        let compute = std::array::from_fn(|kind| {
            let buffers = [
                &self.seen.buffer, &self.states.buffer, &self.pieces.buffer, &self.work.buffer, &self.indices.buffer, &self.thin.buffer,
                &self.counters,
            ];
            let tables = [
                self.instances.binding(),
                models.vertices.binding(),
                models.edges.binding(),
                models.triangles.binding(),
                self.chunks[kind].binding(),
            ];
            let resources: Vec<_> = tables.into_iter().chain(buffers.map(|buffer| buffer.as_entire_binding())).collect();
            bind(device, "geometry", &self.group_layout, &resources)
        });
        let textures = models
            .texture
            .create_view(&wgpu::TextureViewDescriptor { dimension: Some(wgpu::TextureViewDimension::D2Array), ..Default::default() });
        let draw = bind(
            device,
            "draw",
            &self.draw_layout,
            &[
                self.instances.binding(),
                self.seen.buffer.as_entire_binding(),
                models.material_buffer.buffer.as_entire_binding(),
                wgpu::BindingResource::TextureView(&textures),
                wgpu::BindingResource::Sampler(&self.sampler),
                self.ground.light.as_entire_binding(),
                wgpu::BindingResource::TextureView(&self.ground.view),
            ],
        );
        (compute, draw)
    }

    fn stage(&self, pass: &mut wgpu::ComputePass, pipeline: &wgpu::ComputePipeline, kind: usize) {
        let [x, y] = self.lists.dispatch[kind];
        let Some((groups, _)) = &self.groups else { return };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(1, &groups[kind], &[]);
        if self.has_held() {
            pass.dispatch_workgroups_indirect(&self.arguments, types::ARGUMENTS_CHUNKS[kind]);
        } else if x > 0 {
            pass.dispatch_workgroups(x, y, 1);
        }
    }

    fn single(&self, pass: &mut wgpu::ComputePass, pipeline: &wgpu::ComputePipeline) {
        let Some((groups, _)) = &self.groups else { return };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(1, &groups[0], &[]);
        pass.set_bind_group(2, &self.arguments_group, &[]);
        pass.dispatch_workgroups(1, 1, 1);
    }

    fn indirect(&self, pass: &mut wgpu::ComputePass, pipeline: &wgpu::ComputePipeline, offset: u64) {
        let Some((groups, _)) = &self.groups else { return };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(1, &groups[0], &[]);
        pass.dispatch_workgroups_indirect(&self.arguments, offset);
    }

    /// Stage 0: what is held.
    pub fn place(&self, pass: &mut wgpu::ComputePass) {
        if let Some(held) = &self.lists.held {
            self.placing.run(pass, held);
        }
    }

    /// Stage 1: model vertices.
    pub fn vertices(&self, pass: &mut wgpu::ComputePass) {
        self.stage(pass, &self.pipelines.now().vertices, 0);
    }

    /// Stage 2: model edges.
    pub fn edges(&self, pass: &mut wgpu::ComputePass) {
        self.stage(pass, &self.pipelines.now().edges, 1);
    }

    /// Stage 3: the object stage.
    pub fn triangles(&self, pass: &mut wgpu::ComputePass) {
        self.stage(pass, &self.pipelines.now().triangles, 2);
    }

    /// Makes so many passes of splitting as an earlier frame needed and a few more: what would need more is then drawn coarser and counted,
    /// and the next frame has them. None: as many as any frame needs.
    pub fn follow(&mut self, counters: Option<&Counters>) {
        self.refine_passes = counters.map_or(REFINE_PASSES, |earlier| (earlier.passes + MORE_PASSES).min(REFINE_PASSES));
    }

    /// Stage 4: splitting.
    pub fn refine(&self, pass: &mut wgpu::ComputePass) {
        for number in 1..=self.refine_passes {
            let is_cut = number == self.refine_passes && number < REFINE_PASSES;
            let pipelines = self.pipelines.now();
            self.single(pass, if is_cut { &pipelines.last_pieces } else { &pipelines.next_pieces });
            self.indirect(pass, &self.pipelines.now().refine, types::ARGUMENTS_REFINE);
        }
        self.single(pass, &self.pipelines.now().finish);
    }

    /// Stage 5: the mesh stage.
    pub fn mesh(&self, pass: &mut wgpu::ComputePass) {
        self.indirect(pass, &self.pipelines.now().mesh_vertices, types::ARGUMENTS_MESH_VERTICES);
        self.indirect(pass, &self.pipelines.now().mesh_triangles, types::ARGUMENTS_MESH);
        self.single(pass, &self.pipelines.now().finish_thin);
    }

    /// Takes a pipeline and the vertices that it draws; false if there is nothing, and the arguments are from another frame.
    fn begin(&self, pass: &mut wgpu::RenderPass, pipeline: &wgpu::RenderPipeline, vertices: &wgpu::Buffer) -> bool {
        let Some((_, group)) = self.groups.as_ref().filter(|_| !self.is_empty()) else { return false };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(2, group, &[]);
        pass.set_vertex_buffer(0, vertices.slice(..));
        true
    }

    fn draw_surfaces(&self, pass: &mut wgpu::RenderPass, pipeline: &wgpu::RenderPipeline) {
        if self.begin(pass, pipeline, &self.seen.buffer) {
            pass.set_index_buffer(self.indices.buffer.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed_indirect(&self.arguments, types::ARGUMENTS_OPAQUE);
        }
    }

    fn draw_all_thin(&self, pass: &mut wgpu::RenderPass, pipeline: &wgpu::RenderPipeline) {
        if self.begin(pass, pipeline, &self.thin.buffer) {
            pass.draw_indirect(&self.arguments, types::ARGUMENTS_THIN);
        }
    }

    /// Opaque triangles, with depth.
    pub fn draw_opaque(&self, pass: &mut wgpu::RenderPass) {
        self.draw_surfaces(pass, &self.draws.opaque);
    }

    /// The own ship's triangles, as a mask without depth.
    pub fn draw_own(&self, pass: &mut wgpu::RenderPass) {
        self.draw_surfaces(pass, &self.draws.own);
    }

    /// Thin triangles, summed.
    pub fn draw_thin(&self, pass: &mut wgpu::RenderPass) {
        self.draw_all_thin(pass, &self.draws.thin);
    }

    /// Takes the pipeline and the vertices of those of them whose light crosses the disk's plane so often, up to three times; false if
    /// there are none. Which they are, [`ThinLists`](thin::ThinLists) knows.
    pub fn begin_thin_across(&self, pass: &mut wgpu::RenderPass, crossings: u32) -> bool {
        self.draws.thin_across.get(crossings as usize).is_some_and(|pipeline| self.begin(pass, pipeline, &self.thin.buffer))
    }

    /// Compiles what draws layers, before they are first drawn.
    pub fn prepare_layers(&mut self, device: &wgpu::Device, frame_layout: &wgpu::BindGroupLayout) {
        self.layer_draws.get_or_insert_with(|| {
            let pipeline = draw_pipeline(device, frame_layout, &self.draw_layout);
            let targets = [(LAYERS_FORMAT, None); 2];
            let layers =
                |label, vertex| pipeline(label, Raster { vertex, fragment: "layers_fragment", targets: &targets, depth: Some(true) });
            LayerDraws { opaque: layers("layers", "opaque_vertex"), thin: layers("layers thin", "thin_layers_vertex") }
        });
    }

    /// The layers of both; after [`prepare_layers`](Geometry::prepare_layers).
    pub fn draw_layers(&self, pass: &mut wgpu::RenderPass) {
        let Some(draws) = &self.layer_draws else { return };
        self.draw_surfaces(pass, &draws.opaque);
        self.draw_all_thin(pass, &draws.thin);
    }

    /// The counters, for reading back.
    pub fn counters(&self) -> &wgpu::Buffer {
        &self.counters
    }

    /// Seen vertices: first those of the models, object by object and order by order, then those of the mesh stage.
    pub fn seen(&self) -> &wgpu::Buffer {
        &self.seen.buffer
    }

    /// The table of instances, for tests that read it.
    pub fn instances(&self) -> &wgpu::Texture {
        self.instances.texture()
    }

    /// Indirect arguments, laid out as `types::ARGUMENTS_*` say.
    pub fn arguments(&self) -> &wgpu::Buffer {
        &self.arguments
    }

    /// Thin triangles, `ThinVertex` of WGSL.
    pub fn thin(&self) -> &wgpu::Buffer {
        &self.thin.buffer
    }

    /// Indices of opaque triangles.
    pub fn indices(&self) -> &wgpu::Buffer {
        &self.indices.buffer
    }
}
