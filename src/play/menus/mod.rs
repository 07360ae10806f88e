//! The menus: title, pause, result, settings, manual, and what a chase begins with.
//!
//! A menu is a list of entries ([`mod@entries`], [`lists`]), one of which has the focus. Keyboard, gamepad ([`mod@keys`]) and mouse
//! (`rows`) touch it; [`mod@navigate`] does what they ask. What is painted never decides anything, so all of it works without a window.

pub mod change;
pub mod entries;
mod flight_map;
pub mod keys;
pub mod lists;
pub mod manual;
mod mission_about;
pub mod navigate;
mod outcome;
pub mod presets;
mod response;
mod rows;
pub mod screens;
mod seeing;
mod title;
mod words;

use bevy::prelude::*;
use bevy_egui::egui::{self, Align2, RichText, ScrollArea, Ui, vec2};
use bevy_egui::{EguiContexts, EguiPrimaryContextPass};

use crate::play::coach::review::Review;
use crate::play::hud::notice::Notice;
use crate::play::hud::paint::{FAINT, OWN, SEEN, SHADE, TEXT, TRUE};
use crate::play::hud::palette::Palette;
use crate::play::hud::panel::Panel;
use crate::play::input::bindings::Bindings;
use crate::play::input::button::Device;
use crate::play::menus::entries::{Menu, Page};
use crate::play::menus::navigate::{FileConfig, navigate};
use crate::play::menus::screens::Screen;
use crate::play::missions::{Catalogue, LastFlight};
use crate::play::player_state::PlayerState;
use crate::play::records::Records;
use crate::play::schedule::{GameSet, PaintSet};
use crate::play::session::Session;
use crate::play::words::Language;
use crate::scene::ship::Ai;
use crate::sim::replay::Playback;
use crate::sim::{Chase, Clock};
use mission_about::Title;
use rows::{header, rows};
use title::{ABOUT, LIST, title};
use words::{Prompts, camera_hint, goal, hint};

/// What the menus know and do, without painting them. Needs [`GamePlugin`](crate::play::game::GamePlugin).
pub struct MenuModelPlugin;

impl Plugin for MenuModelPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Menu>().init_resource::<FileConfig>().add_systems(Update, navigate.in_set(GameSet::Menus));
    }
}

/// The cards of the screens, and what a chase begins with. Needs [`HudPlugin`](crate::play::hud::HudPlugin).
pub struct MenusPlugin;

impl Plugin for MenusPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Update, welcome.in_set(GameSet::Window)).add_systems(EguiPrimaryContextPass, draw.in_set(PaintSet::Menus));
    }
}

/// What the menus are painted from.
type Flight<'w> = (
    (Option<Res<'w, Chase>>, Res<'w, Review>, Res<'w, LastFlight>),
    Res<'w, Panel>,
    Res<'w, PlayerState>,
    Option<Res<'w, Catalogue>>,
    Res<'w, Records>,
);

