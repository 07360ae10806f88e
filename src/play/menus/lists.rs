//! The entries of each screen and page.

use bevy::prelude::*;

use crate::play::input::action::Action;
use crate::play::input::bindings::{Bindings, conflicts};
use crate::play::input::button::Button;
use crate::play::menus::change::{share, words_key, written};
use crate::play::menus::entries::{Does, Entry, Menu, Page, SLOTS};
use crate::play::menus::manual;
use crate::play::menus::presets::Preset;
use crate::play::menus::screens::{MenuAction, Screen};
use crate::play::missions::{Catalogue, LastFlight};
use crate::play::photo;
use crate::play::player_state::PlayerState;
use crate::play::session::Session;
use crate::play::words::{self, Language};
use crate::scene::GameConfig;
use crate::scene::config::{self, HELD, Setting};

/// What is on the screen now.
pub fn entries(world: &World) -> Vec<Entry> {
    let (Some(session), Some(menu)) = (world.get_resource::<Session>(), world.get_resource::<Menu>()) else { return Vec::new() };
    let language = session.language();
    if let Some(page) = menu.page() {
        return of_page(page, session, menu);
    }
    let mut entries = match world.resource::<State<Screen>>().get() {
        Screen::Playing => Vec::new(),
        Screen::Warning => warning(session),
        Screen::Title => title(world, session),
        Screen::Paused => paused(language),
        Screen::Result => result(world, session),
        Screen::Photo => photo::entries(world),
    };
    // A page is closed by the browser.
    if cfg!(target_family = "wasm") {
        entries.retain(|entry| !matches!(entry.does, Does::Ask(MenuAction::Quit)));
    }
    entries
}

fn ask(language: Language, id: &'static str, key: &str, action: MenuAction) -> Entry {
    Entry::new(id, language.say(key), Does::Ask(action))
}

fn open(language: Language, id: &'static str, key: &str, page: Page) -> Entry {
    Entry::new(id, language.say(key), Does::Open(page))
}

/// A setting that is kept.
fn choose(session: &Session, path: &str) -> Option<Entry> {
    let setting = config::setting(path)?;
    Some(of_setting(session, setting, Does::Choose(setting)))
}

/// A setting with its name and value.
fn of_setting(session: &Session, setting: &'static Setting<GameConfig>, does: Does) -> Entry {
    let (language, value) = (session.language(), setting.get(&session.config));
    let entry = Entry::new(setting.path(), language.say(&words_key(setting)), does).valued(written(language, setting, &value));
    Entry { share: share(setting, &value), ..entry }
}

fn warning(session: &Session) -> Vec<Entry> {
    let settings = ["interface.language", "video.reduced_motion", "accessibility.reduced_flashes", "accessibility.text_size"];
    let mut entries = vec![Entry::new("warned", session.language().say("menu-warned"), Does::Warned)];
    entries.extend(settings.iter().filter_map(|path| choose(session, path)));
    entries
}

fn title(world: &World, session: &Session) -> Vec<Entry> {
    let language = session.language();
    let level = language.say(&format!("difficulty-{}", session.difficulty.name()));
    let mut entries = vec![Entry::new("level", language.say("menu-difficulty"), Does::Level).valued(level)];
    if let Some(catalogue) = world.get_resource::<Catalogue>() {
        let free = world.resource::<PlayerState>().free;
        for choice in 0..catalogue.len() {
            let scene = catalogue.scene(choice, free);
            entries.push(match &scene.mission {
                Some(mission) if choice < catalogue.missions.len() => {
                    let title = language.mission(scene, "title", &mission.title);
                    Entry::new(format!("mission-{}", choice + 1), format!("{}  {title}", choice + 1), Does::Fly(choice))
                }
                _ => Entry::new("free", language.say("menu-free-flight"), Does::Fly(choice)).valued(scene.name.clone()),
            });
        }
    } else {
        entries.push(ask(language, "fly", "menu-fly", MenuAction::Start));
    }
    entries.extend([
        open(language, "settings", "menu-settings", Page::Settings),
        open(language, "manual", "menu-manual", Page::Manual(0)),
        ask(language, "quit", "menu-quit", MenuAction::Quit),
    ]);
    entries
}

