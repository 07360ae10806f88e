//! The HUD's markers: where hole, target and course are on the screen, or arrows at its edge that point to them, each with its name.

use crate::spacetime::Observer;
use bevy_egui::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, Vec2 as Size, vec2};
use glam::DVec3;

use crate::play::camera::BEHIND;
use crate::play::hud::layout::settle;
use crate::play::hud::paint::{ALARM, FAINT, NAME_PAD, OWN, SEEN, TEXT, TRUE, rimmed, text};
use crate::play::hud::panel::{GateAhead, Panel};
use crate::play::words::Language;
use crate::sim::guidance::Brake;

/// Where a direction in camera axes is on the screen; or, if it is not on it, where at the edge an arrow points to it, and how it points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MarkerPosition {
    /// On the screen, in points from the upper left corner.
    On([f64; 2]),
    /// At the edge, with the unit vector towards it (x right, y down).
    Edge([f64; 2], [f64; 2]),
}

/// See [`MarkerPosition`]; `size` in points, `inset` the distance of arrows from the edge.
pub fn marker_position(direction: DVec3, field_of_view: f64, size: [f64; 2], inset: f64) -> MarkerPosition {
    let camera = Observer { position: DVec3::X, momentum: DVec3::ZERO, attitude: glam::DQuat::IDENTITY, field_of_view };
    // On a square of 1,000 pixels; its middle is the screen's.
    if let Some([x, y]) = camera.pixel(direction, [1000, 1000]) {
        let at = [0.5 * size[0] + (x - 500.0) * size[0] / 1000.0, 0.5 * size[1] + (y - 500.0) * size[0] / 1000.0];
        if (0.0..=size[0]).contains(&at[0]) && (0.0..=size[1]).contains(&at[1]) {
            return MarkerPosition::On(at);
        }
    }
    // The shortest turn that brings it into view goes along its projection across the line of sight.
    let length = direction.x.hypot(direction.y);
    let towards = if length > 1e-9 { [direction.x / length, -direction.y / length] } else { [0.0, 1.0] };
    let room = [0.5 * size[0] - inset, 0.5 * size[1] - inset];
    let reach = (room[0] / towards[0].abs().max(1e-9)).min(room[1] / towards[1].abs().max(1e-9));
    MarkerPosition::Edge([0.5 * size[0] + reach * towards[0], 0.5 * size[1] + reach * towards[1]], towards)
}

/// Where one's own ship is on the screen `rect` in third person, wings and all, in points: names and arrows keep off it.
pub fn own_ship(rect: Rect, field_of_view: f64) -> Rect {
    /// Half its width and height as seen from behind, in lengths of the ship, with room for its leaning as it turns.
    const HALF: Size = vec2(0.5, 0.3);
    // Pixels for a length of the ship: the screen's half width is tan(field_of_view / 2) at distance 1.
    let scale = (0.5 * f64::from(rect.width()) / ((0.5 * field_of_view).tan() * BEHIND.z)) as f32;
    Rect::from_center_size(rect.center() + vec2(0.0, scale * BEHIND.y as f32), 2.0 * scale * HALF)
}

/// Nothing but markers lies nearer to the screen's edge than this, in points.
const FREE: f32 = 6.0;
/// Side of the box of an arrow, in points.
const ARROW: f32 = 34.0;

/// What a marker is called; where its name would best be, which may be taken.
struct Name {
    words: String,
    size: f32,
    colour: Color32,
    at: Pos2,
    anchor: Align2,
}

/// What is painted on the screen so far, and the names to come.
struct Board<'a> {
    painter: &'a Painter,
    rect: Rect,
    /// Panels, and the markers so far.
    marked: Vec<Rect>,
    taken: Vec<Rect>,
    names: Vec<Name>,
}

/// Where nothing of the markers may lie, in points.
#[derive(Clone, Debug, Default)]
pub struct Taken {
    /// Panels: what is marked under one of them has its marker beside it.
    pub panels: Vec<Rect>,
    /// What only names and arrows keep off.
    pub other: Vec<Rect>,
}

