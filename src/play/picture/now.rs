//! The chase as it is in this frame, between the last two steps of the simulation.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use crate::play::session::Session;
use crate::sim::{Chase, Clock, Controls, Engine, Fleet, Fuel, History};

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
    ships: Query<'w, 's, (&'static History, &'static Engine, &'static Controls, &'static Fuel)>,
}

impl Now<'_, '_> {
    /// T of the frame, in r_s/c: at most a step before the clock's.
    pub fn time(&self) -> f64 {
        (self.clock.time - self.clock.step * (1.0 - self.fixed.overstep_fraction_f64())).max(0.0)
    }

    /// T of the last step, in r_s/c.
    pub fn clock(&self) -> f64 {
        self.clock.time
    }

    /// The ships' worldlines, in scene order.
    pub fn histories(&self) -> Vec<&History> {
        self.fleet.0.iter().filter_map(|&ship| self.ships.get(ship).ok()).map(|ship| ship.0).collect()
    }

    /// The player's worldline, engine, controls and tank; None before the chase has begun.
    pub fn own(&self) -> Option<(&History, &Engine, &Controls, &Fuel)> {
        self.fleet.0.get(self.session.player()).and_then(|&ship| self.ships.get(ship).ok())
    }

    /// The worldline of the ship that the player is after, and its index.
    pub fn target(&self) -> Option<(usize, &History)> {
        let index = self.session.target()?;
        let ship = self.fleet.0.get(index)?;
        Some((index, self.ships.get(*ship).ok()?.0))
    }
}