/// Draws the menu of the screen.
fn draw(
    mut contexts: EguiContexts,
    screen: Res<State<Screen>>,
    session: Res<Session>,
    ((chase, review, last), panel, player, catalogue, records): Flight,
    (bindings, device): (Res<Bindings>, Res<Device>),
    mut menu: ResMut<Menu>,
) -> Result {
    let context = contexts.ctx_mut()?;
    let prompts = Prompts { language: session.language(), bindings: &bindings, device: *device };
    let language = session.language();
    // What is painted is only looked at; a change would have the whole menu made again.
    let menu = menu.bypass_change_detection();
    if let Some(page) = menu.page() {
        draw_page(context, page, &session, menu, prompts, &panel);
        return Ok(());
    }
    match screen.get() {
        Screen::Playing => (),
        Screen::Warning => card(context, "warning", WIDE, |ui| {
            heading(ui, &language.say("warning-title"));
            paragraph(ui, &language.say("warning-text"));
            rows(ui, menu);
        }),
        Screen::Title => card(context, "title", LIST + 16.0 + ABOUT, |ui| {
            if let Some(catalogue) = &catalogue {
                title(ui, menu, &session, &Title { catalogue, records: &records, choice: player.choice, free: player.free });
            } else {
                rows(ui, menu);
            }
            footer(ui, prompts, false);
        }),
        // At the side: the ship is in the middle.
        Screen::Paused => card(context, "pause", WIDE, |ui| {
            heading(ui, &language.say("menu-paused"));
            rows(ui, menu);
            ui.add_space(6.0);
            paragraph(ui, &words::keys_of_flight(prompts));
            markers(ui, language);
            footer(ui, prompts, false);
        }),
        Screen::Result => card(context, "result", NARROW, |ui| {
            outcome::result(ui, &session, chase.as_deref(), &panel, (player.flown, &review));
            outcome::score(ui, &session, &last);
            rows(ui, menu);
        }),
        Screen::Photo if menu.entries.is_empty() => (),
        Screen::Photo => card(context, "photo", NARROW, |ui| {
            heading(ui, &language.say("menu-photo"));
            rows(ui, menu);
            let button = prompts.button(crate::play::input::action::Action::ToggleHud);
            paragraph(
                ui,
                &match prompts.device {
                    Device::Touch => language.say("photo-hint-touch"),
                    _ => language.fill("photo-hint", &[("button", button.as_str())]),
                },
            );
        }),
    }
    Ok(())
}

/// Draws a page of settings, a card of the manual, or what is seen.
fn draw_page(context: &egui::Context, page: Page, session: &Session, menu: &mut Menu, prompts: Prompts, panel: &Panel) {
    let language = session.language();
    let (name, width) = match page {
        Page::Settings => ("menu-settings", NARROW),
        Page::Video => ("menu-video", WIDE),
        Page::Sound => ("menu-sound", WIDE),
        Page::Controls => ("menu-controls", WIDE),
        Page::Buttons => ("menu-buttons", BUTTONS),
        Page::Accessibility => ("menu-accessibility", WIDE),
        Page::Language => ("menu-language", WIDE),
        Page::Manual(place) => {
            card(context, "manual", manual::WIDTH, |ui| {
                manual::show(ui, place, language);
                rows(ui, menu);
            });
            return;
        }
        Page::Seeing => {
            seeing::draw(context, session, menu, panel);
            return;
        }
    };
    card(context, name, width, |ui| {
        heading(ui, &language.say(name));
        if page == Page::Buttons {
            header(ui, ["menu-keyboard", "menu-keyboard-other", "menu-pad", "menu-hold-or-tap"].map(|key| language.say(key)));
        }
        rows(ui, menu);
        if page == Page::Controls {
            response::curve(ui, session);
        }
        footer(ui, prompts, page == Page::Buttons);
    });
}

/// From the screen's left edge to a card, and between a card's edge and what it says, in points.
const ASIDE: f32 = 16.0;
/// Width of what the pause and most pages say, in points.
const WIDE: f32 = 470.0;
/// Width of what the page of buttons says, in points.
const BUTTONS: f32 = 700.0;
/// Width of what the result says, in points: it leaves the middle of the narrowest window free.
const NARROW: f32 = 340.0;

/// A dark card at the left of the screen, with room for `width` points where there are so many; what is higher than the screen is scrolled.
fn card(context: &egui::Context, name: &'static str, width: f32, content: impl FnOnce(&mut Ui)) {
    let screen = context.content_rect();
    let palette = Palette::in_use(context);
    let width = width.min(screen.width() - 4.0 * ASIDE);
    let most = screen.height() - 4.0 * ASIDE;
    let area = egui::Area::new(egui::Id::new(name)).default_size(screen.size());
    area.anchor(Align2::LEFT_CENTER, [ASIDE, 0.0]).show(context, |ui| {
        egui::Frame::new().fill(palette.shown(SHADE)).corner_radius(10.0).inner_margin(ASIDE).show(ui, |ui| {
            ui.set_width(width);
            ScrollArea::vertical().max_height(most).min_scrolled_height(most).auto_shrink([false, true]).show(ui, |ui| {
                ui.spacing_mut().item_spacing = vec2(8.0, 2.0);
                content(ui);
            });
        });
    });
}

