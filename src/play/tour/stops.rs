//! The stops of the tour.

use bevy::prelude::*;

use crate::play::game::begin;
use crate::play::menus::entries::{Menu, Page};
use crate::play::menus::screens::{MenuAction, Screen};
use crate::play::overlay::state::Overlay;
use crate::play::player_state::PlayerState;
use crate::play::session::Session;
use crate::scene::config::Value;
use crate::sim::{Chase, Clock, Outcome};

/// A picture of the tour, and the way there from the one before.
pub struct Stop {
    pub name: &'static str,
    pub act: fn(&mut App),
}

const fn stop(name: &'static str, act: fn(&mut App)) -> Stop {
    Stop { name, act }
}

pub const STOPS: &[Stop] = &[
    stop("warning", |_| ()),
    stop("title", |app| ask(app, MenuAction::Title)),
    stop("settings", |app| page(app, Page::Settings)),
    stop("settings-picture", |app| page(app, Page::Video)),
    stop("settings-sound", |app| page(app, Page::Sound)),
    stop("settings-controls", |app| page(app, Page::Controls)),
    stop("settings-buttons", |app| page(app, Page::Buttons)),
    stop("settings-accessibility", |app| page(app, Page::Accessibility)),
    stop("settings-language", |app| page(app, Page::Language)),
    stop("manual-1", |app| page(app, Page::Manual(0))),
    stop("manual-2", |app| page(app, Page::Manual(1))),
    stop("manual-3", |app| page(app, Page::Manual(2))),
    stop("manual-4", |app| page(app, Page::Manual(3))),
    stop("manual-5", |app| page(app, Page::Manual(4))),
    stop("manual-6", |app| page(app, Page::Manual(5))),
    stop("manual-7", |app| page(app, Page::Manual(6))),
    stop("manual-8", |app| page(app, Page::Manual(7))),
    stop("mission-begins", |app| fly(app, 1, 0.5)),
    stop("flight", |app| {
        app.world_mut().resource_mut::<PlayerState>().autopilot = true;
        until(app, 20.0);
        app.world_mut().resource_mut::<PlayerState>().autopilot = false;
    }),
    stop("flight-fewer", |app| app.world_mut().resource_mut::<Session>().config.interface.hud = "reduced".into()),
    stop("flight-least", |app| app.world_mut().resource_mut::<Session>().config.interface.hud = "least".into()),
    stop("flight-colours", |app| {
        let config = &mut app.world_mut().resource_mut::<Session>().config;
        config.interface.hud = "full".into();
        (config.accessibility.palette, config.accessibility.high_contrast) = ("red-green".into(), true);
    }),
    stop("pause", |app| {
        let config = &mut app.world_mut().resource_mut::<Session>().config;
        (config.accessibility.palette, config.accessibility.high_contrast) = ("standard".into(), false);
        ask(app, MenuAction::Pause);
    }),
    stop("photo", |app| ask(app, MenuAction::Photo)),
    stop("result", |app| {
        ask(app, MenuAction::Photo);
        ask(app, MenuAction::Pause);
        let time = app.world().resource::<Clock>().time;
        app.world_mut().resource_mut::<Chase>().outcome = Some((Outcome::Done, time));
    }),
    stop("free-flight", |app| {
        let free = app.world().get_resource::<crate::play::missions::Catalogue>().map_or(0, |catalogue| catalogue.missions.len());
        fly(app, free, 3.0);
    }),
    stop("seeing", |app| {
        app.world_mut().resource_mut::<PlayerState>().autopilot = true;
        until(app, 12.0);
        app.world_mut().resource_mut::<Menu>().open(Page::Seeing);
        ask(app, MenuAction::Pause);
    }),
    stop("seeing-no-doppler", |app| {
        let config = &mut app.world_mut().resource_mut::<Session>().config;
        (config.render.doppler, config.render.beaming) = (false, false);
    }),
    stop("overlay", |app| {
        let config = &mut app.world_mut().resource_mut::<Session>().config;
        (config.render.doppler, config.render.beaming) = (true, true);
        app.world_mut().resource_mut::<Menu>().close_all();
        ask(app, MenuAction::Pause);
        app.world_mut().resource_mut::<PlayerState>().overlay = true;
        let mut overlay = app.world_mut().resource_mut::<Overlay>();
        overlay.open.insert("render");
        overlay.change("render.bloom", Value::Number(0.35));
    }),
];

/// Asks the menus for something, and lets it happen.
fn ask(app: &mut App, action: MenuAction) {
    app.world_mut().write_message(action);
    app.update();
    app.update();
}

/// Shows a page alone.
fn page(app: &mut App, page: Page) {
    let mut menu = app.world_mut().resource_mut::<Menu>();
    menu.close_all();
    menu.open(page);
}

/// Flies a choice of the title's list to T = `time`.
fn fly(app: &mut App, choice: usize, time: f64) {
    app.world_mut().resource_mut::<PlayerState>().choice = choice;
    app.world_mut().resource_mut::<Menu>().close_all();
    begin(app.world_mut(), Screen::Playing);
    app.world_mut().resource_mut::<NextState<Screen>>().set(Screen::Playing);
    app.update();
    until(app, time);
}

/// Lets the flight go on to T = `time`, without a picture of each step.
fn until(app: &mut App, time: f64) {
    // Who is decided before stays so.
    for _ in 0..20_000 {
        if app.world().resource::<Clock>().time >= time || app.world().resource::<Chase>().outcome.is_some() {
            break;
        }
        app.world_mut().run_schedule(FixedUpdate);
    }
}
