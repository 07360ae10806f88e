//! The title: the missions with their stars, and what the chosen one is about.

use bevy_egui::egui::{self, RichText, Ui};

use super::parts::{FAINT, PALE, WARM, buttons, calm};
use super::words::{goal, key, measure, stars, unit};
use crate::play::hud::instruments::Scale;
use crate::play::hud::paint::TRUE;
use crate::play::menus::screens::MenuAction;
use crate::play::missions::Catalogue;
use crate::play::records::Records;
use crate::play::session::Session;
use crate::scene::Difficulty;
use crate::scene::mission::ScoredBy;
use crate::scene::ship::Ai;

/// What the title is made of.
pub(super) struct Title<'a> {
    pub(super) catalogue: &'a Catalogue,
    pub(super) records: &'a Records,
    pub(super) choice: usize,
    pub(super) free: usize,
}

/// Width of the list of missions, in points.
pub(super) const LIST: f32 = 270.0;
/// Width of what is said of the chosen one, in points.
pub(super) const ABOUT: f32 = 330.0;

pub(super) fn title(ui: &mut Ui, session: &mut Session, title: &Title, ask: &mut impl FnMut(MenuAction)) {
    ui.label(RichText::new("LENSRUNNER").size(38.0).color(PALE).strong());
    ui.label(RichText::new("flights in the spacetime of a black hole").size(14.0).color(FAINT));
    ui.add_space(4.0);
    ui.label(RichText::new("The picture turns, bends and brightens quickly. For those sensitive to it:").size(12.5).color(WARM));
    calm(ui, session);
    ui.add_space(8.0);
    ui.horizontal_top(|ui| {
        ui.vertical(|ui| {
            ui.set_width(LIST);
            list(ui, session, title, ask);
        });
        ui.add_space(16.0);
        ui.vertical(|ui| {
            ui.set_width(ABOUT);
            about(ui, session, title, ask);
        });
    });
    ui.add_space(8.0);
    let keys = format!("{} pauses and shows the keys", key(&session.config.controls.pause));
    ui.label(RichText::new(keys).size(12.5).color(FAINT));
}

/// The missions, each with its stars on the chosen difficulty.
fn list(ui: &mut Ui, session: &Session, title: &Title, ask: &mut impl FnMut(MenuAction)) {
    ui.horizontal(|ui| {
        for difficulty in Difficulty::ALL {
            let words = RichText::new(difficulty.name()).size(14.0);
            if ui.selectable_label(session.difficulty == difficulty, words).clicked() {
                ask(MenuAction::Level(difficulty));
            }
        }
    });
    ui.add_space(4.0);
    for choice in 0..title.catalogue.len() {
        let scene = title.catalogue.scene(choice, title.free);
        let words = match &scene.mission {
            Some(mission) if choice < title.catalogue.missions.len() => {
                let best = title.records.best(&scene.record_name(), session.difficulty);
                format!("{}  {}  {}", choice + 1, mission.title, stars(best.map_or(0, |best| best.stars)))
            }
            _ => format!("Free flight: {}", scene.name),
        };
        let label = egui::Button::selectable(title.choice == choice, RichText::new(words).size(15.0)).min_size(egui::vec2(LIST, 24.0));
        let entry = ui.add(label);
        if entry.clicked() {
            ask(MenuAction::Choose(choice));
        }
        if entry.double_clicked() {
            ask(MenuAction::Start);
        }
    }
}

/// What the chosen mission is about, and the way into it.
fn about(ui: &mut Ui, session: &Session, title: &Title, ask: &mut impl FnMut(MenuAction)) {
    let scene = title.catalogue.scene(title.choice, title.free);
    match &scene.mission {
        Some(mission) => {
            ui.label(RichText::new(&mission.title).size(22.0).color(PALE));
            ui.label(RichText::new(&mission.idea).size(14.0).color(TRUE));
            ui.add_space(4.0);
            ui.label(RichText::new(&mission.brief).size(13.0).color(PALE));
            ui.add_space(6.0);
            let scale = Scale::of(session.config.hole.mass_solar);
            let clock = match mission.clock {
                ScoredBy::Far => "Best on the far clock",
                ScoredBy::Own => "Best on your own clock",
                ScoredBy::Fuel => "Least Δv",
            };
            let unit = unit(mission.clock);
            let best = title.records.best(&scene.record_name(), session.difficulty);
            let best = best.map_or("not yet won".to_owned(), |best| match mission.clock {
                ScoredBy::Fuel => format!("{:.2} {unit}", best.score),
                ScoredBy::Far | ScoredBy::Own => format!("{:.1} {unit} ({})", best.score, scale.span(best.score)),
            });
            ui.label(RichText::new(format!("{clock}, {}: {best}", session.difficulty)).size(12.5).color(FAINT));
            if let Some([three, two]) = mission.levels[session.difficulty as usize].stars {
                ui.label(RichText::new(format!("★★★ by {three} {unit}  ·  ★★☆ by {two} {unit}")).size(12.5).color(FAINT));
            }
        }
        None => {
            ui.label(RichText::new("Free flight").size(22.0).color(PALE));
            ui.horizontal(|ui| {
                let count = title.catalogue.free.len();
                for (words, by) in [("◀", count - 1), ("▶", 1)] {
                    if ui.button(RichText::new(words).size(16.0)).clicked() {
                        ask(MenuAction::Scene((title.free + by) % count));
                    }
                }
                let place = format!("{}  ({} of {count}, keys left and right)", scene.name, title.free + 1);
                ui.label(RichText::new(place).size(14.0).color(TRUE));
            });
            let words = if scene.ships.iter().any(|ship| ship.ai == Ai::Flee) {
                goal(session)
            } else {
                "Fly where you like: nothing is to be won.".into()
            };
            ui.label(RichText::new(words).size(13.0).color(PALE));
            ui.label(RichText::new(measure(session)).size(12.5).color(FAINT));
        }
    }
    ui.add_space(10.0);
    buttons(ui, ask, &[("Fly  (Enter)", MenuAction::Start), ("Quit", MenuAction::Quit)]);
}