/// Paints the markers of `panel` on the screen `rect`, with their names in this language and the numbers of `said`. Returns what they take up themselves, in points: markers
/// first, then arrows, then names.
pub fn paint(painter: &Painter, rect: Rect, (panel, said): (&Panel, &Panel), taken: Taken, language: Language) -> Vec<Rect> {
    let size = [f64::from(rect.width()), f64::from(rect.height())];
    let find = |direction: DVec3| marker_position(direction, panel.field_of_view, size, f64::from(FREE + 0.5 * ARROW));
    let point = |at: [f64; 2]| rect.min + vec2(at[0] as f32, at[1] as f32);
    let Taken { panels, other } = taken;
    let (panel_count, before) = (panels.len(), panels.len() + other.len());
    let mut board = Board { painter, rect, marked: panels.clone(), taken: [panels, other].concat(), names: Vec::new() };
    // Where the ship points: not ahead while one looks aside, or the mouse leads the camera.
    let nose = panel.nose.map(find);
    if let Some(MarkerPosition::On(at)) = nose {
        reticle(painter, point(at));
        board.takes(point(at), 18.0);
    }

    let colours = [OWN, SEEN, ALARM];
    for (line, colour) in panel.lines.iter().zip(colours) {
        let points: Vec<Option<Pos2>> = line
            .iter()
            .map(|direction| match direction.map(find) {
                Some(MarkerPosition::On(at)) => Some(point(at)),
                _ => None,
            })
            .collect();
        dotted(painter, &points, &board.marked[..panel_count], colour);
    }
    for &(direction, time) in &panel.aims {
        if let MarkerPosition::On(at) = find(direction) {
            let at = board.marks(point(at), 9.0, ALARM);
            cross(painter, at, 9.0, Stroke::new(2.0, ALARM));
            let words = language.fill("hud-aim", &[("time", format!("{time:.0}").as_str())]);
            board.name(words, 11.5, ALARM, at + vec2(13.0, 0.0), Align2::LEFT_CENTER);
        }
    }
    if let Some(near) = panel.pass {
        for (direction, colour) in near.directions.into_iter().zip(colours) {
            if let Some(MarkerPosition::On(at)) = direction.map(find) {
                let at = point(at);
                rimmed(painter, Stroke::new(1.6, colour), |stroke| Shape::circle_stroke(at, 4.0, stroke));
                board.takes(at, 4.0);
            }
        }
    }
    let [first, second] = panel.images.map(|image| image.map(|image| (find(image.direction), image.age)));
    let truth = panel.truth.map(find);
    let heading = panel.heading.map(find);
    let fallen = panel.fallen.map(find);
    let moving = panel.moving.map(|moving| [moving, -moving].map(find));
    let brake = panel.guidance.map_or(Brake::Free, |guide| guide.brake);
    // The names most wanted come first; each keeps off those before it.
    if let Some((MarkerPosition::On(at), age)) = first {
        let at = board.marks(point(at), 13.0, SEEN);
        diamond(painter, at, 13.0, Stroke::new(2.0, SEEN));
        let age = said.images[0].map_or(age, |image| image.age);
        let words = language.fill("hud-seen", &[("age", format!("{age:.1}").as_str())]);
        board.name(words, 13.0, SEEN, at + vec2(18.0, -10.0), Align2::LEFT_BOTTOM);
    }
    if let Some(MarkerPosition::On(at)) = truth {
        let at = board.marks(point(at), 13.0, TRUE);
        for quarter in 0..8 {
            let begin = f64::from(quarter) / 8.0;
            dash(painter, at, 13.0, begin, begin + 0.07, Stroke::new(1.8, TRUE));
        }
        board.name(with_pass(language.say("hud-now"), said, language), 13.0, TRUE, at + vec2(18.0, 10.0), Align2::LEFT_TOP);
    }
    if let Some(MarkerPosition::On(at)) = fallen {
        let at = board.marks(point(at), 8.0, SEEN);
        for half in [vec2(8.0, 0.0), vec2(0.0, 8.0)] {
            rimmed(painter, Stroke::new(1.6, SEEN), |stroke| Shape::line_segment([at - half, at + half], stroke));
        }
        board.name(with_pass(language.say("hud-fallen"), said, language), 11.5, SEEN, at + vec2(13.0, 8.0), Align2::LEFT_TOP);
    }
    let thrust = panel.thrust.map(|(direction, _)| find(direction));
    if let Some(MarkerPosition::On(at)) = thrust {
        let at = board.marks(point(at), 11.0, OWN);
        corners(painter, at, 11.0, Stroke::new(2.0, OWN));
        let push = said.thrust.or(panel.thrust).map_or(0.0, |(_, push)| push);
        let words = language.fill("hud-thrust", &[("push", format!("{push:.2}").as_str())]);
        board.name(words, 13.0, OWN, at + vec2(-14.0, -10.0), Align2::RIGHT_BOTTOM);
    }
    if let Some([ahead, behind]) = moving {
        let colour = brake_colour(brake);
        if let MarkerPosition::On(at) = ahead {
            let at = board.marks(point(at), 10.0, colour);
            rimmed(painter, Stroke::new(2.0, colour), |stroke| Shape::circle_stroke(at, 3.0, stroke));
            for side in [vec2(-10.0, 8.0), vec2(10.0, 8.0), vec2(0.0, -12.0)] {
                rimmed(painter, Stroke::new(2.0, colour), |stroke| Shape::line_segment([at + side * 0.45, at + side], stroke));
            }
            board.name(language.say("hud-moving"), 11.5, colour, at + vec2(-14.0, 12.0), Align2::RIGHT_TOP);
        }
        if let MarkerPosition::On(at) = behind {
            let at = board.marks(point(at), 8.0, colour);
            cross(painter, at, 7.0, Stroke::new(2.0, colour));
            board.name(language.say("hud-against"), 11.5, colour, at + vec2(-12.0, 8.0), Align2::RIGHT_TOP);
        }
    }
    if let Some(MarkerPosition::On(at)) = heading {
        let at = board.marks(point(at), 12.0, OWN);
        rimmed(painter, Stroke::new(1.5, OWN), |stroke| Shape::circle_stroke(at, 6.0, stroke));
        for (from, to) in [(vec2(-12.0, 0.0), vec2(-6.0, 0.0)), (vec2(6.0, 0.0), vec2(12.0, 0.0)), (vec2(0.0, -12.0), vec2(0.0, -6.0))] {
            rimmed(painter, Stroke::new(1.5, OWN), |stroke| Shape::line_segment([at + from, at + to], stroke));
        }
        board.name(language.say("hud-course"), 11.5, OWN, at + vec2(14.0, 12.0), Align2::LEFT_TOP);
    }
    if let Some((MarkerPosition::On(at), _)) = second {
        let at = board.marks(point(at), 7.0, SEEN);
        diamond(painter, at, 7.0, Stroke::new(1.2, SEEN));
        board.name(language.say("hud-second-image"), 11.5, SEEN, at + vec2(11.0, 0.0), Align2::LEFT_CENTER);
    }
    match panel.gate.and_then(|gate| Some((find(gate.direction?), gate))) {
        Some((MarkerPosition::On(at), gate)) => {
            let at = board.marks(point(at), 16.0, TRUE);
            rimmed(painter, Stroke::new(1.8, TRUE), |stroke| Shape::circle_stroke(at, 16.0, stroke));
            board.name(
                gate_name(said.gate.as_ref().unwrap_or(&gate), said, language),
                13.0,
                TRUE,
                at + vec2(20.0, 0.0),
                Align2::LEFT_CENTER,
            );
        }
        Some((MarkerPosition::Edge(at, towards), gate)) => {
            let number = gate.number.to_string();
            board.arrow(at, towards, &language.fill("hud-gate", &[("number", number.as_str())]), TRUE);
        }
        None => (),
    }
    if let Some((MarkerPosition::Edge(at, towards), _)) = first {
        board.arrow(at, towards, &language.say("hud-target"), SEEN);
    }
    if let Some(MarkerPosition::Edge(at, towards)) = truth {
        let name = [Some(language.say("hud-now")), passes(said, language)].into_iter().flatten().collect::<Vec<_>>().join(" · ");
        board.arrow(at, towards, &name, TRUE);
    }
    if let Some(MarkerPosition::Edge(at, towards)) = fallen {
        board.arrow(at, towards, &language.say("hud-fallen-short"), SEEN);
    }
    if let Some(MarkerPosition::Edge(at, towards)) = thrust {
        board.arrow(at, towards, &language.say("hud-thrust-short"), OWN);
    }
    if let Some([MarkerPosition::Edge(at, towards), _]) = moving {
        board.arrow(at, towards, &language.say("hud-moving"), brake_colour(brake));
    }
    // Where the motion against the target is shown, that against the hovering ones would be one arrow too many.
    if let (Some(MarkerPosition::Edge(at, towards)), None) = (heading, moving) {
        board.arrow(at, towards, &language.say("hud-course"), OWN);
    }
    for &(direction, _) in &panel.aims {
        if let MarkerPosition::Edge(at, towards) = find(direction) {
            board.arrow(at, towards, &language.say("hud-aim-short"), ALARM);
        }
    }
    if let (Some((MarkerPosition::Edge(at, towards), _)), true) = (second, panel.by_light) {
        board.arrow(at, towards, &language.say("hud-second-image"), SEEN);
    }
    if let Some(MarkerPosition::Edge(at, towards)) = nose {
        board.arrow(at, towards, &language.say("hud-nose"), TEXT);
    }
    // The hole's shadow shows it where it is on the screen.
    if let Some(MarkerPosition::Edge(at, towards)) = panel.hole.map(find) {
        board.arrow(at, towards, &language.say("hud-hole"), ALARM);
    }
    board.write();
    board.taken.split_off(before)
}

