//! The right window: every setting in groups as in `game.toml`, a search, and what can be done with what was changed. Only rows that are
//! in view are laid out.

use bevy_egui::egui::{Align, Button, Color32, Label, Layout, Rect, RichText, ScrollArea, Sense, TextEdit, Ui, UiBuilder, pos2, vec2};
use bevy_egui::egui::{WidgetInfo, WidgetType, collapsing_header::paint_default_icon};

use crate::play::overlay::rows::{CHANGED, ROW, UNSAVED, row};
use crate::play::overlay::state::{Ask, Overlay, OverlayView};
use crate::scene::GameConfig;
use crate::scene::config;

/// Height of a group's heading, in points.
const HEADING: f32 = 24.0;

/// A line of the list.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Line {
    /// The heading of a section, and whether it is open.
    Group(&'static str, bool),
    /// A setting, by its place in the list of all.
    Setting(usize),
}

impl Line {
    fn height(self) -> f32 {
        match self {
            Line::Group(..) => HEADING,
            Line::Setting(_) => ROW,
        }
    }
}

/// The lines: all groups with what is in the open ones, or what was found under its groups.
fn lines(overlay: &mut Overlay) -> Vec<Line> {
    let found = overlay.found().map(<[usize]>::to_vec);
    let mut lines = Vec::new();
    for section in config::section_names() {
        let within: Vec<usize> = config::settings()
            .iter()
            .enumerate()
            .filter(|(place, setting)| setting.section == section && found.as_ref().is_none_or(|found| found.contains(place)))
            .map(|(place, _)| place)
            .collect();
        let open = found.is_some() || overlay.open.contains(section);
        if within.is_empty() {
            continue;
        }
        lines.push(Line::Group(section, open));
        if open {
            lines.extend(within.into_iter().map(Line::Setting));
        }
    }
    lines
}

/// Shows them.
pub fn show(ui: &mut Ui, seen: &OverlayView, overlay: &mut Overlay) {
    buttons(ui, seen, overlay);
    let search = TextEdit::singleline(&mut overlay.search).hint_text("search: name, unit or description").desired_width(f32::INFINITY);
    let search = ui.add(search);
    search.widget_info(|| WidgetInfo::labeled(WidgetType::TextEdit, true, "search"));
    // One line, whatever it says, so that what is below stays where it is; all of it is under the pointer.
    let said = if overlay.said.is_empty() { " " } else { &overlay.said };
    ui.add(Label::new(RichText::new(said).small().color(UNSAVED)).truncate());
    ui.separator();
    let lines = lines(overlay);
    let height: f32 = lines.iter().map(|line| line.height()).sum();
    ScrollArea::vertical().auto_shrink([false, false]).show_viewport(ui, |ui, view| {
        ui.set_height(height);
        let (left, width, mut top) = (ui.max_rect().left(), ui.available_width(), ui.max_rect().top());
        let mut above = 0.0;
        for line in lines {
            let rect = Rect::from_min_size(pos2(left, top), vec2(width, line.height()));
            if above + line.height() >= view.min.y && above <= view.max.y {
                match line {
                    Line::Group(section, open) => heading(ui, rect, section, open, seen, overlay),
                    Line::Setting(place) => row(ui, rect, place, seen, overlay),
                }
            }
            (above, top) = (above + line.height(), top + line.height());
        }
    });
}

/// What can be done with all of it.
fn buttons(ui: &mut Ui, seen: &OverlayView, overlay: &mut Overlay) {
    let (undo, redo) = overlay.history.depth();
    let unsaved = seen.marks.iter().filter(|mark| mark.unsaved).count();
    ui.horizontal(|ui| {
        let asks = [
            ("Undo", undo > 0, "takes the last change back", Ask::Undo),
            ("Redo", redo > 0, "does it again", Ask::Redo),
            ("Save", unsaved > 0, "writes what was changed here to game.toml; its comments stay", Ask::Save),
            ("Copy as command line", true, "a command that starts the game as it is set now", Ask::Copy),
        ];
        for (name, enabled, help, ask) in asks {
            if ui.add_enabled(enabled, Button::new(name)).on_hover_text(help).clicked() {
                overlay.asked.push(ask);
            }
        }
    });
}

/// The heading of a group: a click opens or closes it.
fn heading(ui: &mut Ui, rect: Rect, section: &'static str, open: bool, seen: &OverlayView, overlay: &mut Overlay) {
    let response = ui.interact(rect, ui.layer_id().id.with(section), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::CollapsingHeader, true, section));
    if response.clicked() && !overlay.open.remove(section) {
        overlay.open.insert(section);
    }
    let all = config::settings().iter().zip(seen.marks).filter(|(setting, _)| setting.section == section);
    let (changed, unsaved) =
        all.fold((0, 0), |(changed, unsaved), (_, mark)| (changed + u32::from(mark.changed), unsaved + u32::from(mark.unsaved)));
    if response.hovered() {
        ui.painter().rect_filled(rect, 2.0, Color32::from_white_alpha(10));
    }
    ui.scope_builder(UiBuilder::new().max_rect(rect).layout(Layout::left_to_right(Align::Center)), |ui| {
        let (_, icon) = ui.allocate_exact_size(vec2(14.0, 10.0), Sense::hover());
        paint_default_icon(ui, f32::from(u8::from(open)), &icon);
        ui.strong(section);
        if changed > 0 {
            ui.colored_label(CHANGED, format!("{changed} changed"));
        }
        if unsaved > 0 {
            ui.colored_label(UNSAVED, format!("{unsaved} not saved"));
        }
        if changed == 0 {
            return;
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let reset = ui.add(Button::new("⟲ group").small());
            reset.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, format!("reset group {section}")));
            if reset.on_hover_text("all of the group back to its defaults").clicked() {
                let usual = GameConfig::default();
                let within = config::settings().iter().enumerate().filter(|(_, setting)| setting.section == section);
                let to = within.map(|(place, setting)| (place, setting.get(&usual))).collect();
                overlay.asked.push(Ask::Change { to, continues: false });
            }
        });
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_those_of_the_file_and_a_search_opens_them() {
        let mut overlay = Overlay::default();
        assert_eq!(lines(&mut overlay), config::section_names().into_iter().map(|name| Line::Group(name, false)).collect::<Vec<_>>());
        overlay.open.insert("hole");
        assert_eq!(lines(&mut overlay)[..3], [Line::Group("hole", true), Line::Setting(0), Line::Group("clock", false)]);
        overlay.search = "orders".into();
        let place = config::settings().iter().position(|setting| setting.path() == "render.orders").expect("a setting");
        assert_eq!(lines(&mut overlay), [Line::Group("render", true), Line::Setting(place)]);
    }
}
