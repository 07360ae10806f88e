//! The HUD: dials and markers, painted with egui. The numbers come from [`super::instruments`].

use bevy::prelude::*;
use bevy_egui::EguiContexts;
use bevy_egui::egui::{self, Align2, Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};
use glam::DVec3;

use crate::render::frame::Camera;
use crate::scene::GameConfig;
use crate::sim::{Chase, ChaseRules};

use super::camera::View;
use super::game::Seat;
use super::instruments::{Countdown, Scale, hold_words};
use super::live::Notice;
use super::plate::{ALARM, FAINT, OWN, Plate, SEEN, TEXT, TRUE, bar, text};
use super::screens::Screen;
use super::session::Session;
use super::window::Panel;

/// Space between the screen's edge and the dials, in points.
const MARGIN: f32 = 18.0;
/// What comes down from the upper edge ends above this, in points.
const BELOW_DIALS: f32 = 122.0;

/// Draws the HUD.
#[allow(clippy::too_many_arguments)]
pub fn draw(
    mut contexts: EguiContexts,
    screen: Res<State<Screen>>,
    session: Res<Session>,
    player: Res<Seat>,
    panel: Res<Panel>,
    chase: Option<Res<Chase>>,
    rules: Res<ChaseRules>,
    notice: Res<Notice>,
    real: Res<Time<Real>>,
) -> Result {
    let context = contexts.ctx_mut()?;
    let painter = context.layer_painter(egui::LayerId::background());
    let rect = context.content_rect();
    lay_in(context, &painter);
    if let Some(words) = left_out(&session.config) {
        text(&painter, pos2(rect.center().x, rect.bottom() - 24.0), Align2::CENTER_BOTTOM, words, 12.0, TEXT);
    }
    if real.elapsed_secs_f64() < notice.until {
        // In front of menus and the overlay too.
        let front = context.layer_painter(egui::LayerId::new(egui::Order::Foreground, egui::Id::new("notice")));
        message(&front, rect, &notice.text).paint(&front);
    }
    if player.bare || matches!(screen.get(), Screen::Title | Screen::Result) {
        return Ok(());
    }
    markers(&painter, rect, &panel);
    let rules = rules.0;
    if let Some(chase) = chase.filter(|chase| chase.outcome.is_none()) {
        if chase.held > 0.0 {
            hold(&painter, rect.center(), chase.held, rules.hold_time);
        }
        if let Some(read) = panel.instruments {
            let scale = Scale::of(session.config.hole.mass_solar);
            countdown(&painter, pos2(rect.center().x, rect.top() + MARGIN), &scale, &Countdown::at(read.far_time, rules.time_limit));
        }
    }
    dials(&painter, rect, &session, &player, &panel);
    Ok(())
}

/// A line for the player, wrapped where it is wider than the screen.
fn message(painter: &Painter, rect: Rect, words: &str) -> Plate {
    let at = pos2(rect.center().x, rect.top() + BELOW_DIALS);
    Plate::lay(painter, at, Align2::CENTER_TOP, rect.width() - 2.0 * MARGIN, &[(words, 14.0, TRUE)])
}

/// Sizes of all text of the HUD, in points.
const SIZES: [f32; 8] = [11.0, 12.0, 13.0, 14.0, 15.0, 18.0, 19.0, 30.0];

/// Has every letter drawn to the fonts' texture before it is needed, one picture of each: the texture reaches the screen a frame after what is
/// written with it, and a digit that is seen for the first time would be missing meanwhile.
fn lay_in(context: &egui::Context, painter: &Painter) {
    if context.global_style().visuals.text_options.subpixel_binning {
        context.all_styles_mut(|style| style.visuals.text_options.subpixel_binning = false);
    }
    let letters: String = (' '..='~').chain("—–−·×°²⁰¹³⁴⁵⁶⁷⁸⁹γτ…".chars()).collect();
    for size in SIZES {
        // Kept by the fonts as long as it is asked for.
        let _ = painter.layout_no_wrap(letters.clone(), FontId::proportional(size), TEXT);
    }
}