fn paused(language: Language) -> Vec<Entry> {
    vec![
        ask(language, "go-on", "menu-go-on", MenuAction::Pause),
        ask(language, "again", "menu-start-again", MenuAction::Again),
        ask(language, "another", "menu-another", MenuAction::Start),
        open(language, "seeing", "menu-seeing", Page::Seeing),
        ask(language, "photo", "menu-photo", MenuAction::Photo),
        open(language, "settings", "menu-settings", Page::Settings),
        open(language, "manual", "menu-manual", Page::Manual(0)),
        ask(language, "title", "menu-title", MenuAction::Title),
        ask(language, "quit", "menu-quit", MenuAction::Quit),
    ]
}

fn result(world: &World, session: &Session) -> Vec<Entry> {
    let language = session.language();
    let last = world.get_resource::<LastFlight>();
    let won = session.scene.mission.is_some() && last.is_some_and(|last| last.won.is_some());
    let kept = last.is_some_and(|last| last.replay.is_some());
    // What most want next comes first.
    let mut entries: Vec<Entry> = won.then(|| ask(language, "next", "menu-next", MenuAction::Next)).into_iter().collect();
    entries.push(ask(language, "again", "menu-again", MenuAction::Again));
    entries.push(ask(language, "another", "menu-another", MenuAction::Start));
    if kept {
        entries.push(ask(language, "watch", "menu-watch", MenuAction::Watch));
        let share = ask(language, "share", "menu-share", MenuAction::Share);
        let long = last.is_some_and(|last| matches!(last.link, Some(Err(_))));
        entries.push(if long { share.valued(language.say("menu-share-long")) } else { share });
    }
    entries.push(ask(language, "title", "menu-title", MenuAction::Title));
    entries.push(ask(language, "quit", "menu-quit", MenuAction::Quit));
    entries
}

/// The settings that a page changes.
pub fn settings_of(page: Page) -> &'static [&'static str] {
    match page {
        Page::Video => &[
            "video.fullscreen", "video.vsync", "video.frame_limit", "video.quality", "video.held_rate", "video.fov",
            "accessibility.text_size", "interface.hud", "video.pause_without_focus",
        ],
        Page::Sound => &[
            "sound.master", "sound.mute_master", "sound.effects", "sound.mute_effects", "sound.music", "sound.mute_music", "sound.beacon",
            "sound.mute_beacon",
        ],
        Page::Controls => &[
            "controls.mouse_sensitivity",
            "controls.invert_x",
            "controls.invert_y",
            "controls.left_stick_dead_zone",
            "controls.left_stick_curve",
            "controls.right_stick_dead_zone",
            "controls.right_stick_curve",
            "controls.stick_pitch",
            "controls.stick_yaw",
            "controls.stick_thrust",
            "controls.stick_invert_pitch",
            "controls.stick_invert_yaw",
            "controls.stick_invert_thrust",
        ],
        Page::Accessibility => &[
            "video.reduced_motion",
            "accessibility.reduced_flashes",
            "accessibility.palette",
            "accessibility.high_contrast",
            "accessibility.text_size",
            "interface.hud",
            "video.pause_without_focus",
            "interface.coach",
            "assist.enabled",
            "assist.reference",
            "assist.avoid_hole",
            "clock.slow_near_danger",
        ],
        Page::Language => &["interface.language"],
        Page::Settings | Page::Buttons | Page::Manual(_) | Page::Seeing => &[],
    }
}

/// What light does, each to be left out.
pub const SWITCHES: [&str; 5] = ["render.lensing", "render.doppler", "render.beaming", "render.light_delay", "render.orders"];

/// What a page keeps in the browser goes to a file and back; elsewhere there are files.
fn kept(language: Language) -> Vec<Entry> {
    if !cfg!(target_family = "wasm") {
        return Vec::new();
    }
    vec![
        ask(language, "save-all", "menu-save-all", MenuAction::SaveAll),
        ask(language, "bring-all", "menu-bring-all", MenuAction::BringAll),
    ]
}

