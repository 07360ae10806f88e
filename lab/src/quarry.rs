//! How long a quarry lasts: the game's own pilot beside two that know nothing, each hunted by the same autopilot from the same start.

use std::path::PathBuf;

use clap::Args;
use glam::DVec3;
use lensrunner::argument::whole;
use lensrunner::scene::{self, Difficulty, GameConfig, Scene};
use lensrunner::sim::ship::{Controls, Engine, Fleet, Manual, ShipMotion};
use lensrunner::sim::{Clock, Command, app_of, outcome, step};
use rand::{RngExt, SeedableRng, rngs::StdRng};
use rayon::prelude::*;

use crate::chart::ChartError;
use crate::say::say;

/// How long the quarry lasts, flown by the game's pilot, straight away, and at random, before the same hunter: a table.
#[derive(Args, Clone, Debug)]
pub struct QuarryRequest {
    /// A scene or mission whose first ship hunts the second.
    #[arg(long, value_name = "NAME|FILE", default_value = "02-first-pursuit")]
    pub scene: String,
    /// Chases of each kind.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = whole::<u64>(1, 1_000_000))]
    pub seeds: u64,
}

/// T at which a chase ends undecided, in r_s/c.
const LIMIT: f64 = 270.0;

/// Who flies the quarry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Flees {
    /// The game's pilot.
    Pilot,
    /// Full thrust straight away from the hunter.
    Straight,
    /// Full thrust in a direction drawn anew every [`PERIOD`].
    Random,
}

impl Flees {
    /// All of them.
    const ALL: [Flees; 3] = [Flees::Pilot, Flees::Straight, Flees::Random];

    /// As the table writes it.
    fn name(self) -> &'static str {
        ["the game's pilot", "straight away", "random"][self as usize]
    }
}

/// T between two directions of a random quarry, in r_s/c: the game's replanning period.
const PERIOD: f64 = 2.5;

/// The arena may be left by this factor: its edge is where pilots turn back.
const LEEWAY: f64 = 1.1;

/// One chase.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Chased {
    /// T at the end, in r_s/c.
    time: f64,
    /// The quarry was caught, fell in, or left the arena.
    lost: bool,
    /// It fell into the hole.
    fell: bool,
    /// Its least distance from the hole, in r_s.
    least: f64,
    /// The hunter came near it shortly before the end.
    cornered: bool,
}

/// A hunter so near, in r_s, leaves no other way.
const CORNERED: f64 = 1.5;
/// How long before the end, in r_s/c: a fall from r = 3 takes half of it.
const LATE: f64 = 8.0;

/// The quarry's ship, flown blindly.
struct Blind {
    how: Flees,
    chance: StdRng,
    direction: DVec3,
    until: f64,
}

/// Flies one chase of a scene whose first ship hunts the second, until T = [`LIMIT`].
fn chase(scene: &Scene, config: &GameConfig, seed: u64, how: Flees) -> Chased {
    let mut app = app_of(scene, config, seed);
    let fleet = app.world().resource::<Fleet>().0.clone();
    let (hunter, quarry) = (fleet[0], fleet[1]);
    let mut blind = Blind { how, chance: StdRng::seed_from_u64(seed), direction: DVec3::X, until: 0.0 };
    if how != Flees::Pilot {
        app.world_mut().entity_mut(quarry).insert(Manual);
    }
    let arena = scene.rules(config).arena_radius * LEEWAY;
    let mut least = f64::INFINITY;
    let mut near_at = f64::NEG_INFINITY;
    loop {
        let world = app.world_mut();
        let [there, here] = [hunter, quarry].map(|ship| world.get::<ShipMotion>(ship).map_or(DVec3::ZERO, |motion| motion.0.position));
        let direction = blind.direction(world.resource::<Clock>().time, here - there);
        let attitude = world.get::<ShipMotion>(quarry).map(|motion| motion.0.attitude);
        let thrust = world.get::<Engine>(quarry).map_or(0.0, |engine| engine.max_thrust);
        if let (Some(attitude), true, Some(mut controls)) = (attitude, how != Flees::Pilot, world.get_mut::<Controls>(quarry)) {
            controls.0 = Command { thrust: attitude.conjugate() * direction * thrust, rates: DVec3::ZERO };
        }
        step(world);
        let r = world.get::<ShipMotion>(quarry).map_or(0.0, |motion| motion.0.position.length());
        least = least.min(r);
        let time = world.resource::<Clock>().time;
        if there.distance(here) < CORNERED {
            near_at = time;
        }
        let cornered = time - near_at < LATE;
        if let Some((_, decided)) = outcome(world) {
            return Chased { time: decided, lost: decided < LIMIT, fell: r < 1.0, least, cornered };
        }
        // The chase is held within the arena: who leaves it has given up.
        if r > arena {
            return Chased { time, lost: true, fell: false, least, cornered };
        }
        if time >= LIMIT {
            return Chased { time, lost: false, fell: r < 1.0, least, cornered };
        }
    }
}

impl Blind {
    /// Where it thrusts at T = `time`; `away`: from the hunter to it.
    fn direction(&mut self, time: f64, away: DVec3) -> DVec3 {
        if self.how == Flees::Straight {
            return away.normalize_or_zero();
        }
        if time >= self.until {
            let direction = DVec3::from_array([(); 3].map(|()| self.chance.random_range(-1.0..1.0)));
            self.direction = direction.normalize_or(DVec3::X);
            self.until = time + PERIOD;
        }
        self.direction
    }
}

/// Flies the chases of each difficulty and each way to flee, and says how long the quarry lasts.
pub fn run(request: &QuarryRequest) -> Result<Vec<PathBuf>, ChartError> {
    let (config, scene) = (scene::config::find(None)?, scene::load(&request.scene)?);
    if scene.ships.len() < 2 {
        return Err(ChartError::Input(format!("{}: it needs two ships, the first to hunt the second", request.scene)));
    }
    say("| difficulty | quarry | mean time | lost | fell in | not cornered | least r |\n|---|---|---|---|---|---|---|");
    let seeds = request.seeds;
    for difficulty in Difficulty::ALL {
        let config = scene.config(&config, difficulty);
        for how in Flees::ALL {
            let all: Vec<Chased> = (0..seeds).into_par_iter().map(|seed| chase(&scene, &config, seed, how)).collect();
            let mean = all.iter().map(|chase| chase.time).sum::<f64>() / all.len().max(1) as f64;
            let [lost, fell, free] = [|c: &Chased| c.lost, |c: &Chased| c.fell, |c: &Chased| c.fell && !c.cornered]
                .map(|is| all.iter().filter(|c| is(c)).count());
            let least = all.iter().map(|chase| chase.least).fold(f64::INFINITY, f64::min);
            say(format_args!("| {difficulty} | {} | {mean:.1} r_s/c | {lost} of {seeds} | {fell} | {free} | {least:.2} r_s |", how.name()));
        }
    }
    Ok(Vec::new())
}
