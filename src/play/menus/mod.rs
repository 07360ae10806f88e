//! Title, pause and result.

mod parts;
pub mod screens;
mod title;
mod words;

use bevy::prelude::*;
use bevy_egui::egui::{self, Align2, Color32, RichText, Ui};
use bevy_egui::{EguiContexts, EguiPrimaryContextPass};

use crate::scene::ship::Ai;
use crate::sim::replay::Playback;
use crate::sim::{Chase, Clock, Outcome};

use crate::play::hud::instruments::Scale;
use crate::play::hud::notice::Notice;
use crate::play::hud::paint::{OWN, SEEN, SHADE, TRUE};
use crate::play::hud::panel::Panel;
use crate::play::menus::screens::{MenuAction, Screen};
use crate::play::missions::{Catalogue, LastFlight};
use crate::play::player_state::{Flown, PlayerState};
use crate::play::records::Records;
use crate::play::schedule::{GameSet, PaintSet};
use crate::play::session::Session;
use parts::{FAINT, PALE, WARM, buttons, calm, table};
use title::{ABOUT, LIST, Title, title};
use words::{camera_hint, goal, hint, key, stars, unit};
/// The cards of the screens, and what a chase begins with. Needs [`HudPlugin`](crate::play::hud::HudPlugin).
pub struct MenusPlugin;

impl Plugin for MenusPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Update, welcome.in_set(GameSet::Window)).add_systems(EguiPrimaryContextPass, draw.in_set(PaintSet::Menus));
    }
}

/// Draws the menu of the screen.
fn draw(
    mut contexts: EguiContexts,
    screen: Res<State<Screen>>,
    mut session: ResMut<Session>,
    (chase, panel): (Option<Res<Chase>>, Res<Panel>),
    player: Res<PlayerState>,
    (catalogue, records, last): (Option<Res<Catalogue>>, Res<Records>, Res<LastFlight>),
    mut actions: MessageWriter<MenuAction>,
) -> Result {
    let context = contexts.ctx_mut()?;
    let mut ask = |action| _ = actions.write(action);
    match screen.get() {
        Screen::Playing => (),
        Screen::Title => card(context, "title", TITLE, |ui| {
            if let Some(catalogue) = &catalogue {
                title(ui, &mut session, &Title { catalogue, records: &records, choice: player.choice, free: player.free }, &mut ask);
            }
        }),
        // At the side: the pointer rests in the middle, where a button would be pressed by mistake.
        Screen::Paused => card(context, "pause", WIDE, |ui| {
            ui.label(RichText::new("Paused").size(34.0).color(PALE));
            ui.add_space(10.0);
            buttons(
                ui,
                &mut ask,
                &[
                    ("Go on", MenuAction::Pause),
                    ("Start again", MenuAction::Start),
                    ("Title", MenuAction::Title),
                    ("Quit", MenuAction::Quit),
                ],
            );
            calm(ui, &mut session);
            ui.add_space(6.0);
            controls(ui, &session);
        }),
        Screen::Result => card(context, "result", NARROW, |ui| {
            result(ui, &session, chase.as_deref(), &panel, player.flown);
            score(ui, &session, &last);
            let mut choices = vec![("Again  (Enter)", MenuAction::Start)];
            if session.scene.mission.is_some() && last.won.is_some() {
                choices.push(("Next mission", MenuAction::Next));
            }
            if last.replay.is_some() {
                choices.push(("Watch", MenuAction::Watch));
            }
            choices.extend([("Title", MenuAction::Title), ("Quit", MenuAction::Quit)]);
            buttons(ui, &mut ask, &choices);
        }),
    }
    Ok(())
}

/// From the screen's left edge to a card, in points.
const ASIDE: f32 = 24.0;
/// Between a card's edge and what it says, in points.
const INSIDE: f32 = 24.0;
/// Width of what the title says, in points.
const TITLE: f32 = LIST + 16.0 + ABOUT + 8.0;
/// Width of what the pause says, in points.
const WIDE: f32 = 470.0;
/// Width of what the result says, in points: it leaves the middle of the narrowest window free.
const NARROW: f32 = 330.0;