impl Board<'_> {
    /// A marker is painted round `at`.
    fn takes(&mut self, at: Pos2, half: f32) {
        self.taken.push(Rect::from_center_size(at, Size::splat(2.0 * half)));
    }

    /// Where the marker of what is at `at` is painted, with a line to it where that is elsewhere: under a panel or on another marker it
    /// would not be seen.
    fn marks(&mut self, at: Pos2, half: f32, colour: Color32) -> Pos2 {
        let wanted = Rect::from_center_size(at, Size::splat(2.0 * half));
        let place = settle(wanted, self.free(), &self.marked);
        self.marked.push(place);
        self.taken.push(place);
        let beside = place.center();
        if beside.distance(at) > half {
            let line = [beside + (at - beside).normalized() * half, at];
            rimmed(self.painter, Stroke::new(1.0, colour), |stroke| Shape::line_segment(line, stroke));
        }
        beside
    }

    fn name(&mut self, words: String, size: f32, colour: Color32, at: Pos2, anchor: Align2) {
        self.names.push(Name { words, size, colour, at, anchor });
    }

    /// What names and arrows may cover.
    fn free(&self) -> Rect {
        self.rect.shrink(FREE)
    }

    /// An arrow at the edge of the screen, named. Where the dials are it goes along the edge, to the nearest place beside them.
    fn arrow(&mut self, at: [f64; 2], towards: [f64; 2], name: &str, colour: Color32) {
        let towards = vec2(towards[0] as f32, towards[1] as f32);
        let at = self.rect.min + vec2(at[0] as f32, at[1] as f32);
        // What lies inside of the arrows' row is no place for them.
        let inside = self.free().shrink(ARROW + 1.0);
        self.taken.push(inside);
        let place = settle(Rect::from_center_size(at, Size::splat(ARROW)), self.free(), &self.taken);
        self.taken.pop();
        self.taken.push(place);
        let at = place.center();
        let side = vec2(-towards.y, towards.x);
        let corners = vec![at + towards * 16.0, at - towards * 8.0 + side * 11.0, at - towards * 2.0, at - towards * 8.0 - side * 11.0];
        rimmed(self.painter, Stroke::new(2.0, colour), |stroke| Shape::closed_line(corners.clone(), stroke));
        // The name is on the arrow's inner side.
        let beside = at - towards * (0.5 * ARROW + 14.0);
        self.name(name.into(), 11.5, colour, beside, Align2::CENTER_CENTER);
    }

    /// Writes the names, each as near to its marker as there is room.
    fn write(&mut self) {
        for name in std::mem::take(&mut self.names) {
            let galley = self.painter.layout_no_wrap(name.words.clone(), FontId::proportional(name.size), name.colour);
            let wanted = name.anchor.anchor_size(name.at, galley.size() + 2.0 * NAME_PAD);
            let place = settle(wanted, self.free(), &self.taken);
            self.taken.push(text(self.painter, place.min, Align2::LEFT_TOP, &name.words, name.size, name.colour));
        }
    }
}

