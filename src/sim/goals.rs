//! A mission's goals: what is done of them after each step, how the mission ends (in `SimSet::Rules`, instead of the plain chase), and what
//! the player's autopilot is to do: the present goal as an order.

use std::sync::Arc;

use bevy::prelude::*;
use glam::{DQuat, DVec3};

use super::clock::Clock;
use super::history::{History, rotation};
use super::pilot::rollout::Point;
use super::player_commands::PlayerCommands;
use super::rules::{Chase, ChaseRules, Outcome, judge_chase};
use super::ship::{Controls, CrossedHorizon, Ended, Engine, Fleet, Fuel, Pilot, PilotOrder, ShipMotion};
use super::sight::apparition;
use super::{SimEvent, SimSet, bolts::Hits};
use crate::scene::mission::{GoalTask, Mission};
use crate::spacetime::Observer;
use crate::spacetime::light::Order;
use crate::spacetime::matter::ShipState;

/// The mission that is flown.
#[derive(Resource, Clone, Debug)]
pub struct ActiveMission(pub Arc<Mission>);

/// How far the mission has come.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct Progress {
    /// The player's ship.
    pub own: Entity,
    /// Index of the goal that is to be done now; as many as there are goals when all are done.
    pub goal: usize,
    /// How much of it is done, in the unit of [`needed`].
    pub done: f64,
    /// Gates that were flown through.
    pub gates: usize,
    /// For how long a pursuer has held the player's ship, in r_s/c of T.
    pub held_by: f64,
    /// The player's ship before the step.
    before: Before,
}

/// What the steps' changes are told from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Before {
    position: DVec3,
    attitude: DQuat,
    fuel: f64,
}

impl Progress {
    /// At the beginning of a mission whose player's ship is `own`.
    pub fn new(own: Entity, state: &ShipState, fuel: f64) -> Progress {
        let before = Before { position: state.position, attitude: state.attitude, fuel };
        Progress { own, goal: 0, done: 0.0, gates: 0, held_by: 0.0, before }
    }

    /// The share of the present goal that is done, of 1.
    pub fn share(&self, mission: &Mission, rules: &ChaseRules) -> f64 {
        let whole = mission.goals.get(self.goal).map_or(1.0, |goal| needed(&goal.task, mission, rules));
        if whole > 0.0 { (self.done / whole).clamp(0.0, 1.0) } else { 0.0 }
    }
}

/// How much of a task is all of it: c of Δv, radians, turns, hits, gates, or r_s/c of T.
pub fn needed(task: &GoalTask, mission: &Mission, rules: &ChaseRules) -> f64 {
    match *task {
        GoalTask::Burn { amount } => amount,
        GoalTask::Turn { angle } => angle,
        GoalTask::Coast { span } | GoalTask::Look { span, .. } | GoalTask::Reach { span, .. } | GoalTask::Match { span, .. } => span,
        GoalTask::Hold { span, .. } => {
            if span.is_nan() {
                rules.0.hold_time
            } else {
                span
            }
        }
        GoalTask::Hit { times, .. } => f64::from(times),
        GoalTask::Survive { until, .. } => until,
        GoalTask::Gates => mission.gates.len() as f64,
        GoalTask::Whirl { turns, .. } => turns,
    }
}

/// How near the target must be to be caught or flown with, in r_s; None where the present goal of a mission is another.
pub fn catch_radius(mission: Option<&ActiveMission>, progress: Option<&Progress>, rules: &ChaseRules) -> Option<f64> {
    let Some((mission, progress)) = mission.zip(progress) else { return Some(rules.0.capture_radius) };
    match mission.0.goals.get(progress.goal)?.task {
        GoalTask::Hold { distance, .. } => Some(distance.unwrap_or(rules.0.capture_radius)),
        GoalTask::Match { distance, .. } => Some(distance),
        _ => None,
    }
}

/// The order of the present goal.
fn order(mission: &Mission, progress: &Progress, fleet: &Fleet) -> PilotOrder {
    let ship = |index: usize| fleet.0.get(index).copied();
    let pursuer = mission.caught_by.first().and_then(|&index| ship(index));
    let Some(goal) = mission.goals.get(progress.goal) else { return PilotOrder::Rest };
    // Below the horizon one comes by falling: what is to be done then is begun before.
    let falls = matches!(goal.task, GoalTask::Reach { most, .. } if most <= 1.0);
    let goal = if falls { mission.goals.get(progress.goal + 1).unwrap_or(goal) } else { goal };
    let order = match goal.task {
        GoalTask::Burn { .. } => Some(PilotOrder::Keep(BURN_TO)),
        GoalTask::Turn { .. } => Some(PilotOrder::Turn),
        GoalTask::Coast { .. } => Some(PilotOrder::Rest),
        GoalTask::Look { ship: index, .. } => ship(index).map(PilotOrder::Face),
        GoalTask::Hold { ship: index, .. } | GoalTask::Match { ship: index, .. } => ship(index).map(PilotOrder::Catch),
        GoalTask::Hit { ship: index, .. } => ship(index).map(PilotOrder::Hit),
        GoalTask::Reach { least, most, .. } | GoalTask::Whirl { least, most, .. } => Some(PilotOrder::Keep(0.5 * (least + most))),
        GoalTask::Survive { .. } => pursuer.map(PilotOrder::Escape),
        GoalTask::Gates => mission.gates.get(progress.gates).map(|gate| PilotOrder::Pass(gate.position)),
    };
    order.unwrap_or(PilotOrder::Rest)
}

