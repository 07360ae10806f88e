//! A scene played to one moment: what a picture of it needs.

use bevy::prelude::*;

use crate::scene::{GameConfig, Scene};
use crate::spacetime::matter::ShipState;

use super::{Clock, Fleet, History, ShipMotion, app_of, outcome};

/// A scene with its ships at a time T.
pub struct Moment {
    world: App,
    names: Vec<String>,
}

impl Moment {
    /// Plays the scene from T = 0 to T = `at`.
    pub fn new(scene: &Scene, config: &GameConfig, at: f64, seed: u64) -> Moment {
        let world = app_of(scene, config, seed);
        let mut moment = Moment { world, names: scene.ships.iter().map(|ship| ship.name.clone()).collect() };
        let step = moment.world.world().resource::<Clock>().step;
        moment.advance((at / step).round() as u64);
        moment
    }

    /// Plays on for so many steps of the clock.
    pub fn advance(&mut self, steps: u64) {
        for _ in 0..steps {
            self.world.world_mut().run_schedule(FixedUpdate);
        }
    }

    /// Whether a chase has been decided.
    pub fn is_decided(&self) -> bool {
        outcome(self.world.world()).is_some()
    }

    /// The clock.
    pub fn time(&self) -> f64 {
        self.world.world().resource::<Clock>().time
    }

    /// States of the ships by name, in scene order.
    pub fn ships(&self) -> Vec<(&str, ShipState)> {
        let world = self.world.world();
        let fleet = &world.resource::<Fleet>().0;
        fleet.iter().zip(&self.names).filter_map(|(&entity, name)| Some((name.as_str(), world.get::<ShipMotion>(entity)?.0))).collect()
    }

    /// Worldlines of the ships, in scene order.
    pub fn histories(&self) -> Vec<&History> {
        let world = self.world.world();
        world.resource::<Fleet>().0.iter().filter_map(|&entity| world.get::<History>(entity)).collect()
    }
}