/// The colour of what a brake sign says.
pub fn brake_colour(brake: Brake) -> Color32 {
    match brake {
        Brake::Free => OWN,
        Brake::Soon => TRUE,
        Brake::Now => ALARM,
    }
}

/// The name of a gate, with how far off it is, how near one passes its middle, and how wide it is.
fn gate_name(gate: &GateAhead, panel: &Panel, language: Language) -> String {
    let number = |value: f64| format!("{value:.1}");
    let [place, distance, radius] = [gate.number.to_string(), number(gate.distance), number(gate.radius)];
    let name = language.fill("hud-gate-off", &[("number", place.as_str()), ("distance", distance.as_str())]);
    let ring = language.fill("hud-gate-ring", &[("radius", radius.as_str())]);
    [Some(name), passes(panel, language), Some(ring)].into_iter().flatten().collect::<Vec<_>>().join(" · ")
}

/// How near one passes what one is after, and in which time, in words.
fn passes(panel: &Panel, language: Language) -> Option<String> {
    let near = panel.pass?;
    let [distance, ahead] = [format!("{:.1}", near.distance), format!("{:.0}", near.ahead)];
    Some(language.fill("hud-passes", &[("distance", distance.as_str()), ("ahead", ahead.as_str())]))
}

/// The name of the target's place, with how near one passes it, and how near it is caught.
fn with_pass(name: String, panel: &Panel, language: Language) -> String {
    let Some(reach) = panel.reach else { return name };
    let reach = language.fill("hud-reach", &[("reach", format!("{reach:.1}").as_str())]);
    [Some(name), passes(panel, language), Some(reach)].into_iter().flatten().collect::<Vec<_>>().join(" · ")
}

