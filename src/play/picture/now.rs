//! The chase as it is in this frame, between the last two steps of the simulation.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use crate::play::missions::Ghost;
use crate::play::session::Session;
use crate::sim::bolts::{Bolt, Gun};
use crate::sim::goals::catch_radius;
use crate::sim::{ActiveMission, Bolts, Chase, ChaseRules, Clock, Controls, Engine, Fleet, Fuel, History, Progress, SimEvent};

/// T of the frame, in r_s/c: at most a step before the clock's.
pub fn time(clock: &Clock, fixed: &Time<Fixed>) -> f64 {
    (clock.time - clock.step * (1.0 - fixed.overstep_fraction_f64())).max(0.0)
}

/// What the picture and the HUD are made of.
#[derive(SystemParam)]
pub struct Now<'w, 's> {
    /// What is played.
    pub session: Res<'w, Session>,
    /// The chase, once it has begun.
    pub chase: Option<Res<'w, Chase>>,
    clock: Res<'w, Clock>,
    fixed: Res<'w, Time<Fixed>>,
    fleet: Res<'w, Fleet>,
    bolts: Res<'w, Bolts>,
    /// The rules in force.
    pub rules: Res<'w, ChaseRules>,
    ghost: Option<Res<'w, Ghost>>,
    /// The mission and how far it has come.
    pub mission: Option<Res<'w, ActiveMission>>,
    /// See `mission`.
    pub progress: Option<Res<'w, Progress>>,
    guns: Query<'w, 's, &'static Gun>,
    ships: Query<'w, 's, (&'static History, &'static Engine, &'static Controls, &'static Fuel)>,
}

impl Now<'_, '_> {
    /// How far the frame is through the last step, 0 to 1.
    pub fn share(&self) -> f64 {
        self.fixed.overstep_fraction_f64()
    }

    /// T of the frame, in r_s/c: at most a step before the clock's.
    pub fn time(&self) -> f64 {
        time(&self.clock, &self.fixed)
    }

    /// T of the last step, in r_s/c.
    pub fn clock(&self) -> f64 {
        self.clock.time
    }

    /// The ships' worldlines, in scene order, then the ghost's and the bolts'.
    pub fn histories(&self) -> Vec<&History> {
        let ships = self.fleet.0.iter().filter_map(|&ship| self.ships.get(ship).ok()).map(|ship| ship.0);
        ships.chain(self.ghost.iter().map(|ghost| &ghost.0)).chain(self.bolts.0.iter().map(|bolt| &bolt.history)).collect()
    }

    /// The player's worldline, engine, controls and tank; None before the chase has begun.
    pub fn own(&self) -> Option<(&History, &Engine, &Controls, &Fuel)> {
        self.fleet.0.get(self.session.player()).and_then(|&ship| self.ships.get(ship).ok())
    }

    /// The player's gun, in a mission.
    pub fn gun(&self) -> Option<Gun> {
        self.fleet.0.get(self.session.player()).and_then(|&ship| self.guns.get(ship).ok()).copied()
    }

    /// The player's bolt of which this event tells that it hit.
    pub fn bolt_that_hit(&self, event: &SimEvent) -> Option<&Bolt> {
        let SimEvent::Hit { time, .. } = event else { return None };
        let own = self.fleet.0.get(self.session.player())?;
        self.bolts.0.iter().find(|bolt| bolt.owner == *own && bolt.ended == Some(*time))
    }

    /// How near the target must be to be caught, in r_s; None where the present goal is another.
    pub fn reach(&self) -> Option<f64> {
        catch_radius(self.mission.as_deref(), self.progress.as_deref(), &self.rules)
    }

    /// The worldline of the ship that the player is after, and its index.
    pub fn target(&self) -> Option<(usize, &History)> {
        let index = target_index(&self.session, self.mission.is_some(), &self.fleet, self.chase.as_deref())?;
        let ship = self.fleet.0.get(index)?;
        Some((index, self.ships.get(*ship).ok()?.0))
    }
}

/// Index of the ship that the player is after: in a mission the one that the present goal is about, else the one that the scene names.
pub fn target_index(session: &Session, in_mission: bool, fleet: &Fleet, chase: Option<&Chase>) -> Option<usize> {
    if !in_mission {
        return session.target();
    }
    let quarry = chase.and_then(|chase| chase.quarry)?;
    fleet.0.iter().position(|&ship| ship == quarry)
}