fn heading(ui: &mut Ui, words: &str) {
    let colour = Palette::in_use(ui.ctx()).shown(TEXT);
    ui.label(RichText::new(words).size(24.0).color(colour).strong());
    ui.add_space(4.0);
}

fn paragraph(ui: &mut Ui, words: &str) {
    let colour = Palette::in_use(ui.ctx()).shown(TEXT);
    ui.label(RichText::new(words).size(13.0).color(colour));
    ui.add_space(4.0);
}

/// How a menu is used with the device in use; `unbinds` where buttons are bound.
fn footer(ui: &mut Ui, prompts: Prompts, unbinds: bool) {
    let on_pad = prompts.device == Device::Pad;
    let mut words = prompts.language.say(match prompts.device {
        Device::Keyboard => "menu-help-keys",
        Device::Pad => "menu-help-pad",
        Device::Touch => "menu-help-touch",
    });
    if unbinds {
        words.push_str(" · ");
        words.push_str(&prompts.language.say(if on_pad { "menu-unbind-pad" } else { "menu-unbind-keys" }));
    }
    ui.add_space(6.0);
    ui.label(RichText::new(words).size(12.0).color(Palette::in_use(ui.ctx()).shown(FAINT)));
}

/// The names of the HUD's markers, in their colours, and what they mean.
fn markers(ui: &mut Ui, language: Language) {
    let palette = Palette::in_use(ui.ctx());
    ui.add_space(6.0);
    let markers = [
        ("marker-now", TRUE),
        ("marker-fallen", SEEN),
        ("marker-seen", SEEN),
        ("marker-second", SEEN),
        ("marker-thrust", OWN),
        ("marker-drift", OWN),
        ("marker-course", OWN),
        ("marker-lines", FAINT),
    ];
    for (key, colour) in markers {
        ui.label(RichText::new(language.say(key)).size(12.0).color(palette.shown(colour)));
    }
}

/// The devices' state and the words for it.
type Buttons<'w> = (Res<'w, Bindings>, Res<'w, Device>);

/// Says the goal when a chase begins, and on the first flight what to begin with: until the player has, or has had time to read it.
fn welcome(
    (session, screen): (Res<Session>, Res<State<Screen>>),
    (clock, real, playback): (Res<Clock>, Res<Time<Real>>, Option<Res<Playback>>),
    (bindings, device): Buttons,
    mut player: ResMut<PlayerState>,
    mut notice: ResMut<Notice>,
) {
    /// How long the goal is shown after the beginning, in r_s/c of T.
    const SHOWN: f64 = 12.0;
    /// How long the hint is shown, in seconds of wall time in play.
    const HINTED: f64 = 30.0;
    if *screen.get() != Screen::Playing {
        return;
    }
    if !player.begun {
        player.hinted += real.delta_secs_f64();
        player.begun = player.hinted > HINTED;
    }
    let prompts = Prompts { language: session.language(), bindings: &bindings, device: *device };
    // A mission says its goals by itself.
    let has_quarry = session.scene.mission.is_none() && session.scene.ships.iter().any(|ship| ship.ai == Ai::Flee);
    let goal = ((clock.time < SHOWN || !player.begun) && has_quarry).then(|| goal(&session));
    let hint = match &playback {
        Some(_) => (clock.time < SHOWN).then(|| camera_hint(prompts)),
        None => (!player.begun).then(|| hint(&session, prompts)),
    };
    let words: Vec<String> = goal.into_iter().chain(hint).collect();
    if !words.is_empty() && notice.until < real.elapsed_secs_f64() {
        *notice = Notice { text: words.join("\n"), until: real.elapsed_secs_f64() + 0.5, share: None };
    }
}
