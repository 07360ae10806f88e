//! The renderer: one frame from a [`FrameInput`] to an output view. It owns every pass; Bevy, the `shot` command and the tests all use it
//! alike.

use std::mem::offset_of;
use std::sync::Arc;
use std::time::Instant;

use wgpu::{BufferUsages, ShaderStages};

use crate::lensing::{Slice, Table};
use crate::scene::model::Model;

use crate::render::Gpu;
use crate::render::aurora::Aurora;
use crate::render::disk::types::DiskCounters;
use crate::render::disk::{Disk, DiskPasses};
use crate::render::frame::{FrameInput, blackbody_table, uniform};
use crate::render::geometry::Geometry;
use crate::render::geometry::thin::ThinLists;
use crate::render::gpu::layout::{Slot, TableTexture, bind, buffer, layout, storage};
use crate::render::gpu::library::Worldlines;
use crate::render::gpu::readback::{self, DeferredCopy, Picture, PictureError};
use crate::render::gpu::targets::Targets;
use crate::render::gpu::timing::Timing;
use crate::render::gpu::types::{self, Counters, Star};
use crate::render::method::Method;
use crate::render::method::tables::Tables;
use crate::render::models::{ModelRange, ModelSet, Models};
use crate::render::passes::{Recording, Shown, begin_thin, colour, depth};
use crate::render::post_process::coverage::covered;
use crate::render::post_process::upscale::{Upscale, drawn_size};
use crate::render::post_process::{Finish, PostProcess};
use crate::render::sky::table::{NODES, sky_table, straight_sky_table};
use crate::render::sky::{Background, Stars};

/// What does not change from frame to frame.
#[derive(Clone, Debug)]
pub struct Surroundings {
    /// The baked table of lensing.
    pub table: Arc<Table>,
    /// The catalogue.
    pub stars: Vec<Star>,
    /// The Milky Way.
    pub milky_way: crate::render::sky::Panorama,
}

/// What the renderer needs of a scene before it can draw frames of it: data of the processor alone.
#[derive(Clone, Debug, Default)]
pub struct SceneUpload {
    /// All models, where their [`ModelRange`]s say.
    pub models: ModelSet,
    /// The disk, if the scene has one.
    pub disk: Option<Disk>,
    /// Frames to draw unseen before the first that is seen, so that all is compiled by then; with none the scene is shown at once.
    pub rehearsal: Vec<FrameInput>,
}

/// All passes and their buffers.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    tables: Tables,
    frame: wgpu::Buffer,
    lens_slice: TableTexture,
    sky_slice: TableTexture,
    /// The table of the sky for the radius that the slices are for.
    sky: Vec<[f32; 4]>,
    blackbody: TableTexture,
    adaptation: wgpu::Buffer,
    frame_layout: wgpu::BindGroupLayout,
    format: wgpu::TextureFormat,
    frame_group: wgpu::BindGroup,
    /// The radius and the method that the slices are for.
    sliced: (f64, Method),
    slice: Option<Slice>,
    disk: Option<DiskPasses>,
    /// Whether the scene has a disk; its passes are kept for the next that has.
    has_disk: bool,
    models: Models,
    geometry: Geometry,
    thin: ThinLists,
    background: Background,
    stars: Stars,
    aurora: Aurora,
    post_process: PostProcess,
    upscale: Upscale,
    targets: Targets,
    /// Size of the output in pixels, and the share of its width that is drawn.
    output: ([u32; 2], f32),
    /// The output has no size.
    hidden: bool,
    /// How the frame is finished; outlines are smooth where it has bodies.
    finish: Finish,
    before: Before,
    timing: Timing,
    /// Whether counters are brought back after each frame.
    counting: bool,
    /// The counters of geometry and disk of an earlier frame.
    counted: [DeferredCopy; 2],
}

/// What was on the screen before a frame: over that its mean brightness may rise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Before {
    /// Nothing.
    Black,
    /// A picture of unknown brightness.
    Unmeasured,
    /// A picture whose brightness is kept on the device.
    Measured,
}

