//! A scene played to one moment: what a picture of it needs.

use bevy::prelude::*;

use crate::scene::pilot_kind::PilotKind;
use crate::scene::{GameConfig, Scene};
use crate::spacetime::matter::ShipState;

use super::replay::{Playback, Replay};
use super::run::state_hash;
use super::ship::Player;
use super::{Bolts, Clock, Fleet, History, ShipMotion, app_of, board, outcome};

/// Makes a ship that of the player, where none is yet.
fn mark_player(world: &mut World, ship: Option<usize>) {
    let is_marked = world.query_filtered::<(), With<Player>>().iter(world).next().is_some();
    let ship = ship.filter(|_| !is_marked).and_then(|ship| world.resource::<Fleet>().0.get(ship).copied());
    if let Some(ship) = ship {
        world.entity_mut(ship).insert(Player);
    }
}

/// A scene with its ships at a time T.
pub struct Moment {
    /// The scene.
    pub scene: Scene,
    world: App,
    nobody: History,
}

impl Moment {
    /// Plays the scene from T = 0 to T = `at`.
    pub fn new(scene: &Scene, config: &GameConfig, at: f64, seed: u64) -> Moment {
        let mut moment = Moment { scene: scene.clone(), world: app_of(scene, config, seed), nobody: History::nobody() };
        let step = moment.world.world().resource::<Clock>().step;
        moment.advance((at / step).round() as u64);
        moment
    }

    /// The scene at T = 0 with `pilot` at the controls of the player's ship, or of the first where the scene marks none.
    pub fn with_pilot(scene: &Scene, config: &GameConfig, seed: u64, pilot: PilotKind) -> Moment {
        let mut moment = Moment::new(scene, config, 0.0, seed);
        let world = moment.world.world_mut();
        mark_player(world, Some(0));
        board(world, pilot);
        moment
    }

    /// Flies a flight again up to its last step. `config` is that of its difficulty; `player` is the ship that is flown by hand where the
    /// scene marks none.
    pub fn flown(scene: &Scene, config: &GameConfig, flight: &Replay, player: Option<usize>) -> Moment {
        let mut app = app_of(scene, config, flight.seed);
        let world = app.world_mut();
        mark_player(world, player);
        world.insert_resource(Playback::of(flight));
        board(world, flight.pilot);
        let mut moment = Moment { scene: scene.clone(), world: app, nobody: History::nobody() };
        moment.advance(flight.ticks);
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
        let ships = fleet.iter().zip(&self.scene.ships);
        ships.filter_map(|(&entity, ship)| Some((ship.name.as_str(), world.get::<ShipMotion>(entity)?.0))).collect()
    }

    /// Of the ships' state, as a replay keeps it.
    pub fn hash(&self) -> String {
        state_hash(self.world.world()).to_string()
    }

    /// Worldlines of the bolts, each in its place.
    pub fn bolts(&self) -> Vec<&History> {
        self.world.world().resource::<Bolts>().0.iter().map(|bolt| &bolt.history).collect()
    }

    /// Worldlines of the ships, in scene order.
    pub fn histories(&self) -> Vec<&History> {
        let world = self.world.world();
        world.resource::<Fleet>().0.iter().filter_map(|&entity| world.get::<History>(entity)).collect()
    }

    /// Worldlines of all that flies: of the ships, then nobody's in the ghost's place, then those of the bolts.
    pub fn all_histories(&self) -> Vec<&History> {
        self.histories().into_iter().chain([&self.nobody]).chain(self.bolts()).collect()
    }
}
