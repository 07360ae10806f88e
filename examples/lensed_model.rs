//! A glTF model seen past the hole, in an App of one's own: `cargo run --release --example lensed_model`.
//!
//! Three things make a picture: [`RelativisticRenderPlugin`], a [`Stage`] with the scene's models, and each frame a `FrameInput` in [`FrameToDraw`].

use bevy::prelude::*;
use bevy::window::PrimaryWindow;
use glam::DVec3;
use lensrunner::render::plugin::{FrameToDraw, RelativisticRenderPlugin, SharedRenderer};
use lensrunner::render::shot::surroundings;
use lensrunner::render::stage::{Stage, settings, static_camera};
use lensrunner::scene::{self, GameConfig};

fn main() -> AppExit {
    App::new()
        .add_plugins(DefaultPlugins)
        .add_plugins(RelativisticRenderPlugin { surroundings: surroundings() })
        .add_systems(Startup, |mut commands: Commands| {
            commands.spawn((Camera2d, Msaa::Off));
        })
        .add_systems(Update, draw)
        .run()
}

/// Swings a hovering camera to and fro, so that the model's image opens to a ring and closes again.
fn draw(world: &mut World, mut stage: Local<Option<Stage>>) {
    let config = GameConfig::default();
    // The renderer is there as soon as the graphics device is.
    let Some(renderer) = world.get_resource::<SharedRenderer>().cloned() else { return };
    let stage = stage.get_or_insert_with(|| {
        let scene = scene::load("examples/lensed_model.toml").expect("the example is started in the project's folder");
        Stage::new(&mut renderer.lock(), &scene, &config)
    });
    let mut windows = world.query_filtered::<&Window, With<PrimaryWindow>>();
    let Some(size) = windows.iter(world).next().map(|window| [window.physical_width(), window.physical_height()]) else { return };
    let angle = 0.1 * world.resource::<Time>().elapsed_secs_f64().sin();
    let position = 12.0 * DVec3::new(angle.sin(), 0.0, angle.cos());
    let camera = static_camera(position, -position, DVec3::Y, 50f64.to_radians());
    let frame = stage.frame(camera, size, 0.0, &[], None, &settings(&config));
    world.resource_mut::<FrameToDraw>().0 = Some(frame);
}
