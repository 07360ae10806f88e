//! The HUD: dials, painted with egui, and the messages. The numbers come from [`crate::play::hud::instruments`], the markers from
//! [`crate::play::hud::markers`].

pub mod ahead;
pub mod colours;
pub mod dials;
pub mod goals;
pub mod instruments;
pub mod layout;
pub mod markers;
pub mod notice;
pub mod paint;
pub mod palette;
pub mod panel;
mod touch;

use std::sync::LazyLock;

use bevy::prelude::*;
use bevy_egui::egui::text::{LayoutJob, TextFormat};
use bevy_egui::egui::{self, Align2, FontId, Painter, Pos2, Rect, Stroke, pos2, vec2};
use bevy_egui::{EguiContexts, EguiPrimaryContextPass};

use crate::scene::GameConfig;
use crate::sim::bolts::HIT_RADIUS;
use crate::sim::by_hand::Avoiding;
use crate::sim::replay::Playback;
use crate::sim::{ActiveMission, Chase, ChaseRules, PlayerCommands, Progress};

use crate::play::camera::CameraView;
use crate::play::hud::instruments::{Countdown, Scale, hold_numbers};
use crate::play::hud::notice::Notice;
use crate::play::hud::paint::{ALARM, FAINT, OWN, TEXT, TRUE, TextBox, text};
use crate::play::hud::panel::{Panel, Said};
use crate::play::input::action::Action;
use crate::play::input::bindings::Bindings;
use crate::play::input::button::Device;
use crate::play::input::touch::TouchControls;
use crate::play::menus::screens::Screen;
use crate::play::pace::Slowing;
use crate::play::picture::stage_loading::CurrentStage;
use crate::play::player_state::PlayerState;
use crate::play::schedule::{GameSet, PaintSet};
use crate::play::session::Session;
use crate::play::words::{self, Language};
use markers::arc;

/// Space between the screen's edge and the dials, in points.
const MARGIN: f32 = 18.0;
/// Space between two text boxes one above the other, in points.
const BETWEEN: f32 = 6.0;
/// What comes down from the upper edge ends above this, in points.
const BELOW_DIALS: f32 = 122.0;

/// Dials, markers and messages. Needs [`PicturePlugin`](crate::play::picture::PicturePlugin).
pub struct HudPlugin;

impl Plugin for HudPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Panel>()
            .init_resource::<Notice>()
            .init_resource::<Dials>()
            .add_systems(Update, panel::read_panel.in_set(GameSet::Instruments).run_if(resource_exists::<CurrentStage>))
            .add_systems(EguiPrimaryContextPass, draw.in_set(PaintSet::Hud));
    }
}

/// Where the dials were painted last, in points; none before the first flight.
#[derive(Resource, Clone, Debug, Default)]
pub struct Dials(pub Vec<Rect>);

/// What is flown: a mission and how far it has come, a replay.
type Flown<'w> = (Option<Res<'w, ActiveMission>>, Option<Res<'w, Progress>>, Option<Res<'w, Playback>>);

/// What is bound to each action, and the device in use.
type Buttons<'w> = (Res<'w, Bindings>, Res<'w, Device>);

/// What is said, and how the flight is shown.
type Shown<'w> = (Res<'w, Notice>, Res<'w, Time<Real>>, Option<Res<'w, CurrentStage>>, Res<'w, Slowing>);

