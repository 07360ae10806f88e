//! [`RelativisticRenderPlugin`]: the renderer inside Bevy. The main world makes a [`FrameInput`] each frame; it is drawn into the view of
//! the 2-D camera, after Bevy's own passes and under the user interface.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};

use bevy::core_pipeline::core_2d::main_transparent_pass_2d;
use bevy::core_pipeline::{Core2d, Core2dSystems};
use bevy::prelude::*;
use bevy::render::renderer::{RenderAdapterInfo, RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::view::ViewTarget;
use bevy::render::{Extract, ExtractSchedule, RenderApp};

use crate::render::Gpu;
use crate::render::frame::FrameInput;
use crate::render::gpu::device::{Watch, missing_limits};
use crate::render::renderer::{Renderer, Surroundings};

/// The renderer, for the main world (models, timings) and the render world (frames) alike.
#[derive(Resource, Clone, Debug)]
pub struct SharedRenderer(Arc<Mutex<Renderer>>);

impl SharedRenderer {
    /// The renderer; waits while a frame is being recorded.
    pub fn lock(&self) -> MutexGuard<'_, Renderer> {
        // A thread that panicked while it held the renderer has ended the program already.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The renderer, unless a frame is being recorded.
    pub fn try_lock(&self) -> Option<MutexGuard<'_, Renderer>> {
        match self.0.try_lock() {
            Ok(guard) => Some(guard),
            Err(TryLockError::Poisoned(poisoned)) => Some(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        }
    }
}

/// Nearer than this, in r_s, a camera may soon be inside the horizon: seconds away for who falls, and none who circles is as near.
const NEAR_THE_HORIZON: f64 = 3.0;

/// What the next frame shows; None draws nothing.
#[derive(Resource, Clone, Debug, Default)]
pub struct FrameToDraw(pub Option<FrameInput>);

/// Draws [`FrameToDraw`] into the view of every 2-D camera. Add it after Bevy's `RenderPlugin`; [`SharedRenderer`] is there once the app's
/// plugins are finished, if the device is large enough; else the app ends with an error.
pub struct RelativisticRenderPlugin {
    /// Table, stars, Milky Way.
    pub surroundings: Surroundings,
}

impl Plugin for RelativisticRenderPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<FrameToDraw>();
    }

    fn finish(&self, app: &mut App) {
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
        let world = render_app.world();
        let (Some(device), Some(queue), Some(info)) =
            (world.get_resource::<RenderDevice>(), world.get_resource::<RenderQueue>(), world.get_resource::<RenderAdapterInfo>())
        else {
            error!("there is no graphics device to draw with");
            app.world_mut().write_message(AppExit::error());
            return;
        };
        let gpu =
            Gpu { device: device.wgpu_device().clone(), queue: (**queue.0).clone(), adapter: (***info).clone(), watch: Watch::default() };
        if let Some(needs) = missing_limits(&gpu.device.limits()) {
            error!("the GPU adapter `{}` cannot be used: {needs}", gpu.adapter.name);
            app.world_mut().write_message(AppExit::error());
            return;
        }
        // The size and the format are the window's from the first frame on.
        let renderer = Renderer::new(&gpu, &self.surroundings, wgpu::TextureFormat::Rgba8UnormSrgb, [1, 1]);
        let shared = SharedRenderer(Arc::new(Mutex::new(renderer)));
        render_app
            .insert_resource(shared.clone())
            .init_resource::<FrameToDraw>()
            .add_systems(ExtractSchedule, take_frame)
            .add_systems(Core2d, draw.after(main_transparent_pass_2d).in_set(Core2dSystems::MainPass));
        app.insert_resource(shared);
    }
}

fn take_frame(mut next: ResMut<FrameToDraw>, main: Extract<Res<FrameToDraw>>) {
    next.0.clone_from(&main.0);
}

fn draw(view: ViewQuery<&ViewTarget>, frame: Res<FrameToDraw>, renderer: Res<SharedRenderer>, mut context: RenderContext) {
    let target = view.into_inner();
    let Some(input) = &frame.0 else { return };
    let size = target.main_texture().size();
    if size.width == 0 || size.height == 0 {
        return;
    }
    let mut renderer = renderer.lock();
    renderer.set_output_format(target.main_texture_format());
    renderer.resize([size.width, size.height]);
    if input.camera.radius() < NEAR_THE_HORIZON {
        renderer.foresee_the_inside();
    }
    if renderer.prepare(input) {
        renderer.encode(context.command_encoder(), target.main_texture_view());
    }
}