impl Renderer {
    /// Compiles all passes for an output of `format` and `size`.
    pub fn new(gpu: &Gpu, surroundings: &Surroundings, format: wgpu::TextureFormat, size: [u32; 2]) -> Self {
        let device = &gpu.device;
        let frame_layout = layout(
            device,
            "frame",
            ShaderStages::COMPUTE | ShaderStages::VERTEX_FRAGMENT,
            &[Slot::Uniform, Slot::Numbers, Slot::Numbers, Slot::Numbers],
        );
        let frame = buffer(device, "frame", size_of::<types::Frame>() as u64, BufferUsages::UNIFORM);
        let lens_slice = TableTexture::new(device, "lens slice", false);
        let sky_slice = TableTexture::of(gpu, "sky slice", &[[0.0; 4]; NODES]);
        let table = blackbody_table();
        let blackbody = TableTexture::of(gpu, "black body", &table);
        // Until the first frame is metered, a middling exposure.
        let adaptation = storage(gpu, "adaptation", &[[1.0f32, 0.0, 0.0, 0.0]]);
        let mut post_process = PostProcess::new(device, &frame_layout, format);
        let targets = Targets::new(device, size.map(|side| side.max(1)));
        let upscale = Upscale::new(device, &frame_layout, format);
        post_process.resize(gpu, &targets, &adaptation);
        let frame_group = frame_bindings(device, &frame_layout, &frame, [&lens_slice, &sky_slice, &blackbody]);
        Renderer {
            geometry: Geometry::new(device, &frame_layout, Worldlines::Bodies),
            thin: ThinLists::new(device, &frame_layout),
            background: Background::new(gpu, &frame_layout, &surroundings.milky_way),
            stars: Stars::new(gpu, &frame_layout, &surroundings.stars, &table),
            aurora: Aurora::new(gpu, &frame_layout),
            models: Models::new(device),
            timing: Timing::new(gpu),
            gpu: gpu.clone(),
            tables: Tables::new(surroundings.table.clone()),
            frame,
            lens_slice,
            sky_slice,
            sky: Vec::new(),
            blackbody,
            adaptation,
            frame_layout,
            format,
            frame_group,
            sliced: (f64::NAN, Method::default()),
            slice: None,
            disk: None,
            has_disk: false,
            upscale,
            post_process,
            output: (targets.size, 1.0),
            targets,
            hidden: size.contains(&0),
            finish: Finish { blooms: true, smooth: false, steady: false, resolution: 1.0 },
            before: Before::Black,
            counting: false,
            counted: Default::default(),
        }
    }

    /// The device this renderer draws with.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The baked table.
    pub fn table(&self) -> &Arc<Table> {
        self.tables.small()
    }

    /// The tables of the methods.
    pub fn tables(&mut self) -> &mut Tables {
        &mut self.tables
    }

    /// Adds a model.
    pub fn add_model(&mut self, model: &Model) -> ModelRange {
        self.geometry.models_changed();
        self.models.add(&self.gpu, model)
    }

    /// Draws the models and the disk of this scene from now on, and nothing of another.
    pub fn upload(&mut self, scene: &SceneUpload) {
        self.geometry.models_changed();
        self.models.upload(&self.gpu, scene.models.clone());
        self.set_disk(scene.disk.clone());
    }

    /// Draws this disk from now on, or none.
    pub fn set_disk(&mut self, disk: Option<Disk>) {
        self.has_disk = disk.is_some();
        match (disk, &mut self.disk) {
            (Some(disk), Some(passes)) => passes.set(&self.gpu, &self.frame_layout, disk),
            (Some(disk), None) => self.disk = Some(DiskPasses::new(&self.gpu, &self.frame_layout, disk)),
            (None, _) => {}
        }
    }

    /// The passes of the disk, if the scene has one.
    pub fn disk(&self) -> Option<&DiskPasses> {
        self.disk.as_ref().filter(|_| self.has_disk)
    }

    /// What the stages of the disk counted in the last frame; None without a disk.
    pub fn disk_counters(&self) -> Result<Option<DiskCounters>, PictureError> {
        let Some(disk) = self.disk() else { return Ok(None) };
        let bytes = readback::buffer(&self.gpu, disk.arcs().counters())?;
        Ok(Some(first_of(&bytes)))
    }