/// What is left out of the picture's physics, for the player to know.
fn left_out(config: &GameConfig) -> Option<&'static str> {
    match (config.render.doppler, config.render.beaming) {
        (true, true) => None,
        (false, false) => Some("as in the film: without the Doppler shift of colour and brightness"),
        (false, true) => Some("without the Doppler shift of colour"),
        (true, false) => Some("without the Doppler shift of brightness"),
    }
}

fn plate(painter: &Painter, at: Pos2, anchor: Align2, lines: &[(&str, f32, Color32)]) {
    Plate::lay(painter, at, anchor, f32::INFINITY, lines).paint(painter);
}

/// How long one has been near enough, on a ring and in words.
fn hold(painter: &Painter, middle: Pos2, held: f64, needed: f64) {
    arc(painter, middle, 46.0, (held / needed.max(1e-9)).clamp(0.0, 1.0), Stroke::new(4.0, OWN));
    text(painter, middle + vec2(0.0, 58.0), Align2::CENTER_TOP, &hold_words(held, needed), 15.0, OWN);
}

/// What is left of the chase's time, on the far clock, over a bar that grows shorter.
fn countdown(painter: &Painter, top: Pos2, scale: &Scale, countdown: &Countdown) {
    let colour = if countdown.late() { ALARM } else { TEXT };
    let lines = [
        ("TIME LEFT", 11.0, FAINT),
        (&scale.clock(countdown.left), 19.0, colour),
        (&format!("T = {:.1} of {} r_s/c", countdown.limit - countdown.left, countdown.limit), 12.0, FAINT),
    ];
    let plate = Plate::lay(painter, top, Align2::CENTER_TOP, f32::INFINITY, &lines);
    let below = plate.frame.left_bottom() + vec2(2.0, 4.0);
    let length = plate.frame.width() - 4.0;
    plate.paint(painter);
    let colour = if countdown.late() { ALARM } else { OWN };
    bar(painter, Rect::from_min_size(below, vec2(length, 4.0)), countdown.share() as f32, colour);
}

