//! The whole game on a picture instead of a window, driven by its devices: from the first start to the end.

use std::time::Duration;

use bevy::input::ButtonState;
use bevy::input::gamepad::{GamepadConnection, GamepadConnectionEvent, RawGamepadButtonChangedEvent, RawGamepadEvent};
use bevy::input::keyboard::{Key, KeyboardInput, NativeKey};
use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;
use lensrunner::play::choices::Choices;
use lensrunner::play::menus::entries::{Menu, Page};
use lensrunner::play::menus::screens::Screen;
use lensrunner::play::missions::LastFlight;
use lensrunner::play::photo::Photo;
use lensrunner::play::picture::CurrentShot;
use lensrunner::play::player_state::PlayerState;
use lensrunner::play::session::Session;
use lensrunner::play::tour::wait_for_scene;
use lensrunner::play::window::{Options, OutputSurface, app};
use lensrunner::scene::Difficulty;
use lensrunner::sim::replay::Playback;
use lensrunner::sim::{Chase, Clock};

use crate::support::Folder;

/// The game at its first start.
fn game(folder: &Folder) -> App {
    let mut session = Session::load(None, None, Some(3)).unwrap();
    // What is tested here is not the picture.
    (session.config.render.orders, session.config.render.pixel_error_budget, session.config.aurora.enabled) = (1, 8.0, false);
    game_of(folder, session, [160, 90])
}

/// The same of a session, on a picture of this size.
pub(super) fn game_of(folder: &Folder, mut session: Session, size: [u32; 2]) -> App {
    session.difficulty = Difficulty::Easy;
    // English, whatever the machine speaks.
    session.config.interface.language = "en".into();
    let options = Options { data: Some(folder.path().into()), ..Options::default() };
    let (choices, said) = Choices::load_from(&folder.path().join("settings.toml"));
    assert_eq!(said, None);
    let mut app = app(session, &options, OutputSurface::Picture(size), choices);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(100)));
    app.finish();
    app.cleanup();
    wait_for_scene(&mut app);
    app.update();
    app
}

pub(super) fn screen(app: &App) -> Screen {
    *app.world().resource::<State<Screen>>().get()
}

pub(super) fn send(app: &mut App, key: KeyCode, state: ButtonState) {
    let logical_key = Key::Unidentified(NativeKey::Unidentified);
    app.world_mut().write_message(KeyboardInput {
        key_code: key,
        logical_key,
        state,
        text: None,
        repeat: false,
        window: Entity::PLACEHOLDER,
    });
}

/// Presses a key and lets it go; afterwards the next screen is there.
pub(super) fn push(app: &mut App, key: KeyCode) {
    send(app, key, ButtonState::Pressed);
    app.update();
    send(app, key, ButtonState::Released);
    app.update();
    app.update();
}

fn focused(app: &App) -> String {
    let menu = app.world().resource::<Menu>();
    menu.entries.get(menu.focus).map(|entry| entry.id.clone()).unwrap_or_default()
}

/// Goes to an entry of the menu with `down`.
fn go(app: &mut App, id: &str, down: &mut impl FnMut(&mut App)) {
    for _ in 0..60 {
        if focused(app) == id {
            return;
        }
        down(app);
    }
    panic!("no {id} among {:?}", app.world().resource::<Menu>().entries.iter().map(|entry| &entry.id).collect::<Vec<_>>());
}

/// Chooses an entry of the menu by the arrow keys and Enter.
pub(super) fn choose(app: &mut App, id: &str) {
    go(app, id, &mut |app| push(app, KeyCode::ArrowDown));
    push(app, KeyCode::Enter);
}

/// Lets the simulation go on until the flight is decided.
pub(super) fn fly_on(app: &mut App) {
    for _ in 0..40_000 {
        if app.world().resource::<Chase>().outcome.is_some() {
            break;
        }
        app.world_mut().run_schedule(FixedUpdate);
    }
    app.update();
    app.update();
}

