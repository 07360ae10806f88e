//! The renderer and the thread that works on it: its passes are compiled, and a new scene is put on it, while the window shows something
//! else and answers.

use std::sync::Arc;

use bevy::platform::cell::SyncCell;
use bevy::prelude::Resource;

use crate::breath::breath;
use crate::render::disk::textures::make_patterns;
use crate::render::frame::FrameInput;
use crate::render::gpu::targets::target;
use crate::render::job::{Job, Wake};
use crate::render::renderer::{REHEARSED, Renderer, SceneUpload};

/// The renderer, or the thread that has it meanwhile. One system at a time has it (its receivers are not shared between threads).
#[derive(Resource)]
pub(super) struct RendererLoader {
    renderer: Option<SyncCell<Renderer>>,
    work: Option<Job<Renderer>>,
    scene: Option<Arc<SceneUpload>>,
    wake: Wake,
}

/// The thread that worked on the renderer ended badly: there is none any more.
#[derive(Debug)]
pub(super) struct Broken;

impl RendererLoader {
    /// Has a renderer made; who waits is woken by the end of that, and of all other work.
    pub fn begin<F: Future<Output = Renderer> + 'static>(wake: &Wake, make: impl FnOnce() -> F + Send + 'static) -> RendererLoader {
        let mut loader = RendererLoader { renderer: None, work: None, scene: None, wake: wake.clone() };
        loader.work(make);
        loader
    }

    fn work<F: Future<Output = Renderer> + 'static>(&mut self, work: impl FnOnce() -> F + Send + 'static) {
        self.work = Job::begin("renderer", &self.wake, work).ok();
    }

    /// Takes the renderer back from the thread that is done with it. Nothing is left where that thread failed or could not begin.
    pub fn collect(&mut self) -> Result<(), Broken> {
        if let Some(work) = self.work.take_if(|work| work.is_finished()) {
            self.renderer = work.join().ok().map(SyncCell::new);
        }
        if self.renderer.is_none() && self.work.is_none() { Err(Broken) } else { Ok(()) }
    }

    /// The renderer, if nobody works on it.
    pub fn renderer(&mut self) -> Option<&mut Renderer> {
        self.renderer.as_mut().map(SyncCell::get)
    }

    /// The scene that can be drawn now.
    pub fn ready(&self) -> Option<&Arc<SceneUpload>> {
        self.scene.as_ref().filter(|_| self.renderer.is_some())
    }

    /// Puts a scene on the renderer, if nobody works on it and it has another: at once, or where frames are to be rehearsed on a thread.
    pub fn put(&mut self, scene: &Arc<SceneUpload>) {
        if self.scene.as_ref().is_some_and(|there| Arc::ptr_eq(there, scene)) {
            return;
        }
        let Some(renderer) = self.renderer.take() else { return };
        let mut renderer = SyncCell::to_inner(renderer);
        self.scene = Some(scene.clone());
        if scene.rehearsal.is_empty() {
            renderer.upload(scene);
            self.renderer = Some(SyncCell::new(renderer));
            return;
        }
        let scene = scene.clone();
        self.work(async move || {
            if scene.disk.is_some() {
                make_patterns().await;
            }
            renderer.upload(&scene);
            breath().await;
            rehearse(&mut renderer, &scene.rehearsal).await;
            renderer
        });
    }
}

impl Drop for RendererLoader {
    fn drop(&mut self) {
        // The device must stay alive while a driver compiles.
        if let Some(work) = self.work.take() {
            _ = work.join();
        }
    }
}

/// Draws frames that nobody sees: some drivers compile a pass when it is first drawn with.
async fn rehearse(renderer: &mut Renderer, frames: &[FrameInput]) {
    let size = renderer.size();
    renderer.resize(REHEARSED);
    let gpu = renderer.gpu().clone();
    let (_texture, view) = target(&gpu.device, "rehearsal", REHEARSED, renderer.output_format());
    for frame in frames {
        if renderer.prepare(frame) {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            renderer.encode(&mut encoder, &view);
            gpu.queue.submit([encoder.finish()]);
            // A device that is lost meanwhile ends the game elsewhere.
            _ = gpu.device.poll(wgpu::PollType::wait_indefinitely());
            breath().await;
        }
    }
    renderer.resize(size);
}
