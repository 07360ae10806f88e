//! [`EnemyAiPlugin`]: the pilots. One code flies hunter and quarry; the quarry has the sign of the distance turned.
//!
//! Far away, sampling model-predictive control ([`mod@plan`]); where a meeting can be flown, zero-effort-miss shooting
//! ([`mod@rendezvous`]); the hole is avoided in both. A pilot knows the other ship as it was a reaction delay ago and expects it to go on
//! as it did. Difficulty is thrust, replanning period, horizon and reaction delay, nothing else.

pub mod plan;
pub mod rendezvous;
pub mod rollout;

use bevy::prelude::*;
use glam::{DQuat, DVec3};
use rand::{SeedableRng, rngs::StdRng};

use crate::scene::ship::Ai;
use crate::spacetime::matter::ShipState;

use super::clock::Clock;
use super::flight::Command;
use super::history::History;
use super::ship::{Controls, Ended, Engine, Fleet, Fuel, Pilot, ShipMotion};
use super::{ChaseRules, SimSet};
use plan::{Aim, Task, plan};
use rendezvous::rendezvous;
use rollout::{PlannedBurn, Point};

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
    /// Of those who flee.
    pub quarry: Skill,
    /// Of those who pursue (the autopilot).
    pub hunter: Skill,
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

/// What a pilot has in mind. Every [`Pilot`] has one.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct Mind {
    /// The burn being flown.
    pub burn: PlannedBurn,
    /// T at which it was planned, in r_s/c.
    pub since: f64,
    /// T of the next plan, in r_s/c.
    pub next_plan: f64,
    /// The thrust of a meeting being flown, on rest-frame axes; None while far.
    pub meeting: Option<DVec3>,
}

impl Default for Mind {
    fn default() -> Self {
        Mind { burn: PlannedBurn::COAST, since: 0.0, next_plan: 0.0, meeting: None }
    }
}

/// Marks a ship flown by hand: its pilot, if it has one, keeps its hands off.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct Manual;

/// The pilots, in `SimSet::Ai`.
pub struct EnemyAiPlugin;

impl Plugin for EnemyAiPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Skills>()
            .init_resource::<Chance>()
            .init_resource::<ChaseRules>()
            .add_systems(FixedUpdate, fly_by_pilot.in_set(SimSet::Ai));
    }
}

/// How long the other ship is watched to tell its thrust, in r_s/c.
const WATCH: f64 = 1.0;
/// How long it is expected to go on as it does, in r_s/c.
const PERSISTENCE: f64 = 4.0;

/// T between two looks at whether a meeting can be flown, in r_s/c.
const MEETING_PERIOD: f64 = 0.25;

type Piloted<'a> = (&'a Pilot, &'a mut Mind, &'a mut Controls, &'a ShipMotion, &'a Engine, &'a Fuel);

/// Every pilot, in scene order, sets the controls of its ship for the coming step.
pub fn fly_by_pilot(
    clock: Res<Clock>,
    fleet: Res<Fleet>,
    skills: Res<Skills>,
    rules: Res<ChaseRules>,
    mut chance: ResMut<Chance>,
    mut pilots: Query<Piloted, (Without<Ended>, Without<Manual>)>,
    others: Query<(&History, &Engine)>,
) {
    for &entity in &fleet.0 {
        let Ok((pilot, mut mind, mut controls, motion, engine, fuel)) = pilots.get_mut(entity) else { continue };
        let Ok((other_history, other_engine)) = others.get(pilot.target) else { continue };
        let (aim, skill) = match pilot.ai {
            Ai::Flee => (Aim::Escape, skills.quarry),
            _ => (Aim::Catch, skills.hunter),
        };
        let now = clock.time;
        if now >= mind.next_plan {
            let (other, other_burn) = reckon(other_history, now, skill.reaction_delay);
            let task = Task {
                aim,
                own: Point::from(&motion.0),
                other,
                other_burn,
                max_thrust: if fuel.left > 0.0 { engine.max_thrust } else { 0.0 },
                fuel: fuel.left,
                other_thrust: other_engine.max_thrust,
                horizon: skill.horizon,
                arena_radius: rules.0.arena_radius,
            };
            mind.meeting = if aim == Aim::Catch { rendezvous(&task) } else { None };
            if mind.meeting.is_some() {
                mind.next_plan = now + MEETING_PERIOD;
            } else {
                let rest = PlannedBurn { duration: mind.burn.duration - (now - mind.since), ..mind.burn };
                mind.burn = plan(&task, &rest, &mut chance.0).0;
                mind.since = now;
                mind.next_plan = now + skill.replan_period;
            }
        }
        let wish = mind.meeting.unwrap_or_else(|| {
            if now - mind.since < mind.burn.duration { Point::from(&motion.0).from_local(mind.burn.thrust) } else { DVec3::ZERO }
        });
        controls.0 = command(&motion.0, wish, engine);
    }
}

/// The other ship now, and what it burns, from what was to be seen of it up to `delay` ago: the burn is the change of its momentum over the
/// last [`WATCH`] beyond free fall, taken to go on for [`PERSISTENCE`].
fn reckon(history: &History, now: f64, delay: f64) -> (Point, PlannedBurn) {
    let seen = |time: f64| {
        let sample = history.at(time);
        Point { x: sample.position, p: sample.momentum }
    };
    let fly = |mut point: Point, span: f64, burn: &PlannedBurn| {
        let steps = (span * 2.0).ceil().max(1.0);
        for _ in 0..steps as usize {
            point = rollout::advance(&point, span / steps, |at| burn.acceleration(at, 0.0, 0.0));
        }
        point
    };
    let last = seen(now - delay);
    let gained = (last.p - fly(seen(now - delay - WATCH), WATCH, &PlannedBurn::COAST).p) / WATCH;
    let burn = PlannedBurn { thrust: last.to_local(gained), duration: PERSISTENCE };
    (fly(last, delay, &burn), burn)
}

/// The command that gives the proper acceleration `wish` (rest-frame axes), the nose (−z) turning to where the engine pushes.
fn command(state: &ShipState, wish: DVec3, engine: &Engine) -> Command {
    let body: DQuat = state.attitude.conjugate();
    let thrust = body * wish;
    let rates = match wish.try_normalize() {
        Some(direction) => turn_nose(body * direction, engine.max_rate),
        None => DVec3::ZERO,
    };
    Command { thrust, rates }
}

/// Body rates that turn the nose (−z) towards `direction` (a unit vector on body axes): proportional to the sine of the angle, full when
/// behind.
pub fn turn_nose(direction: DVec3, max_rate: f64) -> DVec3 {
    let axis = DVec3::NEG_Z.cross(direction);
    let wanted = if direction.z > 0.0 { axis.try_normalize().unwrap_or(DVec3::Y) } else { axis };
    wanted * max_rate
}
