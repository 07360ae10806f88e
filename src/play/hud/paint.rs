//! What the HUD is painted with: words on a dark ground, text boxes, bars, and lines with a dark rim, so that all of it is seen before
//! stars and disk.

use std::sync::Arc;

pub use crate::play::hud::colours::{ALARM, FAINT, OWN, SEEN, SHADE, TEXT, TRUE};
use crate::play::hud::palette::Palette;
use bevy_egui::egui::{Align, Align2, Color32, FontId, Galley, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, Vec2 as Size, pos2, vec2};

/// Behind the names of markers: a little more is seen through them, for they lie on what they name.
const NAME_SHADE: Color32 = Color32::from_rgba_premultiplied(4, 8, 14, 250);
/// Space between a text box's edge and its words, in points.
const PAD: Size = vec2(10.0, 6.0);
/// How thick bars are, in points.
const BAR: f32 = 5.0;
/// How much higher a text box is by its bar, in points.
pub const BAR_ROOM: f32 = BAR + PAD.y;

/// Space between a name and the edge of its ground, in points.
pub const NAME_PAD: Size = vec2(4.0, 1.5);

/// Words on a dark ground that is [`NAME_PAD`] larger; returns the ground. `at` is where its `anchor` is.
pub fn text(painter: &Painter, at: Pos2, anchor: Align2, words: &str, size: f32, colour: Color32) -> Rect {
    let palette = Palette::in_use(painter.ctx());
    let colour = palette.shown(colour);
    let galley = painter.layout_no_wrap(words.to_owned(), FontId::proportional(size), colour);
    let ground = anchor.anchor_size(at, galley.size() + 2.0 * NAME_PAD);
    painter.rect_filled(ground, 4.0, if palette.high_contrast { Color32::BLACK } else { NAME_SHADE });
    painter.galley(ground.min + NAME_PAD, galley, colour);
    ground
}

/// A shape of strokes on a dark copy of it that is a little wider.
pub fn rimmed(painter: &Painter, stroke: Stroke, shape: impl Fn(Stroke) -> Shape) {
    let palette = Palette::in_use(painter.ctx());
    let stroke = Stroke::new(stroke.width + palette.wider(), palette.shown(stroke.color));
    painter.add(shape(Stroke::new(stroke.width + 3.5, Color32::from_black_alpha(240))));
    painter.add(shape(stroke));
}

/// A bar, `share` of which is filled.
fn bar(painter: &Painter, bar: Rect, share: f32, colour: Color32) {
    let filled = Rect::from_min_size(bar.min, vec2(bar.width() * share.clamp(0.0, 1.0), bar.height()));
    let palette = Palette::in_use(painter.ctx());
    painter.rect_filled(filled, 3.0, palette.shown(colour).gamma_multiply(0.75));
    painter.rect_stroke(bar, 3.0, Stroke::new(1.0, palette.shown(FAINT)), StrokeKind::Outside);
}

/// Lines of text on a dark ground, laid out and not painted yet.
pub struct TextBox {
    /// What it covers, in points.
    pub frame: Rect,
    lines: Vec<(Pos2, Arc<Galley>, Color32)>,
    bar: Option<(Rect, f32, Color32)>,
}

impl TextBox {
    /// A text box whose `anchor` is at `at`; lines longer than `widest` are wrapped.
    pub fn lay_out(painter: &Painter, at: Pos2, anchor: Align2, widest: f32, lines: &[(&str, f32, Color32)]) -> TextBox {
        let palette = Palette::in_use(painter.ctx());
        let galleys = lines.iter().map(|&(words, size, colour)| {
            let colour = palette.shown(colour);
            (painter.layout(words.to_owned(), FontId::proportional(size), colour, widest - 2.0 * PAD.x), colour)
        });
        let galleys: Vec<_> = galleys.collect();
        let inside = galleys.iter().fold(Size::ZERO, |sum, (galley, _)| vec2(sum.x.max(galley.size().x), sum.y + galley.size().y));
        let frame = anchor.anchor_size(at, inside + 2.0 * PAD);
        let mut top = frame.top() + PAD.y;
        let lines = galleys.into_iter().map(|(galley, colour)| {
            let free = frame.width() - 2.0 * PAD.x - galley.size().x;
            let share = match anchor.x() {
                Align::Min => 0.0,
                Align::Center => 0.5,
                Align::Max => 1.0,
            };
            let place = pos2(frame.left() + PAD.x + share * free, top);
            top += galley.size().y;
            (place, galley, colour)
        });
        TextBox { frame, lines: lines.collect(), bar: None }
    }

