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

/// The body rates in force, rad per proper r_s/c: those of the last step.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct Turning(pub DVec3);

/// The fastest that the farthest vertex of a ship goes round its centre, in c, in the ship's own frame. So fast a body keeps its shape to
/// 1/γ = 0.97, and no vertex outruns light however the centre moves.
pub const TIP_SPEED: f64 = 0.25;

/// What the ship can do.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct Engine {
    /// The most proper acceleration, any direction, in c²/r_s.
    pub max_thrust: f64,
    /// The fastest turn that is asked for, in rad per proper r_s/c.
    pub max_rate: f64,
    /// Distance of the ship's farthest vertex from its centre, in r_s.
    pub reach: f64,
}

impl Engine {
    /// The fastest turn, in rad per proper r_s/c: as asked for, and no vertex faster than [`TIP_SPEED`].
    pub fn fastest_turn(&self) -> f64 {
        self.max_rate.min(TIP_SPEED / self.reach)
    }

    /// How fast the turn changes at most, in rad per (r_s/c)² of proper time. A ship takes up its fastest turn while light crosses it once,
    /// from tip to tip: no sooner can one end of a body follow the other.
    pub fn turn_acceleration(&self) -> f64 {
        TIP_SPEED / (2.0 * self.reach * self.reach)
    }

    /// The thrust (body axes, c²/r_s) that the engine gives where `wanted` is asked for; what is not finite is none.
    pub fn thrust(&self, wanted: DVec3) -> DVec3 {
        limited(wanted, self.max_thrust)
    }

    /// The body rates (rad per proper r_s/c) over the coming `span` of proper time (r_s/c), where `wanted` are asked for and `turning` are
    /// in force; what is not finite is none.
    pub fn turn(&self, wanted: DVec3, turning: DVec3, span: f64) -> DVec3 {
        turning + limited(limited(wanted, self.fastest_turn()) - turning, self.turn_acceleration() * span)
    }
}

fn limited(v: DVec3, max: f64) -> DVec3 {
    if v.is_finite() { v.clamp_length_max(max) } else { DVec3::ZERO }
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
