//! Where the windows of the overlay lie: at both sides, between the HUD's dials.

use bevy_egui::egui::{Rect, pos2};

/// Width of a window, in points, where there is room.
const WIDTH: f32 = 400.0;
/// The share of the screen's width that a window takes at most.
const SHARE: f32 = 0.36;
/// Space to the edge of the screen and to the dials, in points.
const SPACE: f32 = 8.0;
/// Lower than this, in points, a window is of no use: then it lies on the dials.
const LEAST: f32 = 180.0;

/// The places of the left and the right window on a screen with these dials.
pub fn places(screen: Rect, dials: &[Rect]) -> [Rect; 2] {
    let width = WIDTH.min(SHARE * screen.width());
    let column = |left: f32| {
        let whole = Rect::from_min_max(pos2(left, screen.top() + SPACE), pos2(left + width, screen.bottom() - SPACE));
        let beside = dials.iter().filter(|dial| dial.left() < whole.right() && whole.left() < dial.right());
        let (mut top, mut bottom) = (whole.top(), whole.bottom());
        for dial in beside {
            if dial.center().y < screen.center().y {
                top = top.max(dial.bottom() + SPACE);
            } else {
                bottom = bottom.min(dial.top() - SPACE);
            }
        }
        if bottom - top < LEAST { whole } else { Rect::from_min_max(pos2(left, top), pos2(left + width, bottom)) }
    };
    [column(screen.left() + SPACE), column(screen.right() - SPACE - width)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_lie_between_the_dials_of_a_small_screen() {
        let screen = Rect::from_min_max(pos2(0.0, 0.0), pos2(1280.0, 720.0));
        let dial = |x: f32, y: f32, w: f32, h: f32| Rect::from_min_max(pos2(x, y), pos2(x + w, y + h));
        let dials = [
            dial(18.0, 18.0, 150.0, 96.0),
            dial(1078.0, 18.0, 184.0, 74.0),
            dial(18.0, 598.0, 170.0, 104.0),
            dial(18.0, 528.0, 148.0, 64.0),
            dial(1032.0, 538.0, 230.0, 164.0),
            dial(560.0, 18.0, 150.0, 70.0),
        ];
        let places = places(screen, &dials);
        for place in places {
            assert!(screen.contains_rect(place) && place.height() > 380.0 && place.width() == 400.0, "{place}");
            assert!(dials.iter().all(|dial| !dial.intersects(place)), "{place}");
        }
        assert!(!places[0].intersects(places[1]));
        let small = super::places(Rect::from_min_max(pos2(0.0, 0.0), pos2(640.0, 360.0)), &dials);
        assert!(small.iter().all(|place| place.height() > LEAST && place.width() > 200.0));
    }
}
