//! Title, pause and result.

use bevy::prelude::*;
use bevy_egui::EguiContexts;
use bevy_egui::egui::{self, Align2, Color32, RichText, Ui};

use crate::sim::{Chase, Outcome};

use super::game::{Flown, Seat};
use super::instruments::Scale;
use super::screens::{Screen, Wish};
use super::session::Session;
use super::window::Panel;

const PALE: Color32 = Color32::from_rgb(226, 234, 242);
const FAINT: Color32 = Color32::from_rgb(150, 166, 182);
const WARM: Color32 = Color32::from_rgb(255, 190, 110);

/// Draws the menu of the screen.
pub fn draw(
    mut contexts: EguiContexts,
    screen: Res<State<Screen>>,
    session: Res<Session>,
    chase: Option<Res<Chase>>,
    panel: Res<Panel>,
    seat: Res<Seat>,
    mut wishes: MessageWriter<Wish>,
) -> Result {
    let context = contexts.ctx_mut()?;
    let mut ask = |wish| _ = wishes.write(wish);
    match screen.get() {
        Screen::Playing => (),
        Screen::Title => card(context, "title", WIDE, |ui| title(ui, &session, &mut ask)),
        // At the side: the pointer rests in the middle, where a button would be pressed by mistake.
        Screen::Paused => card(context, "pause", WIDE, |ui| {
            ui.label(RichText::new("Paused").size(34.0).color(PALE));
            ui.add_space(10.0);
            buttons(ui, &mut ask, &[("Go on", Wish::Pause), ("Start again", Wish::Start), ("Title", Wish::Title), ("Quit", Wish::Quit)]);
            ui.add_space(10.0);
            controls(ui, &session);
        }),
        Screen::Result => card(context, "result", NARROW, |ui| {
            result(ui, &session, chase.as_deref(), &panel, seat.flown);
            buttons(ui, &mut ask, &[("Once more", Wish::Start), ("Title", Wish::Title), ("Quit", Wish::Quit)]);
        }),
    }
    Ok(())
}

/// From the screen's left edge to a card, in points.
const ASIDE: f32 = 24.0;
/// Between a card's edge and what it says, in points.
const INSIDE: f32 = 24.0;
/// Width of what the title and the pause say, in points.
const WIDE: f32 = 470.0;
/// Width of what the result says, in points: it leaves the middle of the narrowest window free.
const NARROW: f32 = 330.0;

/// A dark card at the left of the screen, with room for `width` points.
fn card(context: &egui::Context, name: &'static str, width: f32, content: impl FnOnce(&mut Ui)) {
    egui::Area::new(egui::Id::new(name)).anchor(Align2::LEFT_CENTER, [ASIDE, 0.0]).show(context, |ui| {
        egui::Frame::new().fill(Color32::from_rgba_premultiplied(5, 9, 16, 225)).corner_radius(12.0).inner_margin(INSIDE).show(ui, |ui| {
            ui.vertical_centered(|ui| {
                ui.set_width(width);
                content(ui);
            })
        });
    });
}

fn buttons(ui: &mut Ui, ask: &mut impl FnMut(Wish), choices: &[(&str, Wish)]) {
    for &(words, wish) in choices {
        let button = egui::Button::new(RichText::new(words).size(18.0).color(PALE)).min_size(egui::vec2(230.0, 34.0));
        if ui.add(button).clicked() {
            ask(wish);
        }
        ui.add_space(4.0);
    }
}

fn title(ui: &mut Ui, session: &Session, ask: &mut impl FnMut(Wish)) {
    ui.label(RichText::new("LENSRUNNER").size(46.0).color(PALE).strong());
    ui.label(RichText::new("a chase in the spacetime of a black hole").size(15.0).color(FAINT));
    ui.add_space(14.0);
    ui.label(
        RichText::new("The picture turns, bends and brightens quickly. Those who are sensitive to motion or flashing light may set reduced_motion in game.toml, or let the autopilot fly.")
            .size(12.5)
            .color(WARM),
    );
    ui.add_space(12.0);
    ui.label(RichText::new(goal(session)).size(15.0).color(PALE));
    ui.add_space(12.0);
    buttons(ui, ask, &[("Start  (Enter)", Wish::Start), ("Quit", Wish::Quit)]);
    ui.add_space(8.0);
    controls(ui, session);
}

/// What the chase is about, in a sentence.
pub fn goal(session: &Session) -> String {
    let rules = session.scene.rules(&session.config);
    format!(
        "Catch the quarry: stay within {} r_s of it for {} r_s/c, before T = {} r_s/c, and do not fall into the hole.",
        rules.capture_radius, rules.hold_time, rules.time_limit
    )
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
        ("Roll", format!("{}  {}", key(&keys.roll_left), key(&keys.roll_right))),
        ("Assist, autopilot", format!("{}  {}", key(&keys.toggle_assist), key(&keys.toggle_autopilot))),
        ("Camera, look at the target", format!("{}  {} (hold)", key(&keys.toggle_camera), key(&keys.look_at_target))),
        (
            "Slower, faster, pause, start again",
            format!("{}  {}  {}  {}", key(&keys.slower), key(&keys.faster), key(&keys.pause), key(&keys.restart)),
        ),
        ("HUD, dev overlay, picture", format!("{}  {}  {}", key(&keys.toggle_hud), key(&keys.toggle_overlay), key(&keys.screenshot))),
    ];
    egui::Grid::new("controls").num_columns(2).spacing([28.0, 4.0]).show(ui, |ui| {
        for (what, how) in rows {
            ui.label(RichText::new(what).size(13.0).color(FAINT));
            ui.label(RichText::new(how).size(13.0).color(PALE));
            ui.end_row();
        }
    });
}

/// A key as it is written on the keyboard.
fn key(name: &str) -> &str {
    let name = name.strip_prefix("Key").or_else(|| name.strip_prefix("Digit")).unwrap_or(name);
    match name {
        "ControlLeft" => "Ctrl",
        "ShiftLeft" => "Shift",
        "Escape" => "Esc",
        "Comma" => ", (comma)",
        "Period" => ". (period)",
        other => other,
    }
}

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

/// What the result says of the autopilot, if it flew.
fn pilot(flown: Flown) -> Option<&'static str> {
    match (flown.by_autopilot, flown.by_hand) {
        (false, _) => None,
        (true, true) => Some("the autopilot flew a part of the way"),
        (true, false) => Some("the autopilot flew"),
    }
}

/// What the result says, large, and its colour.
fn headline(outcome: Outcome) -> (&'static str, Color32) {
    match outcome {
        Outcome::Caught => ("CAUGHT", Color32::from_rgb(150, 240, 150)),
        Outcome::HunterLost => ("LOST", Color32::from_rgb(255, 96, 80)),
        Outcome::QuarryLost => ("IT IS GONE", WARM),
        Outcome::TimeOut => ("TOO LATE", WARM),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::play::window::INTERFACE;

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
}
