//! [`EnemyAiPlugin`]: the pilots. One code flies all ships; who flees has the sign of the distance turned.
//!
//! Far away, sampling model-predictive control ([`mod@plan`]); where a meeting can be flown, zero-effort-miss shooting
//! ([`mod@rendezvous`]); bolts are aimed by shooting too ([`mod@aim`]). The hole is avoided in all. A pilot knows the other ship as it was
//! a reaction delay ago, or by its light, and expects it to go on as it did. Difficulty is thrust, fuel, replanning period, horizon and
//! reaction delay, nothing else. [`beginner`] flies nose to the marker, [`person`] with a
//! person's limits by what the screen shows, and [`jerky`] as hands do that throw the ship about.

pub mod aim;
pub mod beginner;
pub mod jerky;
pub mod person;
pub mod plan;
pub mod rendezvous;
pub mod rollout;
pub mod steer;

use bevy::prelude::*;
use glam::{DQuat, DVec3};
use rand::{SeedableRng, rngs::StdRng};

use crate::scene::ship::Sees;
use crate::spacetime::Observer;
use crate::spacetime::light::Order as ImageOrder;
use crate::spacetime::matter::ShipState;

use super::bolts::{Gun, Trigger};
use super::clock::Clock;
use super::flight::Command;
use super::goals::give_orders;
use super::history::History;
use super::ship::{Controls, Ended, Engine, Fleet, Fuel, Manual, Pilot, PilotOrder, Player, ShipMotion};
use super::sight::{apparition, emission_time};
use super::{ActiveMission, ChaseRules, SimSet};
use beginner::Beginner;
use jerky::Jerky;
use person::Person;
use plan::{Aim, Task, plan};
use rendezvous::{intercept, rendezvous};
use rollout::{PlannedBurn, Point, flown};
use steer::turn_nose;

/// How well a pilot flies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Skill {
    /// T between two plans, in r_s/c.
    pub replan_period: f64,
    /// How far a plan looks ahead, in r_s/c.
    pub horizon: f64,
    /// How old its knowledge of the other ship is, in r_s/c.
    pub reaction_delay: f64,
}

impl Default for Skill {
    fn default() -> Self {
        Skill { replan_period: 2.0, horizon: 40.0, reaction_delay: 1.0 }
    }
}

/// The skills of the two sides.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub struct Skills {
    /// Of the player's autopilot.
    pub own: Skill,
    /// Of all others.
    pub enemy: Skill,
}

/// The one source of chance in the simulation.
#[derive(Resource, Debug)]
pub struct Chance(pub StdRng);

impl Chance {
    /// The same seed gives the same chase.
    pub fn from_seed(seed: u64) -> Self {
        Chance(StdRng::seed_from_u64(seed))
    }
}

impl Default for Chance {
    fn default() -> Self {
        Chance::from_seed(0)
    }
}

/// The plan that a pilot follows, and what it last knew. Every [`Pilot`] has one.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct PilotState {
    /// The burn being flown.
    pub burn: PlannedBurn,
    /// T at which it was planned, in r_s/c.
    pub since: f64,
    /// T of the next plan, in r_s/c.
    pub next_plan: f64,
    /// The thrust of a meeting being flown, on rest-frame axes; None while far.
    pub meeting: Option<DVec3>,
    /// What it was planned for.
    pub order: PilotOrder,
    /// T of what it last knew of the other ship, in r_s/c.
    pub known: f64,
    /// Where the nose is to point to fire a bolt, on rest-frame axes, and how far off it may, in radians.
    pub aim: Option<(DVec3, f64)>,
}

impl Default for PilotState {
    fn default() -> Self {
        PilotState { burn: PlannedBurn::COAST, since: 0.0, next_plan: 0.0, meeting: None, order: PilotOrder::Rest, known: 0.0, aim: None }
    }
}

/// The pilots, in `SimSet::Ai`.
pub struct EnemyAiPlugin;

impl Plugin for EnemyAiPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Skills>().init_resource::<Chance>().init_resource::<ChaseRules>().add_systems(
            FixedUpdate,
            (give_orders, beginner::fly_as_beginner, jerky::fly_by_jerks, person::fly_as_person, fly_by_pilot).chain().in_set(SimSet::Ai),
        );
    }
}