fn dials(painter: &Painter, rect: Rect, session: &Session, player: &Seat, panel: &Panel) {
    let Some(read) = panel.instruments else { return };
    let scale = Scale::of(session.config.hole.mass_solar);
    let [left, right] = [rect.left() + MARGIN, rect.right() - MARGIN];
    let [top, bottom] = [rect.top() + MARGIN, rect.bottom() - MARGIN];

    let rate = read.far_rate.map_or("inside: no far clock is seen".to_owned(), |rate| format!("far time runs {rate:.2} × own"));
    plate(
        painter,
        pos2(left, top),
        Align2::LEFT_TOP,
        &[
            ("OWN CLOCK", 11.0, FAINT),
            (&scale.clock(read.own_time), 19.0, TEXT),
            ("FAR CLOCK", 11.0, FAINT),
            (&scale.clock(read.far_time), 19.0, TEXT),
            (&rate, 12.0, FAINT),
        ],
    );

    let near = if read.radius < 1.0 {
        ALARM
    } else if read.radius < 3.0 {
        TRUE
    } else {
        TEXT
    };
    plate(
        painter,
        pos2(right, top),
        Align2::RIGHT_TOP,
        &[
            ("FROM THE HOLE  r", 11.0, FAINT),
            (&format!("{:.2} r_s", read.radius), 19.0, near),
            (&scale.kilometres(read.radius), 13.0, TEXT),
            (&format!("camera  {:.2} r_s · {}", read.camera_radius, scale.kilometres(read.camera_radius)), 12.0, FAINT),
        ],
    );

    let speed = read.speed.map_or("—".to_owned(), |speed| format!("{speed:.3} c"));
    let gees = scale.gees(read.acceleration);
    let load = format!("{gees:.1} g");
    plate(
        painter,
        pos2(left, bottom),
        Align2::LEFT_BOTTOM,
        &[
            ("SPEED against what hovers here", 11.0, FAINT),
            (&speed, 30.0, TEXT),
            ("LOAD", 11.0, FAINT),
            (&load, 19.0, if gees > 15.0 { TRUE } else { TEXT }),
        ],
    );

    if let Some(target) = read.target {
        let closing = format!("{:+.3} c", target.closing);
        plate(
            painter,
            pos2(right, bottom),
            Align2::RIGHT_BOTTOM,
            &[
                ("RANGE", 11.0, FAINT),
                (&format!("{:.2} r_s", target.range), 30.0, TEXT),
                (&scale.kilometres(target.range), 12.0, FAINT),
                ("CLOSING", 11.0, FAINT),
                (&closing, 19.0, if target.closing > 0.0 { OWN } else { TRUE }),
            ],
        );
    }

    fuel(painter, pos2(rect.center().x, bottom), read.fuel);
    let assist = if session.config.assist.enabled { "ASSIST" } else { "FREE FLIGHT" };
    let pilot = if player.autopilot { "AUTOPILOT" } else { assist };
    let view = if player.view == View::Cockpit { "cockpit" } else { "third person" };
    let state = format!("{pilot}  ·  {view}  ·  pace {:.2} r_s/c a second", session.config.clock.pace);
    plate(painter, pos2(rect.center().x, bottom - 26.0), Align2::CENTER_BOTTOM, &[(&state, 12.0, TEXT)]);
    if player.avoiding {
        text(painter, pos2(rect.center().x, rect.bottom() - 110.0), Align2::CENTER_BOTTOM, "PULLING AWAY FROM THE HOLE", 18.0, ALARM);
    } else if read.radius < 1.0 {
        text(painter, pos2(rect.center().x, rect.bottom() - 110.0), Align2::CENTER_BOTTOM, "BELOW THE HORIZON", 18.0, ALARM);
    }
}

fn fuel(painter: &Painter, bottom: Pos2, share: Option<f64>) {
    let place = Rect::from_center_size(bottom - vec2(0.0, 12.0), vec2(300.0, 12.0));
    let share = share.map(|share| share as f32);
    let colour = if share.is_some_and(|share| share < 0.15) { ALARM } else { OWN };
    bar(painter, place, share.unwrap_or(1.0), colour);
    let words = share.map_or("FUEL".to_owned(), |share| format!("FUEL  {:.0} %", 100.0 * share));
    // Dark on the bar, light on the shade beside it.
    let ink = if share.unwrap_or(1.0) > 0.5 { Color32::BLACK } else { TEXT };
    text(painter, place.center(), Align2::CENTER_CENTER, &words, 10.5, ink);
}

/// Where a direction in camera axes is on the screen; or, if it is not on it, where at the edge an arrow points to it, and how it points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// On the screen, in points from the upper left corner.
    On([f64; 2]),
    /// At the edge, with the unit vector towards it (x right, y down).
    Edge([f64; 2], [f64; 2]),
}

/// See [`Place`]; `size` in points, `inset` the distance of arrows from the edge.
pub fn place(direction: DVec3, field_of_view: f64, size: [f64; 2], inset: f64) -> Place {
    let camera = Camera { position: DVec3::X, momentum: DVec3::ZERO, attitude: glam::DQuat::IDENTITY, field_of_view };
    // On a square of 1,000 pixels; its middle is the screen's.
    if let Some([x, y]) = camera.pixel(direction, [1000, 1000]) {
        let at = [0.5 * size[0] + (x - 500.0) * size[0] / 1000.0, 0.5 * size[1] + (y - 500.0) * size[0] / 1000.0];
        if (0.0..=size[0]).contains(&at[0]) && (0.0..=size[1]).contains(&at[1]) {
            return Place::On(at);
        }
    }
    // The shortest turn that brings it into view goes along its projection across the line of sight.
    let length = direction.x.hypot(direction.y);
    let towards = if length > 1e-9 { [direction.x / length, -direction.y / length] } else { [0.0, 1.0] };
    let room = [0.5 * size[0] - inset, 0.5 * size[1] - inset];
    let reach = (room[0] / towards[0].abs().max(1e-9)).min(room[1] / towards[1].abs().max(1e-9));
    Place::Edge([0.5 * size[0] + reach * towards[0], 0.5 * size[1] + reach * towards[1]], towards)
}

