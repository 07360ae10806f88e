//! The dials in the corners of the screen: clocks, distance from the hole, speed, target, and who flies with how much fuel.

use bevy_egui::egui::{Align2, Color32, Painter, Pos2, Rect, vec2};

use crate::play::camera::CameraView;
use crate::play::hud::instruments::{Bearing, Instruments, Scale};
use crate::play::hud::paint::{ALARM, BAR_ROOM, FAINT, OWN, TEXT, TRUE, TextBox};
use crate::play::hud::{BETWEEN, MARGIN};
use crate::play::player_state::PlayerState;
use crate::play::session::Session;

/// Fuel is low below this share of a full tank.
const LOW_FUEL: f64 = 0.15;
/// A load above this is drawn in another colour, in g.
const HEAVY: f64 = 15.0;
/// Nearer to the hole than this, in r_s, the distance is drawn in another colour: the innermost stable orbit.
const NEAR: f64 = 3.0;

/// How the flight goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Going {
    /// Nobody flies, a replay is shown.
    pub replayed: bool,
    /// The share of the chosen pace.
    pub slowing: f64,
    /// The target is shown as it was when its light left it.
    pub by_light: bool,
}

/// Lays out all dials in `rect`.
pub fn lay(painter: &Painter, rect: Rect, session: &Session, player: &PlayerState, read: &Instruments, going: Going) -> Vec<TextBox> {
    let scale = Scale::of(session.config.hole.mass_solar);
    let rect = rect.shrink(MARGIN);
    let speed = speed(painter, rect.left_bottom(), &scale, read);
    // Above the speed: below the middle it would lie on one's own ship.
    let state = state(painter, speed.frame.left_top() - vec2(0.0, BETWEEN + BAR_ROOM), session, player, read, going);
    let mut dials = vec![clocks(painter, rect.left_top(), &scale, read), distance(painter, rect.right_top(), &scale, read), speed, state];
    dials.extend(read.target.map(|read| target(painter, rect.right_bottom(), &scale, &read, going.by_light)));
    dials
}

/// Lines of text as long as they are.
fn text_box(painter: &Painter, at: Pos2, anchor: Align2, lines: &[(&str, f32, Color32)]) -> TextBox {
    TextBox::lay(painter, at, anchor, f32::INFINITY, lines)
}

fn clocks(painter: &Painter, at: Pos2, scale: &Scale, read: &Instruments) -> TextBox {
    let rate = read.far_rate.map_or("inside: no far clock is seen".to_owned(), |rate| format!("far time runs {rate:.2} × own"));
    let lines = [
        ("OWN CLOCK", 11.0, FAINT),
        (&*scale.clock(read.own_time), 19.0, TEXT),
        ("FAR CLOCK", 11.0, FAINT),
        (&*scale.clock(read.far_time), 19.0, TEXT),
        (&*rate, 12.0, FAINT),
    ];
    text_box(painter, at, Align2::LEFT_TOP, &lines)
}

fn distance(painter: &Painter, at: Pos2, scale: &Scale, read: &Instruments) -> TextBox {
    let colour = match read.radius {
        r if r < 1.0 => ALARM,
        r if r < NEAR => TRUE,
        _ => TEXT,
    };
    let lines = [
        ("FROM THE HOLE  r", 11.0, FAINT),
        (&*format!("{:.2} r_s", read.radius), 19.0, colour),
        (&*scale.kilometres(read.radius), 13.0, TEXT),
        (&*format!("camera  {:.2} r_s · {}", read.camera_radius, scale.kilometres(read.camera_radius)), 12.0, FAINT),
    ];
    text_box(painter, at, Align2::RIGHT_TOP, &lines)
}

fn speed(painter: &Painter, at: Pos2, scale: &Scale, read: &Instruments) -> TextBox {
    let speed = read.speed.map_or("—".to_owned(), |speed| format!("{speed:.3} c"));
    let gees = scale.gees(read.acceleration);
    let lines = [
        ("SPEED  (0: hovering)", 11.0, FAINT),
        (&*speed, 30.0, TEXT),
        ("LOAD", 11.0, FAINT),
        (&*format!("{gees:.1} g"), 19.0, if gees > HEAVY { TRUE } else { TEXT }),
    ];
    text_box(painter, at, Align2::LEFT_BOTTOM, &lines)
}

fn target(painter: &Painter, at: Pos2, scale: &Scale, read: &Bearing, by_light: bool) -> TextBox {
    let lines = [
        (if by_light { "RANGE, as seen" } else { "RANGE" }, 11.0, FAINT),
        (&*format!("{:.2} r_s", read.range), 30.0, TEXT),
        (&*scale.kilometres(read.range), 12.0, FAINT),
        ("CLOSING", 11.0, FAINT),
        (&*format!("{:+.3} c", read.closing), 19.0, if read.closing > 0.0 { OWN } else { TRUE }),
    ];
    text_box(painter, at, Align2::RIGHT_BOTTOM, &lines)
}

/// Who flies, where one looks from, the pace, and what is in the tanks, over a bar of it.
fn state(painter: &Painter, at: Pos2, session: &Session, player: &PlayerState, read: &Instruments, going: Going) -> TextBox {
    let assist = if player.assisted(&session.config) { "ASSIST" } else { "FREE FLIGHT" };
    let pilot = match (going.replayed, player.autopilot) {
        (true, _) => "REPLAY",
        (false, true) => "AUTOPILOT",
        (false, false) => assist,
    };
    let view = match player.view {
        _ if going.replayed => "the mouse leads the camera",
        _ if player.gaze.aside() => "at the target",
        CameraView::Cockpit => "cockpit",
        CameraView::ThirdPerson => "third person",
    };
    let tanks = read.fuel.map_or("FUEL without limit".to_owned(), |share| format!("FUEL  {:.0} %", 100.0 * share));
    let [colour, filled] = if read.fuel.is_some_and(|share| share < LOW_FUEL) { [ALARM; 2] } else { [TEXT, OWN] };
    let slowed = if going.slowing < 0.98 { ", slowed" } else { "" };
    let lines = [
        (&*format!("{pilot}  ·  {view}"), 12.0, TEXT),
        (&*format!("pace {:.2} r_s/c a second{slowed}", session.config.clock.pace * going.slowing), 12.0, TEXT),
        (&*tanks, 12.0, colour),
    ];
    text_box(painter, at, Align2::LEFT_BOTTOM, &lines).over_bar(read.fuel.unwrap_or(1.0) as f32, filled)
}