fn page(app: &App) -> Option<Page> {
    app.world().resource::<Menu>().page()
}

/// By the keyboard alone: the first start with its warning, training, a mission under the autopilot to its end, its replay, what is seen,
/// photo mode, settings that are kept, the other language, out.
#[test]
fn the_whole_way_by_the_keyboard() {
    let folder = Folder::new();
    let mut app = game(&folder);
    assert_eq!(screen(&app), Screen::Warning);
    let before = app.world().resource::<Clock>().time;
    (0..5).for_each(|_| app.update());
    assert_eq!(app.world().resource::<Clock>().time, before, "nothing moves before it is read");
    choose(&mut app, "video.reduced_motion");
    choose(&mut app, "warned");
    assert_eq!(screen(&app), Screen::Title);
    // Training, by hand for a while: the ship thrusts.
    choose(&mut app, "mission-1");
    wait_for_scene(&mut app);
    assert_eq!((screen(&app), app.world().resource::<Session>().scene.name.as_str()), (Screen::Playing, "01-training"));
    send(&mut app, KeyCode::KeyW, ButtonState::Pressed);
    (0..5).for_each(|_| app.update());
    send(&mut app, KeyCode::KeyW, ButtonState::Released);
    assert!(app.world().resource::<PlayerState>().begun && app.world().resource::<CurrentShot>().0.is_some());
    push(&mut app, KeyCode::Escape);
    assert_eq!(screen(&app), Screen::Paused);
    choose(&mut app, "title");
    // A mission, to its end.
    choose(&mut app, "mission-2");
    wait_for_scene(&mut app);
    push(&mut app, KeyCode::KeyP);
    fly_on(&mut app);
    assert_eq!(screen(&app), Screen::Result);
    let last = app.world().resource::<LastFlight>();
    assert!(last.replay.is_some() && !last.is_best, "the autopilot's flights are nobody's best");
    // Its replay.
    choose(&mut app, "watch");
    wait_for_scene(&mut app);
    assert!(screen(&app) == Screen::Playing && app.world().contains_resource::<Playback>());
    // What is seen, and back to the flight.
    push(&mut app, KeyCode::F1);
    assert_eq!((screen(&app), page(&app)), (Screen::Paused, Some(Page::Seeing)));
    choose(&mut app, "doppler");
    assert!(!app.world().resource::<Session>().config.render.doppler);
    choose(&mut app, "doppler");
    push(&mut app, KeyCode::F1);
    assert_eq!((screen(&app), page(&app)), (Screen::Playing, None));
    // Photo mode: the camera leaves the ship.
    push(&mut app, KeyCode::F2);
    assert_eq!(screen(&app), Screen::Photo);
    let home = app.world().resource::<Photo>().camera.position;
    send(&mut app, KeyCode::KeyS, ButtonState::Pressed);
    (0..4).for_each(|_| app.update());
    send(&mut app, KeyCode::KeyS, ButtonState::Released);
    assert!(app.world().resource::<Photo>().camera.position.distance(home) > 0.1);
    push(&mut app, KeyCode::ArrowRight);
    assert!((app.world().resource::<Photo>().camera.field_of_view.to_degrees() - 65.0).abs() < 1e-6);
    push(&mut app, KeyCode::Escape);
    assert_eq!(screen(&app), Screen::Paused);
    // Settings: a slider, and a key bound anew.
    choose(&mut app, "settings");
    choose(&mut app, "sound");
    push(&mut app, KeyCode::ArrowLeft);
    assert!((app.world().resource::<Session>().config.sound.master - 0.75).abs() < 1e-9);
    push(&mut app, KeyCode::Escape);
    choose(&mut app, "buttons");
    choose(&mut app, "boost");
    push(&mut app, KeyCode::KeyX);
    assert_eq!(app.world().resource::<Session>().config.controls.boost, "KeyX PadSouth");
    go(&mut app, "mute", &mut |app| push(app, KeyCode::ArrowDown));
    push(&mut app, KeyCode::Delete);
    assert_eq!(app.world().resource::<Session>().config.controls.mute, "None");
    push(&mut app, KeyCode::Escape);
    // The other language.
    choose(&mut app, "language");
    go(&mut app, "interface.language", &mut |app| push(app, KeyCode::ArrowDown));
    push(&mut app, KeyCode::ArrowRight);
    assert_eq!(app.world().resource::<Menu>().entries.last().unwrap().words, "もどる");
    push(&mut app, KeyCode::Escape);
    push(&mut app, KeyCode::Escape);
    (0..8).for_each(|_| app.update());
    choose(&mut app, "quit");
    assert!(app.should_exit().is_some());
    // All of it is there at the next start, and the warning is not.
    let (choices, said) = Choices::load_from(&folder.path().join("settings.toml"));
    let mut session = Session::load(None, None, None).unwrap();
    choices.over(&mut session.config);
    let config = &session.config;
    assert_eq!(said, None);
    assert!(config.interface.warned && config.video.reduced_motion && config.interface.language == "ja");
    assert_eq!((config.controls.boost.as_str(), config.controls.mute.as_str()), ("KeyX PadSouth", "None"));
}

