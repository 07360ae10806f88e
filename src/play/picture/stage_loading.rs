//! A scene on its way to the screen: its models are made on a thread, then the renderer compiles what it needs for them on another.
//! Meanwhile the window answers.

use std::sync::Arc;

use bevy::prelude::*;

use crate::breath::breath;
use crate::play::camera::{CameraView, state_of};
use crate::play::loading::Loading;
use crate::play::picture::now::Now;
use crate::play::session::Session;
use crate::render::frame::FrameInput;
use crate::render::gpu::types::placed::THIN;
use crate::render::job::{Job, Wake};
use crate::render::plugin::{FrameToDraw, LensingTable, SceneReady, SceneToDraw};
use crate::render::renderer::{REHEARSED, SceneUpload};
use crate::render::stage::{Stage, settings};
use crate::scene::model::texture::make_planet;
use crate::sim::snapshot::FrameCamera;

/// The scene, ready for frames.
#[derive(Resource, Debug)]
pub struct CurrentStage(pub Stage);

/// A scene that is not ready yet.
#[derive(Resource, Debug)]
pub enum StageLoading {
    /// Its models are being made.
    Making(Job<(Stage, SceneUpload)>),
    /// The renderer has it and compiles.
    HandedOver(Box<Stage>, Arc<SceneUpload>),
}

/// Brings scenes to the renderer.
pub struct StageLoadingPlugin;

impl Plugin for StageLoadingPlugin {
    fn build(&self, app: &mut App) {
        let nothing = not(resource_exists::<CurrentStage>.or_else(resource_exists::<StageLoading>));
        app.init_resource::<Loading>().add_systems(
            PreUpdate,
            (restage.run_if(nothing), hand_over.run_if(resource_exists::<StageLoading>), show.run_if(resource_exists::<StageLoading>))
                .chain(),
        );
    }
}

/// Has the models and the disk of the session's scene made anew; until they are there the picture stays as it is.
pub fn restage(world: &mut World) {
    let (Some(table), Some(session)) = (world.get_resource::<LensingTable>(), world.get_resource::<Session>()) else { return };
    let (table, scene, config) = (table.0.clone(), session.scene.clone(), session.effective());
    let make = async move || {
        if let Some(planet) = &scene.planet {
            make_planet(planet.seed).await;
        }
        let assembly = scene.assemble(&config);
        breath().await;
        let (stage, upload) = Stage::prepare(&table, &scene, assembly, &config, None).await;
        (stage.watched(), upload)
    };
    match Job::begin("scene", world.resource::<Wake>(), make) {
        // What an earlier thread makes is not wanted any more.
        Ok(making) => world.insert_resource(StageLoading::Making(making)),
        Err(reason) => fail(world, &reason.to_string()),
    }
}

/// The same for another scene than before: there is no picture until it is there.
pub fn change_scene(world: &mut World) {
    if !world.contains_resource::<CurrentStage>() && !world.contains_resource::<StageLoading>() {
        // It has not begun: it will with the session as it is then.
        return;
    }
    world.remove_resource::<CurrentStage>();
    world.init_resource::<Loading>();
    world.insert_resource(FrameToDraw(None));
    restage(world);
}

/// Ends the game: without a scene there is nothing to see.
fn fail(world: &mut World, reason: &str) {
    error!("the scene cannot be loaded: {reason}");
    world.write_message(AppExit::error());
}

/// What is made goes to the renderer: at once where the picture before is shown on, else to be rehearsed.
fn hand_over(world: &mut World) {
    let making = match world.remove_resource::<StageLoading>() {
        Some(StageLoading::Making(making)) if making.is_finished() => making,
        Some(other) => return world.insert_resource(other),
        None => return,
    };
    let Ok((mut stage, mut upload)) = making.join() else { return fail(world, "its models could not be made") };
    if world.contains_resource::<CurrentStage>() {
        world.insert_resource(SceneToDraw(Some(Arc::new(upload))));
        world.insert_resource(CurrentStage(stage));
        // A frame of the models before names some that are no longer there.
        world.insert_resource(FrameToDraw(None));
        return;
    }
    upload.rehearsal = world.run_system_cached_with(rehearsal, &mut stage).unwrap_or_default();
    let upload = Arc::new(upload);
    world.insert_resource(SceneToDraw(Some(upload.clone())));
    world.insert_resource(StageLoading::HandedOver(Box::new(stage), upload));
    world.resource::<Wake>().wake();
}

/// Once the renderer is ready, frames are made.
fn show(world: &mut World) {
    let Some(StageLoading::HandedOver(_, upload)) = world.get_resource::<StageLoading>() else { return };
    if !world.resource::<SceneReady>().0.as_ref().is_some_and(|ready| Arc::ptr_eq(ready, upload)) {
        return;
    }
    if let Some(StageLoading::HandedOver(stage, _)) = world.remove_resource::<StageLoading>() {
        world.insert_resource(CurrentStage(*stage));
        world.remove_resource::<Loading>();
    }
}

/// Frames that need whatever this scene may need: as seen from the player's ship, each image once more as a thin one, and from far. What is
/// needed inside the horizon alone is compiled when the camera comes near it.
fn rehearsal(mut stage: InMut<Stage>, now: Now) -> Vec<FrameInput> {
    let Some((history, ..)) = now.own() else { return Vec::new() };
    let (me, time, config) = (now.session.player(), now.time(), &now.session.config);
    let state = state_of(&history.at(time));
    let field_of_view = config.video.fov.to_radians();
    let settings = settings(config);
    let mut frame = |shot: FrameCamera| {
        let settings = crate::render::settings::Settings { own_ship: shot.lit, ..settings };
        stage.frame(shot.camera, REHEARSED, time, &now.histories(), shot.hidden, &settings)
    };
    let mut own = frame(FrameCamera::own(me, &state, CameraView::ThirdPerson, state.attitude, now.session.length(me), field_of_view));
    let mut thin = own.placed.clone();
    thin.iter_mut().for_each(|image| image.instance.flags |= THIN);
    own.placed.append(&mut thin);
    let mut far = frame(FrameCamera::afar(state.position, 0.0, field_of_view));
    far.held = far.held.map(|flags| flags | THIN);
    vec![far, own]
}
