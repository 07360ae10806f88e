//! The picture of a stick's answer on the page of controls.

use bevy_egui::egui::{Align2, FontId, Sense, Shape, Stroke, StrokeKind, Ui, pos2, vec2};

use crate::play::hud::paint::{FAINT, SEEN};
use crate::play::hud::palette::Palette;
use crate::play::input::response::Response;
use crate::play::session::Session;

/// Draws how far the ship answers over how far a stick is pushed.
pub(super) fn curve(ui: &mut Ui, session: &Session) {
    /// Side of the picture, in points.
    const SIDE: f32 = 130.0;
    let response = Response::of(&session.config.controls);
    let (frame, _) = ui.allocate_exact_size(vec2(ui.available_width(), SIDE + 12.0), Sense::hover());
    let palette = Palette::in_use(ui.ctx());
    let square = bevy_egui::egui::Rect::from_min_size(frame.min + vec2(8.0, 6.0), vec2(1.6 * SIDE, SIDE));
    let painter = ui.painter_at(frame);
    let faint = palette.shown(FAINT);
    painter.rect_stroke(square, 2.0, Stroke::new(1.0, faint), StrokeKind::Inside);
    let at = |way: f64, answer: f64| pos2(square.left() + square.width() * way as f32, square.bottom() - square.height() * answer as f32);
    painter.line_segment([at(0.0, 0.0), at(1.0, 1.0)], Stroke::new(0.6, faint.gamma_multiply(0.5)));
    let points = (0..=60).map(|k| f64::from(k) / 60.0).map(|way| at(way, response.answer(way))).collect();
    painter.add(Shape::line(points, Stroke::new(2.0 + palette.wider(), palette.shown(SEEN))));
    let language = session.language();
    let font = FontId::proportional(12.0);
    painter.text(square.right_bottom() + vec2(8.0, 0.0), Align2::LEFT_BOTTOM, language.say("curve-way"), font.clone(), faint);
    painter.text(square.right_top() + vec2(8.0, 0.0), Align2::LEFT_TOP, language.say("curve-answer"), font, faint);
}