/// A radius far enough from any start, in r_s, that going there takes thrust.
const BURN_TO: f64 = 15.0;
/// A ship coasts with less than this share of its engine's thrust.
const COASTING: f64 = 0.05;

/// Judges missions.
pub struct GoalsPlugin;

impl Plugin for GoalsPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(FixedUpdate, judge_mission.run_if(resource_exists::<Progress>).after(judge_chase).in_set(SimSet::Rules));
    }
}

/// Orders of the present goal for the player's pilot.
pub fn give_orders(mission: Option<Res<ActiveMission>>, progress: Option<Res<Progress>>, fleet: Res<Fleet>, mut pilots: Query<&mut Pilot>) {
    let (Some(mission), Some(progress)) = (mission, progress) else { return };
    let Ok(mut pilot) = pilots.get_mut(progress.own) else { return };
    let order = order(&mission.0, &progress, &fleet);
    if pilot.order != order {
        pilot.order = order;
    }
}

type Seen<'a> = (&'a ShipMotion, &'a History, &'a Fuel, &'a Controls, &'a Engine, Option<&'a Hits>, Has<CrossedHorizon>, Has<Ended>);

/// Runs after the ships have flown: `clock.time` is the T of their states.
fn judge_mission(
    (clock, rules, commands): (Res<Clock>, Res<ChaseRules>, Res<PlayerCommands>),
    mission: Res<ActiveMission>,
    fleet: Res<Fleet>,
    mut progress: ResMut<Progress>,
    mut chase: ResMut<Chase>,
    ships: Query<Seen>,
    mut events: MessageWriter<SimEvent>,
) {
    if chase.outcome.is_some() {
        return;
    }
    let Ok((own, _, fuel, ..)) = ships.get(progress.own) else { return };
    let mission = &*mission.0;
    let step = Step { clock: &clock, rules: &rules, commands: &commands, fleet: &fleet, ships: &ships };
    let outcome = step.lost(mission, &mut progress).or_else(|| {
        if let Some(goal) = mission.goals.get(progress.goal) {
            progress.done = step.done(&goal.task, mission, &mut progress);
            // Sums of steps are a rounding short; what takes no time must still be so.
            if progress.done > 0.0 && progress.done >= needed(&goal.task, mission, &rules) - 1e-9 {
                progress.goal += 1;
                progress.done = 0.0;
                events.write(SimEvent::GoalDone { goal: progress.goal, time: clock.time });
            }
        }
        (progress.goal >= mission.goals.len()).then_some(Outcome::Done)
    });
    progress.before = Before { position: own.0.position, attitude: own.0.attitude, fuel: fuel.left };
    // The target is the ship that the present goal is about.
    let about = mission.goals.get(progress.goal).and_then(|goal| goal.task.ship());
    chase.quarry = about.and_then(|index| fleet.0.get(index).copied()).or(chase.quarry);
    chase.held = progress.done;
    if let Some(outcome) = outcome {
        chase.outcome = Some((outcome, clock.time));
        events.write(SimEvent::Decided { outcome, time: clock.time });
    }
}

/// What a step is judged by.
struct Step<'a, 'w, 's, 'q> {
    clock: &'a Clock,
    rules: &'a ChaseRules,
    commands: &'a PlayerCommands,
    fleet: &'a Fleet,
    ships: &'a Query<'w, 's, Seen<'q>>,
}

impl Step<'_, '_, '_, '_> {
    fn state(&self, ship: usize) -> Option<ShipState> {
        Some(self.ships.get(*self.fleet.0.get(ship)?).ok()?.0.0)
    }

    /// Whether a ship is gone; `inside`: only at the singularity.
    fn is_lost(&self, ship: usize, inside: bool) -> bool {
        let Some(Ok((.., crossed, ended))) = self.fleet.0.get(ship).map(|&entity| self.ships.get(entity)) else { return true };
        ended || (crossed && !inside)
    }