/// How long the other ship is watched to tell its thrust, in r_s/c.
const WATCH: f64 = 1.0;
/// How long it is expected to go on as it does, in r_s/c.
const PERSISTENCE: f64 = 4.0;

/// T between two looks at whether a meeting can be flown, in r_s/c.
const MEETING_PERIOD: f64 = 0.25;

type Piloted<'a> = (
    (&'a Pilot, &'a mut PilotState, &'a mut Controls),
    (&'a ShipMotion, &'a Engine, &'a Fuel),
    (Option<&'a Gun>, Option<&'a mut Trigger>),
    Has<Player>,
);
type ByPilot = (Without<Ended>, Without<Manual>, Without<Beginner>, Without<Jerky>, Without<Person>);

/// Every pilot, in scene order, sets the controls of its ship for the coming step.
fn fly_by_pilot(
    clock: Res<Clock>,
    (fleet, skills, rules): (Res<Fleet>, Res<Skills>, Res<ChaseRules>),
    mission: Option<Res<ActiveMission>>,
    mut chance: ResMut<Chance>,
    mut pilots: Query<Piloted, ByPilot>,
    others: Query<(&History, &Engine)>,
) {
    let inside = mission.is_some_and(|mission| mission.0.inside);
    for &entity in &fleet.0 {
        let Ok(((pilot, mut state, mut controls), (motion, engine, fuel), (gun, trigger), is_player)) = pilots.get_mut(entity) else {
            continue;
        };
        let context = PilotContext { state: &motion.0, engine, fuel: fuel.left, now: clock.time, sees: pilot.sees };
        let skill = if is_player { skills.own } else { skills.enemy };
        if state.order != pilot.order {
            *state = PilotState { order: pilot.order, known: state.known, ..PilotState::default() };
        }
        let other = pilot.order.target().map(|ship| others.get(ship));
        let other = match other {
            Some(Ok(other)) => Some(other),
            Some(Err(_)) => continue,
            None => None,
        };
        match pilot.order {
            PilotOrder::Rest => {
                controls.0 = Command::default();
                continue;
            }
            PilotOrder::Turn => {
                controls.0 = Command { thrust: DVec3::ZERO, rates: DVec3::Y * engine.fastest_turn() };
                continue;
            }
            PilotOrder::Face(_) => {
                controls.0 = other
                    .and_then(|(history, _)| context.image(history))
                    .map_or_else(Command::default, |ahead| Command { thrust: DVec3::ZERO, rates: turn_nose(ahead, engine.fastest_turn()) });
                continue;
            }
            PilotOrder::Catch(_) | PilotOrder::Hit(_) | PilotOrder::Escape(_) | PilotOrder::Pass(_) | PilotOrder::Keep(_) => (),
        }
        if clock.time >= state.next_plan {
            let known = other.map(|(history, engine)| (context.reckon(history, skill.reaction_delay, &mut state.known), engine.max_thrust));
            let task = context.task(pilot.order, known, &skill, rules.0.arena_radius, inside);
            state.aim = match (pilot.order, gun) {
                (PilotOrder::Hit(_), Some(gun)) if gun.left > 0 => {
                    aim::lead(&motion.0, &task.other, &task.other_burn).map(|aim| (aim.direction, aim.tolerance))
                }
                _ => None,
            };
            state.meeting = match task.aim {
                Aim::Catch => rendezvous(&task),
                Aim::Pass => intercept(&task),
                Aim::Escape | Aim::Keep(_) => None,
            };
            if state.meeting.is_some() {
                state.next_plan = clock.time + MEETING_PERIOD;
            } else {
                let rest = PlannedBurn { duration: state.burn.duration - (clock.time - state.since), ..state.burn };
                state.burn = plan(&task, &rest, &mut chance.0).0;
                state.since = clock.time;
                state.next_plan = clock.time + if state.aim.is_some() { MEETING_PERIOD } else { skill.replan_period };
            }
        }
        let burning = clock.time - state.since < state.burn.duration;
        let wish =
            state.meeting.unwrap_or_else(|| if burning { Point::from(&motion.0).from_local(state.burn.thrust) } else { DVec3::ZERO });
        controls.0 = command(&motion.0, wish, engine);
        if let Some((direction, tolerance)) = state.aim {
            let ahead = motion.0.attitude.conjugate() * direction;
            controls.0.rates = turn_nose(ahead, engine.fastest_turn());
            if let Some(mut trigger) = trigger {
                trigger.pulled = ahead.angle_between(DVec3::NEG_Z) < tolerance;
            }
        }
    }
}

/// What a pilot knows of its own ship.
struct PilotContext<'a> {
    state: &'a ShipState,
    engine: &'a Engine,
    fuel: f64,
    now: f64,
    sees: Sees,
}

