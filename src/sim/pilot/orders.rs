//! What the player's autopilot is to do in a mission: the present goal as an order.

use bevy::prelude::*;

use crate::scene::mission::{GoalTask, Mission};
use crate::sim::goals::{ActiveMission, Progress};
use crate::sim::ship::{Fleet, Pilot, PilotOrder};

/// Orders of the present goal for the player's pilot.
pub fn give_orders(mission: Option<Res<ActiveMission>>, progress: Option<Res<Progress>>, fleet: Res<Fleet>, mut pilots: Query<&mut Pilot>) {
    let (Some(mission), Some(progress)) = (mission, progress) else { return };
    let Ok(mut pilot) = pilots.get_mut(progress.own) else { return };
    let order = order(&mission.0, &progress, &fleet);
    if pilot.order != order {
        pilot.order = order;
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
        GoalTask::Hold { ship: index, .. } => ship(index).map(PilotOrder::Catch),
        GoalTask::Hit { ship: index, .. } => ship(index).map(PilotOrder::Hit),
        GoalTask::Reach { least, most, .. } | GoalTask::Whirl { least, most, .. } => Some(PilotOrder::Keep(0.5 * (least + most))),
        GoalTask::Survive { .. } => pursuer.map(PilotOrder::Escape),
        GoalTask::Gates => mission.gates.get(progress.gates).map(|gate| PilotOrder::Pass(gate.position)),
    };
    order.unwrap_or(PilotOrder::Rest)
}

/// A radius far enough from any start, in r_s, that going there takes thrust.
const BURN_TO: f64 = 15.0;
