//! One flight from beginning to end without graphics, and what became of it: what `check`, `balance` and `simulate --sweep` count.

use bevy::prelude::*;

use crate::scene::mission::{Difficulty, ScoredBy};
use crate::scene::pilot_kind::PilotKind;
use crate::scene::{GameConfig, Scene};
use crate::spacetime::matter::{angular_momentum, energy};

use super::hash::StateHash;
use super::rules::Outcome;
use super::ship::{Fleet, Fuel, Player, Ship, ShipMotion};
use super::{Clock, History, SimEvent, app_of, board, outcome};

/// What is flown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunRequest {
    /// Of a mission.
    pub difficulty: Difficulty,
    /// At the player's ship.
    pub pilot: PilotKind,
    /// For everything left to chance.
    pub seed: u64,
    /// T at which it ends undecided, in r_s/c; the scene's own time limit if none.
    pub until: Option<f64>,
}

/// What became of it.
#[derive(Clone, Debug, PartialEq)]
pub struct FlightReport {
    /// How it ended; None if it was not decided.
    pub outcome: Option<Outcome>,
    /// T at the end, in r_s/c.
    pub time: f64,
    /// The proper time of the player's ship, or of the first, at the end, in r_s/c.
    pub proper_time: f64,
    /// What that ship has left of its Δv, in c; infinite for one without limits.
    pub fuel: f64,
    /// The Δv that ship has spent, in c.
    pub spent: f64,
    /// The least and the greatest radius that ship came to, in r_s.
    pub radius: [f64; 2],
    /// The largest change of any ship's energy and angular momentum per mass from its first value, in 1 and r_s c: 0 for what coasts, but
    /// for rounding.
    pub drift: [f64; 2],
    /// Fixed steps.
    pub steps: u64,
    /// Of the final state of all ships, in scene order.
    pub hash: StateHash,
}

impl FlightReport {
    /// What the mission scores, in r_s/c or c of Δv.
    pub fn score(&self, clock: ScoredBy) -> f64 {
        match clock {
            ScoredBy::Far => self.time,
            ScoredBy::Own => self.proper_time,
            ScoredBy::Fuel => self.spent,
        }
    }
}

/// How much of the ships' histories a run keeps, in r_s/c: more than light and the longest reaction delay take within an arena.
const KEEP: f64 = 150.0;

/// Flies `scene` to its end. `config` is `game.toml`, to which the difficulty is applied.
pub fn run(scene: &Scene, config: &GameConfig, request: &RunRequest) -> FlightReport {
    run_levelled(scene, &scene.config(config, request.difficulty), request)
}

/// As [`run`]; the difficulty is in `config` already.
pub fn run_levelled(scene: &Scene, config: &GameConfig, request: &RunRequest) -> FlightReport {
    let until = request.until.unwrap_or(scene.rules(config).time_limit);
    let mut app = app_of(scene, config, request.seed);
    let world = app.world_mut();
    board(world, request.pilot);
    for mut history in world.query::<&mut History>().iter_mut(world) {
        history.forget_beyond(KEEP);
    }
    fly_to_end(world, until)
}

/// Steps a started world to its end.
pub fn fly_to_end(world: &mut World, until: f64) -> FlightReport {
    let own = player(world);
    let mut watch = FlightWatch::begin(world);
    loop {
        world.run_schedule(FixedUpdate);
        watch.look(world, own);
        world.clear_trackers();
        world.resource_mut::<Messages<SimEvent>>().clear();
        if outcome(world).is_some() || world.resource::<Clock>().time >= until {
            return watch.report(world, own);
        }
    }
}

/// The player's ship, or the first.
fn player(world: &mut World) -> Option<Entity> {
    let marked = world.query_filtered::<Entity, With<Player>>().iter(world).next();
    marked.or_else(|| world.resource::<Fleet>().0.first().copied())
}

/// What is watched during a flight.
struct FlightWatch {
    radius: [f64; 2],
    first: Vec<(f64, glam::DVec3)>,
    drift: [f64; 2],
}

impl FlightWatch {
    fn begin(world: &World) -> FlightWatch {
        let first = states(world).map(|state| (energy(&state.0), angular_momentum(&state.0))).collect();
        FlightWatch { radius: [f64::INFINITY, 0.0], first, drift: [0.0; 2] }
    }

    fn look(&mut self, world: &World, own: Option<Entity>) {
        if let Some(motion) = own.and_then(|own| world.get::<ShipMotion>(own)) {
            let r = motion.0.position.length();
            self.radius = [self.radius[0].min(r), self.radius[1].max(r)];
        }
        for (state, (e, l)) in states(world).zip(&self.first) {
            self.drift[0] = self.drift[0].max((energy(&state.0) - e).abs());
            self.drift[1] = self.drift[1].max(angular_momentum(&state.0).distance(*l));
        }
    }

    fn report(&self, world: &World, own: Option<Entity>) -> FlightReport {
        let clock = world.resource::<Clock>();
        FlightReport {
            outcome: outcome(world).map(|(outcome, _)| outcome),
            time: clock.time,
            proper_time: own.and_then(|own| world.get::<ShipMotion>(own)).map_or(0.0, |motion| motion.0.proper_time),
            fuel: own.and_then(|own| world.get::<Fuel>(own)).map_or(f64::INFINITY, |fuel| fuel.left),
            spent: own.and_then(|own| world.get::<Fuel>(own)).map_or(0.0, Fuel::spent),
            radius: self.radius,
            drift: self.drift,
            steps: clock.tick,
            hash: state_hash(world),
        }
    }
}

/// The motion of all ships, in scene order.
fn states(world: &World) -> impl Iterator<Item = &ShipMotion> {
    world.resource::<Fleet>().0.iter().filter_map(|&ship| world.get::<ShipMotion>(ship))
}

/// A fingerprint of all ships, in scene order.
pub fn state_hash(world: &World) -> StateHash {
    let mut hash = StateHash::default();
    for &ship in &world.resource::<Fleet>().0 {
        if let (Some(ship), Some(motion)) = (world.get::<Ship>(ship), world.get::<ShipMotion>(ship)) {
            hash.ship(&ship.name, &motion.0);
        }
    }
    hash
}
