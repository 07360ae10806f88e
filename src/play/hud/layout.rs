//! Where names and arrows go so that they can be read: inside the screen, off the dials and off one another.

use bevy_egui::egui::{Rect, pos2};

/// Space left beside what a box was pushed off, in points.
const GAP: f32 = 2.0;

/// The place nearest to `wanted` where a box of its size lies inside `free` and on none of `taken`; `wanted`, moved inside `free`, where
/// there is none. All in points.
pub fn settle(wanted: Rect, free: Rect, taken: &[Rect]) -> Rect {
    let size = wanted.size();
    // Too large a box begins at the upper left.
    let inside = |x: f32, y: f32| {
        Rect::from_min_size(pos2(x.min(free.right() - size.x).max(free.left()), y.min(free.bottom() - size.y).max(free.top())), size)
    };
    let clear = |place: &Rect| !taken.iter().any(|other| overlap(place, other));
    let at_once = inside(wanted.left(), wanted.top());
    if clear(&at_once) {
        return at_once;
    }
    // The nearest free place touches what is in the way, or the edge of the screen, along each axis in which it moved.
    let near = taken.iter().filter(|other| overlap(&free, other));
    let (mut xs, mut ys) = (vec![wanted.left()], vec![wanted.top()]);
    for other in near {
        xs.extend([other.left() - size.x - GAP, other.right() + GAP]);
        ys.extend([other.top() - size.y - GAP, other.bottom() + GAP]);
    }
    let places = xs.iter().flat_map(|&x| ys.iter().map(move |&y| inside(x, y)));
    let distance = |place: &Rect| (place.min - wanted.min).length_sq();
    places.filter(clear).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(at_once)
}

/// Whether two boxes share more than an edge.
pub fn overlap(a: &Rect, b: &Rect) -> bool {
    a.left() < b.right() && b.left() < a.right() && a.top() < b.bottom() && b.top() < a.bottom()
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_egui::egui::vec2;

    const FREE: Rect = Rect { min: pos2(0.0, 0.0), max: pos2(900.0, 620.0) };

    fn label(x: f32, y: f32) -> Rect {
        Rect::from_min_size(pos2(x, y), vec2(100.0, 14.0))
    }

    #[test]
    fn what_has_room_stays() {
        assert_eq!(settle(label(40.0, 50.0), FREE, &[label(40.0, 70.0)]), label(40.0, 50.0));
    }

    #[test]
    fn what_crosses_the_edge_is_moved_inside() {
        assert_eq!(settle(label(880.0, -5.0), FREE, &[]), label(800.0, 0.0));
    }

    #[test]
    fn the_shortest_way_off_is_taken() {
        let panel = Rect::from_min_max(pos2(700.0, 500.0), pos2(880.0, 600.0));
        // Six points above its upper edge are 20 to go up, and any other way is longer.
        assert_eq!(settle(label(720.0, 494.0), FREE, &[panel]), label(720.0, 500.0 - 14.0 - GAP));
        // At the screen's lower right there is no way down or to the right.
        assert!(!overlap(&settle(label(850.0, 590.0), FREE, &[panel]), &panel));
    }

    #[test]
    fn many_at_one_place_are_apart() {
        let mut taken = Vec::new();
        for _ in 0..12 {
            let place = settle(label(850.0, 300.0), FREE, &taken);
            assert!(FREE.contains_rect(place) && !taken.iter().any(|other| overlap(&place, other)), "{place}");
            taken.push(place);
        }
    }

    #[test]
    fn without_room_it_is_inside_all_the_same() {
        assert_eq!(settle(label(850.0, 300.0), FREE, &[FREE]), label(800.0, 300.0));
        assert_eq!(settle(Rect::from_min_size(pos2(5.0, 5.0), vec2(2000.0, 9.0)), FREE, &[]).min, pos2(0.0, 5.0));
    }
}
