//! A frame from its input to the buffers of the device, in three steps: planned, uploaded, bound.

use web_time::Instant;

use crate::render::frame::{FrameInput, uniform};
use crate::render::gpu::layout::bind;
use crate::render::gpu::targets::Targets;
use crate::render::post_process::upscale::drawn_size;
use crate::render::renderer::plan::FramePlan;
use crate::render::renderer::{Before, Renderer};

impl Renderer {
    /// Plans a frame: works out all that the processor has to, and touches nothing of the device. There must be a device and a size, and
    /// the camera must be finite and away from r = 0; else nothing is planned, and false is returned.
    pub fn plan(&mut self, input: &FrameInput) -> bool {
        self.plan = None;
        let camera = &input.camera;
        if self.hidden || self.gpu.watch.complaint().is_some() {
            return false;
        }
        if !(camera.position.is_finite() && camera.momentum.is_finite() && camera.attitude.is_finite() && camera.radius() > 1e-3) {
            return false;
        }
        self.output.1 = input.settings.resolution;
        let size = drawn_size(self.output.0, self.output.1);
        self.timing.begin_work();
        let begin = Instant::now();
        self.slices.follow(self.tables.small(), camera.radius(), input.settings.method);
        let begin = self.timing.worked("slice of the table", begin);
        if let (Some(disk), Some(slice)) = (self.disk.as_mut().filter(|_| self.has_disk), &self.slices.slice) {
            disk.plan(input, slice, size[0]);
        }
        let begin = self.timing.worked("view of the disk", begin);
        let most = self.gpu.device.limits().max_storage_buffer_binding_size;
        let held = input.held.and_then(|flags| self.geometry.held_images(camera, &input.settings, flags));
        self.bodies.make(&input.placed, held, input.settings.vertex_budget, most);
        let mut uniform = uniform(input, size, self.bodies.capacity);
        if let Some(disk) = self.disk() {
            uniform.exposure_key = disk.disk().config.exposure_key as f32;
            uniform.disk_indices = [1; 4];
        }
        self.timing.worked("lists of bodies", begin);
        self.plan = Some(FramePlan { size, uniform });
        true
    }

    /// Uploads the planned frame of this input, and gives buffers, textures and targets the sizes that it needs. Without a plan nothing is
    /// done.
    pub fn prepare_resources(&mut self, input: &FrameInput) {
        let Some(FramePlan { size, mut uniform }) = self.plan.take() else { return };
        self.make_targets(size);
        let begin = Instant::now();
        if let Some(slice) = self.slices.slice.as_ref().filter(|_| std::mem::take(&mut self.slices.are_new)) {
            // The slices depend on radius and method alone.
            let method = input.settings.method;
            self.geometry.set_method(method, input.camera.radius() < 1.0);
            if self.method != method {
                self.aurora.set_method(&self.gpu.device, &self.frame_layout, method);
                self.method = method;
            }
            if self.lens_slice.write(&self.gpu, &self.tables.texels(method, input.camera.radius(), slice)) {
                self.frame_group = None;
            }
            self.sky_slice.write(&self.gpu, &self.slices.sky);
        }
        let begin = self.timing.worked("slice of the table", begin);
        if let Some(disk) = self.disk.as_mut().filter(|_| self.has_disk) {
            disk.prepare(&self.gpu, &self.frame_layout, input, size[0]);
        }
        let begin = self.timing.worked("view of the disk", begin);
        let ground = input.aurora.as_ref().and_then(|aurora| aurora.ground.as_ref());
        self.geometry.prepare(&self.gpu, &mut self.bodies, ground);
        if self.geometry.has_thin() {
            self.thin.prepare(&self.gpu, self.geometry.capacity().thin, size);
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
        self.stars.prepare(&self.gpu, input.settings.stars);
        let begin = self.timing.worked("lists of stars", begin);
        self.background.prepare(&self.gpu, size);
        self.aurora.prepare(&self.gpu, input.aurora.as_ref(), &self.targets);
        self.finish.smooth = input.settings.smooth && input.has_bodies();
        self.finish.has_own_ship = input.settings.unmetered[2] > 0.0;
        self.finish.blooms = input.settings.bloom > 0.0;
        self.finish.resolution = input.settings.resolution;
        self.timing.worked("rest of the uploads", begin);
    }

    /// Makes the bind groups of a frame whose resources are prepared: those whose resources are others than before. What only the size of
    /// the targets changes is bound with them.
    pub fn prepare_bind_groups(&mut self) {
        let begin = Instant::now();
        let device = &self.gpu.device;
        if self.frame_group.is_none() {
            let tables = [&self.lens_slice, &self.sky_slice, &self.blackbody];
            let [lens, sky, blackbody] = tables.map(|table| table.binding());
            let resources = [self.frame.as_entire_binding(), lens, sky, blackbody];
            self.frame_group = Some(bind(device, "frame", &self.frame_layout, &resources));
        }
        if let Some(disk) = self.disk.as_mut().filter(|_| self.has_disk) {
            disk.bind(device);
        }
        self.geometry.bind(device, &self.models);
        if self.geometry.has_thin() {
            self.thin.bind(device, [self.geometry.thin(), self.geometry.arguments()]);
        }
        self.background.bind(device);
        self.aurora.bind(device);
        self.timing.worked("rest of the uploads", begin);
    }

    /// All three steps, for who has no App: false if nothing was planned, and the frame stays as it was.
    pub fn prepare(&mut self, input: &FrameInput) -> bool {
        let is_planned = self.plan(input);
        if is_planned {
            self.prepare_resources(input);
            self.prepare_bind_groups();
        }
        is_planned
    }

    /// Makes targets of this size, for the output as it is.
    fn make_targets(&mut self, drawn: [u32; 2]) {
        if [drawn, self.output.0] != [self.targets.size, self.targets.output] {
            self.targets = Targets::new(&self.gpu.device, drawn, self.output.0);
            self.post_process.resize(&self.gpu, &self.targets, &self.adaptation);
        }
        self.upscale.resize(&self.gpu.device, &self.targets, self.post_process.adapted());
    }
}
