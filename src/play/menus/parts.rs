//! Colours and parts of the cards.

use bevy_egui::egui::{self, Color32, RichText, Ui};

use crate::play::menus::screens::MenuAction;
use crate::play::session::Session;

pub(super) const WARM: Color32 = Color32::from_rgb(255, 190, 110);
pub(super) const FAINT: Color32 = Color32::from_rgb(150, 166, 182);

pub(super) const PALE: Color32 = Color32::from_rgb(226, 234, 242);

pub(super) fn buttons(ui: &mut Ui, ask: &mut impl FnMut(MenuAction), choices: &[(&str, MenuAction)]) {
    for &(words, action) in choices {
        let button = egui::Button::new(RichText::new(words).size(18.0).color(PALE)).min_size(egui::vec2(230.0, 34.0));
        if ui.add(button).clicked() {
            ask(action);
        }
        ui.add_space(4.0);
    }
}

/// The switch of `video.reduced_motion`, until the game ends or `game.toml` says otherwise.
pub(super) fn calm(ui: &mut Ui, session: &mut Session) {
    let mut on = session.config.video.reduced_motion;
    let words = RichText::new("Reduced motion: the camera does not sway or glide").size(12.5).color(PALE);
    if ui.checkbox(&mut on, words).changed() {
        session.config.video.reduced_motion = on;
    }
}

pub(super) fn table<const N: usize>(ui: &mut Ui, name: &str, rows: [(RichText, RichText); N]) {
    egui::Grid::new(name).num_columns(2).min_row_height(15.0).spacing([16.0, 2.0]).show(ui, |ui| {
        for (what, how) in rows {
            ui.label(what.size(12.5));
            ui.label(how.size(12.5));
            ui.end_row();
        }
    });
}
