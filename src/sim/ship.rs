//! Ships as entities, and how a scene puts them into a world.

use bevy::prelude::*;

use glam::DVec3;

use crate::scene::ship::{Burn, Sees, ShipSpec};
use crate::spacetime::matter::ShipState;

use super::flight::Command;

/// A ship.
#[derive(Component, Clone, Debug, PartialEq, Eq)]
pub struct Ship {
    /// Its name in the scene.
    pub name: String,
    /// Its place in the scene's order.
    pub index: usize,
}

/// A ship's state at [`super::Clock::time`] (r_s = c = 1).
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct ShipMotion(pub ShipState);

/// What the pilot asks for, constant over a step; the engine's limits are applied when it is flown.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct Controls(pub Command);

/// Δv left, in c: ∫ |proper acceleration| dτ. Without it one coasts.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct Fuel {
    /// Left now; infinite for a ship without limits.
    pub left: f64,
    /// At the start.
    pub capacity: f64,
}

impl Fuel {
    /// The Δv spent so far, in c; 0 where the tanks have no bottom.
    pub fn spent(&self) -> f64 {
        if self.capacity.is_finite() { self.capacity - self.left } else { 0.0 }
    }
}

/// What the ship can do.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct Engine {
    /// The most proper acceleration, any direction, in c²/r_s.
    pub max_thrust: f64,
    /// The fastest turn, in rad per proper r_s/c.
    pub max_rate: f64,
}

impl Engine {
    /// `command` cut to what the engine can do; a command that is not finite is none.
    pub fn limit(&self, command: &Command) -> Command {
        let limited = |v: DVec3, max: f64| if v.is_finite() { v.clamp_length_max(max) } else { DVec3::ZERO };
        Command { thrust: limited(command.thrust, self.max_thrust), rates: limited(command.rates, self.max_rate) }
    }
}

/// The scene's thrust programme, flown instead of the controls while it burns.
#[derive(Component, Clone, Debug, Default, PartialEq)]
pub struct Programme(pub Vec<Burn>);

/// Who flies where nobody does by hand.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct Pilot {
    /// What it is to do.
    pub order: PilotOrder,
    /// By what it knows other ships.
    pub sees: Sees,
}

/// What a pilot is to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PilotOrder {
    /// Nothing: coast.
    Rest,
    /// Be with this ship, soon.
    Catch(Entity),
    /// Hit this ship with bolts.
    Hit(Entity),
    /// Stay away from this ship.
    Escape(Entity),
    /// Turn the nose to the image of this ship.
    Face(Entity),
    /// Turn round.
    Turn,
    /// Fly through this place (r_s), at any speed.
    Pass(DVec3),
    /// Stay about this radius (r_s).
    Keep(f64),
}

impl PilotOrder {
    /// The ship that it is about.
    pub fn target(self) -> Option<Entity> {
        match self {
            PilotOrder::Catch(ship) | PilotOrder::Hit(ship) | PilotOrder::Escape(ship) | PilotOrder::Face(ship) => Some(ship),
            PilotOrder::Rest | PilotOrder::Turn | PilotOrder::Pass(_) | PilotOrder::Keep(_) => None,
        }
    }
}

/// Marks the ship that a player flies where there is one.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct Player;

/// Marks a ship flown by hand: its pilot, if it has one, keeps its hands off.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct Manual;

/// Set once the ship is inside r = 1: the T at which it went through, in r_s/c.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct CrossedHorizon(pub f64);

/// Why a ship is no more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EndReason {
    /// It came to r ≤ 0.01 r_s (`matter::SINGULARITY_RADIUS`).
    Singularity,
    /// Its numbers overflowed.
    NotFinite,
}

impl std::fmt::Display for EndReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            EndReason::Singularity => "reached the singularity",
            EndReason::NotFinite => "left the range of numbers",
        })
    }
}

/// Set on a ship that is no more; its motion stays at the last state.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct Ended {
    /// T in r_s/c.
    pub time: f64,
    /// Why.
    pub reason: EndReason,
}

/// All ships in scene order: systems go through them in this order, never in the order of storage.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct Fleet(pub Vec<Entity>);

impl Fleet {
    /// The entity of the ship `name`.
    pub fn find(&self, name: &str, specs: &[ShipSpec]) -> Option<Entity> {
        specs.iter().position(|spec| spec.name == name).and_then(|index| self.0.get(index).copied())
    }
}
