//! How the entries of a menu are painted, and what the mouse does to them.

use bevy_egui::egui::{self, Align2, Color32, FontId, Rect, Sense, Stroke, StrokeKind, Ui, pos2, vec2};

use crate::play::hud::paint::{ALARM, FAINT, TEXT, TRUE};
use crate::play::hud::palette::Palette;
use crate::play::menus::entries::{Does, Entry, Menu, SLOTS, Touch, Way};

/// Height of a row of one line, in points.
const ROW: f32 = 25.0;
/// Size of its letters, in points.
const LETTERS: f32 = 14.5;
/// Size of a value's, in points.
const VALUE: f32 = 13.0;
/// Space between a row's edge and its words, in points.
const PAD: f32 = 8.0;
/// Width of a bar that is turned, in points.
const BAR: f32 = 110.0;
/// Width of the column for a value beside a bar, in points.
const NUMBER: f32 = 66.0;

/// Paints all entries of the menu, as wide as there is room, and notes what the mouse does.
pub(super) fn rows(ui: &mut Ui, menu: &mut Menu) {
    let moved = ui.input(|input| input.pointer.delta() != egui::Vec2::ZERO);
    for place in 0..menu.entries.len() {
        row(ui, menu, place, moved);
    }
}

/// Paints the entry at `place`.
pub(super) fn row(ui: &mut Ui, menu: &mut Menu, place: usize, moved: bool) {
    let Some(entry) = menu.entries.get(place).cloned() else { return };
    let palette = Palette::in_use(ui.ctx());
    let has_focus = menu.focus == place;
    let width = ui.available_width();
    let columns = columns(&entry, width);
    let name = columns.first().map_or(width, |column| column.0) - 2.0 * PAD;
    let colour = palette.shown(if entry.amiss.is_some() { ALARM } else { TEXT });
    let font = FontId::proportional(LETTERS);
    let words = match &entry.amiss {
        Some(amiss) => format!("{}\n{amiss}", entry.words),
        None => entry.words.clone(),
    };
    let galley = ui.painter().layout(words, font.clone(), colour, name.max(40.0));
    // Wide enough for a finger where there is one.
    let height = ROW.max(ui.spacing().interact_size.y).max(galley.size().y + 6.0);
    let (frame, response) = ui.allocate_exact_size(vec2(width, height), Sense::click_and_drag());
    if has_focus && ui.memory(|memory| memory.data.get_temp::<usize>(shown_focus()) != Some(place)) {
        ui.scroll_to_rect(frame, None);
        ui.memory_mut(|memory| memory.data.insert_temp(shown_focus(), place));
    }
    let painter = ui.painter_at(frame.expand(1.0));
    if has_focus {
        painter.rect_filled(frame, 4.0, Color32::from_rgb(34, 58, 84));
        painter.rect_stroke(frame, 4.0, Stroke::new(1.0 + palette.wider(), palette.shown(TRUE)), StrokeKind::Inside);
    }
    painter.galley(pos2(frame.left() + PAD, frame.top() + 0.5 * (height - galley.size().y)), galley, colour);
    for (k, (left, wide)) in columns.iter().enumerate() {
        let cell = Rect::from_min_size(pos2(frame.left() + left, frame.top()), vec2(*wide, height));
        let chosen = has_focus && (columns.len() == 1 || menu.column == k);
        value(&painter, cell, &entry, k, chosen, palette);
    }
    let at = response.interact_pointer_pos().or(response.hover_pos());
    let column =
        at.and_then(|at| columns.iter().position(|(left, wide)| (*left..left + wide).contains(&(at.x - frame.left())))).unwrap_or(0);
    if response.hovered() && moved && !has_focus {
        menu.touched.push(Touch::Focus(place, menu.column));
    }
    let turned = entry.share.zip(columns.first()).zip(at);
    if let (true, Some(((_, (left, _)), at))) = (response.dragged() || response.clicked(), turned) {
        let share = (at.x - frame.left() - left) / BAR;
        if (-0.1..1.1).contains(&share) {
            menu.touched.extend([Touch::Focus(place, 0), Touch::Turn(f64::from(share))]);
            return;
        }
    }
    if response.clicked() && entry.share.is_none() {
        let chooses = matches!(entry.does, Does::Fly(_)) && !has_focus;
        menu.touched.push(Touch::Focus(place, column));
        // Free flight names its scene between arrows, which are touched.
        let arrows = (has_focus && entry.id == "free").then(|| columns.first()).flatten().zip(at);
        if let Some(((left, wide), at)) = arrows.filter(|((left, _), at)| at.x - frame.left() > *left) {
            let words = entry
                .values
                .first()
                .map_or(0.0, |words| ui.painter().layout_no_wrap(format!("‹ {words} ›"), FontId::proportional(VALUE), colour).size().x);
            let middle = frame.left() + left + wide - 0.5 * words.min(*wide);
            menu.touched.push(Touch::Step(if at.x < middle { Way::Left } else { Way::Right }));
            return;
        }
        // A mission is looked at by the first click and flown by the second.
        if !chooses {
            menu.touched.push(Touch::Confirm);
        }
    }
    if response.secondary_clicked() && matches!(entry.does, Does::Bind(_)) {
        menu.touched.extend([Touch::Focus(place, column), Touch::Clear]);
    }
}

