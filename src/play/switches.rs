//! Keys that switch something: screens, views, the assist, the pace.

use bevy::input::mouse::AccumulatedMouseMotion;
use bevy::prelude::*;
use bevy_egui::input::EguiWantsInput;

use crate::play::hud::notice::Notice;
use crate::play::hud::panel::Panel;
use crate::play::input::PlayerInput;
use crate::play::input::action::Action;
use crate::play::menus::entries::{Menu, Page, Touch};
use crate::play::menus::navigate::choose;
use crate::play::menus::screens::{MenuAction, Screen};
use crate::play::player_state::{PlayerState, TAP, assist_words};
use crate::play::session::Session;
use crate::play::window::record;
use crate::scene::config;
use crate::sim::Chase;
use crate::sim::assist::AssistMode;
use crate::sim::by_hand::Avoiding;

/// What the HUD shows of it, where there is one.
type Screened<'w> = (Option<Res<'w, Panel>>, Option<Res<'w, Avoiding>>, Option<ResMut<'w, Notice>>);

/// Keys that switch something.
pub(in crate::play) fn read_keys(
    input: PlayerInput,
    (screen, typing): (Res<State<Screen>>, Option<Res<EguiWantsInput>>),
    mut session: ResMut<Session>,
    (mut player, mut menu): (ResMut<PlayerState>, ResMut<Menu>),
    (chase, real, turned): (Option<Res<Chase>>, Res<Time<Real>>, Res<AccumulatedMouseMotion>),
    (panel, avoiding, notice): Screened,
    (mut actions, mut commands): (MessageWriter<MenuAction>, Commands),
) {
    let plays = *screen.get() == Screen::Playing;
    if input.pushed(Action::ToggleOverlay) {
        player.overlay = !player.overlay;
    }
    let typing = typing.is_some_and(|typing| typing.wants_keyboard_input()) || menu.awaits.is_some();
    player.looking = plays && !typing && input.holds(Action::LookAtTarget);
    player.facing = plays && !typing && input.holds(Action::FaceTarget);
    player.fired |= plays && !typing && input.pushed(Action::Fire);
    if typing {
        return;
    }
    if input.pushed(Action::Screenshot) {
        commands.queue(record::screenshot);
    }
    for (action, path) in [(Action::ToggleFullScreen, "video.fullscreen"), (Action::Mute, "sound.mute_master")] {
        if input.pushed(action) {
            commands.queue(move |world: &mut World| toggle(world, path));
        }
    }
    let flown = matches!(screen.get(), Screen::Playing | Screen::Paused | Screen::Result);
    if input.pushed(Action::Restart) && flown && menu.page().is_none() {
        actions.write(MenuAction::Again);
    }
    if input.pushed(Action::WhatAmISeeing) {
        match (screen.get(), menu.page()) {
            (_, Some(Page::Seeing)) => menu.touched.push(Touch::Back),
            (Screen::Playing, _) => {
                player.seeing_from_play = true;
                menu.open(Page::Seeing);
                actions.write(MenuAction::Pause);
            }
            (Screen::Paused, None) => {
                player.seeing_from_play = false;
                menu.open(Page::Seeing);
            }
            _ => (),
        }
    }
    if !plays {
        return;
    }
    if input.pushed(Action::Pause) {
        actions.write(MenuAction::Pause);
    }
    if input.pushed(Action::PhotoMode) {
        actions.write(MenuAction::Photo);
    }
    if input.pushed(Action::ToggleCamera) {
        player.view = player.view.toggled();
        player.follower.reset();
    }
    if input.pushed(Action::ToggleHud) {
        player.hud_off = !player.hud_off;
    }
    let has_target = chase.is_some_and(|chase| chase.quarry.is_some());
    let brakes = panel.is_some_and(|panel| panel.says_brake(player.autopilot, avoiding.is_some_and(|avoiding| avoiding.0)));
    let chosen = hold_assist(&input, &mut player, &session, [has_target, brakes], real.delta_secs_f64());
    if let (Some(mode), Some(mut notice)) = (chosen, notice) {
        let language = session.language();
        let [now, next] = [mode, mode.next(has_target)].map(|mode| language.say(assist_words(mode)));
        let text = language.fill("hud-assist-chosen", &[("now", now.as_str()), ("next", next.as_str())]);
        *notice = Notice { text, until: real.elapsed_secs_f64() + CHOSEN, share: None };
    }
    let begins = input.stick().thrust != glam::DVec3::ZERO
        || player.facing
        || input.holds(Action::LookAtTarget)
        || input.holds(Action::ToggleAutopilot);
    player.begun |= player.pilot.is_some() || begins;
    player.touched |= begins || input.stick().turn != glam::DVec3::ZERO || turned.delta.length() > 0.0;
    if input.pushed(Action::ToggleAutopilot) {
        player.autopilot = !player.autopilot;
    }
    let faster = f64::from(i8::from(input.pushed(Action::Faster)) - i8::from(input.pushed(Action::Slower)));
    if faster != 0.0 {
        let pace = session.config.clock.pace * faster.exp2();
        session.config.clock.pace = pace.clamp(0.05, 24.0);
    }
}

/// The assist's key: a tap chooses what it holds to, which is returned; held it matches the target's motion. `seconds` of wall time have
/// passed. `brakes`: the sign to brake is shown, and a tap is meant for it.
fn hold_assist(
    input: &PlayerInput,
    player: &mut PlayerState,
    session: &Session,
    [has_target, brakes]: [bool; 2],
    seconds: f64,
) -> Option<AssistMode> {
    let held = input.holds(Action::ToggleAssist);
    let pushed = input.pushed(Action::ToggleAssist);
    let before = player.assist_held;
    player.assist_held = held.then(|| before.map_or(0.0, |before| before + seconds));
    // A short press may begin and end within a frame.
    let tapped = !held && before.map_or(pushed, |before| before < TAP);
    let chosen = (tapped && !brakes).then(|| player.assisted(&session.config).next(has_target));
    player.assist = chosen.or(player.assist);
    chosen
}

/// How long it is said what the assist holds to, in seconds of wall time.
const CHOSEN: f64 = 2.5;

/// Switches a setting that is kept.
fn toggle(world: &mut World, path: &str) {
    let Some(setting) = config::setting(path) else { return };
    let on = setting.get(&world.resource::<Session>().config) == config::Value::Switch(true);
    choose(world, setting, config::Value::Switch(!on));
}
