//! A glTF model seen past the hole, in an App of one's own: `cargo run --release --example lensed_model`.
//!
//! Three things make a picture: [`RelativisticRenderPlugin`]; once, a [`Stage`] of the scene, with its models in [`SceneToDraw`]; and each
//! frame a `FrameInput` in [`FrameToDraw`].

use std::sync::Arc;

use bevy::prelude::*;
use bevy::tasks::block_on;
use bevy::window::PrimaryWindow;
use glam::DVec3;
use lensrunner::render::plugin::{FrameToDraw, LensingTable, RelativisticRenderPlugin, SceneToDraw};
use lensrunner::render::shot::surroundings;
use lensrunner::render::stage::{Stage, settings, static_camera};
use lensrunner::scene::{self, GameConfig};

fn main() -> AppExit {
    App::new()
        .add_plugins(DefaultPlugins)
        .add_plugins(RelativisticRenderPlugin { surroundings })
        .add_systems(Update, (load.run_if(resource_added::<LensingTable>), draw.run_if(resource_exists::<CurrentStage>)))
        .run()
}

/// The scene, ready for frames.
#[derive(Resource)]
struct CurrentStage(Stage);

fn load(mut commands: Commands, table: Res<LensingTable>, mut drawn: ResMut<SceneToDraw>) {
    let config = GameConfig::default();
    let scene = scene::load(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/lensed_model.toml")).expect("the example's scene is beside it");
    let (stage, upload) = block_on(Stage::prepare(&table.0, &scene, scene.assemble(&config), &config, None));
    drawn.0 = Some(Arc::new(upload));
    commands.insert_resource(CurrentStage(stage));
    commands.spawn((Camera2d, Msaa::Off));
}

/// Swings a hovering camera to and fro, so that the model's image opens to a ring and closes again.
fn draw(mut current: ResMut<CurrentStage>, time: Res<Time>, windows: Query<&Window, With<PrimaryWindow>>, mut frame: ResMut<FrameToDraw>) {
    let Some(window) = windows.iter().next() else { return };
    let angle = 0.1 * time.elapsed_secs_f64().sin();
    let position = 12.0 * DVec3::new(angle.sin(), 0.0, angle.cos());
    let camera = static_camera(position, -position, DVec3::Y, 50f64.to_radians());
    let size = [window.physical_width(), window.physical_height()];
    frame.0 = Some(current.0.frame(camera, size, 0.0, &[], None, &settings(&GameConfig::default())));
}