/// What the HUD keeps from frame to frame.
type Kept<'w, 's> = (Local<'s, goals::Slow>, ResMut<'w, Dials>, Local<'s, Preloaded>, Local<'s, Said>, ResMut<'w, TouchControls>);

/// Draws the HUD.
fn draw(
    mut contexts: EguiContexts,
    (screen, session, player): (Res<State<Screen>>, Res<Session>, Res<PlayerState>),
    (chase, rules, avoiding): (Option<Res<Chase>>, Res<ChaseRules>, Res<Avoiding>),
    (panel, commands, (bindings, device)): (Res<Panel>, Option<Res<PlayerCommands>>, Buttons),
    (notice, real, current, slowing): Shown,
    (mission, progress, playback): Flown,
    (mut slow, mut painted, mut preloaded, mut numbers, mut fingers): Kept,
) -> Result {
    let context = contexts.ctx_mut()?;
    let painter = context.layer_painter(egui::LayerId::background());
    let rect = context.content_rect();
    if preloaded.is_due(context.pixels_per_point()) {
        preload_letters(context, &painter);
    }
    let language = session.language();
    if current.is_none() {
        // Off the menu of the title.
        let (at, align) = match screen.get() {
            Screen::Title => (rect.right_bottom() - vec2(MARGIN, MARGIN), Align2::RIGHT_BOTTOM),
            _ => (rect.center(), Align2::CENTER_CENTER),
        };
        text(&painter, at, align, &language.say("hud-loading"), 18.0, TEXT);
    }
    let shown = current.is_some() && shows(*screen.get(), player.hud_off);
    let mut said = Vec::new();
    if let Some(words) = left_out(&session.config, language) {
        let at = pos2(rect.center().x, rect.bottom() - MARGIN);
        let text_box = TextBox::lay_out(&painter, at, Align2::CENTER_BOTTOM, 0.5 * rect.width(), &[(&words, 12.0, TRUE)]);
        said.push(text_box.frame);
        text_box.paint(&painter);
    }
    let says = (real.elapsed_secs_f64() < notice.until).then_some(notice.text.as_str()).filter(|words| !words.is_empty());
    // In front of menus and the overlay too.
    let front = context.layer_painter(egui::LayerId::new(egui::Order::Foreground, egui::Id::new("notice")));
    if !shown {
        if let Some(words) = says {
            message(&front, rect, rect.top() + BELOW_DIALS, words, notice.share).paint(&front);
        }
        return Ok(());
    }
    let mut taken = markers::Taken { panels: said, other: Vec::new() };
    let numbers = numbers.follow(&panel, real.elapsed_secs_f64());
    let Some(read) = numbers.instruments else { return Ok(()) };
    let helped = commands.is_some_and(|commands| commands.thrust == [0; 3]) && !player.autopilot && playback.is_none();
    let mut text_boxes = dials::lay_out(
        &painter,
        rect,
        &session,
        &player,
        &read,
        dials::Going {
            replayed: playback.is_some(),
            slowing: slowing.0,
            by_light: panel.by_light,
            guidance: numbers.guidance.filter(|_| panel.reach.is_some()),
            advice: numbers.advice,
            helped,
        },
    );
    let rules = rules.0;
    if let Some(chase) = chase.filter(|chase| chase.outcome.is_none()) {
        let holds = match (&mission, &progress) {
            (Some(mission), Some(progress)) => goals::is_held(&mission.0, progress),
            _ => true,
        };
        if chase.held > 0.0 && holds {
            let needed = goals::whole(mission.as_deref(), progress.as_deref(), &rules);
            taken.other.push(hold(&painter, rect.center(), chase.held, needed, language));
        }
        let scale = Scale::of(&session);
        text_boxes.push(countdown(&painter, rect, &scale, &Countdown::at(read.far_time, rules.time_limit)));
    }
    if let (Some(mission), Some(progress)) = (&mission, &progress) {
        let below = text_boxes.last().map_or(rect.top() + MARGIN, |countdown| countdown.frame.bottom() + BETWEEN);
        let seconds = real.elapsed_secs_f64();
        let scene = (language, &session.scene);
        let goals = goals::Goals { mission: &mission.0, progress, rules: ChaseRules(rules), scene, buttons: (&bindings, *device) };
        text_boxes.extend(goals::lay_out(&painter, rect, below, &goals, &mut slow, seconds));
    }
    if let Some(words) = says {
        let message = message(&front, rect, middle_bottom(&text_boxes, rect) + BETWEEN, words, notice.share);
        taken.panels.push(message.frame);
        message.paint(&front);
    }
    if let Some(words) = extra(numbers, language) {
        let at = pos2(rect.right() - MARGIN, target_top(&text_boxes, rect) - BETWEEN);
        text_boxes.push(TextBox::lay_out(&painter, at, Align2::RIGHT_BOTTOM, f32::INFINITY, &[(&words, 12.0, TEXT)]));
    }
    painted.0 = text_boxes.iter().map(|text_box| text_box.frame).collect();
    taken.panels.extend(&painted.0);
    if player.view == CameraView::ThirdPerson {
        taken.other.push(markers::own_ship(rect, panel.field_of_view));
    }
    for text_box in text_boxes {
        text_box.paint(&painter);
    }
    let edge =
        mission.as_ref().zip(progress.as_ref()).is_some_and(|(mission, progress)| goals::near_edge(&mission.0, progress, read.radius));
    let warned = Warned { avoiding: avoiding.0, brake: panel.says_brake(player.autopilot, avoiding.0), edge, radius: read.radius };
    let button = words::buttons::of(language, &bindings, *device, Action::ToggleAssist);
    taken.panels.extend(warnings(&painter, rect, &warned, &button, language));
    if *device == Device::Touch {
        let size = [f64::from(rect.width()), f64::from(rect.height())];
        let seen = panel.images[0].map(|image| markers::marker_position(image.direction, panel.field_of_view, size, 0.0));
        fingers.target =
            seen.map(|(markers::MarkerPosition::On(at) | markers::MarkerPosition::Edge(at, _))| Vec2::new(at[0] as f32, at[1] as f32));
        touch::paint(&painter, &fingers, language);
        taken.other.extend(touch::covered(&fingers));
    }
    markers::paint(&painter, rect, (&panel, numbers), taken, language);
    Ok(())
}

/// Whether dials and markers are shown: in play alone, since menus lie on them.
fn shows(screen: Screen, hud_off: bool) -> bool {
    screen == Screen::Playing && !hud_off
}

/// A line for the player, wrapped where it is wider than the screen.
fn message(painter: &Painter, rect: Rect, top: f32, words: &str, share: Option<f64>) -> TextBox {
    let at = pos2(rect.center().x, top);
    let text_box = TextBox::lay_out(painter, at, Align2::CENTER_TOP, rect.width() - 2.0 * MARGIN, &[(words, 14.0, TRUE)]);
    match share {
        Some(share) => text_box.over_bar(share as f32, TRUE),
        None => text_box,
    }
}

/// Sizes of all text of the HUD, in points.
const SIZES: [f32; 9] = [11.0, 11.5, 12.0, 13.0, 14.0, 15.0, 18.0, 19.0, 26.0];

/// When the letters were asked for last.
#[derive(Default)]
struct Preloaded {
    /// Pixels to the point then.
    scale: f32,
    /// Frames since.
    frames: u32,
}

/// The fonts keep a letter longer than this many frames without it.
const ASKED_EVERY: u32 = 30;

impl Preloaded {
    /// Whether they are to be asked for again.
    fn is_due(&mut self, scale: f32) -> bool {
        self.frames += 1;
        let due = scale != self.scale || self.frames >= ASKED_EVERY;
        if due {
            *self = Preloaded { scale, frames: 0 };
        }
        due
    }
}

/// Has every letter drawn to the fonts' texture before it is needed, one picture of each: the texture reaches the screen a frame after what
/// is written with it, and a digit that is seen for the first time would be missing meanwhile.
fn preload_letters(context: &egui::Context, painter: &Painter) {
    if context.global_style().visuals.text_options.subpixel_binning {
        context.all_styles_mut(|style| style.visuals.text_options.subpixel_binning = false);
    }
    let _ = painter.layout_job(LETTERS.clone());
}

/// All letters in all sizes.
static LETTERS: LazyLock<LayoutJob> = LazyLock::new(|| {
    let letters: String = (' '..='~').chain("\u{a0}“”—–−·×°²⁰¹³⁴⁵⁶⁷⁸⁹γτ…".chars()).collect();
    let mut job = LayoutJob::default();
    for size in SIZES {
        job.append(&letters, 0.0, TextFormat::simple(FontId::proportional(size), TEXT));
    }
    job
});

/// The lower edge of the panels that come down in the middle.
fn middle_bottom(text_boxes: &[TextBox], rect: Rect) -> f32 {
    let middle = text_boxes.iter().map(|text_box| text_box.frame).filter(|frame| frame.x_range().contains(rect.center().x));
    middle.filter(|frame| frame.top() < rect.center().y).map(|frame| frame.bottom()).fold(rect.top() + MARGIN, f32::max)
}

/// The upper edge of what is said of the target, the lowest panel at the right.
fn target_top(text_boxes: &[TextBox], rect: Rect) -> f32 {
    let right = text_boxes.iter().map(|text_box| text_box.frame).filter(|frame| frame.min.x > rect.center().x);
    right.filter(|frame| frame.top() > rect.center().y).map(|frame| frame.top()).fold(rect.bottom() - MARGIN, f32::min)
}

/// Bolts left, and how near one comes.
fn extra(panel: &Panel, language: Language) -> Option<String> {
    let number = |value: f64| format!("{value:.1}");
    let bolts = panel.bolts.map(|left| language.fill("hud-bolts", &[("left", left.to_string().as_str())]));
    let shot = panel.shot_passes.map(|distance| match distance {
        _ if distance <= HIT_RADIUS => language.say("hud-bolt-hits"),
        _ => language.fill("hud-bolt-passes", &[("distance", number(distance).as_str())]),
    });
    let words: Vec<String> = bolts.into_iter().chain(shot).collect();
    (!words.is_empty()).then(|| words.join("\n"))
}

/// What is left out of the picture's physics, for the player to know.
fn left_out(config: &GameConfig, language: Language) -> Option<String> {
    let render = &config.render;
    let out = [
        (render.lensing, "left-out-bending"),
        (render.doppler, "left-out-doppler"),
        (render.beaming, "left-out-beaming"),
        (render.light_delay, "left-out-delay"),
        (render.orders > 1, "left-out-second"),
    ];
    let out: Vec<String> = out.into_iter().filter(|(on, _)| !on).map(|(_, key)| language.say(key)).collect();
    (!out.is_empty()).then(|| language.fill("left-out", &[("what", out.join(", ").as_str())]))
}

/// How long one has been near enough, on a ring and in words; returns where the words are.
fn hold(painter: &Painter, middle: Pos2, held: f64, needed: f64, language: Language) -> Rect {
    arc(painter, middle, 46.0, (held / needed.max(1e-9)).clamp(0.0, 1.0), Stroke::new(4.0, OWN));
    let words = language.fill("hud-hold", &[("numbers", hold_numbers(held, needed).as_str())]);
    text(painter, middle + vec2(0.0, 58.0), Align2::CENTER_TOP, &words, 15.0, OWN)
}

/// What is left of the chase's time, on the far clock, over a bar that grows shorter.
fn countdown(painter: &Painter, rect: Rect, scale: &Scale, countdown: &Countdown) -> TextBox {
    let [colour, filled] = if countdown.late() { [ALARM; 2] } else { [TEXT, OWN] };
    let lines = [
        (&*scale.language.say("hud-time-left"), 11.0, FAINT),
        (&scale.clock(countdown.left), 19.0, colour),
        (&format!("T = {:.1} / {} r_s/c", countdown.limit - countdown.left, countdown.limit), 12.0, FAINT),
    ];
    let top = pos2(rect.center().x, rect.top() + MARGIN);
    TextBox::lay_out(painter, top, Align2::CENTER_TOP, f32::INFINITY, &lines).over_bar(countdown.share() as f32, filled)
}

/// What must not be missed.
struct Warned {
    /// The assist pulls away from the hole.
    avoiding: bool,
    /// It is time to brake for the target.
    brake: bool,
    /// A little farther and the mission is lost.
    edge: bool,
    /// r of the ship, in r_s.
    radius: f64,
}

/// Says it in large letters, and returns where; `button` is what to hold for braking.
fn warnings(painter: &Painter, rect: Rect, warned: &Warned, button: &str, language: Language) -> Option<Rect> {
    let words = match warned {
        Warned { avoiding: true, .. } => language.say("hud-pulling-away"),
        Warned { radius: ..1.0, .. } => language.say("hud-below-horizon"),
        Warned { edge: true, .. } => language.say("hud-near-edge"),
        Warned { brake: true, .. } => language.fill("hud-brake-now", &[("button", button)]),
        _ => return None,
    };
    Some(text(painter, pos2(rect.center().x, rect.bottom() - MARGIN - 28.0), Align2::CENTER_BOTTOM, &words, 18.0, ALARM))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::play::hud::instruments::Instruments;
    use crate::play::hud::layout::overlap;
    use crate::play::hud::paint::tests::on_canvas;
    use crate::scene::config::parse;
    use crate::sim::intercept::Advice;
    use crate::spacetime::matter::ShipState;
    use glam::DVec3;

    /// The longest complaint about game.toml names every key of [controls].
    #[test]
    fn a_long_message_stays_on_the_screen() {
        let file = std::path::Path::new("a/folder/of/somebody/game.toml");
        let complaint = parse(file, "[controls]\nnone = 1\n").expect_err("no such key").to_string();
        assert!(complaint.len() > 300, "{complaint}");
        for size in [[900.0, 620.0], [1280.0, 720.0]] {
            on_canvas(size, |painter, rect| {
                let frame = message(painter, rect, rect.top() + BELOW_DIALS, &complaint, None).frame;
                assert!(rect.contains_rect(frame) && frame.height() > 40.0, "{frame}");
            });
        }
    }

    #[test]
    fn dials_are_shown_in_play_alone() {
        assert!(shows(Screen::Playing, false) && !shows(Screen::Playing, true));
        for screen in [Screen::Title, Screen::Paused, Screen::Result] {
            assert!(!shows(screen, false), "{screen:?}");
        }
    }

    /// Clocks, time, hole, speed, range, who flies: none lies on another in the narrowest window and at 16:9, however full the tanks.
    #[test]
    fn dials_do_not_overlap() {
        let session = Session::load(None, Some("chase"), Some(0)).expect("the game's own files");
        let scale = Scale::of(&session);
        let state = ShipState::new(DVec3::X * 9.0, DVec3::ZERO);
        let read = Instruments::read(&state, 399.0, 9.67, 0.06, (7.0, 7.0), Some(&ShipState::new(DVec3::X * -9.0, DVec3::ZERO)));
        for size in [[900.0, 620.0], [1103.0, 620.0], [1280.0, 720.0]] {
            on_canvas(size, |painter, rect| {
                let mut text_boxes = dials::lay_out(
                    painter,
                    rect,
                    &session,
                    &PlayerState::default(),
                    &read,
                    dials::Going {
                        replayed: false,
                        slowing: 0.5,
                        by_light: true,
                        guidance: None,
                        advice: Some(Advice::Wait),
                        helped: false,
                    },
                );
                text_boxes.push(countdown(painter, rect, &scale, &Countdown::at(1.0, 400.0)));
                assert_eq!(text_boxes.len(), 6);
                for (k, text_box) in text_boxes.iter().enumerate() {
                    assert!(rect.contains_rect(text_box.frame), "{}", text_box.frame);
                    assert!(!overlap(&text_box.frame, &markers::own_ship(rect, 60_f64.to_radians())), "{}", text_box.frame);
                    assert!(text_box.frame.bottom() < BELOW_DIALS || text_box.frame.top() > rect.center().y, "{}", text_box.frame);
                    assert!(text_boxes[..k].iter().all(|other| !overlap(&other.frame, &text_box.frame)), "{}", text_box.frame);
                }
            });
        }
    }
}
