//! The dials in the corners of the screen: clocks, distance from the hole, speed, target, and who flies with how much fuel.

use bevy_egui::egui::{Align2, Color32, Painter, Pos2, Rect, vec2};

use crate::play::camera::CameraView;
use crate::play::hud::instruments::{Bearing, Instruments, Scale};
use crate::play::hud::markers::brake_colour;
use crate::play::hud::paint::{ALARM, BAR_ROOM, FAINT, OWN, TEXT, TRUE, TextBox};
use crate::play::hud::{BETWEEN, MARGIN};
use crate::play::player_state::{PlayerState, assist_words};
use crate::play::session::Session;
use crate::scene::pilot_kind::PilotKind;
use crate::sim::guidance::{Brake, Guidance};
use crate::sim::intercept::Advice;

/// Fuel is low below this share of a full tank.
pub const LOW_FUEL: f64 = 0.15;
/// A load above this is drawn in another colour, in g.
const HEAVY: f64 = 15.0;
/// Nearer to the hole than this, in r_s, the distance is drawn in another colour: the innermost stable orbit.
const NEAR: f64 = 3.0;
/// A screen lower or narrower than this, in points, has no room for all lines: small windows, large letters.
const ROOM: (f32, f32) = (880.0, 600.0);

/// How much the HUD shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Density {
    /// What a pilot must know.
    Least,
    /// One number for each thing.
    Reduced,
    /// All of it.
    #[default]
    Full,
}

impl Density {
    /// As `interface.hud` says, but no more than there is room for.
    pub fn of(choice: &str, rect: Rect) -> Density {
        let chosen = match choice {
            "least" => Density::Least,
            "reduced" => Density::Reduced,
            _ => Density::Full,
        };
        if rect.width() < ROOM.0 || rect.height() < ROOM.1 { chosen.min(Density::Reduced) } else { chosen }
    }
}

/// How the flight goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Going {
    /// Nobody flies, a replay is shown.
    pub replayed: bool,
    /// The share of the chosen pace.
    pub slowing: f64,
    /// The target is shown as it was when its light left it.
    pub by_light: bool,
    /// Motion against the target.
    pub guidance: Option<Guidance>,
    /// What leads to it.
    pub advice: Option<Advice>,
    /// No thrust is asked for: what there is, the assist's.
    pub helped: bool,
}

/// A line of a dial: the least density that has it, words, size, colour.
type Line = (Density, String, f32, Color32);

/// Lays out all dials in `rect`.
pub fn lay_out(painter: &Painter, rect: Rect, session: &Session, player: &PlayerState, read: &Instruments, going: Going) -> Vec<TextBox> {
    let scale = Scale::of(session);
    let density = Density::of(&session.config.interface.hud, rect);
    let inner = rect.shrink(MARGIN);
    let mut dials = Vec::new();
    let mut add = |at: Pos2, anchor: Align2, lines: Vec<Line>| {
        let lines: Vec<(&str, f32, Color32)> =
            lines.iter().filter(|line| line.0 <= density).map(|(_, words, size, colour)| (words.as_str(), *size, *colour)).collect();
        if !lines.is_empty() {
            dials.push(TextBox::lay_out(painter, at, anchor, f32::INFINITY, &lines));
        }
    };
    add(inner.left_top(), Align2::LEFT_TOP, clocks(&scale, read));
    add(inner.right_top(), Align2::RIGHT_TOP, distance(&scale, read));
    if let Some(bearing) = &read.target {
        add(inner.right_bottom(), Align2::RIGHT_BOTTOM, target(&scale, bearing, going));
    }
    add(inner.left_bottom(), Align2::LEFT_BOTTOM, speed(&scale, read, going.helped));
    // Above the speed: below the middle it would lie on one's own ship.
    let below = dials.last().map_or(inner.left_bottom(), |speed| speed.frame.left_top());
    dials.push(state(painter, below - vec2(0.0, BETWEEN + BAR_ROOM), session, player, read, going, density));
    dials
}

fn clocks(scale: &Scale, read: &Instruments) -> Vec<Line> {
    let language = scale.language;
    let rate = read
        .far_rate
        .map_or(language.say("hud-no-far-clock"), |rate| language.fill("hud-far-rate", &[("rate", format!("{rate:.2}").as_str())]));
    vec![
        (Density::Reduced, language.say("hud-own-clock"), 11.0, FAINT),
        (Density::Reduced, scale.clock(read.own_time), 19.0, TEXT),
        (Density::Full, language.say("hud-far-clock"), 11.0, FAINT),
        (Density::Full, scale.clock(read.far_time), 19.0, TEXT),
        (Density::Full, rate, 12.0, FAINT),
    ]
}

fn distance(scale: &Scale, read: &Instruments) -> Vec<Line> {
    let colour = match read.radius {
        r if r < 1.0 => ALARM,
        r if r < NEAR => TRUE,
        _ => TEXT,
    };
    let camera = format!("{:.2}", read.camera_radius);
    let falls = match read.lowest {
        Some(lowest) => scale.language.fill("hud-falls-to", &[("radius", format!("{lowest:.2}").as_str())]),
        None => scale.language.say("hud-falls-in"),
    };
    let camera = scale.language.fill("hud-camera", &[("radius", camera.as_str()), ("falls", falls.as_str())]);
    let deep = if read.lowest.is_none() { TRUE } else { FAINT };
    vec![
        (Density::Reduced, scale.language.say("hud-from-hole"), 11.0, FAINT),
        (Density::Least, format!("r {:.2} r_s", read.radius), 19.0, colour),
        (Density::Full, scale.kilometres(read.radius), 13.0, TEXT),
        (Density::Full, camera, 12.0, deep),
    ]
}

