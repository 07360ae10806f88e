//! What a player is after, and what leads there.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use glam::DVec3;

use super::assist::AssistMode;
use super::goals::{ActiveMission, Progress, catch_radius};
use super::history::History;
use super::intercept::{Advice, Way};
use super::known::{Known, eye, known, resting};
use super::pilot::rollout::Point;
use super::rules::{Chase, ChaseRules};
use super::ship::{Pilot, PilotOrder};
use super::sight::apparition;
use crate::scene::mission::GoalTask;
use crate::spacetime::light::Order;
use crate::spacetime::matter::ShipState;

/// What a player is after.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// A ship.
    Ship(Entity),
    /// The next gate: a place that rests, and its radius, in r_s.
    Gate(DVec3, f64),
}

/// What the pilot of a ship is after, and what is known of it.
#[derive(SystemParam)]
pub struct Targets<'w, 's> {
    chase: Option<Res<'w, Chase>>,
    mission: Option<Res<'w, ActiveMission>>,
    progress: Option<Res<'w, Progress>>,
    rules: Option<Res<'w, ChaseRules>>,
    pilots: Query<'w, 's, &'static Pilot>,
    histories: Query<'w, 's, &'static History>,
}

impl Targets<'_, '_> {
    /// What `own` is after: in a mission what the present goal is about.
    pub fn of(&self, own: Entity) -> Option<Target> {
        match (&self.mission, &self.progress) {
            (Some(mission), Some(progress)) => {
                let gates = mission.0.goals.get(progress.goal).is_some_and(|goal| goal.task == GoalTask::Gates);
                if gates {
                    return mission.0.gates.get(progress.gates).map(|gate| Target::Gate(gate.position, gate.radius));
                }
                self.chase.as_ref()?.quarry.map(Target::Ship)
            }
            _ => self.pilots.get(own).ok().map(|pilot| pilot.order).and_then(PilotOrder::target).map(Target::Ship),
        }
    }

    /// What is known of it at T = `time` in the ship `own` in this state.
    pub fn known(&self, own: Entity, state: &ShipState, time: f64) -> Option<Known> {
        match self.of(own)? {
            Target::Ship(ship) => known(state, time, self.histories.get(ship).ok()?, self.tells_now()),
            Target::Gate(place, _) => resting(place),
        }
    }

    /// Where the first image of the ship that `own` is after is seen from it, on body axes.
    pub fn image(&self, own: Entity, state: &ShipState, time: f64) -> Option<DVec3> {
        let Some(Target::Ship(ship)) = self.of(own) else { return None };
        Some(apparition(&eye(state), time, self.histories.get(ship).ok()?, Order::ALL[0])?.direction)
    }

    /// How near it must come to what it is after, in r_s: to catch a ship, to fly through a gate. None where the goal is another.
    pub fn reach(&self, own: Entity) -> Option<f64> {
        match self.of(own)? {
            Target::Ship(_) => catch_radius(self.mission.as_deref(), self.progress.as_deref(), self.rules.as_deref()?),
            Target::Gate(_, radius) => Some(radius),
        }
    }

    /// What leads `own`, with an engine of `thrust` (c²/r_s), to the ship that it is after, and is known so at T = `time`. None where nothing
    /// is advised: only to a ship that is to be flown with outside the horizon. Through a gate one flies, and inside there is no time to meet.
    pub fn advice(&self, (own, way): (Entity, &mut Way), state: &ShipState, known: &Known, time: f64, thrust: f64) -> Option<Advice> {
        let inside = self.mission.as_ref().is_some_and(|mission| mission.0.inside);
        let Some(Target::Ship(_)) = self.of(own).filter(|_| !inside) else { return None };
        way.follow(&Point::from(state), known, time, thrust, self.reach(own)?)
    }

    /// Where the nose of `own` is of most use, a unit vector on body axes: where thrust leads to what it is after, else to where that is now
    /// as far as is known. And the assist that serves on that way.
    pub fn mark(&self, (own, way): (Entity, &mut Way), state: &ShipState, time: f64, thrust: f64) -> Option<(DVec3, AssistMode)> {
        let known = self.known(own, state, time)?;
        let advice = self.advice((own, way), state, &known, time, thrust);
        let towards = advice.and_then(Advice::thrust).map_or(known.point.x - state.position, |intercept| intercept.push);
        let mark = state.attitude.conjugate() * towards.try_normalize()?;
        Some((mark, advice.map_or(AssistMode::Target, |advice| advice.assist(state.position.length(), mark))))
    }

    /// Whether the mission tells where ships are now.
    pub fn tells_now(&self) -> bool {
        self.mission.as_ref().is_none_or(|mission| mission.0.now_marker)
    }
}