/// A line of dots with a dark edge, with gaps where a place is not on the screen; each piece ends in an arrow, so that its way is read.
/// Under `panels` there are none.
fn dotted(painter: &Painter, points: &[Option<Pos2>], panels: &[Rect], colour: Color32) {
    for piece in points.split(|point| point.is_none()) {
        let piece: Vec<Pos2> = piece.iter().flatten().copied().collect();
        for pair in piece.windows(2).filter(|pair| !panels.iter().any(|panel| panel.contains(pair[0]))) {
            rimmed(painter, Stroke::new(1.4, colour), |stroke| Shape::line_segment([pair[0], pair[0] + (pair[1] - pair[0]) * 0.5], stroke));
        }
        let Some(&tip) = piece.last() else { continue };
        // The last place far enough off to tell a direction.
        let Some(from) = piece.iter().rev().find(|from| from.distance(tip) > 4.0) else { continue };
        let along = (tip - *from).normalized();
        let side = vec2(-along.y, along.x);
        let corners = vec![tip - along * 8.0 + side * 4.5, tip, tip - along * 8.0 - side * 4.5];
        rimmed(painter, Stroke::new(1.4, colour), |stroke| Shape::line(corners.clone(), stroke));
    }
}

/// An oblique cross.
fn cross(painter: &Painter, at: Pos2, half: f32, stroke: Stroke) {
    for side in [vec2(half, half), vec2(half, -half)] {
        rimmed(painter, stroke, |stroke| Shape::line_segment([at - side, at + side], stroke));
    }
}

