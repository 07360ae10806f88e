//! From a scene and `game.toml` to a world at T = 0.

use super::pilot::Mind;
use crate::scene::ship::{Ai, ShipSpec};
use bevy::prelude::*;

use crate::scene::{GameConfig, Scene};

use super::clock::Clock;
use super::history::History;
use super::pilot::{Chance, Manual, Skill, Skills};
use super::rules::{Chase, ChaseRules, begin_chase};
use super::ship::{Controls, Engine, Fleet, Fuel, Pilot, Player, Programme, Ship, ShipMotion};

/// Starts `scene` (again): clock at T = 0, ships where the scene puts them, chance from `seed`. The plugins [`super::SimulationPlugins`]
/// must be there. The player's ship, too, is flown by its AI until [`set_manual`] takes it over.
pub fn start(world: &mut World, scene: &Scene, config: &GameConfig, seed: u64) {
    world.insert_resource(Clock::new(config.clock.step));
    world.insert_resource(Chance::from_seed(seed));
    world.insert_resource(skills(config));
    world.insert_resource(ChaseRules(scene.rules(config)));
    muster(world, &scene.ships, &defaults(config), 0.0);
    begin_chase(world);
}

/// Takes the player's ship from its AI (true), or gives it back (false).
pub fn set_manual(world: &mut World, manual: bool) {
    let Some(fleet) = world.get_resource::<Fleet>().cloned() else { return };
    for entity in fleet.0 {
        if world.get::<Player>(entity).is_some() {
            if manual {
                world.entity_mut(entity).insert(Manual);
            } else {
                world.entity_mut(entity).remove::<Manual>();
            }
        }
    }
}

/// How the chase ended, if it has, and at which T.
pub fn outcome(world: &World) -> Option<(super::Outcome, f64)> {
    world.get_resource::<Chase>().and_then(|chase| chase.outcome)
}

/// The quarry's skill from `[enemy]`; the autopilot's is its own default.
pub fn skills(config: &GameConfig) -> Skills {
    let enemy = &config.enemy;
    Skills {
        quarry: Skill { replan_period: enemy.replan_period, horizon: enemy.horizon, reaction_delay: enemy.reaction_delay },
        hunter: Skill::default(),
    }
}

fn defaults(config: &GameConfig) -> Defaults {
    Defaults {
        hunter_thrust: config.ship.thrust,
        hunter_fuel: config.ship.fuel,
        quarry_thrust: config.enemy.thrust,
        quarry_fuel: config.enemy.fuel,
        // Turns are given by the wall second; the simulation wants them by the r_s/c.
        max_rate: config.ship.turn_rate / config.clock.pace,
    }
}

/// What a scene leaves open, from the game's configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Defaults {
    /// For the player and those who pursue, c²/r_s.
    pub hunter_thrust: f64,
    /// Δv, in c.
    pub hunter_fuel: f64,
    /// For those who flee, c²/r_s.
    pub quarry_thrust: f64,
    /// Δv, in c.
    pub quarry_fuel: f64,
    /// The fastest turn, rad per proper r_s/c.
    pub max_rate: f64,
}

/// Spawns the ships of a scene in its order and inserts the [`Fleet`]. Ships of an earlier scene are despawned.
pub fn muster(world: &mut World, specs: &[ShipSpec], defaults: &Defaults, time: f64) {
    if let Some(old) = world.remove_resource::<Fleet>() {
        for entity in old.0 {
            world.despawn(entity);
        }
    }
    let fleet = Fleet(specs.iter().enumerate().map(|(index, spec)| spawn(world, index, spec, defaults, time)).collect());
    for (index, spec) in specs.iter().enumerate() {
        let first_other = (0..specs.len()).find(|&other| other != index);
        let target = spec.target.as_ref().map_or(first_other.map(|other| fleet.0[other]), |name| fleet.find(name, specs));
        if let (true, Some(target)) = (spec.ai != Ai::None, target) {
            world.entity_mut(fleet.0[index]).insert((Pilot { ai: spec.ai, target }, Mind::default()));
        }
    }
    world.insert_resource(fleet);
}

fn spawn(world: &mut World, index: usize, spec: &ShipSpec, defaults: &Defaults, time: f64) -> Entity {
    let (thrust, tank) = match (spec.ai, spec.player) {
        (Ai::Flee, false) => (defaults.quarry_thrust, defaults.quarry_fuel),
        (Ai::None, false) => (defaults.hunter_thrust, f64::INFINITY),
        _ => (defaults.hunter_thrust, defaults.hunter_fuel),
    };
    let fuel = if spec.fuel.is_finite() { spec.fuel } else { tank };
    let mut entity = world.spawn((
        Ship { name: spec.name.clone(), index },
        ShipMotion(spec.state),
        Controls::default(),
        Fuel { left: fuel, capacity: fuel },
        Engine { max_thrust: spec.max_thrust.unwrap_or(thrust), max_rate: defaults.max_rate },
        Programme(spec.programme.clone()),
        History::new(time, &spec.state),
    ));
    if spec.player {
        entity.insert(Player);
    }
    entity.id()
}
