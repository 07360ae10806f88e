//! [`RelativisticRenderPlugin`]: the renderer inside Bevy. The main world says what to draw ([`SceneToDraw`], [`FrameToDraw`]); the render
//! world owns the [`Renderer`], draws it into the view of the 2-D camera, after Bevy's own passes and under the user interface, and gives
//! [`RenderStatistics`] back.
//!
//! Each step of the renderer is a system of its own, in Bevy's phase for it: extracted by `take_frame`, planned by `plan_frame` in `Queue`,
//! uploaded by `prepare_resources`, bound by `prepare_bind_groups`, and recorded by `draw` among the passes of the camera.

use std::sync::{Arc, OnceLock};

use bevy::core_pipeline::core_2d::main_transparent_pass_2d;
use bevy::core_pipeline::{Core2d, Core2dSystems};
use bevy::prelude::*;
use bevy::render::camera::SortedCameras;
use bevy::render::diagnostic::RecordDiagnostics;
use bevy::render::renderer::{RenderAdapterInfo, RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::view::ViewTarget;
use bevy::render::{Extract, ExtractSchedule, MainWorld, Render, RenderApp, RenderSystems};

use crate::lensing::Table;
use crate::render::Gpu;
use crate::render::disk::types::DiskCounters;
use crate::render::frame::FrameInput;
use crate::render::gpu::device::{Watch, missing_limits};
use crate::render::gpu::types::Counters;
use crate::render::job::{Job, Wake};
use crate::render::renderer::{Renderer, SceneUpload, Surroundings};
use crate::render::renderer_loader::{Broken, RendererLoader};

/// Nearer than this, in r_s, a camera may soon be inside the horizon: seconds away for who falls, and none who circles is as near.
const NEAR_THE_HORIZON: f64 = 3.0;

/// Main world: the lensing table that the renderer draws with, for [`Stage::prepare`](crate::render::stage::Stage::prepare). It is there
/// once it has been read.
#[derive(Resource, Clone, Debug)]
pub struct LensingTable(pub Arc<Table>);

/// Main world: the models and the disk of the scene, uploaded when they change; None until a scene is loaded.
#[derive(Resource, Clone, Debug, Default)]
pub struct SceneToDraw(pub Option<Arc<SceneUpload>>);

/// Main world: the scene that the renderer can draw now, all of its passes compiled; None while they are.
#[derive(Resource, Clone, Debug, Default)]
pub struct SceneReady(pub Option<Arc<SceneUpload>>);

/// Main world: what the next frame shows, made by the [`Stage`](crate::render::stage::Stage) of [`SceneToDraw`]; None draws nothing.
#[derive(Resource, Clone, Debug, Default)]
pub struct FrameToDraw(pub Option<FrameInput>);

/// Main world: whether anybody reads how long each pass takes. Else passes are not timed: that costs the processor time.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct PassesTimed(pub bool);

/// Main world: what an earlier frame, two or three before this one, took and counted.
#[derive(Resource, Clone, Debug, Default)]
pub struct RenderStatistics {
    /// Duration of each pass on the GPU, in ms; empty where it has no timestamps, or while they are not [timed](PassesTimed).
    pub passes: Vec<(&'static str, f32)>,
    /// What the processor did to prepare and record the last frame, in ms.
    pub work: Vec<(&'static str, f32)>,
    /// What the stages of the geometry counted.
    pub counters: Option<Counters>,
    /// What the stages of the disk counted, in a scene that has one.
    pub disk: Option<DiskCounters>,
}

/// Render world: the view that the frame is planned for; None if there is nothing to draw.
#[derive(Resource, Clone, Copy, Debug, Default)]
struct PlannedView(Option<Entity>);

/// Draws [`FrameToDraw`] into the view of the 2-D camera; of several, into that of the first by their order. Add it after Bevy's
/// `RenderPlugin`. Passes are compiled on a thread of their own; until then nothing is drawn. If there is no device, or one that is too
/// small, the app ends with an error.
pub struct RelativisticRenderPlugin {
    /// Makes table, stars, Milky Way; called on a thread of its own.
    pub surroundings: fn() -> Surroundings,
}

impl Plugin for RelativisticRenderPlugin {
    fn build(&self, app: &mut App) {
        let making = SurroundingsInTheMaking { ready: Arc::default(), make: self.surroundings };
        let wake = Wake::default();
        let early = making.clone();
        // Without this thread they are made when the renderer is.
        _ = Job::begin("surroundings", &wake, async move || _ = early.wait());
        app.init_resource::<FrameToDraw>()
            .init_resource::<SceneToDraw>()
            .init_resource::<SceneReady>()
            .init_resource::<RenderStatistics>()
            .init_resource::<PassesTimed>()
            .insert_resource(making.clone())
            .insert_resource(wake.clone())
            .add_systems(PreUpdate, take_table.run_if(not(resource_exists::<LensingTable>)));
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
        render_app
            .insert_resource(making)
            .insert_resource(wake)
            .init_resource::<FrameToDraw>()
            .init_resource::<SceneToDraw>()
            .init_resource::<PlannedView>()
            .add_systems(ExtractSchedule, (take_frame, exchange).chain().run_if(resource_exists::<RendererLoader>))
            .add_systems(
                Render,
                (
                    put_scene.in_set(RenderSystems::PrepareAssets),
                    plan_frame.in_set(RenderSystems::Queue),
                    prepare_resources.in_set(RenderSystems::PrepareResources),
                    prepare_bind_groups.in_set(RenderSystems::PrepareBindGroups),
                )
                    .run_if(resource_exists::<RendererLoader>),
            )
            .add_systems(
                Core2d,
                draw.after(main_transparent_pass_2d).in_set(Core2dSystems::MainPass).run_if(resource_exists::<RendererLoader>),
            );
    }

    fn finish(&self, app: &mut App) {
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
        let world = render_app.world_mut();
        let complaint = match (world.get_resource::<RenderDevice>(), world.get_resource::<RenderAdapterInfo>()) {
            (Some(device), Some(info)) => {
                missing_limits(&device.limits()).map(|needs| format!("the GPU adapter `{}` cannot be used: {needs}", info.name))
            }
            _ => Some("there is no graphics device to draw with".into()),
        };
        if let Some(complaint) = complaint {
            error!("{complaint}");
            app.world_mut().write_message(AppExit::error());
        } else {
            make_renderer(world);
        }
    }
}

/// Table, stars and Milky Way, made by whoever needs them first; both worlds have this.
#[derive(Resource, Clone, Debug)]
struct SurroundingsInTheMaking {
    ready: Arc<OnceLock<Surroundings>>,
    make: fn() -> Surroundings,
}

impl SurroundingsInTheMaking {
    /// Makes them, or waits for who does.
    fn wait(&self) -> &Surroundings {
        self.ready.get_or_init(self.make)
    }
}

fn take_table(making: Res<SurroundingsInTheMaking>, wake: Res<Wake>, mut commands: Commands) {
    if let Some(surroundings) = making.ready.get() {
        commands.insert_resource(LensingTable(surroundings.table.clone()));
        wake.wake();
    }
}

/// Has all passes compiled, before there is a window. The size is that of the window from the first frame on.
fn make_renderer(world: &mut World) {
    let (device, queue, info) = (world.resource::<RenderDevice>(), world.resource::<RenderQueue>(), world.resource::<RenderAdapterInfo>());
    let gpu = Gpu { device: device.wgpu_device().clone(), queue: (**queue.0).clone(), adapter: (***info).clone(), watch: Watch::default() };
    let making = world.resource::<SurroundingsInTheMaking>().clone();
    let make = async move || Renderer::new(&gpu, making.wait(), wgpu::TextureFormat::Rgba8UnormSrgb, [1, 1]);
    let loader = RendererLoader::begin(world.resource::<Wake>(), make);
    world.insert_resource(loader);
}

fn take_frame(
    mut frame: ResMut<FrameToDraw>,
    mut scene: ResMut<SceneToDraw>,
    main_frame: Extract<Res<FrameToDraw>>,
    main_scene: Extract<Res<SceneToDraw>>,
) {
    // In the memory of the frame before.
    frame.0.clone_from(&main_frame.0);
    scene.0.clone_from(&main_scene.0);
}

/// Takes the renderer back from its thread, and says how it stands.
fn exchange(mut main: ResMut<MainWorld>, mut loader: ResMut<RendererLoader>, mut said: Local<bool>) {
    if let Err(Broken) = loader.collect()
        && !std::mem::replace(&mut *said, true)
    {
        error!("the passes of the picture could not be compiled: the game ends");
        main.write_message(AppExit::error());
    }
    let ready = loader.ready().cloned();
    if let Some(mut state) = main.get_resource_mut::<SceneReady>() {
        state.0 = ready;
    }
    let timed = main.get_resource::<PassesTimed>().is_some_and(|timed| timed.0);
    let (Some(mut statistics), Some(renderer)) = (main.get_resource_mut::<RenderStatistics>(), loader.renderer()) else { return };
    // Splitting follows what earlier frames needed.
    renderer.set_counting(true);
    renderer.timing().set_timing(timed);
    statistics.passes.clear();
    if timed {
        statistics.passes.extend_from_slice(renderer.timing().latest());
    }
    statistics.work.clear();
    statistics.work.extend_from_slice(renderer.timing().work());
    (statistics.counters, statistics.disk) = renderer.latest_counters();
}

fn put_scene(scene: Res<SceneToDraw>, mut loader: ResMut<RendererLoader>) {
    if let Some(upload) = &scene.0 {
        loader.put(upload);
    }
}

/// Plans the frame for the view of the first 2-D camera that has one. Without a view, as in a minimised window, all stays as it was.
fn plan_frame(
    (cameras, views): (Res<SortedCameras>, Query<&ViewTarget, With<Camera2d>>),
    (frame, scene): (Res<FrameToDraw>, Res<SceneToDraw>),
    mut loader: ResMut<RendererLoader>,
    mut planned: ResMut<PlannedView>,
) {
    planned.0 = None;
    let Some((view, target)) = cameras.0.iter().find_map(|camera| Some((camera.entity, views.get(camera.entity).ok()?))) else { return };
    let size = target.main_texture().size();
    // Until a scene is there, its frames name models that are not.
    let is_there = scene.0.as_ref().is_some_and(|scene| loader.ready().is_some_and(|ready| Arc::ptr_eq(ready, scene)));
    let Some(renderer) = loader.renderer() else { return };
    let Some(input) = frame.0.as_ref().filter(|_| is_there && size.width > 0 && size.height > 0) else {
        renderer.nothing_shown();
        return;
    };
    renderer.set_output_format(target.main_texture_format());
    renderer.resize([size.width, size.height]);
    if renderer.plan(input) {
        planned.0 = Some(view);
    } else {
        renderer.nothing_shown();
    }
}

fn prepare_resources(planned: Res<PlannedView>, frame: Res<FrameToDraw>, mut loader: ResMut<RendererLoader>) {
    let (Some(_), Some(input), Some(renderer)) = (planned.0, &frame.0, loader.renderer()) else { return };
    if input.camera.radius() < NEAR_THE_HORIZON {
        renderer.precompile_the_inside();
    }
    renderer.prepare_resources(input);
}

fn prepare_bind_groups(planned: Res<PlannedView>, mut loader: ResMut<RendererLoader>) {
    if let (Some(_), Some(renderer)) = (planned.0, loader.renderer()) {
        renderer.prepare_bind_groups();
    }
}

/// Records the passes of the frame that is prepared for this view.
/// [`RenderDiagnosticsPlugin`](bevy::render::diagnostic::RenderDiagnosticsPlugin) gets their time together.
fn draw(view: ViewQuery<&ViewTarget>, planned: Res<PlannedView>, mut loader: ResMut<RendererLoader>, mut context: RenderContext) {
    let Some(renderer) = loader.renderer().filter(|_| planned.0 == Some(view.entity())) else { return };
    let diagnostics = context.diagnostic_recorder();
    let diagnostics = diagnostics.as_deref();
    let span = diagnostics.time_span(context.command_encoder(), "relativistic");
    renderer.encode(context.command_encoder(), view.into_inner().main_texture_view());
    span.end(context.command_encoder());
}
