//! The dev overlay on a picture instead of a window, driven by the pointer and by typing: what is under a name is found as a screen reader
//! finds it.

use std::path::PathBuf;

use bevy::prelude::*;
use bevy_egui::egui::accesskit::{Action, ActionData, ActionRequest, Node, NodeId, TreeId};
use bevy_egui::egui::{Event, Id, Modifiers, OutputCommand, PointerButton, Pos2, pos2};
use bevy_egui::input::EguiInputEvent;
use bevy_egui::{EguiContext, EguiOutput};
use lensrunner::picture_file::moment::{is_moment, read_moment};
use lensrunner::play::choices::Choices;
use lensrunner::play::hud::Dials;
use lensrunner::play::menus::screens::Screen;
use lensrunner::play::missions::Watched;
use lensrunner::play::overlay::moments::Journey;
use lensrunner::play::overlay::state::{Ask, Overlay};
use lensrunner::play::player_state::PlayerState;
use lensrunner::play::session::Session;
use lensrunner::play::tour::wait_for_scene;
use lensrunner::render::shot::shot_again;
use lensrunner::scene::GameConfig;
use lensrunner::scene::config::edit::edited;
use lensrunner::scene::config::{self, Value};
use lensrunner::sim::Clock;
use lensrunner::sim::replay::Playback;
use lensrunner::sim::run::state_hash;
use lensrunner::sim::snapshot::Snapshot;

use super::interface::{choose, fly_on, game_of, push, screen};
use crate::support::Folder;

/// The game in its first mission, with a `game.toml` of its own and the overlay open.
fn opened(folder: &Folder, size: [u32; 2]) -> (App, PathBuf) {
    let file = folder.path().join("game.toml");
    // Without what costs most of the picture.
    let cheap = ["render.orders=1", "video.quality=low"].map(|one| one.parse().unwrap());
    std::fs::write(&file, edited(&file, &std::fs::read_to_string("game.toml").unwrap(), &cheap).unwrap()).unwrap();
    let session = Session::load(Some(&file), None, Some(3)).unwrap();
    let mut app = game_of(folder, session, size);
    app.world_mut().resource_mut::<Overlay>().folder = Some(folder.path().join("moments"));
    app.world_mut().query::<&mut EguiContext>().single_mut(app.world_mut()).unwrap().get_mut().enable_accesskit();
    choose(&mut app, "warned");
    choose(&mut app, "mission-2");
    wait_for_scene(&mut app);
    push(&mut app, KeyCode::KeyP);
    push(&mut app, KeyCode::F3);
    assert!(app.world().resource::<PlayerState>().overlay);
    (app, file)
}

/// All that is on the screen, and what it is called.
fn nodes(app: &mut App) -> Vec<(NodeId, Node)> {
    app.update();
    let output = app.world_mut().query::<&EguiOutput>().single(app.world()).unwrap();
    output.platform_output.accesskit_update.as_ref().map(|update| update.nodes.clone()).unwrap_or_default()
}

/// What a node is called: a word alone is its own name.
fn name(node: &Node) -> Option<&str> {
    node.label().or(node.value())
}

fn find(app: &mut App, wanted: &str) -> Option<(NodeId, Node)> {
    nodes(app).into_iter().find(|(_, node)| name(node) == Some(wanted))
}

/// What is there to change a setting with.
fn knob(app: &mut App, path: &str) -> (NodeId, Node) {
    let all = nodes(app);
    // The search box may hold the same words.
    let labels: Vec<NodeId> = all.iter().filter(|(_, node)| name(node) == Some(path)).map(|(id, _)| *id).collect();
    let is_labelled = |node: &Node| node.labelled_by().iter().any(|label| labels.contains(label));
    all.into_iter().find(|(_, node)| is_labelled(node)).unwrap_or_else(|| panic!("nothing is labelled by {path}"))
}

fn send(app: &mut App, events: &[Event]) {
    let context = app.world_mut().query_filtered::<Entity, With<EguiContext>>().single(app.world()).unwrap();
    for event in events {
        app.world_mut().write_message(EguiInputEvent { context, event: event.clone() });
    }
    app.update();
}

/// Clicks on what has this name, and lets it happen.
fn click(app: &mut App, wanted: &str) {
    let (_, node) = find(app, wanted).unwrap_or_else(|| {
        let names: Vec<String> = nodes(app).iter().filter_map(|(_, node)| name(node).map(String::from)).collect();
        panic!("no {wanted:?} among {names:?}")
    });
    click_on(app, &node);
}

fn click_on(app: &mut App, node: &Node) {
    let place = node.bounds().unwrap();
    let middle: Pos2 = pos2((0.5 * (place.x0 + place.x1)) as f32, (0.5 * (place.y0 + place.y1)) as f32);
    let button = |pressed| Event::PointerButton { pos: middle, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE };
    send(app, &[Event::PointerMoved(middle)]);
    send(app, &[button(true)]);
    send(app, &[button(false)]);
    app.update();
}