/// The corners of a square.
fn corners(painter: &Painter, at: Pos2, half: f32, stroke: Stroke) {
    for side in [vec2(-half, -half), vec2(half, -half), vec2(half, half), vec2(-half, half)] {
        let (corner, inward) = (at + side, side * -0.6);
        let bend = vec![corner + inward * vec2(1.0, 0.0), corner, corner + inward * vec2(0.0, 1.0)];
        rimmed(painter, stroke, |stroke| Shape::line(bend.clone(), stroke));
    }
}

/// The ship's nose.
fn reticle(painter: &Painter, c: Pos2) {
    for (from, to) in [(vec2(-16.0, 0.0), vec2(-6.0, 0.0)), (vec2(6.0, 0.0), vec2(16.0, 0.0)), (vec2(0.0, 6.0), vec2(0.0, 16.0))] {
        rimmed(painter, Stroke::new(1.5, TEXT), |stroke| Shape::line_segment([c + from, c + to], stroke));
    }
}

fn diamond(painter: &Painter, at: Pos2, radius: f32, stroke: Stroke) {
    let corners = [vec2(0.0, -radius), vec2(radius, 0.0), vec2(0.0, radius), vec2(-radius, 0.0)].map(|corner| at + corner);
    rimmed(painter, stroke, |stroke| Shape::closed_line(corners.to_vec(), stroke));
}

fn dash(painter: &Painter, at: Pos2, radius: f32, from: f64, to: f64, stroke: Stroke) {
    let on = |turn: f64| {
        let angle = (turn - 0.25) * std::f64::consts::TAU;
        at + vec2(angle.cos() as f32, angle.sin() as f32) * radius
    };
    let points: Vec<_> = (0..=12).map(|k| on(from + (to - from) * f64::from(k) / 12.0)).collect();
    rimmed(painter, stroke, |stroke| Shape::line(points.clone(), stroke));
}