/// By a gamepad alone; its driver's events are sent by the test.
#[cfg(feature = "pad")]
#[test]
fn the_menus_by_the_gamepad() {
    let folder = Folder::new();
    let mut app = game(&folder);
    let pad = app.world_mut().spawn_empty().id();
    let connection = GamepadConnection::Connected { name: "test".into(), vendor_id: None, product_id: None };
    app.world_mut().write_message(GamepadConnectionEvent { gamepad: pad, connection });
    app.update();
    let press = |app: &mut App, button: GamepadButton| {
        for value in [1.0, 0.0] {
            app.world_mut().write_message(RawGamepadEvent::Button(RawGamepadButtonChangedEvent { gamepad: pad, button, value }));
            app.update();
        }
        app.update();
    };
    let choose = |app: &mut App, id: &str| {
        go(app, id, &mut |app| press(app, GamepadButton::DPadDown));
        press(app, GamepadButton::South);
    };
    choose(&mut app, "warned");
    choose(&mut app, "settings");
    choose(&mut app, "buttons");
    // The third column is the gamepad's.
    go(&mut app, "mute", &mut |app| press(app, GamepadButton::DPadDown));
    press(&mut app, GamepadButton::DPadRight);
    press(&mut app, GamepadButton::DPadRight);
    press(&mut app, GamepadButton::South);
    press(&mut app, GamepadButton::LeftThumb);
    assert_eq!(app.world().resource::<Session>().config.controls.mute, "KeyM PadLeftThumb");
    // It is a button for two things now, which the row says.
    let amiss = |app: &App, id: &str| app.world().resource::<Menu>().entries.iter().find(|entry| entry.id == id).unwrap().amiss.clone();
    assert!(amiss(&app, "mute").is_some_and(|words| words.contains("Slower")), "{:?}", amiss(&app, "mute"));
    press(&mut app, GamepadButton::North);
    assert_eq!(app.world().resource::<Session>().config.controls.mute, "KeyM");
    press(&mut app, GamepadButton::East);
    press(&mut app, GamepadButton::East);
    choose(&mut app, "mission-2");
    assert_eq!(screen(&app), Screen::Playing);
    press(&mut app, GamepadButton::Start);
    assert_eq!(screen(&app), Screen::Paused);
    choose(&mut app, "title");
    go(&mut app, "quit", &mut |app| press(app, GamepadButton::DPadDown));
    app.world_mut().write_message(RawGamepadEvent::Button(RawGamepadButtonChangedEvent {
        gamepad: pad,
        button: GamepadButton::South,
        value: 1.0,
    }));
    app.update();
    assert!(app.should_exit().is_some());
}
