//! The coach: one hint at a time, by what happens in a flight by hand, and after a loss why. Each hint is given a few times, then it is
//! silent; `interface.coach` switches it off.

mod gates;
pub mod review;

use bevy::prelude::*;

use crate::play::camera::state_of;
use crate::play::game::begins_anew;
use crate::play::hud::dials::LOW_FUEL;
use crate::play::hud::notice::Notice;
use crate::play::hud::panel::{self, Panel};
use crate::play::input::action::Action;
use crate::play::input::bindings::Bindings;
use crate::play::input::button::Device;
use crate::play::menus::screens::Screen;
use crate::play::picture::now::Now;
use crate::play::picture::stage_loading::CurrentStage;
use crate::play::player_state::PlayerState;
use crate::play::schedule::GameSet;
use crate::play::words;
use crate::scene::mission::GoalTask;
use crate::sim::SimEvent;
use crate::sim::assist::AssistMode;
use crate::sim::guidance::{Brake, Guidance, meets};
use crate::sim::pilot::rollout::Point;
use crate::sim::replay::Playback;
use review::Review;

/// What the coach may say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Hint {
    /// No fuel, and the orbit does not meet the target.
    Hopeless,
    /// Too near to the hole.
    Hole,
    /// Too fast for the target.
    Brake,
    /// Sideways against the target.
    Drift,
    /// Little fuel.
    Fuel,
}

impl Hint {
    const ALL: [Hint; 5] = [Hint::Hopeless, Hint::Hole, Hint::Brake, Hint::Drift, Hint::Fuel];

    /// The key of its words.
    fn key(self) -> &'static str {
        ["coach-hopeless", "coach-hole", "coach-brake", "coach-drift", "coach-fuel"][self as usize]
    }
}

/// Flights in which a hint is given.
const FLIGHTS: u32 = 3;
/// How long a hint is shown, in seconds of wall time.
const SHOWN: f64 = 7.0;
/// Below this radius, in r_s, the hole is near: the innermost stable circle is at 3.
const NEAR_HOLE: f64 = 2.6;
/// Below this one, in r_s, a fall that ends in the hole is to be mended at once.
const FALLING: f64 = 5.0;
/// Faster sideways than this, in c, nearer than so many catch radii, drift is worth a hint.
const DRIFT: (f64, f64) = (0.12, 8.0);
/// T between two looks at whether a flight without fuel can still be won, in r_s/c.
const LOOK: f64 = 2.0;

/// How far ahead it is looked, in r_s/c: a time limit may be a thousand million.
const FARTHEST: f64 = 400.0;

/// What the coach has said.
#[derive(Resource, Clone, Debug, Default)]
struct Coach {
    /// In how many flights each hint was given.
    given: [u32; Hint::ALL.len()],
    /// Which were given in this flight.
    now: [bool; Hint::ALL.len()],
    /// Until when the last hint is shown, in seconds of wall time, and which it is.
    until: f64,
    last: Option<Hint>,
    /// T of the flight in the frame before, in r_s/c.
    before: f64,
    /// T of the next look at whether it can be won.
    look: f64,
    hopeless: bool,
}

/// Gives hints in flights by hand.
pub struct CoachPlugin;

impl Plugin for CoachPlugin {
    fn build(&self, app: &mut App) {
        let follow = (review_flight, gates::say_missed_gate, give_hints).chain().after(panel::read_panel).in_set(GameSet::Instruments);
        app.init_resource::<Review>().init_resource::<Coach>().add_systems(Update, follow.run_if(resource_exists::<CurrentStage>));
    }
}

/// Notes what happens; a flight that begins anew has a new review.
fn review_flight(
    (now, panel): (Now, Res<Panel>),
    mut events: MessageReader<SimEvent>,
    (mut review, mut coach, mut notice): (ResMut<Review>, ResMut<Coach>, ResMut<Notice>),
) {
    if begins_anew(&mut coach.before, now.clock()) {
        *review = Review::default();
        (coach.now, coach.look, coach.hopeless) = (Default::default(), 0.0, false);
        // What was said of the flight before.
        if notice.until == coach.until {
            notice.until = 0.0;
        }
    }
    for event in events.read() {
        if let (&SimEvent::GoalDone { goal, time }, Some(mission)) = (event, &now.mission)
            && matches!(mission.0.goals.get(goal.wrapping_sub(1)).map(|goal| &goal.task), Some(GoalTask::Hold { .. }))
        {
            review.note_catch(time);
        }
        if let Some(bolt) = now.bolt_that_hit(event) {
            let span = event.time() - bolt.fired;
            review.note_hit(span, |share| bolt.history.at(bolt.fired + share * span).position);
        }
    }
    let fuel = panel.instruments.map_or(1.0, |read| read.fuel_left);
    let decided = now.chase.as_ref().is_some_and(|chase| chase.outcome.is_some());
    if let Some((own, ..)) = now.own().filter(|_| !decided) {
        let time = now.time();
        review.note(time, own.at(time).position, panel.guidance.zip(panel.reach), fuel);
    }
}