/// Paints the heads of the columns of buttons.
pub(super) fn header(ui: &mut Ui, words: [String; 4]) {
    let width = ui.available_width();
    let (frame, _) = ui.allocate_exact_size(vec2(width, 0.8 * ROW), Sense::hover());
    let colour = Palette::in_use(ui.ctx()).shown(FAINT);
    for ((left, wide), words) in of_buttons(width).into_iter().zip(words) {
        let at = pos2(frame.left() + left + 0.5 * wide, frame.center().y);
        ui.painter().text(at, Align2::CENTER_CENTER, words, FontId::proportional(12.0), colour);
    }
}

/// Where the focus was shown last.
fn shown_focus() -> egui::Id {
    egui::Id::new("menu focus")
}

/// Left edges and widths of an entry's values in a row of this width, in points.
fn columns(entry: &Entry, width: f32) -> Vec<(f32, f32)> {
    match (entry.values.len(), entry.share) {
        (0, _) => Vec::new(),
        (1, Some(_)) => vec![(width - BAR - NUMBER - PAD, BAR + NUMBER)],
        (1, None) => vec![(width * 0.52, width * 0.48 - PAD)],
        (_, _) => of_buttons(width).to_vec(),
    }
}

/// The columns for the buttons of an action.
fn of_buttons(width: f32) -> [(f32, f32); SLOTS.len()] {
    let wide = 0.64 * width / SLOTS.len() as f32;
    std::array::from_fn(|k| (0.36 * width + wide * k as f32 - PAD, wide))
}

