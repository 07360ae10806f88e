//! The renderer: one frame from a [`FrameInput`] to an output view. It owns every pass; Bevy, the `shot` command and the tests all use it
//! alike, in the same steps:
//!
//! | step | file | what |
//! |---|---|---|
//! | [`Renderer::plan`] | `plan`, `prepare` | the processor works out lists and numbers; the device is not touched |
//! | [`Renderer::prepare_resources`] | `prepare` | they are uploaded, and buffers and textures get their sizes |
//! | [`Renderer::prepare_bind_groups`] | `prepare` | what was replaced is bound |
//! | [`Renderer::encode`] | `encode` | all passes are recorded |
//!
//! Inside Bevy each is a system of its own ([`crate::render::plugin`]). Who has no App calls [`Renderer::prepare`], the first three, and
//! [`Renderer::encode`], or [`Renderer::picture`].

mod encode;
mod picture;
mod plan;
mod prepare;

use std::sync::Arc;

use wgpu::{BufferUsages, ShaderStages};

use crate::lensing::Table;
use crate::scene::model::Model;

use crate::lensing::methods::Method;
use crate::render::Gpu;
use crate::render::aurora::Aurora;
use crate::render::disk::types::DiskCounters;
use crate::render::disk::{DiskPasses, DrawnDisk};
use crate::render::frame::{FrameInput, blackbody_table};
use crate::render::geometry::Geometry;
use crate::render::geometry::lists::BodyLists;
use crate::render::geometry::thin::ThinLists;
use crate::render::gpu::device::wait;
use crate::render::gpu::layout::{Slot, TableTexture, buffer, layout, storage};
use crate::render::gpu::library::Worldlines;
use crate::render::gpu::readback::{self, DeferredCopy, PictureError};
use crate::render::gpu::targets::Targets;
use crate::render::gpu::timing::Timing;
use crate::render::gpu::types::{self, Counters, Star};
use crate::render::instances::held::HeldBodies;
use crate::render::models::{ModelRange, ModelSet, Models};
use crate::render::post_process::upscale::Upscale;
use crate::render::post_process::{Finish, PostProcess};
use crate::render::sky::table::NODES;
use crate::render::sky::{Background, Stars};
use crate::render::tables::Tables;
use plan::{FramePlan, Slices};

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
    /// What is held in place.
    pub held: HeldBodies,
    /// The disk, if the scene has one.
    pub disk: Option<DrawnDisk>,
    /// Frames of [`REHEARSED`] pixels to draw unseen before the first that is seen, so that all is compiled by then; with none the scene is
    /// shown at once.
    pub rehearsal: Vec<FrameInput>,
}

/// Width and height of the pictures that nobody sees, in pixels: drivers compile the same for all sizes, and a planet is still wide enough
/// for its aurora.
pub const REHEARSED: [u32; 2] = [192, 108];

/// All passes and their buffers.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    tables: Tables,
    frame: wgpu::Buffer,
    lens_slice: TableTexture,
    sky_slice: TableTexture,
    blackbody: TableTexture,
    adaptation: wgpu::Buffer,
    frame_layout: wgpu::BindGroupLayout,
    format: wgpu::TextureFormat,
    /// None where it is to be made.
    frame_group: Option<wgpu::BindGroup>,
    /// The tables at the radius of the last planned frame.
    slices: Slices,
    /// The frame that is planned and not yet prepared.
    plan: Option<FramePlan>,
    /// Its bodies.
    bodies: BodyLists,
    /// The method that the passes project by.
    method: Method,
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
    /// Size of the output in pixels, and the share of its width that is drawn; the targets follow when a frame is prepared.
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
        let adaptation = storage(gpu, "adaptation", &[types::Adaptation { exposure: 1.0, ..Default::default() }]);
        let drawn = size.map(|side| side.max(1));
        let targets = Targets::new(device, drawn, drawn);
        // Drivers compile on the thread that asks: on as many as there are.
        let finishing = || (PostProcess::new(device, &frame_layout, format), Upscale::new(device, &frame_layout, format));
        let sky = || {
            let background = Background::new(gpu, &frame_layout, &surroundings.milky_way);
            (background, Stars::new(gpu, &frame_layout, &surroundings.stars, &table), Aurora::new(gpu, &frame_layout))
        };
        let geometry = || Geometry::new(device, &frame_layout, Worldlines::Bodies);
        let (((mut post_process, upscale), (background, stars, aurora)), (geometry, thin)) =
            rayon::join(|| rayon::join(finishing, sky), || rayon::join(geometry, || ThinLists::new(device, &frame_layout)));
        post_process.resize(gpu, &targets, &adaptation);
        Renderer {
            geometry,
            thin,
            background,
            stars,
            aurora,
            models: Models::new(device),
            timing: Timing::new(gpu),
            gpu: gpu.clone(),
            tables: Tables::new(surroundings.table.clone()),
            frame,
            lens_slice,
            sky_slice,
            blackbody,
            adaptation,
            frame_layout,
            format,
            frame_group: None,
            slices: Slices::default(),
            plan: None,
            bodies: BodyLists::default(),
            method: Method::default(),
            disk: None,
            has_disk: false,
            upscale,
            post_process,
            output: (targets.size, 1.0),
            targets,
            hidden: size.contains(&0),
            finish: Finish { blooms: true, smooth: false, has_own_ship: false, steady: false, resolution: 1.0 },
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

    /// Draws the models, what is held and the disk of this scene from now on, and nothing of another.
    pub fn upload(&mut self, scene: &SceneUpload) {
        self.geometry.models_changed();
        self.models.upload(&self.gpu, scene.models.clone());
        self.geometry.set_held(&self.gpu, &scene.held);
        self.set_disk(scene.disk.clone());
    }

    /// Draws this disk from now on, or none.
    pub fn set_disk(&mut self, disk: Option<DrawnDisk>) {
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
        self.geometry.precompile(self.method, true);
    }

    /// Takes up another size of the output. Without a size, as a minimised window is, nothing is prepared until there is one again.
    pub fn resize(&mut self, size: [u32; 2]) {
        self.hidden = size.contains(&0);
        if !self.hidden {
            self.output.0 = size;
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
            self.post_process.resize(&self.gpu, &self.targets, &self.adaptation);
        }
    }

    /// The screen has stayed black in place of a frame.
    pub fn nothing_shown(&mut self) {
        self.before = Before::Black;
    }

    /// What the stages of geometry counted in the last frame.
    pub fn counters(&self) -> Result<Counters, PictureError> {
        wait(self.counters_later())
    }

    /// The same, where one cannot wait.
    pub async fn counters_later(&self) -> Result<Counters, PictureError> {
        let bytes = readback::buffer_later(&self.gpu, self.geometry.counters()).await?;
        Ok(first_of(&bytes))
    }

    /// Brings counters back after each frame to come, for [`latest_counters`](Renderer::latest_counters) and for the number of passes of
    /// splitting, which then follows what earlier frames needed; or no longer.
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
        let all = draws.chunks(crate::render::aurora::capacities::FOURS).take(self.aurora.images() as usize);
        Ok(Some(all.fold(vec![0; levels], |sum, image| {
            sum.iter().zip(image).map(|(sum, draw)| sum + draw[0] / crate::render::aurora::capacities::CORNERS).collect()
        })))
    }

    /// The aurora's passes, for tests that read their buffers.
    pub fn aurora(&self) -> &Aurora {
        &self.aurora
    }

    /// The stars' passes, for tests that read their buffers.
    pub fn stars(&self) -> &Stars {
        &self.stars
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