/// A ring, `share` of which is thick.
pub fn arc(painter: &Painter, at: Pos2, radius: f32, share: f64, stroke: Stroke) {
    rimmed(painter, Stroke::new(1.0, FAINT), |stroke| Shape::circle_stroke(at, radius, stroke));
    dash(painter, at, radius, 0.0, share, stroke);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::play::hud::layout::overlap;
    use crate::play::hud::paint::tests::on_canvas;
    use crate::sim::sight::Apparition;
    use bevy_egui::egui::pos2;

    #[test]
    fn ahead_is_the_middle() {
        assert_eq!(marker_position(DVec3::NEG_Z, 1.0, [1280.0, 720.0], 50.0), MarkerPosition::On([640.0, 360.0]));
    }

    #[test]
    fn right_and_up_are_right_and_up() {
        let MarkerPosition::On([x, y]) = marker_position(DVec3::new(0.1, 0.1, -1.0), 1.0, [1280.0, 720.0], 50.0) else {
            panic!("off the screen")
        };
        assert!(x > 640.0 && y < 360.0, "{x} {y}");
    }

    #[test]
    fn what_is_behind_has_an_arrow_at_the_edge() {
        for direction in [DVec3::new(0.2, 0.1, 1.0), DVec3::new(3.0, -1.0, -0.1), DVec3::Z] {
            let MarkerPosition::Edge([x, y], towards) = marker_position(direction, 1.0, [1280.0, 720.0], 50.0) else {
                panic!("on the screen")
            };
            let at_edge = (x - 50.0).abs() < 1.0 || (x - 1230.0).abs() < 1.0 || (y - 50.0).abs() < 1.0 || (y - 670.0).abs() < 1.0;
            assert!(at_edge && (49.0..1231.0).contains(&x) && (49.0..671.0).contains(&y), "{direction}: {x} {y}");
            assert!(direction.x * towards[0] >= 0.0 && direction.y * towards[1] <= 0.0);
        }
    }

    /// What markers, arrows and names take up, on a screen with a panel in the lower right corner.
    fn painted(panel: &Panel) -> (Rect, Vec<Rect>) {
        let corner = Rect::from_min_max(pos2(760.0, 480.0), pos2(882.0, 602.0));
        let mut found = Vec::new();
        on_canvas([900.0, 620.0], |painter, rect| {
            found = paint(painter, rect, (panel, panel), Taken { panels: vec![corner], other: Vec::new() }, Language::English)
        });
        (corner, found)
    }

    fn apart(boxes: &[Rect]) {
        for (k, a) in boxes.iter().enumerate() {
            assert!(boxes[..k].iter().all(|b| !overlap(a, b)), "{boxes:?}");
        }
    }

    fn image(direction: DVec3) -> [Option<Apparition>; 2] {
        [Some(Apparition { direction: direction.normalize(), age: 3.0 }), None]
    }

    #[test]
    fn arrows_to_one_side_are_apart() {
        let behind = DVec3::new(1.0, 0.02, 0.3);
        let hole = Some(DVec3::new(1.0, 0.0, 0.3));
        let panel = Panel { nose: Some(DVec3::NEG_Z), hole, images: image(behind), field_of_view: 1.0, ..Panel::default() };
        let (corner, mut boxes) = painted(&panel);
        // The reticle, two arrows, two names.
        assert_eq!(boxes.len(), 5);
        boxes.push(corner);
        apart(&boxes);
    }

    /// All round: at the edge, whole, and on no dial, which lie at the edge themselves.
    #[test]
    fn arrows_are_at_the_edge_and_off_the_dials() {
        for size in [[900.0, 620.0], [1280.0, 720.0]] {
            for k in 0..64 {
                let (y, x) = (f64::from(k) * std::f64::consts::TAU / 64.0).sin_cos();
                let behind = DVec3::new(x, y, 0.4);
                let panel = Panel { hole: Some(behind.with_z(0.5)), images: image(behind), field_of_view: 1.05, ..Panel::default() };
                on_canvas(size, |painter, rect| {
                    let [wide, high] = size;
                    // Four corners, the countdown, one's own ship.
                    let corners =
                        [(18.0, 18.0), (wide - 198.0, 18.0), (18.0, high - 183.0), (wide - 158.0, high - 126.0), (0.5 * wide - 73.0, 18.0)];
                    let mut dials: Vec<_> = corners.map(|(x, y)| Rect::from_min_size(pos2(x, y), vec2(140.0, 96.0))).to_vec();
                    dials.push(own_ship(rect, panel.field_of_view));
                    let boxes =
                        paint(painter, rect, (&panel, &panel), Taken { panels: dials.clone(), other: Vec::new() }, Language::English);
                    assert_eq!(boxes.len(), 4, "two arrows, two names");
                    for arrow in &boxes[..2] {
                        let inner = rect.shrink(FREE + ARROW);
                        assert!(rect.contains_rect(*arrow) && !overlap(arrow, &inner), "{k}: {arrow}");
                    }
                    assert!(boxes[2..].iter().all(|name| rect.contains_rect(*name)), "{k}: {boxes:?}");
                    apart(&[boxes, dials].concat());
                });
            }
        }
    }

    #[test]
    fn names_are_off_other_markers_and_the_dials_and_whole() {
        // At 1 rad over 900 points a pixel is near 1/824 rad: one above the other, at the right edge, and in the corner.
        for (x, y) in [(0.1, 0.1), (0.52, 0.1), (0.42, -0.22), (0.35, -0.19)] {
            let (seen, now) = (DVec3::new(x, y, -1.0), DVec3::new(x, y + 0.035, -1.0));
            let panel = Panel { nose: Some(DVec3::NEG_Z), truth: Some(now), images: image(seen), field_of_view: 1.0, ..Panel::default() };
            let (corner, boxes) = painted(&panel);
            assert_eq!(boxes.len(), 5, "the reticle, two markers, two names");
            let names = &boxes[3..];
            for name in names {
                assert!(Rect::from_min_size(Pos2::ZERO, vec2(900.0, 620.0)).contains_rect(*name), "{name}");
                assert!(!overlap(name, &corner) && boxes[..3].iter().all(|marker| !overlap(name, marker)), "{boxes:?}");
            }
            apart(names);
        }
    }
}
