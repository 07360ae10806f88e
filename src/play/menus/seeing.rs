//! "What am I seeing?": names of what is on the screen, each with a line to it, and switches of what light does.
//!
//! Each name stands where its line is short, off the switches, off all that is named, and off the other names and their lines.

use bevy_egui::egui::{self, Align2, Color32, Painter, Pos2, Rect, Shape, Stroke, Vec2, vec2};

use super::{card, heading, paragraph};
use crate::play::hud::markers::{MarkerPosition, marker_position};
use crate::play::hud::paint::{FAINT, OWN, SEEN, TEXT, TRUE, TextBox, rimmed};
use crate::play::hud::panel::Panel;
use crate::play::menus::entries::Menu;
use crate::play::menus::rows::rows;
use crate::play::session::Session;
use crate::play::words::Language;
use crate::sim::seeing::{Phenomenon, Pointer};

/// Width of the switches, in points.
const SWITCHES: f32 = 250.0;
/// What the switches cover, from the screen's left edge, in points.
const LEFT: f32 = SWITCHES + 3.0 * 16.0 + 6.0;
/// Width of a name with its explanation, in points.
const WIDTH: f32 = 232.0;
/// Between two names, and between a name and a place that another names, in points.
const GAP: f32 = 6.0;
/// Between the places that are tried for a name, in points.
const STEP: f32 = 14.0;
/// On a screen narrower than this, in points, names stand without explanations.
const ROOM: f32 = 860.0;

/// Draws names and switches.
pub(super) fn draw(context: &egui::Context, session: &Session, menu: &mut Menu, panel: &Panel) {
    let language = session.language();
    let painter = context.layer_painter(egui::LayerId::background());
    let rect = context.content_rect();
    labels(&painter, rect, &panel.pointers, panel.field_of_view, language);
    card(context, "seeing", SWITCHES, |ui| {
        heading(ui, &language.say("menu-seeing"));
        rows(ui, menu);
        paragraph(ui, &language.say(if session.config.render.lensing { "seeing-hint" } else { "seeing-flat" }));
    });
}

/// What a pointer's number says.
fn number(pointer: &Pointer) -> String {
    let value = pointer.number.unwrap_or_default();
    match pointer.sight {
        Phenomenon::EinsteinRing => format!("{:.1}", value.to_degrees()),
        Phenomenon::BlueSide | Phenomenon::RedSide | Phenomenon::Aberration => format!("{value:.2}"),
        _ => format!("{value:.1}"),
    }
}

/// The title of a name, and its explanation.
fn words(language: Language, pointer: &Pointer) -> [String; 2] {
    let key = pointer.sight.key();
    let inside = pointer.sight == Phenomenon::Shadow && pointer.number.is_none();
    let text = format!("seeing-{key}-text{}", if inside { "-inside" } else { "" });
    [language.say(&format!("seeing-{key}")), language.fill(&text, &[("number", number(pointer).as_str())])]
}

/// Paints the names on the screen `rect`. Returns where each is, with the place that it names.
fn labels(painter: &Painter, rect: Rect, pointers: &[Pointer], field_of_view: f64, language: Language) -> Vec<(Rect, Pos2)> {
    let size = [f64::from(rect.width()), f64::from(rect.height())];
    let place = |pointer: &Pointer| match marker_position(pointer.direction, field_of_view, size, 0.0) {
        MarkerPosition::On(at) => Some(rect.min + vec2(at[0] as f32, at[1] as f32)),
        MarkerPosition::Edge(..) => None,
    };
    let explained = rect.width() > ROOM;
    let found: Vec<(Pos2, &Pointer)> = pointers.iter().filter_map(|pointer| Some((place(pointer)?, pointer))).collect();
    let places: Vec<Pos2> = found.iter().map(|(at, _)| *at).collect();
    let mut taken: Vec<(Rect, Pos2)> = Vec::new();
    let mut boxes = Vec::new();
    for (at, pointer) in &found {
        let [title, text] = words(language, pointer);
        let mut lines = vec![(title.as_str(), 13.5, colour(pointer.sight))];
        lines.extend(explained.then_some((text.as_str(), 11.5, TEXT)));
        let text_box = TextBox::lay_out(painter, rect.min, Align2::LEFT_TOP, if explained { WIDTH } else { 0.7 * WIDTH }, &lines);
        let frame = best_place(text_box.frame.size(), rect, *at, &places, &taken);
        taken.push((frame, *at));
        boxes.push((text_box.moved(frame.min - rect.min), *pointer));
    }
    for ((_, pointer), (frame, at)) in boxes.iter().zip(&taken) {
        let stroke = Stroke::new(1.2, colour(pointer.sight));
        let line = [edge(frame, *at), *at];
        rimmed(painter, stroke, |stroke| Shape::line_segment(line, stroke));
        rimmed(painter, stroke, |stroke| Shape::circle_stroke(*at, 4.0, stroke));
    }
    boxes.into_iter().for_each(|(text_box, _)| text_box.paint(painter));
    taken
}

