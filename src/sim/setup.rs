//! From a scene and `game.toml` to a world at T = 0.

use bevy::prelude::*;

use crate::scene::{GameConfig, Scene};

use super::clock::Clock;
use super::pilot::{Chance, Manual, Skill, Skills};
use super::rules::{Chase, ChaseRules, begin_chase};
use super::ship::{Defaults, Fleet, Player, muster};

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
