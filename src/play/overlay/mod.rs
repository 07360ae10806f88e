//! The dev overlay: every number of `game.toml` live, and what a frame costs.

pub mod live;

use std::collections::VecDeque;

use bevy::prelude::*;
use bevy_egui::egui::{self, ComboBox, DragValue, RichText, Slider, TextEdit, Ui};
use bevy_egui::{EguiContexts, EguiPrimaryContextPass};

use crate::render::plugin::RenderStatistics;
use crate::scene::GameConfig;
use crate::scene::config::{self, Allowed, Setting, Value};

use crate::play::player_state::PlayerState;
use crate::play::schedule::PaintSet;
use crate::play::session::Session;

/// Frames over which mean and worst are taken.
const WINDOW: usize = 240;
/// Wall time between two looks at the counters, in seconds: faster, nobody could read them.
const COUNTER_PERIOD: f64 = 0.5;

/// Durations of the last frames, in milliseconds.
#[derive(Clone, Debug, Default)]
pub struct FrameTimes(VecDeque<f64>);

impl FrameTimes {
    /// Adds a frame.
    pub fn push(&mut self, milliseconds: f64) {
        if self.0.len() == WINDOW {
            self.0.pop_front();
        }
        self.0.push_back(milliseconds);
    }

    /// Mean and worst; None before the first frame.
    pub fn mean_and_worst(&self) -> Option<(f64, f64)> {
        let count = self.0.len();
        (count > 0).then(|| (self.0.iter().sum::<f64>() / count as f64, self.0.iter().copied().fold(0.0, f64::max)))
    }
}

/// The dev overlay, and changes of the configuration. Needs [`HudPlugin`](crate::play::hud::HudPlugin).
pub struct OverlayPlugin;

impl Plugin for OverlayPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(live::LivePlugin).add_systems(EguiPrimaryContextPass, draw.in_set(PaintSet::Overlay));
    }
}

/// Draws the overlay where it is on.
fn draw(
    mut contexts: EguiContexts,
    player: Res<PlayerState>,
    mut session: ResMut<Session>,
    mut statistics: ResMut<RenderStatistics>,
    real: Res<Time<Real>>,
    mut times: Local<FrameTimes>,
    mut shown: Local<(f64, RenderStatistics)>,
) -> Result {
    times.push(real.delta_secs_f64() * 1e3);
    statistics.counting = player.overlay;
    if !player.overlay {
        return Ok(());
    }
    let context = contexts.ctx_mut()?;
    if real.elapsed_secs_f64() >= shown.0 {
        *shown = (real.elapsed_secs_f64() + COUNTER_PERIOD, statistics.clone());
    }
    let RenderStatistics { counters, disk, .. } = shown.1;
    let disk = disk.filter(|counters| counters.arcs > 0);
    let mut config = session.config.clone();
    egui::Window::new("Lensrunner").default_pos([16.0, 180.0]).default_width(430.0).default_height(480.0).vscroll(true).show(
        context,
        |ui| {
            costs(ui, &times, &statistics.passes);
            counts(ui, counters.map(|c| (c.complaint(), c.to_string())));
            if let Some(disk) = disk {
                counts(ui, Some((disk.complaint(), disk.to_string())));
            }
            ui.separator();
            for section in config::section_names() {
                egui::CollapsingHeader::new(section).default_open(section == "render").show(ui, |ui| {
                    for setting in config::settings().iter().filter(|setting| setting.section == section) {
                        row(ui, setting, &mut config);
                    }
                });
            }
        },
    );
    if config != session.config {
        session.config = config;
    }
    Ok(())
}