/// Types into the search, in the place of what is there.
fn search(app: &mut App, words: &str) {
    app.world_mut().resource_mut::<Overlay>().search.clear();
    click(app, "search");
    send(app, &[Event::Text(words.into())]);
    app.update();
}

/// Puts the slider of a setting to a value.
fn slide(app: &mut App, path: &str, value: f64) {
    let (target, _) = knob(app, path);
    let request = ActionRequest {
        action: Action::SetValue,
        target_tree: TreeId::ROOT,
        target_node: target,
        data: Some(ActionData::NumericValue(value)),
    };
    send(app, &[Event::AccessKitActionRequest(request)]);
    app.update();
}

fn config(app: &App) -> &GameConfig {
    &app.world().resource::<Session>().config
}

fn said(app: &App) -> &str {
    &app.world().resource::<Overlay>().said
}

/// Opened, searched, changed, undone, reset, saved: to the file, with its comments, and where the player had chosen otherwise.
#[test]
fn what_is_changed_is_undone_reset_and_saved() {
    let folder = Folder::new();
    let (mut app, file) = opened(&folder, [1280, 720]);
    // Both windows are off the dials.
    let dials = app.world().resource::<Dials>().0.clone();
    let context = app.world_mut().query::<&mut EguiContext>().single_mut(app.world_mut()).unwrap().get_mut().clone();
    assert!(dials.len() > 4);
    for window in ["Dev overlay", "game.toml"] {
        let place = context.memory(|memory| memory.area_rect(Id::new(window))).unwrap();
        assert!(context.content_rect().contains_rect(place) && place.height() > 300.0, "{window}: {place}");
        assert!(dials.iter().all(|dial| !dial.intersects(place)), "{window} at {place} hides {dials:?}");
    }
    // Without a search the groups are closed.
    assert!(find(&mut app, "render").is_some() && find(&mut app, "render.bloom").is_none());
    search(&mut app, "lens spread");
    assert!(find(&mut app, "render.bloom").is_some() && find(&mut app, "render.orders").is_none());

    slide(&mut app, "render.bloom", 0.6);
    assert_eq!(config(&app).render.bloom, 0.6);
    click(&mut app, "Undo");
    assert_eq!(config(&app).render.bloom, 0.3);
    click(&mut app, "Redo");
    assert_eq!(config(&app).render.bloom, 0.6);
    click(&mut app, "reset render.bloom");
    assert_eq!(config(&app).render.bloom, 0.3);
    assert!(find(&mut app, "reset render.bloom").is_none(), "there is nothing to reset");
    click(&mut app, "Undo");
    assert_eq!(config(&app).render.bloom, 0.6);
    assert!(find(&mut app, "1 not saved").is_some());

    click(&mut app, "Copy as command line");
    let output = app.world_mut().query::<&EguiOutput>().single(app.world()).unwrap().clone();
    let copied = output.platform_output.commands.iter().find_map(|command| match command {
        OutputCommand::CopyText(text) => Some(text.as_str()),
        _ => None,
    });
    assert!(copied.is_some_and(|text| text.starts_with("lensrunner play ") && text.ends_with(" --set render.bloom=0.6")), "{copied:?}");

    let before = std::fs::read_to_string(&file).unwrap();
    click(&mut app, "Save");
    let after = std::fs::read_to_string(&file).unwrap();
    let changed: Vec<(&str, &str)> = before.lines().zip(after.lines()).filter(|(before, after)| before != after).collect();
    let [(old, new)] = changed[..] else { panic!("{changed:?}") };
    assert!(old.starts_with("bloom = 0.3 ") && new.starts_with("bloom = 0.6 ") && old.split('#').nth(1) == new.split('#').nth(1));
    assert_eq!(before.lines().count(), after.lines().count());
    assert!(find(&mut app, "1 not saved").is_none());

    // All of a group at once, and back.
    click(&mut app, "reset group render");
    assert_eq!(config(&app).render, GameConfig::default().render);
    click(&mut app, "Undo");
    assert_eq!((config(&app).render.bloom, config(&app).render.orders), (0.6, 1));

    // What the player has chosen lies over the file: it gives way to what is saved.
    let fov = config::setting("video.fov").unwrap();
    app.world_mut().resource_scope(|world, mut choices: Mut<Choices>| {
        choices.choose(fov, Value::Number(75.0), &mut world.resource_mut::<Session>().config);
    });
    search(&mut app, "video.fov");
    slide(&mut app, "video.fov", 80.0);
    click(&mut app, "Save");
    assert_eq!(config(&app).video.fov, 80.0);
    let mut begun = config::load(&file).unwrap();
    app.world().resource::<Choices>().over(&mut begun);
    assert_eq!(begun.video.fov, 80.0, "{}", said(&app));

    // A value that clashes with another is refused in words.
    search(&mut app, "exposure_m");
    slide(&mut app, "render.exposure_min", 20.0);
    assert_eq!(config(&app).render.exposure_min, GameConfig::default().render.exposure_min);
    assert!(said(&app).contains("must be less than"), "{}", said(&app));

    // A file that may not be written, and a damaged one, are left as they are, and it is said.
    slide(&mut app, "render.exposure_max", 5.0);
    let mut rights = std::fs::metadata(&file).unwrap().permissions();
    rights.set_readonly(true);
    std::fs::set_permissions(&file, rights.clone()).unwrap();
    let kept = std::fs::read_to_string(&file).unwrap();
    click(&mut app, "Save");
    assert!(said(&app).contains("may only be read"), "{}", said(&app));
    assert_eq!(std::fs::read_to_string(&file).unwrap(), kept);
    std::fs::remove_file(&file).unwrap();
    std::fs::write(&file, "[render]\nbloom = much\n").unwrap();
    click(&mut app, "Save");
    assert!(said(&app).contains("game.toml:2:"), "{}", said(&app));
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "[render]\nbloom = much\n");
}

