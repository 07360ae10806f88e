//! The sticks and buttons for fingers, as the HUD paints them.

use bevy::prelude::Vec2;
use bevy_egui::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, pos2, vec2 as size};

use crate::play::hud::paint::{FAINT, OWN, TEXT};
use crate::play::hud::palette::Palette;
use crate::play::input::touch::TouchControls;
use crate::play::words::Language;

/// Size of the words on buttons, in radii of one.
const LETTERS: f32 = 0.44;
/// Under a button: what is behind it is seen.
const GROUND: Color32 = Color32::from_rgba_premultiplied(4, 8, 14, 190);
const HELD: Color32 = Color32::from_rgba_premultiplied(16, 48, 32, 210);

/// Paints them; the screen begins at the upper left corner.
pub fn paint(painter: &Painter, touch: &TouchControls, language: Language) {
    let palette = Palette::in_use(painter.ctx());
    let layout = &touch.layout;
    let radius = layout.radius;
    let ring = |at: Pos2, radius: f32, colour: Color32| {
        painter.circle_stroke(at, radius, Stroke::new(1.5 + palette.wider(), palette.shown(colour)));
    };
    for ((rest, stands), pushed) in layout.sticks.iter().zip(touch.stands).zip(touch.sticks) {
        let middle = point(stands.unwrap_or(*rest));
        painter.circle_filled(middle, 2.2 * radius, GROUND);
        ring(middle, 2.2 * radius, if stands.is_some() { OWN } else { FAINT });
        let knob = middle + size(pushed.x, -pushed.y) * (1.4 * radius);
        painter.circle_filled(knob, 0.8 * radius, if stands.is_some() { HELD } else { GROUND });
        ring(knob, 0.8 * radius, if stands.is_some() { OWN } else { FAINT });
    }
    for button in &layout.buttons {
        let (middle, held) = (point(button.middle), touch.holds(button.action));
        painter.circle_filled(middle, radius, if held { HELD } else { GROUND });
        ring(middle, radius, if held { OWN } else { FAINT });
        let font = FontId::proportional(LETTERS * radius);
        painter.text(middle, Align2::CENTER_CENTER, language.say(button.word), font, palette.shown(TEXT));
    }
}

/// What they cover.
pub fn covered(touch: &TouchControls) -> Vec<Rect> {
    let layout = &touch.layout;
    let square = |middle: Vec2, radius: f32| Rect::from_center_size(point(middle), size(2.0 * radius, 2.0 * radius));
    let sticks = layout.sticks.iter().map(|stick| square(*stick, 2.2 * layout.radius));
    sticks.chain(layout.buttons.iter().map(|button| square(button.middle, layout.radius))).collect()
}

fn point(at: Vec2) -> Pos2 {
    pos2(at.x, at.y)
}