impl PilotContext<'_> {
    /// The ship as an observer.
    fn eye(&self) -> Observer {
        let ShipState { position, momentum, attitude, .. } = *self.state;
        Observer { position, momentum, attitude, field_of_view: 1.0 }
    }

    /// Where the other ship's primary image is, on body axes.
    fn image(&self, history: &History) -> Option<DVec3> {
        apparition(&self.eye(), self.now, history, ImageOrder::ALL[0]).map(|image| image.direction)
    }

    /// The other ship now, and what it burns, from what is known of it `delay` ago. `known`: T of what was known last, which stays where no
    /// light comes any more.
    fn reckon(&self, history: &History, delay: f64, known: &mut f64) -> (Point, PlannedBurn) {
        match self.sees {
            Sees::Now => *known = self.now - delay,
            Sees::Light | Sees::SecondImage => {
                let order = ImageOrder::ALL[usize::from(self.sees == Sees::SecondImage)];
                if let Some(emitted) = emission_time(&self.eye(), self.now - delay, history, order) {
                    *known = emitted;
                }
            }
        }
        reckon(history, self.now, self.now - *known)
    }

    /// What a plan for `order` is made from; `other` is what is known of the ship that it is about, and that ship's thrust.
    fn task(&self, order: PilotOrder, other: Option<((Point, PlannedBurn), f64)>, skill: &Skill, arena_radius: f64, inside: bool) -> Task {
        let own = Point::from(self.state);
        let aim = match order {
            PilotOrder::Escape(_) => Aim::Escape,
            PilotOrder::Pass(_) => Aim::Pass,
            PilotOrder::Keep(radius) => Aim::Keep(radius),
            _ => Aim::Catch,
        };
        let place = match order {
            PilotOrder::Pass(place) => Point { x: place, p: DVec3::ZERO },
            _ => own,
        };
        let ((other, other_burn), other_thrust) = other.unwrap_or(((place, PlannedBurn::COAST), 0.0));
        Task {
            aim,
            own,
            other,
            other_burn,
            max_thrust: if self.fuel > 0.0 { self.engine.max_thrust } else { 0.0 },
            fuel: self.fuel,
            other_thrust,
            horizon: skill.horizon,
            arena_radius,
            inside,
        }
    }
}

/// The other ship now, and what it burns, from what was to be seen of it up to `delay` ago: the burn is the change of its momentum over the
/// last [`WATCH`] beyond free fall, taken to go on for [`PERSISTENCE`].
fn reckon(history: &History, now: f64, delay: f64) -> (Point, PlannedBurn) {
    let seen = |time: f64| {
        let sample = history.at(time);
        Point { x: sample.position, p: sample.momentum }
    };
    let last = seen(now - delay);
    let gained = (last.p - flown(&seen(now - delay - WATCH), WATCH, &PlannedBurn::COAST).p) / WATCH;
    let burn = PlannedBurn { thrust: last.to_local(gained), duration: PERSISTENCE };
    (flown(&last, delay, &burn), burn)
}

/// The command that gives the proper acceleration `wish` (rest-frame axes), the nose (−z) turning to where the engine pushes.
fn command(state: &ShipState, wish: DVec3, engine: &Engine) -> Command {
    let body: DQuat = state.attitude.conjugate();
    let thrust = body * wish;
    let rates = match wish.try_normalize() {
        Some(direction) => turn_nose(body * direction, engine.fastest_turn()),
        None => DVec3::ZERO,
    };
    Command { thrust, rates }
}
