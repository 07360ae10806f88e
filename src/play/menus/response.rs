//! The picture of both sticks' answers on the page of controls.

use bevy_egui::egui::{Align2, FontId, Sense, Shape, Stroke, StrokeKind, Ui, pos2, vec2};

use crate::play::hud::paint::{FAINT, OWN, SEEN};
use crate::play::hud::palette::Palette;
use crate::play::input::response::Response;
use crate::play::session::Session;

/// Draws how far the ship answers over how far each stick is pushed.
pub(super) fn curve(ui: &mut Ui, session: &Session) {
    /// Side of the picture, in points.
    const SIDE: f32 = 130.0;
    let controls = &session.config.controls;
    let sticks = [(Response::left(controls), OWN, "curve-left"), (Response::right(controls), SEEN, "curve-right")];
    let (frame, _) = ui.allocate_exact_size(vec2(ui.available_width(), SIDE + 12.0), Sense::hover());
    let palette = Palette::in_use(ui.ctx());
    let square = bevy_egui::egui::Rect::from_min_size(frame.min + vec2(8.0, 6.0), vec2(1.6 * SIDE, SIDE));
    let painter = ui.painter_at(frame);
    let faint = palette.shown(FAINT);
    painter.rect_stroke(square, 2.0, Stroke::new(1.0, faint), StrokeKind::Inside);
    let at = |way: f64, answer: f64| pos2(square.left() + square.width() * way as f32, square.bottom() - square.height() * answer as f32);
    painter.line_segment([at(0.0, 0.0), at(1.0, 1.0)], Stroke::new(0.6, faint.gamma_multiply(0.5)));
    let language = session.language();
    let font = FontId::proportional(12.0);
    for (k, (response, colour, words)) in sticks.into_iter().enumerate() {
        // One lies beneath the other where they are the same.
        let width = if k == 0 { 4.0 } else { 1.5 } + palette.wider();
        let points = (0..=60).map(|k| f64::from(k) / 60.0).map(|way| at(way, response.answer(way))).collect();
        painter.add(Shape::line(points, Stroke::new(width, palette.shown(colour))));
        let place = square.right_center() + vec2(8.0, 16.0 * (k as f32 - 0.5));
        painter.text(place, Align2::LEFT_CENTER, language.say(words), font.clone(), palette.shown(colour));
    }
    painter.text(square.right_bottom() + vec2(8.0, 0.0), Align2::LEFT_BOTTOM, language.say("curve-way"), font.clone(), faint);
    painter.text(square.right_top() + vec2(8.0, 0.0), Align2::LEFT_TOP, language.say("curve-answer"), font, faint);
}
