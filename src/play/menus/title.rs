//! The title: the missions with their stars, and what the chosen one is about.

use bevy_egui::egui::{RichText, Ui};

use super::mission_about::{Title, about};
use super::rows::row;
use super::words::stars;
use crate::play::hud::paint::{FAINT, TEXT, TRUE};
use crate::play::hud::palette::Palette;
use crate::play::menus::entries::{Does, Menu};
use crate::play::session::Session;
use bevy_egui::egui::{Align2, FontId, vec2};

/// Width of the list of missions, in points.
pub(super) const LIST: f32 = 290.0;
/// Width of what is said of the chosen one, in points.
pub(super) const ABOUT: f32 = 330.0;
/// Room for the stars at the right of the list, in points.
const STARS: f32 = 52.0;

pub(super) fn title(ui: &mut Ui, menu: &mut Menu, session: &Session, title: &Title) {
    let palette = Palette::in_use(ui.ctx());
    let language = session.language();
    ui.label(RichText::new("LENSRUNNER").size(34.0).color(palette.shown(TEXT)).strong());
    ui.label(RichText::new(language.say("title-line")).size(13.5).color(palette.shown(FAINT)));
    ui.add_space(6.0);
    let list = LIST.min(0.5 * ui.available_width());
    ui.horizontal_top(|ui| {
        ui.vertical(|ui| {
            ui.set_width(list);
            ui.spacing_mut().item_spacing.y = 0.0;
            let moved = ui.input(|input| input.pointer.delta() != vec2(0.0, 0.0));
            for place in 0..menu.entries.len() {
                let before = ui.cursor().top();
                row(ui, menu, place, moved);
                if let Does::Fly(choice) = menu.entries[place].does {
                    stars_of(ui, before, list, session, title, choice);
                }
            }
        });
        ui.add_space(16.0);
        ui.vertical(|ui| {
            ui.set_width(ui.available_width().min(ABOUT));
            about(ui, session, title);
        });
    });
}

/// Paints the stars of a mission beside its name.
fn stars_of(ui: &Ui, top: f32, width: f32, session: &Session, title: &Title, choice: usize) {
    if choice >= title.catalogue.missions.len() {
        return;
    }
    let scene = title.catalogue.scene(choice, title.free);
    let best = title.records.best(&scene.record_name(), session.difficulty);
    let words = stars(best.map_or(0, |best| best.stars));
    let middle = 0.5 * (top + ui.cursor().top());
    let at = ui.min_rect().left_top() + vec2(width - 6.0, middle - ui.min_rect().top());
    let colour = Palette::in_use(ui.ctx()).shown(if best.is_some() { TRUE } else { FAINT });
    let galley = ui.painter().layout_no_wrap(words, FontId::proportional(13.0), colour);
    let place = Align2::RIGHT_CENTER.anchor_size(at, galley.size().min(vec2(STARS, 40.0)));
    ui.painter().galley(place.min, galley, colour);
}
