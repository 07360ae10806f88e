//! One setting of `game.toml` on the screen: its name, its value to change, and below them range, unit, default and what it does.

use bevy_egui::egui::{
    Align2, Button, Checkbox, Color32, ComboBox, DragValue, FontId, Label, Rect, Response, RichText, Sense, Slider, TextEdit, Ui,
    UiBuilder, WidgetInfo, WidgetType, pos2, vec2,
};

use crate::play::overlay::state::{Ask, Overlay, OverlayView};
use crate::scene::GameConfig;
use crate::scene::config::{self, Allowed, Setting, Value};

/// Height of a row, in points.
pub const ROW: f32 = 38.0;
/// Marks what is not as the file has it.
pub const UNSAVED: Color32 = Color32::from_rgb(255, 170, 60);
/// Marks what is not its default.
pub const CHANGED: Color32 = Color32::from_rgb(150, 200, 255);
/// Width of the value with its slider, in points.
const VALUE: f32 = 172.0;
/// Width of the button that resets, in points.
const RESET: f32 = 20.0;

/// The settings with these paths, one below the other.
pub fn list(ui: &mut Ui, paths: &[&str], seen: &OverlayView, overlay: &mut Overlay) {
    for path in paths {
        let Some(place) = config::settings().iter().position(|setting| setting.path() == *path) else { continue };
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
        row(ui, rect, place, seen, overlay);
    }
}

/// The setting at `place` in the list of all, in `rect`.
pub fn row(ui: &mut Ui, rect: Rect, place: usize, seen: &OverlayView, overlay: &mut Overlay) {
    let setting = &config::settings()[place];
    let mark = seen.marks.get(place).copied().unwrap_or_default();
    let upper = Rect::from_min_size(rect.min + vec2(0.0, 1.0), vec2(rect.width(), 20.0));
    let value_left = upper.right() - RESET - 4.0 - VALUE;
    let name = Rect::from_min_max(pos2(upper.left() + 10.0, upper.top()), pos2(value_left - 4.0, upper.bottom()));
    let colour = if mark.changed { CHANGED } else { ui.visuals().text_color() };
    // Of the window and the setting alone: rows above come and go while a slider is dragged.
    let id = ui.layer_id().id.with(place);
    let mut words = ui.new_child(UiBuilder::new().id(id.with("name")).max_rect(name).layout(*ui.layout()));
    let label = words.add(Label::new(RichText::new(setting.key).color(colour)).truncate().sense(Sense::hover()));
    label.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, setting.path()));
    if mark.unsaved {
        ui.painter().circle_filled(pos2(upper.left() + 4.0, upper.center().y), 3.0, UNSAVED);
    }
    let before = setting.get(seen.config);
    let mut value = before.clone();
    let field = Rect::from_min_size(pos2(value_left, upper.top()), vec2(VALUE, upper.height()));
    let edited = ui
        .scope_builder(UiBuilder::new().max_rect(field).id(id), |ui| edit(ui, setting, &mut value))
        .inner
        .map(|edited| edited.labelled_by(label.id));
    if value != before {
        // What the widget gives may still be refused, as a half-typed key name; then the old value stays.
        if let Ok(value) = setting.check(value) {
            let continues = edited.is_some_and(|edited| edited.dragged() && !edited.drag_started());
            overlay.asked.push(Ask::Change { to: vec![(place, value)], continues });
        }
    }
    let usual = setting.get(&GameConfig::default());
    if mark.changed {
        let at = Rect::from_min_size(pos2(upper.right() - RESET, upper.top()), vec2(RESET, upper.height()));
        let reset = ui.put(at, Button::new("⟲").small());
        reset.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, format!("reset {}", setting.path())));
        if reset.on_hover_text(format!("back to the default, {usual}")).clicked() {
            overlay.asked.push(Ask::Change { to: vec![(place, usual.clone())], continues: false });
        }
    }
    let about = format!("{} · default {usual} · {}", setting.allowed_text(), setting.help);
    let lower = Rect::from_min_max(pos2(name.left(), upper.bottom()), rect.max - vec2(4.0, 0.0));
    let painter = ui.painter().with_clip_rect(lower.intersect(ui.clip_rect()));
    painter.text(lower.left_top(), Align2::LEFT_TOP, &about, FontId::proportional(10.5), ui.visuals().weak_text_color());
    ui.interact(lower, id.with("about"), Sense::hover()).on_hover_text(about);
}

/// The value, to change.
fn edit(ui: &mut Ui, setting: &Setting<GameConfig>, value: &mut Value) -> Option<Response> {
    ui.spacing_mut().slider_width = 92.0;
    match (value, setting.allowed) {
        (Value::Number(number), Allowed::Number { min, max }) => {
            let wide = min >= 0.0 && max > 100.0 * min.max(1e-3);
            Some(ui.add(Slider::new(number, min..=max).logarithmic(wide)))
        }
        (Value::Integer(number), Allowed::Integer { min, max }) if max - min <= 64 => Some(ui.add(Slider::new(number, min..=max))),
        (Value::Integer(number), Allowed::Integer { min, max }) => {
            let speed = f64::from(*number).max(10.0) * 0.01;
            Some(ui.add(DragValue::new(number).range(min..=max).speed(speed)))
        }
        (Value::Switch(on), _) => Some(ui.add(Checkbox::without_text(on))),
        (Value::Word(word), Allowed::Choice(words)) => {
            let choice = ComboBox::from_id_salt("choice").selected_text(word.as_str()).width(VALUE - 16.0).show_ui(ui, |ui| {
                for choice in words {
                    ui.selectable_value(word, (*choice).to_owned(), *choice);
                }
            });
            Some(choice.response)
        }
        (Value::Word(word), _) => {
            // Committed when it is what may be there: a key's name.
            let id = ui.id().with("draft");
            let mut draft = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_else(|| word.clone());
            let typed = ui.add(TextEdit::singleline(&mut draft).desired_width(VALUE - 12.0));
            if typed.has_focus() {
                ui.data_mut(|data| data.insert_temp(id, draft.clone()));
            } else {
                ui.data_mut(|data| data.remove::<String>(id));
            }
            if typed.lost_focus() || setting.check(Value::Word(draft.clone())).is_ok() {
                *word = draft;
            }
            Some(typed)
        }
        _ => None,
    }
}