    /// The size of the output, in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.output.0
    }

    /// The format of the output.
    pub(super) fn output_format(&self) -> wgpu::TextureFormat {
        self.format
    }

    /// The camera is near the horizon and may fall through it: what is needed inside is compiled meanwhile.
    pub fn precompile_the_inside(&mut self) {
        self.geometry.precompile(self.sliced.1, true);
    }

    /// Makes targets of another size. Without a size, as a minimised window is, nothing is prepared until there is one again.
    pub fn resize(&mut self, size: [u32; 2]) {
        self.hidden = size.contains(&0);
        if !self.hidden {
            self.draw_share(size, self.output.1);
        }
    }

    /// Makes targets for an output of `size`, of which the share `resolution` of the width and height is drawn.
    fn draw_share(&mut self, size: [u32; 2], resolution: f32) {
        self.output = (size, resolution);
        let drawn = drawn_size(size, resolution);
        self.upscale.resize(&self.gpu.device, drawn, size);
        if drawn != self.targets.size {
            self.targets = Targets::new(&self.gpu.device, drawn);
            self.post_process.resize(&self.gpu, &self.targets, &self.adaptation);
        }
    }

    /// Makes the passes for an output of another format.
    pub fn set_output_format(&mut self, format: wgpu::TextureFormat) {
        if format != self.format {
            self.format = format;
            // What the passes kept of the picture before goes with them.
            self.before = Before::Black;
            self.post_process = PostProcess::new(&self.gpu.device, &self.frame_layout, format);
            self.upscale = Upscale::new(&self.gpu.device, &self.frame_layout, format);
            self.upscale.resize(&self.gpu.device, self.targets.size, self.output.0);
            self.post_process.resize(&self.gpu, &self.targets, &self.adaptation);
        }
    }

    /// The screen has stayed black in place of a frame.
    pub fn nothing_shown(&mut self) {
        self.before = Before::Black;
    }

    /// Uploads what the frame needs. There must be a device and a size, and the camera must be finite and away from r = 0; else the frame
    /// stays as it was, and false is returned.
    pub fn prepare(&mut self, input: &FrameInput) -> bool {
        let camera = &input.camera;
        if self.hidden || self.gpu.watch.complaint().is_some() {
            return false;
        }
        if !(camera.position.is_finite() && camera.momentum.is_finite() && camera.attitude.is_finite() && camera.radius() > 1e-3) {
            return false;
        }
        if input.settings.resolution != self.output.1 {
            self.draw_share(self.output.0, input.settings.resolution);
        }
        self.timing.begin_work();
        let begin = Instant::now();
        let l = camera.radius();
        // The slices depend on radius and method alone.
        let method = input.settings.method;
        if self.sliced != (l, method) {
            self.geometry.set_method(method, l < 1.0);
            if self.sliced.1 != method {
                self.aurora.set_method(&self.gpu.device, &self.frame_layout, method);
            }
            self.sliced = (l, method);
            // A camera nearer than 0.05 or farther than 5,000 r_s sees the hole as from there.
            let slice = Slice::new(self.tables.small(), l);
            let texels = self.tables.texels(method, l, &slice);
            if self.lens_slice.write(&self.gpu, &texels) {
                let tables = [&self.lens_slice, &self.sky_slice, &self.blackbody];
                self.frame_group = frame_bindings(&self.gpu.device, &self.frame_layout, &self.frame, tables);
            }
            self.sky = if method.bends() { sky_table(l) } else { straight_sky_table() };
            self.sky_slice.write(&self.gpu, &self.sky);
            self.slice = Some(slice);
        }
        let begin = self.timing.worked("slice of the table", begin);
        if let (Some(disk), Some(slice), true) = (&mut self.disk, &self.slice, self.has_disk) {
            disk.prepare(&self.gpu, &self.frame_layout, input, slice, self.targets.size[0]);
        }
        let begin = self.timing.worked("view of the disk", begin);
        let ground = input.aurora.as_ref().and_then(|aurora| aurora.ground.as_ref());
        self.geometry.prepare(&self.gpu, &self.models, &input.placed, input.settings.vertex_budget, ground);
        if self.geometry.has_thin() {
            let buffers = [self.geometry.thin(), self.geometry.arguments()];
            self.thin.prepare(&self.gpu, buffers, self.geometry.capacity().thin, self.targets.size);
        }
        let mut uniform = uniform(input, self.targets.size, self.geometry.capacity());
        if let Some(disk) = self.disk() {
            uniform.exposure_key = disk.disk().config.exposure_key as f32;
            uniform.disk_indices = [1; 4];
        }
        self.finish.steady = input.settings.rise.is_finite();
        match self.before {
            Before::Black => {}
            // Nobody sees a jump here: it is the picture that was shown without a bound.
            Before::Unmeasured => uniform.most_rise = f32::MAX,
            Before::Measured => uniform.rise_per_luminance = 1.0,
        }
        self.gpu.queue.write_buffer(&self.frame, 0, bytemuck::bytes_of(&uniform));
        let begin = self.timing.worked("lists of bodies", begin);
        let edge = f64::from(uniform.shadow_edge);
        self.stars.prepare(&self.gpu, camera, if input.settings.stars { &self.sky } else { &[] }, edge, self.targets.size);
        let begin = self.timing.worked("lists of stars", begin);
        self.background.prepare(&self.gpu, self.targets.size);
        self.aurora.prepare(&self.gpu, input.aurora.as_ref(), &self.targets);
        self.finish.smooth = input.settings.smooth && !input.placed.is_empty();
        self.finish.blooms = input.settings.bloom > 0.0;
        self.finish.resolution = input.settings.resolution;
        self.timing.worked("rest of the uploads", begin);
        true
    }

    /// Records all passes of a prepared frame.
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder, output: &wgpu::TextureView) {
        let begin = Instant::now();
        self.timing.begin();
        self.counted.iter_mut().for_each(DeferredCopy::begin);
        // The own ship is lit by the exposure of the frame before, and stars that would not have been visible then are left out.
        let [exposure, known] = [offset_of!(types::Frame, last_exposure), offset_of!(types::Frame, exposure_known)];
        encoder.copy_buffer_to_buffer(&self.adaptation, 0, &self.frame, exposure as u64, 4);
        encoder.copy_buffer_to_buffer(&self.adaptation, 8, &self.frame, known as u64, 4);
        let disk = self.disk.as_ref().filter(|_| self.has_disk);
        let shown = Shown {
            geometry: &self.geometry,
            thin: &self.thin,
            background: &self.background,
            stars: &self.stars,
            aurora: &self.aurora,
            disk,
        };
        let mut recording =
            Recording { encoder: &mut *encoder, timing: &mut self.timing, frame: &self.frame_group, targets: &self.targets };
        shown.compute(&mut recording);
        if let Some(disk) = disk.filter(|disk| disk.is_of_arcs()) {
            // Whether any of it is in the picture.
            let [from, to] = [offset_of!(DiskCounters, indices), offset_of!(types::Frame, disk_indices)].map(|offset| offset as u64);
            recording.encoder.copy_buffer_to_buffer(disk.arcs().counters(), from, &self.frame, to, 16);
        }
        shown.draw_opaque(&mut recording);
        shown.walk(&mut recording);
        // What is behind the disk is dimmed by it.
        shown.draw_aurora(&mut recording, true);
        shown.lay_over(&mut recording, |recording| self.post_process.compose(recording, &self.thin));
        shown.draw_aurora(&mut recording, false);
        let drawn = self.upscale.drawn().unwrap_or(output);
        self.post_process.run(&mut recording, &self.adaptation, self.finish, drawn);
        self.upscale.run(&mut recording, output);
        self.before = if self.finish.steady { Before::Measured } else { Before::Unmeasured };
        if self.counting {
            self.counted[0].record(&self.gpu.device, encoder, self.geometry.counters());
            if let Some(disk) = disk {
                self.counted[1].record(&self.gpu.device, encoder, disk.arcs().counters());
            }
        }
        self.timing.end(encoder);
        self.timing.worked("encoding", begin);
    }

    /// Draws one frame into a texture of its own and brings it back. The exposure settles first: the frame is drawn twice. Of a frame that
    /// is drawn smaller than the output there is the finished picture alone.
    pub fn picture(&mut self, input: &FrameInput, layers: bool) -> Result<Picture, PictureError> {
        let format = wgpu::TextureFormat::Rgba8UnormSrgb;
        let (texture, view) = crate::render::gpu::targets::target(&self.gpu.device, "output", self.output.0, format);
        for _ in 0..2 {
            if !self.prepare(input) {
                return Err(self.gpu.watch.complaint().map_or(PictureError::Nothing, PictureError::Device));
            }
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            self.encode(&mut encoder, &view);
            if layers {
                self.encode_layers(&mut encoder);
            }
            self.gpu.queue.submit([encoder.finish()]);
        }
        let display = readback::texture(&self.gpu, &texture, 4)?;
        if self.upscale.drawn().is_some() {
            return Ok(Picture { size: self.output.0, display, ..Picture::default() });
        }
        let halves = readback::texture(&self.gpu, &self.targets.picture_texture, 8)?;
        let linear = halves
            .chunks_exact(8)
            .map(|texel| std::array::from_fn(|k| half::f16::from_le_bytes([texel[2 * k], texel[2 * k + 1]]).to_f32()))
            .collect();
        let (layers, surface) = match &self.targets.layers {
            Some(targets) if layers => (readback::floats(&self.gpu, &targets.what.0)?, readback::floats(&self.gpu, &targets.surface.0)?),
            _ => Default::default(),
        };
        let thin = if !layers.is_empty() && self.geometry.has_thin() {
            let sums = readback::texture(&self.gpu, &self.targets.thin_texture, 8)?;
            let signed = readback::texture(&self.gpu, &self.targets.thin_signed_texture, 4)?;
            let number = |bytes: &[u8]| half::f16::from_le_bytes([bytes[0], bytes[1]]).to_f32();
            sums.chunks_exact(8).zip(signed.chunks_exact(4)).map(|(sum, signed)| covered(number(&sum[6..]), number(signed))).collect()
        } else {
            Vec::new()
        };
        Ok(Picture { size: self.targets.size, display, linear, layers, surface, thin })
    }

    fn encode_layers(&mut self, encoder: &mut wgpu::CommandEncoder) {
        if self.geometry.has_thin() {
            // The sum of all: among images of the disk they are drawn in parts.
            self.geometry.draw_thin(&mut begin_thin(true, None, encoder, &self.frame_group, &self.targets));
        }
        let targets = self.targets.layers(&self.gpu.device);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("layers"),
            color_attachments: &[Some(colour(&targets.what.1, true)), Some(colour(&targets.surface.1, true))],
            depth_stencil_attachment: Some(depth(&targets.depth, true)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.frame_group, &[]);
        self.geometry.draw_layers(&mut pass);
    }

    /// What the stages of geometry counted in the last frame.
    pub fn counters(&self) -> Result<Counters, PictureError> {
        let bytes = readback::buffer(&self.gpu, self.geometry.counters())?;
        Ok(first_of(&bytes))
    }

    /// Brings counters back after each frame to come, for [`latest_counters`](Renderer::latest_counters), or no longer.
    pub fn set_counting(&mut self, counting: bool) {
        self.counting = counting;
    }

    /// What geometry and disk counted in an earlier frame, where that has come back; nothing waits for it.
    pub fn latest_counters(&mut self) -> (Option<Counters>, Option<DiskCounters>) {
        let has_disk = self.disk().is_some();
        let [geometry, disk] = &mut self.counted;
        (geometry.latest().map(first_of), disk.latest().filter(|_| has_disk).map(first_of))
    }

    /// Strokes of the aurora in the last frame, by level of its pyramid, all images together; None if none was prepared.
    pub fn aurora_strokes(&self) -> Result<Option<Vec<u32>>, PictureError> {
        if self.aurora.images() == 0 {
            return Ok(None);
        }
        let bytes = readback::buffer(&self.gpu, self.aurora.draws())?;
        let draws: Vec<[u32; 4]> = bytemuck::pod_collect_to_vec(&bytes);
        let levels = self.aurora.levels().count();
        let all = draws.chunks(crate::render::aurora::rooms::FOURS).take(self.aurora.images() as usize);
        Ok(Some(all.fold(vec![0; levels], |sum, image| {
            sum.iter().zip(image).map(|(sum, draw)| sum + draw[0] / crate::render::aurora::rooms::CORNERS).collect()
        })))
    }

    /// The aurora's passes, for tests that read their buffers.
    pub fn aurora(&self) -> &Aurora {
        &self.aurora
    }

    /// The geometry stages, for tests that read their buffers.
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// Durations of the passes of an earlier frame.
    pub fn timing(&mut self) -> &mut Timing {
        &mut self.timing
    }
}

/// The structure that a buffer begins with.
fn first_of<T: bytemuck::AnyBitPattern>(bytes: &[u8]) -> T {
    bytemuck::pod_read_unaligned(&bytes[..size_of::<T>()])
}

fn frame_bindings(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    frame: &wgpu::Buffer,
    [lens, sky, blackbody]: [&TableTexture; 3],
) -> wgpu::BindGroup {
    let resources = [frame.as_entire_binding(), lens.binding(), sky.binding(), blackbody.binding()];
    bind(device, "frame", layout, &resources)
}