fn markers(painter: &Painter, rect: Rect, panel: &Panel) {
    let size = [f64::from(rect.width()), f64::from(rect.height())];
    let find = |direction: DVec3| place(direction, panel.field_of_view, size, 60.0);
    let point = |at: [f64; 2]| rect.min + vec2(at[0] as f32, at[1] as f32);

    // The ship's nose.
    let c = rect.center();
    for (from, to) in [(vec2(-16.0, 0.0), vec2(-6.0, 0.0)), (vec2(6.0, 0.0), vec2(16.0, 0.0)), (vec2(0.0, 6.0), vec2(0.0, 16.0))] {
        painter.line_segment([c + from, c + to], Stroke::new(1.5, TEXT.gamma_multiply(0.7)));
    }
    // Where the hole is: its shadow shows it where it is on the screen.
    if let Some(Place::Edge(at, towards)) = panel.hole.map(find) {
        arrow(painter, rect, at, towards, "hole", ALARM);
    }
    if let Some(Place::On(at)) = panel.heading.map(find) {
        let at = point(at);
        text(painter, at + vec2(14.0, 12.0), Align2::LEFT_TOP, "course", 11.5, OWN.gamma_multiply(0.85));
        painter.circle_stroke(at, 6.0, Stroke::new(1.5, OWN));
        for (from, to) in [(vec2(-12.0, 0.0), vec2(-6.0, 0.0)), (vec2(6.0, 0.0), vec2(12.0, 0.0)), (vec2(0.0, -12.0), vec2(0.0, -6.0))] {
            painter.line_segment([at + from, at + to], Stroke::new(1.5, OWN));
        }
    }
    if let Some(Place::On(at)) = panel.truth.map(find) {
        let at = point(at);
        for quarter in 0..8 {
            let begin = f64::from(quarter) / 8.0;
            dash(painter, at, 13.0, begin, begin + 0.07, Stroke::new(1.8, TRUE));
        }
        text(painter, at + vec2(18.0, 10.0), Align2::LEFT_TOP, "now", 13.0, TRUE);
    }
    for (order, image) in panel.images.iter().enumerate() {
        let Some(image) = image else { continue };
        match (find(image.direction), order) {
            (Place::On(at), 0) => {
                diamond(painter, point(at), 13.0, Stroke::new(2.0, SEEN));
                let label = format!("seen, {:.1} r_s/c ago", image.age);
                text(painter, point(at) + vec2(18.0, -10.0), Align2::LEFT_BOTTOM, &label, 13.0, SEEN);
            }
            (Place::On(at), _) => {
                diamond(painter, point(at), 7.0, Stroke::new(1.2, SEEN.gamma_multiply(0.7)));
                text(painter, point(at) + vec2(11.0, 0.0), Align2::LEFT_CENTER, "2nd image", 11.5, SEEN.gamma_multiply(0.85));
            }
            (Place::Edge(at, towards), 0) => arrow(painter, rect, at, towards, "target", SEEN),
            _ => (),
        }
    }
}

fn diamond(painter: &Painter, at: Pos2, radius: f32, stroke: Stroke) {
    let corners = [vec2(0.0, -radius), vec2(radius, 0.0), vec2(0.0, radius), vec2(-radius, 0.0)].map(|corner| at + corner);
    painter.add(Shape::closed_line(corners.to_vec(), stroke));
}