/// The point of a box that is nearest to `at`.
fn edge(frame: &Rect, at: Pos2) -> Pos2 {
    at.clamp(frame.min, frame.max)
}

/// The best place on the screen for a name of this size that belongs to `at`: the nearest that is free; where nothing is, the nearest that
/// lies on no other name.
fn best_place(size: Vec2, screen: Rect, at: Pos2, places: &[Pos2], taken: &[(Rect, Pos2)]) -> Rect {
    let room = Rect::from_min_max(screen.min + vec2(LEFT, 8.0), screen.max - vec2(8.0, 8.0) - size);
    let count = |span: f32| (span / STEP).max(0.0) as usize;
    let tries = (0..=count(room.height())).flat_map(|row| (0..=count(room.width())).map(move |column| (row, column)));
    let cost = |frame: &Rect| {
        let wide = frame.expand(GAP);
        let on_names = taken.iter().filter(|(other, _)| wide.intersects(*other)).count();
        let on_places = places.iter().filter(|place| wide.expand(GAP).contains(**place)).count();
        let line = [edge(frame, at), at];
        let crossed = taken.iter().filter(|(other, there)| {
            crosses(line, [edge(other, *there), *there]) || crosses_box(line, other) || crosses_box([edge(other, *there), *there], &wide)
        });
        // A name on another cannot be read; one on what is named hides it; a crossing can be followed.
        1e6 * on_names as f32 + 1e4 * on_places as f32 + 400.0 * crossed.count() as f32 + line[0].distance(at)
    };
    tries
        .map(|(row, column)| Rect::from_min_size(room.min + vec2(column as f32 * STEP, row as f32 * STEP), size))
        .min_by(|a, b| cost(a).total_cmp(&cost(b)))
        .unwrap_or(Rect::from_min_size(room.min, size))
}

/// Whether two lines cross.
fn crosses([a, b]: [Pos2; 2], [c, d]: [Pos2; 2]) -> bool {
    let side = |p: Pos2, q: Pos2, r: Pos2| (q - p).rot90().dot(r - p);
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

/// Whether a line goes through a box.
fn crosses_box(line: [Pos2; 2], frame: &Rect) -> bool {
    let diagonals = [[frame.left_top(), frame.right_bottom()], [frame.left_bottom(), frame.right_top()]];
    diagonals.into_iter().any(|diagonal| crosses(line, diagonal))
}

fn colour(sight: Phenomenon) -> Color32 {
    match sight {
        Phenomenon::TrueTarget => TRUE,
        Phenomenon::TargetImage | Phenomenon::SecondImage | Phenomenon::EinsteinRing => SEEN,
        Phenomenon::Aberration => OWN,
        _ => FAINT,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::play::hud::layout::overlap;
    use crate::play::hud::paint::tests::on_canvas;
    use glam::DVec3;

    /// All sights at once, crowded in the middle: in both languages no name lies on another or off the screen, at 720p and with letters
    /// twice as large.
    #[test]
    fn all_names_fit() {
        for language in Language::ALL {
            for size in [[1280.0, 720.0], [1920.0, 1080.0], [900.0, 620.0], [640.0, 360.0]] {
                on_canvas(size, |painter, rect| {
                    let pointers: Vec<Pointer> = Phenomenon::ALL
                        .iter()
                        .enumerate()
                        .map(|(k, sight)| {
                            let turn = k as f64;
                            let direction = DVec3::new(0.15 * turn.cos(), 0.1 * turn.sin(), -1.0).normalize();
                            Pointer { sight: *sight, direction, number: Some(0.75) }
                        })
                        .collect();
                    let painted = labels(painter, rect, &pointers, 1.05, language);
                    assert_eq!(painted.len(), pointers.len());
                    for (k, (frame, _)) in painted.iter().enumerate() {
                        assert!(rect.contains_rect(*frame), "{language:?} {size:?}: {frame}");
                        assert!(painted[..k].iter().all(|(other, _)| !overlap(other, frame)), "{language:?} {size:?}: {frame}");
                        assert!(frame.left() >= LEFT, "{language:?} {size:?}: {frame}");
                    }
                });
            }
        }
    }
}