/// Time stands still and goes on by steps; a moment is saved, and drawn again by what reads it.
#[test]
fn a_moment_is_saved_and_drawn_again() {
    let folder = Folder::new();
    let (mut app, _) = opened(&folder, [960, 640]);
    click(&mut app, "Light");
    assert!(config(&app).render.doppler);
    let (_, checkbox) = knob(&mut app, "render.doppler");
    click_on(&mut app, &checkbox);
    assert!(!config(&app).render.doppler);

    click(&mut app, "Time");
    click(&mut app, "freeze");
    let before = *app.world().resource::<Clock>();
    (0..5).for_each(|_| app.update());
    assert_eq!(app.world().resource::<Clock>().tick, before.tick);
    click(&mut app, "8 steps");
    assert_eq!(app.world().resource::<Clock>().tick, before.tick + 8);

    click(&mut app, "Save this moment");
    let file = app.world().resource::<Overlay>().moment.clone().unwrap_or_else(|| panic!("{}", said(&app)));
    assert!(is_moment(&file) && file.starts_with(folder.path()));
    let snapshot = Snapshot::from_text(&file, &read_moment(&file).unwrap()).unwrap();
    assert!(!snapshot.config().render.doppler && snapshot.flight.ticks == before.tick + 8);
    let moment = snapshot.fly(&file).unwrap();
    let picture = shot_again(&snapshot, &moment, [96, 64], false, true).unwrap();
    assert!(picture.display.iter().filter(|byte| **byte > 40).count() > 200, "something is seen");
    // The same by the command, from the place of a scene.
    let png = folder.path().join("again.png");
    let run = |more: &[&str]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_lensrunner"));
        command.args(["shot", "--scene"]).arg(&file).arg("-o").arg(&png).args(["--size", "96x64"]).args(more);
        let output = command.output().unwrap();
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    assert_eq!(run(&[]).0, Some(0));
    let drawn = image::open(&png).unwrap().to_rgba8();
    let off = drawn.as_raw().iter().zip(&picture.display).filter(|(a, b)| a.abs_diff(**b) > 1).count();
    assert_eq!(off, 0);
    let (code, words) = run(&["--set", "render.orders=1"]);
    assert!(code == Some(2) && words.contains("a moment has its own"), "{words}");
    click(&mut app, "freeze");
    (0..3).for_each(|_| app.update());
    assert!(app.world().resource::<Clock>().tick > before.tick + 8);
}

/// Any moment of a replay, forwards and back, is the one that was flown.
#[test]
fn a_replay_is_gone_through_to_and_fro() {
    let folder = Folder::new();
    let (mut app, _) = opened(&folder, [320, 200]);
    fly_on(&mut app);
    assert_eq!(screen(&app), Screen::Result);
    choose(&mut app, "watch");
    wait_for_scene(&mut app);
    assert!(screen(&app) == Screen::Playing && app.world().contains_resource::<Playback>());
    app.world_mut().resource_mut::<Overlay>().asked.push(Ask::Freeze(true));
    let step = app.world().resource::<Clock>().step;
    let travel = |app: &mut App, tick: u64| {
        app.world_mut().resource_mut::<Overlay>().asked.push(Ask::Teleport(tick as f64 * step));
        app.update();
        for _ in 0..2000 {
            if !app.world().contains_resource::<Journey>() {
                break;
            }
            app.update();
        }
        assert_eq!(app.world().resource::<Clock>().tick, tick, "{}", said(app));
        state_hash(app.world()).to_string()
    };
    let early = travel(&mut app, 300);
    let late = travel(&mut app, 700);
    assert_ne!(early, late);
    assert_eq!(travel(&mut app, 300), early);
    assert_eq!(travel(&mut app, 700), late);
    assert_eq!(screen(&app), Screen::Playing);
    // The end is the one that was flown, and not the last that can be seen.
    let replay = app.world().resource::<Watched>().0.clone();
    assert_eq!(travel(&mut app, replay.ticks), replay.hash);
    app.update();
    app.update();
    assert_eq!(screen(&app), Screen::Result);
    assert_eq!(travel(&mut app, 300), early);
}