/// An arrow at the edge of the screen, named. It keeps to an ellipse, so that it never lies on the dials in the corners.
fn arrow(painter: &Painter, rect: Rect, at: [f64; 2], towards: [f64; 2], name: &str, colour: Color32) {
    let towards = vec2(towards[0] as f32, towards[1] as f32);
    let out = rect.min + vec2(at[0] as f32, at[1] as f32) - rect.center();
    let half = vec2(0.44 * rect.width(), 0.33 * rect.height());
    let at = rect.center() + out / vec2(out.x / half.x, out.y / half.y).length().max(1.0);
    let side = vec2(-towards.y, towards.x);
    let corners = vec![at + towards * 16.0, at - towards * 8.0 + side * 11.0, at - towards * 2.0, at - towards * 8.0 - side * 11.0];
    painter.add(Shape::closed_line(corners, Stroke::new(2.0, colour)));
    text(painter, at - towards * 26.0, Align2::CENTER_CENTER, name, 11.5, colour);
}

fn dash(painter: &Painter, at: Pos2, radius: f32, from: f64, to: f64, stroke: Stroke) {
    let on = |turn: f64| {
        let angle = (turn - 0.25) * std::f64::consts::TAU;
        at + vec2(angle.cos() as f32, angle.sin() as f32) * radius
    };
    let points = (0..=12).map(|k| on(from + (to - from) * f64::from(k) / 12.0)).collect();
    painter.add(Shape::line(points, stroke));
}

fn arc(painter: &Painter, at: Pos2, radius: f32, share: f64, stroke: Stroke) {
    painter.circle_stroke(at, radius, Stroke::new(1.0, FAINT));
    dash(painter, at, radius, 0.0, share, stroke);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::play::plate::tests::on_canvas;
    use crate::scene::config::parse;

    /// The longest complaint about game.toml names every key of [controls].
    #[test]
    fn a_long_message_stays_on_the_screen() {
        let file = std::path::Path::new("a/folder/of/somebody/game.toml");
        let complaint = parse(file, "[controls]\nnone = 1\n").expect_err("no such key").to_string();
        assert!(complaint.len() > 300, "{complaint}");
        for size in [[900.0, 620.0], [1280.0, 720.0]] {
            on_canvas(size, |painter, rect| {
                let frame = message(painter, rect, &complaint).frame;
                assert!(rect.contains_rect(frame) && frame.height() > 40.0, "{frame}");
            });
        }
    }

    #[test]
    fn ahead_is_the_middle() {
        assert_eq!(place(DVec3::NEG_Z, 1.0, [1280.0, 720.0], 50.0), Place::On([640.0, 360.0]));
    }

    #[test]
    fn right_and_up_are_right_and_up() {
        let Place::On([x, y]) = place(DVec3::new(0.1, 0.1, -1.0), 1.0, [1280.0, 720.0], 50.0) else { panic!("off the screen") };
        assert!(x > 640.0 && y < 360.0, "{x} {y}");
    }

    #[test]
    fn what_is_behind_has_an_arrow_at_the_edge() {
        for direction in [DVec3::new(0.2, 0.1, 1.0), DVec3::new(3.0, -1.0, -0.1), DVec3::Z] {
            let Place::Edge([x, y], towards) = place(direction, 1.0, [1280.0, 720.0], 50.0) else { panic!("on the screen") };
            let at_edge = (x - 50.0).abs() < 1.0 || (x - 1230.0).abs() < 1.0 || (y - 50.0).abs() < 1.0 || (y - 670.0).abs() < 1.0;
            assert!(at_edge && (49.0..1231.0).contains(&x) && (49.0..671.0).contains(&y), "{direction}: {x} {y}");
            assert!(direction.x * towards[0] >= 0.0 && direction.y * towards[1] <= 0.0);
        }
    }
}