/// Paints a value in its cell: words between arrows, or a bar and its number.
fn value(painter: &egui::Painter, cell: Rect, entry: &Entry, k: usize, chosen: bool, palette: Palette) {
    let words = entry.values[k].as_str();
    let colour = palette.shown(if chosen { TRUE } else { TEXT });
    if let Some(share) = entry.share {
        let line = Rect::from_center_size(pos2(cell.left() + 0.5 * BAR, cell.center().y), vec2(BAR, 5.0));
        painter.rect_filled(line, 2.5, Color32::from_rgb(58, 70, 84));
        let filled = Rect::from_min_size(line.min, vec2(BAR * share as f32, line.height()));
        painter.rect_filled(filled, 2.5, palette.shown(FAINT));
        painter.circle_filled(pos2(filled.right(), line.center().y), 6.0, colour);
        painter.text(cell.right_center(), Align2::RIGHT_CENTER, words, FontId::proportional(13.0), colour);
        return;
    }
    let is_column = entry.values.len() > 1;
    let turns = !is_column && chosen && !matches!(entry.does, Does::Ask(_) | Does::Open(_));
    let words = if turns { format!("‹ {words} ›") } else { words.to_owned() };
    let anchor = if is_column { Align2::CENTER_CENTER } else { Align2::RIGHT_CENTER };
    let at = if is_column { cell.center() } else { cell.right_center() };
    let mut size = VALUE;
    let mut galley = painter.layout_no_wrap(words.clone(), FontId::proportional(size), colour);
    // Long names of buttons grow smaller before they are cut.
    while galley.size().x > cell.width() && size > 8.0 {
        size -= 1.0;
        galley = painter.layout_no_wrap(words.clone(), FontId::proportional(size), colour);
    }
    let place = anchor.anchor_size(at, galley.size());
    painter.galley(place.min, galley, colour);
    if is_column && chosen && SLOTS.get(k).is_some() {
        painter.rect_stroke(cell.shrink(2.0), 3.0, Stroke::new(1.0, colour), StrokeKind::Inside);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::play::menus::screens::MenuAction;
    use bevy_egui::egui::{Area, Context, Event, Id, Modifiers, PointerButton, Pos2, RawInput};

    /// What a menu of two entries, a button and a slider, notes of these events of the mouse.
    fn touched(events: Vec<Event>) -> Vec<Touch> {
        touched_in(Entry::new("quit", "Quit".into(), Does::Ask(MenuAction::Quit)), events)
    }

    /// The same with another first entry, which has the focus.
    fn touched_in(first: Entry, events: Vec<Event>) -> Vec<Touch> {
        let setting = crate::scene::config::setting("sound.music").expect("a setting");
        let entries =
            vec![first, Entry { share: Some(0.5), ..Entry::new("music", "Music".into(), Does::Choose(setting)).valued("50 %".into()) }];
        let mut menu = Menu { entries, ..Menu::default() };
        let context = Context::default();
        let screen = Rect::from_min_size(Pos2::ZERO, vec2(400.0, 300.0));
        let mut draw = |events: Vec<Event>| {
            let input = RawInput { screen_rect: Some(screen), events, ..RawInput::default() };
            // What is drawn with the result is nobody's.
            let _ = context.run_ui(input, |ui| {
                Area::new(Id::new("menu")).fixed_pos(pos2(0.0, 0.0)).show(ui.ctx(), |ui| {
                    ui.set_width(400.0);
                    ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
                    rows(ui, &mut menu);
                });
            });
        };
        // Measured, painted; then the mouse, a frame for each event.
        draw(Vec::new());
        draw(Vec::new());
        events.into_iter().for_each(|event| draw(vec![event]));
        menu.touched
    }

    fn click(at: Pos2) -> Vec<Event> {
        let button = |pressed| Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE };
        vec![Event::PointerMoved(at), button(true), button(false)]
    }

    #[test]
    fn a_click_chooses_and_confirms() {
        let done = touched(click(pos2(60.0, 12.0)));
        assert_eq!(done, [Touch::Focus(0, 0), Touch::Confirm]);
    }

    #[test]
    fn the_pointer_takes_the_focus_with_it() {
        assert_eq!(touched(vec![Event::PointerMoved(pos2(60.0, 38.0)), Event::PointerMoved(pos2(62.0, 38.0))])[0], Touch::Focus(1, 0));
    }

    #[test]
    fn arrows_turn_where_they_are_clicked() {
        for (right, done) in [(PAD + 4.0, Touch::Step(Way::Right)), (PAD + 45.0, Touch::Step(Way::Left)), (340.0, Touch::Confirm)] {
            let free = Entry::new("free", "Free flight".into(), Does::Fly(10)).valued("chase".into());
            assert_eq!(touched_in(free, click(pos2(400.0 - right, 12.0))), [Touch::Focus(0, 0), done], "{right}");
        }
    }

    /// The bar begins 184 points from the right edge and is 110 long.
    #[test]
    fn a_bar_is_turned_where_it_is_clicked() {
        let done = touched(click(pos2(400.0 - BAR - NUMBER - PAD + 0.75 * BAR, 38.0)));
        assert!(done.iter().any(|touch| matches!(touch, Touch::Turn(share) if (share - 0.75).abs() < 0.02)), "{done:?}");
        assert!(!done.contains(&Touch::Confirm) && !done.contains(&Touch::Step(Way::Up)), "{done:?}");
    }
}