    /// How the mission was lost in this step, if it was.
    fn lost(&self, mission: &Mission, progress: &mut Progress) -> Option<Outcome> {
        let Ok((own, .., crossed, ended)) = self.ships.get(progress.own) else { return None };
        if ended || (crossed && !mission.inside) {
            return Some(Outcome::ShipLost);
        }
        let near = |&ship: &usize| {
            let there = self.state(ship);
            there.is_some_and(|there| there.position.distance(own.0.position) <= self.rules.0.capture_radius)
                && !self.is_lost(ship, mission.inside)
        };
        progress.held_by = if mission.caught_by.iter().any(near) { progress.held_by + self.clock.step } else { 0.0 };
        if !mission.caught_by.is_empty() && progress.held_by >= self.rules.0.hold_time {
            return Some(Outcome::Taken);
        }
        let goal = mission.goals.get(progress.goal)?;
        // Also what a later goal is about.
        let to_come = mission.goals.iter().skip(progress.goal).filter_map(|goal| goal.task.ship());
        let gone = to_come.into_iter().any(|ship| self.is_lost(ship, mission.inside));
        let late = self.clock.time >= self.rules.0.time_limit.min(goal.before) - 1e-9;
        // Who is to survive until the limit has done so when it comes.
        let surviving = matches!(goal.task, GoalTask::Survive { until, .. } if self.clock.time >= until);
        let r = own.0.position.length();
        let strayed = matches!(goal.task, GoalTask::Survive { least, most, .. } if !(least..=most).contains(&r));
        if gone {
            Some(Outcome::QuarryLost)
        } else if strayed {
            Some(Outcome::Strayed)
        } else if (late && !surviving) || own.0.proper_time > mission.proper_limit {
            Some(Outcome::TimeOut)
        } else {
            None
        }
    }

    /// How much of the present goal is done after this step.
    fn done(&self, task: &GoalTask, mission: &Mission, progress: &mut Progress) -> f64 {
        let Ok((own, _, fuel, controls, engine, ..)) = self.ships.get(progress.own) else { return 0.0 };
        let (own, before, so_far) = (own.0, progress.before, progress.done);
        let lasts = |holds: bool| if holds { so_far + self.clock.step } else { 0.0 };
        let r = own.position.length();
        match *task {
            GoalTask::Burn { .. } if before.fuel.is_finite() => so_far + (before.fuel - fuel.left).max(0.0),
            GoalTask::Burn { .. } => so_far + engine.thrust(controls.0.thrust).length() * self.clock.step,
            GoalTask::Turn { .. } => so_far + rotation(before.attitude, own.attitude).length(),
            // The assist goes on with a little, as drift fades.
            // Who has let go by hand has done what was asked, whatever the assist does.
            GoalTask::Coast { .. } => {
                let let_go = !self.commands.autopilot && self.commands.thrust == [0; 3] && !self.commands.matching;
                lasts(let_go || controls.0.thrust.length() < COASTING * engine.max_thrust)
            }
            GoalTask::Look { ship, angle, .. } => lasts(self.commands.looking || self.is_ahead(&own, ship, angle)),
            GoalTask::Reach { least, most, .. } => lasts((least..=most).contains(&r)),
            GoalTask::Hold { ship, distance, .. } => {
                let distance = distance.unwrap_or(self.rules.0.capture_radius);
                lasts(self.state(ship).is_some_and(|there| there.position.distance(own.position) <= distance))
            }
            GoalTask::Match { ship, distance, speed, .. } => {
                let velocity = |state: &ShipState| Point::from(state).velocity();
                lasts(self.state(ship).is_some_and(|there| {
                    there.position.distance(own.position) <= distance && (velocity(&there) - velocity(&own)).length() <= speed
                }))
            }
            GoalTask::Hit { ship, .. } => {
                let hits = self.fleet.0.get(ship).and_then(|&entity| self.ships.get(entity).ok()).and_then(|seen| seen.5);
                hits.map_or(0.0, |hits| f64::from(hits.0))
            }
            GoalTask::Survive { .. } => self.clock.time,
            GoalTask::Gates => {
                if mission.gates.get(progress.gates).is_some_and(|gate| gate.is_passed(before.position, own.position)) {
                    progress.gates += 1;
                }
                progress.gates as f64
            }
            GoalTask::Whirl { least, most, .. } => {
                let swept = before.position.angle_between(own.position) / std::f64::consts::TAU;
                if (least..=most).contains(&r) { so_far + swept } else { so_far }
            }
        }
    }

    /// Whether the primary image of a ship is within `angle` of the nose.
    fn is_ahead(&self, own: &ShipState, ship: usize, angle: f64) -> bool {
        let history = self.fleet.0.get(ship).and_then(|&entity| self.ships.get(entity).ok()).map(|seen| seen.1);
        let camera = Observer { position: own.position, momentum: own.momentum, attitude: own.attitude, field_of_view: 1.0 };
        let image = history.and_then(|history| apparition(&camera, self.clock.time, history, Order::ALL[0]));
        image.is_some_and(|image| image.direction.angle_between(DVec3::NEG_Z) <= angle)
    }
}