    /// Higher by [`BAR_ROOM`], with a thin bar below the words, `share` of which is filled.
    pub fn over_bar(self, share: f32, colour: Color32) -> TextBox {
        let place = Rect::from_min_size(self.frame.left_bottom() + vec2(PAD.x, 0.0), vec2(self.frame.width() - 2.0 * PAD.x, BAR));
        let frame = Rect::from_min_max(self.frame.min, pos2(self.frame.right(), place.bottom() + PAD.y));
        TextBox { frame, bar: Some((place, share, colour)), ..self }
    }

    /// The same elsewhere, `way` points away.
    pub fn moved(mut self, way: Size) -> TextBox {
        self.frame = self.frame.translate(way);
        self.lines.iter_mut().for_each(|line| line.0 += way);
        if let Some(bar) = &mut self.bar {
            bar.0 = bar.0.translate(way);
        }
        self
    }

    /// Paints it.
    pub fn paint(self, painter: &Painter) {
        painter.rect_filled(self.frame, 6.0, Palette::in_use(painter.ctx()).shown(SHADE));
        if let Some((place, share, colour)) = self.bar {
            bar(painter, place, share, colour);
        }
        for (place, galley, colour) in self.lines {
            painter.galley(place, galley, colour);
        }
    }
}

#[cfg(test)]
pub(in crate::play) mod tests {
    use super::*;
    use bevy_egui::egui::{Context, LayerId, RawInput, vec2};

    /// Lets `draw` paint on a canvas of this size, in points.
    pub(in crate::play) fn on_canvas(size: [f32; 2], mut draw: impl FnMut(&Painter, Rect)) {
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(size[0], size[1]));
        let input = RawInput { screen_rect: Some(rect), ..RawInput::default() };
        let context = Context::default();
        crate::play::words::font::install(&context);
        // What is drawn with the result is nobody's.
        let _ = context.run_ui(input, |ui| draw(&ui.ctx().layer_painter(LayerId::background()), rect));
    }

    /// Before the white of the disk every colour has the contrast that WCAG asks of small text, 4.5. Grounds are laid over the picture as
    /// light.
    #[test]
    fn words_are_read_before_the_brightest_disk() {
        let linear = |encoded: u8| {
            let value = f64::from(encoded) / 255.0;
            if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
        };
        let luminance = |colour: Color32| 0.2126 * linear(colour.r()) + 0.7152 * linear(colour.g()) + 0.0722 * linear(colour.b());
        for ground in [SHADE, NAME_SHADE] {
            let behind = luminance(ground) + 1.0 - f64::from(ground.a()) / 255.0;
            for colour in [TEXT, FAINT, SEEN, TRUE, OWN, ALARM] {
                let contrast = (luminance(colour) + 0.05) / (behind + 0.05);
                assert!(contrast > 4.5, "{colour:?} on {ground:?}: {contrast}");
            }
        }
    }

    #[test]
    fn a_long_line_is_wrapped() {
        let words = "a word and one more ".repeat(60);
        on_canvas([900.0, 620.0], |painter, rect| {
            let lay_out = |widest| TextBox::lay_out(painter, rect.center(), Align2::CENTER_CENTER, widest, &[(&words, 14.0, TEXT)]).frame;
            assert!(lay_out(f32::INFINITY).width() > rect.width());
            let wrapped = lay_out(860.0);
            assert!(wrapped.width() <= 860.0 && rect.contains_rect(wrapped), "{wrapped}");
        });
    }
}
