//! What chose how much is drawn, and why: shown as whoever chooses tells it.

use bevy::prelude::*;
use bevy_egui::egui::{Grid, RichText, Ui};

use crate::play::session::Session;
use crate::scene::config;

/// What is told of how much is drawn. Whoever turns the knobs fills it.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct QualityReport {
    /// What was chosen and why, in a sentence.
    pub why: String,
    /// Each knob: its name, where it stands, what it is for.
    pub knobs: Vec<(String, String, String)>,
    /// The error of the picture as predicted and as measured, in words; empty where nobody measures.
    pub error: Vec<(String, String, String)>,
}

/// Tells what the preset of `video.quality` draws otherwise than the sections of `game.toml` say.
pub(super) fn tell_preset(session: Res<Session>, mut report: ResMut<QualityReport>) {
    let (config, drawn) = (&session.config, session.config.drawn());
    let other = config::settings().iter().filter(|setting| setting.get(config) != setting.get(&drawn));
    let knobs = other.map(|setting| {
        let unit = if setting.unit.is_empty() { String::new() } else { format!(" {}", setting.unit) };
        (setting.path(), format!("{}{unit}", setting.get(&drawn)), format!("instead of {}", setting.get(config)))
    });
    let why = match config.video.quality.as_str() {
        "high" => "video.quality = high: as the sections of game.toml say".to_owned(),
        quality => format!("video.quality = {quality}: less of what costs most"),
    };
    let told = QualityReport { why, knobs: knobs.collect(), error: Vec::new() };
    report.set_if_neq(told);
}

/// Shows it.
pub(super) fn show(ui: &mut Ui, report: &QualityReport) {
    ui.label(&report.why);
    for (name, rows) in [("knobs", &report.knobs), ("predicted and measured", &report.error)] {
        if rows.is_empty() {
            continue;
        }
        ui.separator();
        Grid::new(name).num_columns(3).striped(true).show(ui, |ui| {
            for (first, second, third) in rows {
                ui.label(first);
                ui.label(RichText::new(second).strong());
                ui.label(third);
                ui.end_row();
            }
        });
    }
}