/// Says the most urgent thing that was not said in this flight, where nothing else is said.
fn give_hints(
    (now, panel, screen): (Now, Res<Panel>, Res<State<Screen>>),
    (player, playback): (Res<PlayerState>, Option<Res<Playback>>),
    (bindings, device, real): (Res<Bindings>, Res<Device>, Res<Time<Real>>),
    (mut coach, mut notice): (ResMut<Coach>, ResMut<Notice>),
) {
    let session = &now.session;
    let flies = *screen.get() == Screen::Playing && !player.autopilot && playback.is_none() && player.touched;
    let seconds = real.elapsed_secs_f64();
    if *screen.get() != Screen::Playing && notice.until == coach.until && notice.until > seconds {
        notice.until = 0.0;
        // Who had no time to read it is given it again.
        if let Some(hint) = coach.last.take() {
            coach.now[hint as usize] = false;
            coach.given[hint as usize] -= 1;
        }
    }
    if !flies || !session.config.interface.coach || notice.until > seconds {
        return;
    }
    coach.hopeless = is_hopeless(&now, &panel, &mut coach);
    let mode = if player.matching() { AssistMode::Target } else { player.assisted(&session.config) };
    let due = |hint: &Hint| is_due(*hint, &panel, mode, coach.hopeless, now.mission.as_ref().is_some_and(|mission| mission.0.inside));
    let fresh = |hint: &Hint| !coach.now[*hint as usize] && (coach.given[*hint as usize] < FLIGHTS || *hint == Hint::Hopeless);
    let Some(hint) = Hint::ALL.into_iter().find(|hint| fresh(hint) && due(hint)) else { return };
    coach.now[hint as usize] = true;
    coach.given[hint as usize] += 1;
    let language = session.language();
    let action = if hint == Hint::Hopeless { Action::Restart } else { Action::ToggleAssist };
    let button = words::buttons::of(language, &bindings, *device, action);
    (coach.until, coach.last) = (seconds + SHOWN, Some(hint));
    *notice = Notice { text: language.fill(hint.key(), &[("button", button.as_str())]), until: coach.until, share: None };
}

/// Whether a hint is to the point.
fn is_due(hint: Hint, panel: &Panel, mode: AssistMode, hopeless: bool, inside: bool) -> bool {
    let Some(read) = panel.instruments else { return false };
    let target = panel.guidance.zip(panel.reach);
    let falls_in = !inside && read.lowest.is_none() && read.radius < FALLING;
    match hint {
        Hint::Hopeless => hopeless,
        Hint::Hole => !inside && (falls_in || read.radius < NEAR_HOLE) && target.is_some(),
        Hint::Brake => target.is_some_and(|(guide, _)| guide.brake == Brake::Now),
        Hint::Drift => {
            let drifts = |(guide, reach): (Guidance, f64)| {
                let misses = panel.pass.is_none_or(|near| near.distance > reach);
                misses && guide.brake != Brake::Now && guide.sideways() > DRIFT.0 && guide.apart.length() < DRIFT.1 * reach
            };
            !falls_in && mode != AssistMode::Target && panel.advice.is_none() && target.is_some_and(drifts)
        }
        Hint::Fuel => read.fuel.is_some_and(|share| share > 0.0 && share < LOW_FUEL),
    }
}

/// Whether the tanks are empty and the orbit does not meet the target before the time is out.
fn is_hopeless(now: &Now, panel: &Panel, coach: &mut Coach) -> bool {
    let time = now.time();
    let Some((read, reach)) = panel.instruments.zip(panel.reach).filter(|(read, _)| read.fuel == Some(0.0)) else { return false };
    if time < coach.look {
        return coach.hopeless;
    }
    coach.look = time + LOOK;
    let left = (now.rules.0.time_limit - read.far_time).min(FARTHEST);
    let (Some((own, ..)), Some((_, target))) = (now.own(), now.target()) else { return false };
    let [own, target] = [own, target].map(|history| Point::from(&state_of(&history.at(time))));
    !meets(&own, &target, left, reach)
}
