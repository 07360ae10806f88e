//! [`RelativisticRenderPlugin`]: the renderer inside Bevy. The main world says what to draw ([`SceneToDraw`], [`FrameToDraw`]); the render
//! world owns the [`Renderer`], draws it into the view of the 2-D camera, after Bevy's own passes and under the user interface, and gives
//! [`RenderStatistics`] back.

use std::sync::Arc;

use bevy::core_pipeline::core_2d::main_transparent_pass_2d;
use bevy::core_pipeline::{Core2d, Core2dSystems};
use bevy::platform::cell::SyncCell;
use bevy::prelude::*;
use bevy::render::renderer::{RenderAdapterInfo, RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::view::ViewTarget;
use bevy::render::{Extract, ExtractSchedule, MainWorld, Render, RenderApp, RenderStartup, RenderSystems};

use crate::lensing::Table;
use crate::render::Gpu;
use crate::render::disk::types::DiskCounters;
use crate::render::frame::FrameInput;
use crate::render::gpu::device::{Watch, missing_limits};
use crate::render::gpu::types::Counters;
use crate::render::renderer::{Renderer, SceneUpload, Surroundings};

/// Nearer than this, in r_s, a camera may soon be inside the horizon: seconds away for who falls, and none who circles is as near.
const NEAR_THE_HORIZON: f64 = 3.0;

/// Main world: the lensing table that the renderer draws with, for [`Stage::prepare`](crate::render::stage::Stage::prepare).
#[derive(Resource, Clone, Debug)]
pub struct LensingTable(pub Arc<Table>);

/// Main world: the models and the disk of the scene, uploaded when they change; None until a scene is loaded.
#[derive(Resource, Clone, Debug, Default)]
pub struct SceneToDraw(pub Option<Arc<SceneUpload>>);

/// Main world: what the next frame shows, made by the [`Stage`](crate::render::stage::Stage) of [`SceneToDraw`]; None draws nothing.
#[derive(Resource, Clone, Debug, Default)]
pub struct FrameToDraw(pub Option<FrameInput>);

/// Main world: what an earlier frame, two or three before this one, took and counted.
#[derive(Resource, Clone, Debug, Default)]
pub struct RenderStatistics {
    /// Whether counters are wanted: they are brought back only then.
    pub counting: bool,
    /// Duration of each pass on the GPU, in ms; empty where it has no timestamps.
    pub passes: Vec<(&'static str, f32)>,
    /// What the stages of the geometry counted.
    pub counters: Option<Counters>,
    /// What the stages of the disk counted, in a scene that has one.
    pub disk: Option<DiskCounters>,
}

/// Draws [`FrameToDraw`] into the view of every 2-D camera. Add it after Bevy's `RenderPlugin`. If there is no device, or one that is too
/// small, the app ends with an error.
pub struct RelativisticRenderPlugin {
    /// Table, stars, Milky Way.
    pub surroundings: Arc<Surroundings>,
}

impl Plugin for RelativisticRenderPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<FrameToDraw>()
            .init_resource::<SceneToDraw>()
            .init_resource::<RenderStatistics>()
            .insert_resource(LensingTable(self.surroundings.table.clone()));
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
        render_app
            .insert_resource(RendererInputs(self.surroundings.clone()))
            .init_resource::<FrameToDraw>()
            .init_resource::<SceneToDraw>()
            .add_systems(RenderStartup, make_renderer)
            .add_systems(ExtractSchedule, (take_frame, give_statistics).run_if(resource_exists::<OwnedRenderer>))
            .add_systems(Render, upload_scene.in_set(RenderSystems::PrepareResources).run_if(resource_exists::<OwnedRenderer>))
            .add_systems(
                Core2d,
                draw.after(main_transparent_pass_2d).in_set(Core2dSystems::MainPass).run_if(resource_exists::<OwnedRenderer>),
            );
    }

    fn finish(&self, app: &mut App) {
        let Some(render_app) = app.get_sub_app(RenderApp) else { return };
        let world = render_app.world();
        let complaint = match (world.get_resource::<RenderDevice>(), world.get_resource::<RenderAdapterInfo>()) {
            (Some(device), Some(info)) => {
                missing_limits(&device.limits()).map(|needs| format!("the GPU adapter `{}` cannot be used: {needs}", info.name))
            }
            _ => Some("there is no graphics device to draw with".into()),
        };
        if let Some(complaint) = complaint {
            error!("{complaint}");
            app.world_mut().write_message(AppExit::error());
        }
    }
}

/// Render world: the renderer. It is not there where the device cannot be used. One system at a time has it (its receivers are not shared
/// between threads).
#[derive(Resource)]
struct OwnedRenderer(SyncCell<Renderer>);

/// Render world: what the renderer is made of.
#[derive(Resource, Debug)]
struct RendererInputs(Arc<Surroundings>);

/// Compiles all passes. The size and the format are the window's from the first frame on.
fn make_renderer(
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    info: Res<RenderAdapterInfo>,
    ingredients: Res<RendererInputs>,
    mut commands: Commands,
) {
    if missing_limits(&device.limits()).is_some() {
        return;
    }
    let gpu = Gpu { device: device.wgpu_device().clone(), queue: (**queue.0).clone(), adapter: (***info).clone(), watch: Watch::default() };
    let renderer = Renderer::new(&gpu, &ingredients.0, wgpu::TextureFormat::Rgba8UnormSrgb, [1, 1]);
    commands.insert_resource(OwnedRenderer(SyncCell::new(renderer)));
}

fn take_frame(
    mut frame: ResMut<FrameToDraw>,
    mut scene: ResMut<SceneToDraw>,
    main_frame: Extract<Res<FrameToDraw>>,
    main_scene: Extract<Res<SceneToDraw>>,
) {
    frame.0.clone_from(&main_frame.0);
    // Marked as changed only where it is: then it is uploaded.
    let same = match (&scene.0, &main_scene.0) {
        (Some(here), Some(there)) => Arc::ptr_eq(here, there),
        (here, there) => here.is_none() && there.is_none(),
    };
    if !same {
        scene.0.clone_from(&main_scene.0);
    }
}

fn give_statistics(mut main: ResMut<MainWorld>, mut renderer: ResMut<OwnedRenderer>) {
    let Some(mut statistics) = main.get_resource_mut::<RenderStatistics>() else { return };
    let renderer = renderer.0.get();
    renderer.set_counting(statistics.counting);
    statistics.passes.clear();
    statistics.passes.extend_from_slice(renderer.timing().latest());
    (statistics.counters, statistics.disk) = renderer.latest_counters();
}

fn upload_scene(scene: Res<SceneToDraw>, mut renderer: ResMut<OwnedRenderer>) {
    if let Some(upload) = scene.0.as_ref().filter(|_| scene.is_changed()) {
        renderer.0.get().upload(upload);
    }
}

fn draw(view: ViewQuery<&ViewTarget>, frame: Res<FrameToDraw>, mut renderer: ResMut<OwnedRenderer>, mut context: RenderContext) {
    let target = view.into_inner();
    let renderer = renderer.0.get();
    let size = target.main_texture().size();
    let Some(input) = frame.0.as_ref().filter(|_| size.width > 0 && size.height > 0) else {
        renderer.nothing_shown();
        return;
    };
    renderer.set_output_format(target.main_texture_format());
    renderer.resize([size.width, size.height]);
    if input.camera.radius() < NEAR_THE_HORIZON {
        renderer.precompile_the_inside();
    }
    if renderer.prepare(input) {
        renderer.encode(context.command_encoder(), target.main_texture_view());
    } else {
        renderer.nothing_shown();
    }
}