/// A dark card at the left of the screen, with room for `width` points.
fn card(context: &egui::Context, name: &'static str, width: f32, content: impl FnOnce(&mut Ui)) {
    egui::Area::new(egui::Id::new(name)).anchor(Align2::LEFT_CENTER, [ASIDE, 0.0]).show(context, |ui| {
        egui::Frame::new().fill(SHADE).corner_radius(12.0).inner_margin(INSIDE).show(ui, |ui| {
            ui.vertical_centered(|ui| {
                ui.set_width(width);
                content(ui);
            })
        });
    });
}
/// Says the goal when a chase begins, and on the first flight what to begin with: until the player has, or has had time to read it.
fn welcome(
    session: Res<Session>,
    screen: Res<State<Screen>>,
    clock: Res<Clock>,
    real: Res<Time<Real>>,
    playback: Option<Res<Playback>>,
    mut player: ResMut<PlayerState>,
    mut notice: ResMut<Notice>,
) {
    /// How long the goal is shown after the beginning, in r_s/c of T.
    const SHOWN: f64 = 12.0;
    /// How long the hint is shown, in seconds of wall time in play.
    const HINTED: f64 = 30.0;
    if *screen.get() != Screen::Playing {
        return;
    }
    if !player.begun {
        player.hinted += real.delta_secs_f64();
        player.begun = player.hinted > HINTED;
    }
    // A mission says its goals by itself.
    let has_quarry = session.scene.mission.is_none() && session.scene.ships.iter().any(|ship| ship.ai == Ai::Flee);
    let goal = ((clock.time < SHOWN || !player.begun) && has_quarry).then(|| goal(&session));
    let hint = match &playback {
        Some(_) => (clock.time < SHOWN).then(|| camera_hint(&session)),
        None => (!player.begun).then(|| hint(&session)),
    };
    let words: Vec<String> = goal.into_iter().chain(hint).collect();
    if !words.is_empty() && notice.until < real.elapsed_secs_f64() {
        *notice = Notice { text: words.join("\n"), until: real.elapsed_secs_f64() + 0.5 };
    }
}

/// The keys, as they are bound.
fn controls(ui: &mut Ui, session: &Session) {
    let keys = &session.config.controls;
    let rows = [
        (
            "Thrust",
            format!("{} {} {} {}", key(&keys.thrust_forward), key(&keys.thrust_left), key(&keys.thrust_back), key(&keys.thrust_right)),
        ),
        ("Up, down, full thrust", format!("{}  {}  {}", key(&keys.thrust_up), key(&keys.thrust_down), key(&keys.boost))),
        ("Turn", "mouse or arrow keys".to_owned()),
        ("Fire, in missions with bolts", key(&keys.fire).to_owned()),
        ("Roll", format!("{}  {}", key(&keys.roll_left), key(&keys.roll_right))),
        ("Assist, autopilot", format!("{}  {}", key(&keys.toggle_assist), key(&keys.toggle_autopilot))),
        ("Camera, look at the target", format!("{}  {} (hold)", key(&keys.toggle_camera), key(&keys.look_at_target))),
        (
            "Slower, faster, pause, start again",
            format!("{}  {}  {}  {}", key(&keys.slower), key(&keys.faster), key(&keys.pause), key(&keys.restart)),
        ),
        ("HUD, dev overlay, picture", format!("{}  {}  {}", key(&keys.toggle_hud), key(&keys.toggle_overlay), key(&keys.screenshot))),
    ];
    let rows = rows.map(|(what, how)| (RichText::new(what).color(FAINT), RichText::new(how).color(PALE)));
    table(ui, "controls", rows);
    ui.add_space(6.0);
    table(ui, "markers", MARKERS.map(|(name, colour, meaning)| (RichText::new(name).color(colour), RichText::new(meaning).color(FAINT))));
}

/// The names of the HUD's markers, their colours, and what they mean.
const MARKERS: [(&str, Color32, &str); 5] = [
    ("now", TRUE, "dashed ring: where the quarry is at this moment. Fly to this one."),
    ("seen, 7.8 r_s/c ago", SEEN, "its picture: the light left so long ago, from where it was."),
    ("2nd image", SEEN, "the same ship by light that went round the hole's far side."),
    ("course", OWN, "where you fly to; the nose points to the middle."),
    ("dotted lines", FAINT, "how you and the target fall on; small rings: where you pass nearest."),
];
fn result(ui: &mut Ui, session: &Session, chase: Option<&Chase>, panel: &Panel, flown: Flown) {
    let Some((outcome, time)) = chase.and_then(|chase| chase.outcome) else { return };
    let (words, colour) = headline(outcome);
    ui.label(RichText::new(words).size(38.0).color(colour).strong());
    ui.label(RichText::new(outcome.to_string()).size(16.0).color(PALE));
    if let Some(words) = pilot(flown) {
        ui.label(RichText::new(words).size(14.0).color(WARM));
    }
    ui.add_space(10.0);
    let scale = Scale::of(session.config.hole.mass_solar);
    let mut lines = vec![format!("Far clock  {}   (T = {time:.1} r_s/c)", scale.clock(time))];
    if let Some(own) = panel.decided {
        lines.push(format!("Own clock  {}", scale.clock(own)));
        lines.push(format!("Younger than those far away by  {}", scale.clock((time - own).max(0.0))));
    }
    if let Some(read) = panel.instruments {
        lines.extend(read.fuel.map(|fuel| format!("Fuel left  {:.0} %", 100.0 * fuel)));
    }
    for line in lines {
        ui.label(RichText::new(line).size(14.0).color(PALE));
    }
    ui.add_space(14.0);
}