fn of_page(page: Page, session: &Session, menu: &Menu) -> Vec<Entry> {
    let language = session.language();
    let mut entries = match page {
        Page::Settings => vec![
            open(language, "video", "menu-video", Page::Video),
            open(language, "sound", "menu-sound", Page::Sound),
            open(language, "controls", "menu-controls", Page::Controls),
            open(language, "buttons", "menu-buttons", Page::Buttons),
            open(language, "accessibility", "menu-accessibility", Page::Accessibility),
            open(language, "language", "menu-language", Page::Language),
        ]
        .into_iter()
        .chain(kept(language))
        .collect(),
        Page::Buttons => buttons(session, menu),
        Page::Manual(card) => vec![
            Entry::new("next-card", language.say("menu-next-card"), Does::Card((card + 1) % manual::CARDS)),
            Entry::new("card-before", language.say("menu-card-before"), Does::Card((card + manual::CARDS - 1) % manual::CARDS)),
        ],
        Page::Seeing => seeing(session),
        _ => settings_of(page).iter().filter_map(|path| choose(session, path)).collect(),
    };
    if page == Page::Video {
        let video = &session.config.video;
        let size = format!("{} × {}", video.width, video.height);
        entries.insert(1, Entry::new("window-size", language.say("menu-window-size"), Does::WindowSize).valued(size));
    }
    if !settings_of(page).is_empty() && page != Page::Language {
        entries.push(Entry::new("reset", language.say("menu-reset"), Does::Reset(page)));
    }
    entries.push(Entry::new("back", language.say("menu-back"), Does::Back));
    entries
}

fn buttons(session: &Session, menu: &Menu) -> Vec<Entry> {
    let (language, config) = (session.language(), &session.config);
    let bindings = Bindings::of(config);
    let row = |action: Action| {
        let name = action_words(language, action);
        let column = |column: usize| match SLOTS[column] {
            _ if menu.awaits == Some((action, column)) => language.say("menu-press"),
            Some((device, slot)) => {
                let button = bindings.buttons(action).iter().filter(|button| button.device() == device).nth(slot);
                words::buttons::written(language, button.copied())
            }
            None if !HELD.contains(&action.key()) => String::new(),
            None => language.say(if bindings.is_tapped(action) { "menu-tap" } else { "menu-hold" }),
        };
        let clash = conflicts(config, action).into_iter().next().map(|(button, other)| {
            let (button, other) = (words::buttons::written(language, Button::named(&button)), action_words(language, other));
            language.fill("menu-conflict", &[("button", button.as_str()), ("action", other.as_str())])
        });
        Entry { values: (0..SLOTS.len()).map(column).collect(), amiss: clash, ..Entry::new(action.key(), name, Does::Bind(action)) }
    };
    let presets = Preset::ALL.map(|preset| Entry::new(preset.words(), language.say(preset.words()), Does::Preset(preset)));
    presets.into_iter().chain(Action::ALL.map(row)).collect()
}

/// What an action is called.
pub(super) fn action_words(language: Language, action: Action) -> String {
    language.say(&format!("action-{}", action.key().replace('_', "-")))
}

fn seeing(session: &Session) -> Vec<Entry> {
    let language = session.language();
    let mut entries: Vec<Entry> = SWITCHES
        .iter()
        .filter_map(|path| config::setting(path))
        .map(|setting| {
            let on = is_on(setting, &session.config);
            let key = match setting.key {
                "lensing" => "seeing-switch-bending",
                "doppler" => "seeing-switch-doppler",
                "beaming" => "seeing-switch-beaming",
                "light_delay" => "seeing-switch-delay",
                _ => "seeing-switch-second",
            };
            let value = language.say(if on { "menu-on" } else { "menu-off" });
            Entry::new(setting.key, language.say(key), Does::Switch(setting)).valued(value)
        })
        .collect();
    entries.insert(0, ask(language, "go-on", "menu-go-on", MenuAction::Pause));
    entries
}

/// Whether one of [`SWITCHES`] is on: images of order 2 are drawn, or the setting is true.
pub fn is_on(setting: &Setting<GameConfig>, config: &GameConfig) -> bool {
    match setting.get(config) {
        config::Value::Switch(on) => on,
        config::Value::Integer(orders) => orders > 1,
        _ => true,
    }
}
