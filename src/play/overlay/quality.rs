//! What chose how much is drawn, and why: shown as whoever chooses tells it.

use bevy::prelude::*;
use bevy_egui::egui::{Grid, RichText, Ui};

use crate::play::picture::quality::Quality;
use crate::render::quality::options::QualityOption;

/// What is told of how much is drawn. Whoever sets the options fills it.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct QualityReport {
    /// What was chosen and why, in a sentence.
    pub why: String,
    /// Each option: its name, where it stands, what it is for.
    pub options: Vec<(String, String, String)>,
    /// Error and time of the picture as predicted, in words.
    pub predicted: Vec<(String, String, String)>,
}

/// Tells the rung in use, and what chose it.
pub(super) fn fill_report(quality: Res<Quality>, mut report: ResMut<QualityReport>) {
    let Some(rung) = quality.rung() else { return };
    let options = QualityOption::ALL.into_iter().zip(rung.steps).map(|(option, step)| {
        let rest = if step == 0 { "at its finest".to_owned() } else { format!("step {step} of {}", option.steps() - 1) };
        (option.name.to_owned(), option.describe(step), rest)
    });
    let predicted = |name: &str, value: String, words: &str| (name.to_owned(), value, words.to_owned());
    let filled = QualityReport {
        why: quality.describe(),
        options: options.collect(),
        predicted: vec![
            predicted("error, mean FLIP", format!("{:.3}", rung.error), "at most, in 99 of 100 moments"),
            predicted("time of a frame", format!("{:.0} %", 100.0 * rung.time), "of the finest's"),
        ],
    };
    report.set_if_neq(filled);
}

/// Shows it.
pub(super) fn show(ui: &mut Ui, report: &QualityReport) {
    ui.label(&report.why);
    for (name, rows) in [("knobs", &report.options), ("predicted", &report.predicted)] {
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