fn costs(ui: &mut Ui, times: &FrameTimes, passes: &[(&'static str, f32)]) {
    if let Some((mean, worst)) = times.mean_and_worst() {
        let line = format!("frame {mean:.1} ms mean, {worst:.1} ms worst of {WINDOW}   ({:.0} a second)", 1e3 / mean.max(1e-6));
        ui.label(RichText::new(line).strong());
    }
    let total: f32 = passes.iter().map(|pass| pass.1).sum();
    egui::Grid::new("passes").num_columns(2).striped(true).show(ui, |ui| {
        for (name, milliseconds) in passes {
            ui.label(*name);
            ui.label(format!("{milliseconds:.2} ms"));
            ui.end_row();
        }
        if !passes.is_empty() {
            ui.label("all passes");
            ui.label(format!("{total:.2} ms"));
            ui.end_row();
        }
    });
}

/// What is amiss in some counters, and the counts.
fn counts(ui: &mut Ui, counters: Option<(Option<String>, String)>) {
    match counters {
        Some((complaint, counts)) => {
            if let Some(complaint) = complaint {
                ui.colored_label(egui::Color32::ORANGE, complaint);
            }
            ui.label(counts);
        }
        None => _ = ui.label("no counters"),
    }
}

/// One setting: its name, its value to change, its unit.
fn row(ui: &mut Ui, setting: &Setting<GameConfig>, config: &mut GameConfig) {
    let before = setting.get(config);
    let mut value = before.clone();
    ui.horizontal(|ui| {
        edit(ui, setting, &mut value);
        ui.label(setting.key).on_hover_text(format!("{} ({})", setting.help, setting.allowed_text()));
    });
    if value != before {
        // What the widget gives may still be refused, as a half-typed key name; then the old value stays.
        let _ = setting.set(config, value);
    }
}

fn edit(ui: &mut Ui, setting: &Setting<GameConfig>, value: &mut Value) {
    let suffix = if setting.unit.is_empty() { String::new() } else { format!(" {}", setting.unit) };
    match (value, setting.allowed) {
        (Value::Number(number), Allowed::Number { min, max }) => {
            let wide = min >= 0.0 && max > 100.0 * min.max(1e-3);
            ui.add(Slider::new(number, min..=max).logarithmic(wide).suffix(suffix));
        }
        (Value::Integer(number), Allowed::Integer { min, max }) if max - min <= 64 => {
            ui.add(Slider::new(number, min..=max).suffix(suffix));
        }
        (Value::Integer(number), Allowed::Integer { min, max }) => {
            let speed = f64::from(*number).max(10.0) * 0.01;
            ui.add(DragValue::new(number).range(min..=max).speed(speed).suffix(suffix));
        }
        (Value::Switch(on), _) => {
            ui.checkbox(on, "");
        }
        (Value::Word(word), Allowed::Choice(words)) => {
            ComboBox::from_id_salt(setting.path()).selected_text(word.as_str()).show_ui(ui, |ui| {
                for choice in words {
                    ui.selectable_value(word, (*choice).to_owned(), *choice);
                }
            });
        }
        (Value::Word(word), _) => {
            // Committed when it is a key's name.
            let id = ui.id().with(setting.path());
            let mut draft = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_else(|| word.clone());
            let typed = ui.add(TextEdit::singleline(&mut draft).desired_width(110.0));
            if typed.has_focus() {
                ui.data_mut(|data| data.insert_temp(id, draft.clone()));
            } else {
                ui.data_mut(|data| data.remove::<String>(id));
            }
            if typed.lost_focus() || setting.check(Value::Word(draft.clone())).is_ok() {
                *word = draft;
            }
        }
        _ => (),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_worst_of_the_last_frames() {
        let mut times = FrameTimes::default();
        assert_eq!(times.mean_and_worst(), None);
        times.push(1000.0);
        for _ in 0..WINDOW - 1 {
            times.push(10.0);
        }
        assert_eq!(times.mean_and_worst().map(|(_, worst)| worst), Some(1000.0));
        times.push(20.0);
        assert_eq!(times.mean_and_worst().map(|(_, worst)| worst), Some(20.0));
    }
}