/// The stars and the score of a mission.
fn score(ui: &mut Ui, session: &Session, last: &LastFlight) {
    let Some((won, mission)) = last.won.zip(session.scene.mission.as_ref()) else { return };
    let unit = unit(mission.clock);
    ui.label(RichText::new(stars(won.stars)).size(30.0).color(TRUE));
    let words = match (last.is_best, last.before) {
        (true, Some(before)) => format!("{:.1} {unit}: your best, before {:.1}", won.score, before.score),
        (true, None) => format!("{:.1} {unit}: your first", won.score),
        (false, Some(before)) => format!("{:.1} {unit}, your best {:.1}", won.score, before.score),
        (false, None) => format!("{:.1} {unit}", won.score),
    };
    ui.label(RichText::new(words).size(14.0).color(PALE));
    ui.add_space(8.0);
}

/// What the result says of the autopilot, if it flew.
fn pilot(flown: Flown) -> Option<&'static str> {
    match (flown.by_autopilot, flown.by_hand) {
        (false, _) => None,
        (true, true) => Some("the autopilot flew a part of the way: not counted"),
        (true, false) => Some("the autopilot flew: not counted"),
    }
}

/// What the result says, large, and its colour.
fn headline(outcome: Outcome) -> (&'static str, Color32) {
    match outcome {
        Outcome::Caught => ("CAUGHT", Color32::from_rgb(150, 240, 150)),
        Outcome::HunterLost => ("LOST", Color32::from_rgb(255, 96, 80)),
        Outcome::QuarryLost => ("IT IS GONE", WARM),
        Outcome::TimeOut => ("TOO LATE", WARM),
        Outcome::Done => ("DONE", Color32::from_rgb(150, 240, 150)),
        Outcome::Taken => ("CAUGHT", Color32::from_rgb(255, 96, 80)),
        Outcome::Strayed => ("TOO FAR", WARM),
        Outcome::ShipLost => ("LOST", Color32::from_rgb(255, 96, 80)),
    }
}

#[cfg(test)]
mod tests {
    use super::words::measure;
    use super::*;
    use crate::play::window::interface::INTERFACE;

    #[test]
    fn the_result_says_when_the_autopilot_flew() {
        let said = |by_hand, by_autopilot| pilot(Flown { by_hand, by_autopilot });
        assert_eq!(said(true, false), None);
        assert!(said(false, true).is_some_and(|words| !words.contains("part")));
        assert!(said(true, true).is_some_and(|words| words.contains("part")));
    }

    #[test]
    fn the_result_leaves_the_middle_free() {
        // The narrowest the interface is laid out for; ship and quarry are about the middle.
        let right = ASIDE + NARROW + 2.0 * INSIDE;
        assert!(right < 0.5 * INTERFACE[0] - 40.0, "{right}");
    }

    #[test]
    fn keys_as_written_on_the_keyboard() {
        assert_eq!(["KeyW", "Digit4", "ControlLeft", "F3", "Space"].map(key), ["W", "4", "Ctrl", "F3", "Space"]);
    }

    /// A line never ends between a number and its unit, and what a unit is long is said.
    #[test]
    fn the_goal_keeps_numbers_and_units_together() {
        let session = Session::load(None, Some("chase"), Some(0)).expect("the game's own files");
        let said = goal(&session);
        for words in ["0.5\u{a0}r_s", "T\u{a0}=\u{a0}400\u{a0}r_s/c\u{a0}(456\u{a0}days)"] {
            assert!(said.contains(words), "{said}");
        }
        assert!(measure(&session).contains("29.5\u{a0}bn\u{a0}km"), "{}", measure(&session));
    }

    #[test]
    fn the_hint_names_the_keys_as_bound() {
        let mut session = Session::load(None, Some("chase"), Some(0)).expect("the game's own files");
        assert!(hint(&session).contains("hold\u{a0}V"), "{}", hint(&session));
        session.config.controls.look_at_target = "KeyL".into();
        assert!(hint(&session).contains("hold\u{a0}L"), "{}", hint(&session));
    }

    /// The title, the highest of the cards, is no higher than the lowest window the interface is laid out for.
    #[test]
    fn the_title_fits() {
        let mut session = Session::load(None, Some("chase"), Some(0)).expect("the game's own files");
        let catalogue = Catalogue::read(session.scene.clone()).0;
        let mut height = f32::INFINITY;
        crate::play::hud::paint::tests::on_canvas(INTERFACE, |painter, _| {
            // The first picture of an area only measures it.
            card(painter.ctx(), "title", TITLE, |ui| {
                title(ui, &mut session, &Title { catalogue: &catalogue, records: &Records::default(), choice: 3, free: 0 }, &mut |_| ());
                height = ui.min_rect().height() + 2.0 * INSIDE;
            });
        });
        assert!(height < INTERFACE[1], "{height}");
    }
}