fn speed(scale: &Scale, read: &Instruments, helped: bool) -> Vec<Line> {
    let speed = read.speed.map_or("—".to_owned(), |speed| format!("{speed:.3} c"));
    let falling = format!("{:.3}", read.rain_speed);
    let gees = scale.gees(read.acceleration);
    vec![
        (Density::Reduced, scale.language.say("hud-speed"), 11.0, FAINT),
        (Density::Least, speed, 26.0, TEXT),
        (Density::Full, scale.language.fill("hud-speed-falling", &[("speed", falling.as_str())]), 12.0, FAINT),
        (Density::Full, scale.language.say(if helped && gees > 0.05 { "hud-load-assist" } else { "hud-load" }), 11.0, FAINT),
        (Density::Full, format!("{gees:.1} g"), 19.0, if gees > HEAVY { TRUE } else { TEXT }),
    ]
}

/// Who closes slower than this, in c, flies away.
const AWAY: f64 = -0.05;

fn target(scale: &Scale, read: &Bearing, going: Going) -> Vec<Line> {
    let language = scale.language;
    // Away from it is not well either.
    let closing = going
        .guidance
        .map_or(TEXT, |guide| if guide.brake != Brake::Now && guide.closing() < AWAY { TRUE } else { brake_colour(guide.brake) });
    let mut lines = vec![
        (Density::Reduced, language.say(if going.by_light { "hud-range-seen" } else { "hud-range" }), 11.0, FAINT),
        (Density::Least, format!("{:.2} r_s", read.range), 26.0, TEXT),
        (Density::Full, scale.kilometres(read.range), 12.0, FAINT),
        (Density::Full, language.say("hud-closing"), 11.0, FAINT),
        (Density::Reduced, format!("{:+.3} c", thousandths(read.closing)), 19.0, closing),
    ];
    if let Some(guide) = going.guidance {
        let numbers = [guide.sideways(), guide.stopping].map(|value| format!("{value:.2}"));
        let words = language.fill("hud-stops", &[("sideways", numbers[0].as_str()), ("stopping", numbers[1].as_str())]);
        lines.push((Density::Reduced, words, 12.0, closing));
    }
    lines.extend(going.advice.map(|advice| {
        let (key, colour) = match advice {
            Advice::Coast => ("hud-meets", OWN),
            Advice::Thrust(_) => ("hud-meets-by-thrust", TEXT),
            Advice::Wait => ("hud-meets-not", TRUE),
        };
        (Density::Reduced, language.say(key), 12.0, colour)
    }));
    if let Some(g) = read.shift {
        let key = if g >= 1.0 { "hud-light-bluer" } else { "hud-light-redder" };
        lines.push((Density::Full, language.fill(key, &[("g", format!("{g:.3}").as_str())]), 12.0, TEXT));
    }
    lines.push((Density::Full, language.fill("hud-target-clock", &[("clock", scale.clock(read.clock).as_str())]), 12.0, FAINT));
    lines
}

/// Rounded as it is written, so that nothing is −0.000.
fn thousandths(value: f64) -> f64 {
    (value * 1e3).round() * 1e-3 + 0.0
}

/// Who flies, where one looks from, the pace, and what is in the tanks, over a bar of it.
fn state(
    painter: &Painter,
    at: Pos2,
    session: &Session,
    player: &PlayerState,
    read: &Instruments,
    going: Going,
    density: Density,
) -> TextBox {
    let language = session.language();
    let pilot = language.say(match (going.replayed, player.autopilot, player.assisted(&session.config)) {
        (true, ..) => "hud-replay",
        (_, true, _) if player.pilot == Some(PilotKind::Hands) => "hud-hands",
        (_, true, _) => "hud-autopilot",
        _ if player.matching() => "hud-matching",
        _ if player.facing => "hud-facing",
        (_, _, mode) => assist_words(mode),
    });
    let view = language.say(match player.view {
        _ if going.replayed => "hud-view-replay",
        _ if player.gaze.aside() => "hud-view-target",
        CameraView::Cockpit => "hud-view-cockpit",
        CameraView::ThirdPerson => "hud-view-third",
    });
    let tanks = match (read.fuel, read.fuel_left) {
        (Some(share), left) => {
            let percent = format!("{:.0}", 100.0 * share);
            language.fill("hud-fuel", &[("percent", percent.as_str()), ("left", format!("{left:.2}").as_str())])
        }
        (None, _) => language.say("hud-fuel-endless"),
    };
    let [colour, filled] = if read.fuel.is_some_and(|share| share < LOW_FUEL) { [ALARM; 2] } else { [TEXT, OWN] };
    let pace = format!("{:.2}", session.config.clock.pace * going.slowing);
    let pace = language.fill(if going.slowing < 0.98 { "hud-pace-slowed" } else { "hud-pace" }, &[("pace", pace.as_str())]);
    let lines = [(Density::Reduced, format!("{pilot}  ·  {view}"), TEXT), (Density::Full, pace, TEXT), (Density::Least, tanks, colour)];
    let lines: Vec<(&str, f32, Color32)> =
        lines.iter().filter(|line| line.0 <= density).map(|(_, words, colour)| (words.as_str(), 12.0, *colour)).collect();
    TextBox::lay_out(painter, at, Align2::LEFT_BOTTOM, f32::INFINITY, &lines).over_bar(read.fuel.unwrap_or(1.0) as f32, filled)
}
