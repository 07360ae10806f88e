//! The game on a picture instead of a window: it loads in the background, and goes on through what happens to windows, or says why not.

use bevy::input::ButtonState;
use bevy::input::keyboard::{Key, KeyboardInput};
use bevy::prelude::*;
use bevy::render::renderer::RenderDevice;
use bevy::window::{PrimaryWindow, WindowFocused};
use lensrunner::play::choices::Choices;
use lensrunner::play::loading::Loading;
use lensrunner::play::picture::CurrentShot;
use lensrunner::play::session::Session;
use lensrunner::play::window::{Options, OutputSurface, app};
use lensrunner::render::plugin::FrameToDraw;
use lensrunner::sim::Clock;

/// Frames after which what has not been loaded will not be: ten minutes of those that are limited while it loads.
const PATIENCE: u32 = 12_000;

/// A flight of the chase that has just begun to load.
fn game() -> App {
    let session = Session::load(None, Some("ring"), Some(1)).expect("the game's own files");
    let mut config = session.clone();
    config.config.interface.warned = true;
    let options = Options { at_once: true, ..Options::default() };
    let mut app = app(config, &options, OutputSurface::Picture([64, 48]), Choices::default());
    app.finish();
    app.cleanup();
    app
}

fn time(app: &App) -> f64 {
    app.world().resource::<Clock>().time
}

fn load(app: &mut App) {
    for _ in 0..PATIENCE {
        if !app.world().contains_resource::<Loading>() {
            return;
        }
        app.update();
        assert!(app.should_exit().is_none(), "the game ended");
    }
    panic!("the scene has not come");
}

/// While the scene loads, frames pass and time does not. Without an area nothing is drawn, and the flight goes on. Then the device is
/// lost: the game ends with an error, and no panic.
#[test]
fn the_game_goes_on_or_ends_without_a_panic() {
    let mut app = game();
    (0..2).for_each(|_| app.update());
    assert!(app.world().contains_resource::<Loading>(), "compiled in two frames");
    assert_eq!(time(&app), 0.0, "time passes while the scene loads");
    load(&mut app);
    (0..10).for_each(|_| app.update());
    assert!(time(&app) > 0.0 && app.world().resource::<FrameToDraw>().0.is_some());

    let set = |app: &mut App, size: [u32; 2]| {
        let mut windows = app.world_mut().query_filtered::<&mut Window, With<PrimaryWindow>>();
        let mut window = windows.single_mut(app.world_mut()).expect("one window");
        window.resolution.set_physical_resolution(size[0], size[1]);
    };
    for size in [[0, 0], [1, 1], [3, 1000]] {
        let before = time(&app);
        set(&mut app, size);
        (0..5).for_each(|_| app.update());
        assert!(app.should_exit().is_none(), "{size:?}");
        assert_eq!(app.world().resource::<CurrentShot>().0.is_none(), size == [0, 0], "{size:?}");
        assert!(time(&app) > before, "{size:?}");
    }
    set(&mut app, [64, 48]);

    // Focus is lost while a key is held.
    let window = app.world_mut().query_filtered::<Entity, With<PrimaryWindow>>().single(app.world()).expect("one window");
    app.world_mut().write_message(KeyboardInput {
        key_code: KeyCode::KeyW,
        logical_key: Key::Character("w".into()),
        state: ButtonState::Pressed,
        text: None,
        repeat: false,
        window,
    });
    app.update();
    assert!(app.world().resource::<ButtonInput<KeyCode>>().pressed(KeyCode::KeyW));
    app.world_mut().write_message(bevy::input::keyboard::KeyboardFocusLost);
    app.world_mut().write_message(WindowFocused { window, focused: false });
    (0..3).for_each(|_| app.update());
    assert!(!app.world().resource::<ButtonInput<KeyCode>>().pressed(KeyCode::KeyW));
    let before = time(&app);
    (0..5).for_each(|_| app.update());
    assert_eq!(time(&app), before, "the flight pauses without focus");

    app.world().resource::<RenderDevice>().wgpu_device().destroy();
    for _ in 0..PATIENCE {
        app.update();
        if let Some(exit) = app.should_exit() {
            assert_eq!(exit, AppExit::error());
            return;
        }
    }
    panic!("nobody noticed that the device is lost");
}
