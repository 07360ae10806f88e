//! `lensrunner simulate`: the game without graphics, as fast as it goes, written as CSV.

use std::io::{self, Write};
use web_time::Instant;

use crate::scene::pilot_kind::PilotKind;
use crate::scene::ship::Ai;
use crate::scene::{ConfigError, GameConfig, Scene, SceneError};
use crate::spacetime::matter::{ShipState, angular_momentum, energy, has_ended};
use bevy::prelude::*;

use super::flight::{Command, Flight, fly};
use super::hash::StateHash;
use super::replay::MOST_STEPS;
use super::ship::{Controls, Ended, Engine, Fleet, Fuel, Programme, Ship, ShipMotion, Turning};
use super::{Clock, History, SimEvent, app_of, board, outcome};

/// The header row.
pub const COLUMNS: &str = "ship,T,tau,x,y,z,px,py,pz,qw,qx,qy,qz,E,Lx,Ly,Lz";

/// The end of the run unless asked otherwise, in r_s/c; a chase ends with its time limit.
const DEFAULT_UNTIL: f64 = 100.0;
/// T between rows unless asked otherwise, in r_s/c.
pub const DEFAULT_EVERY: f64 = 1.0;
/// The most rows of T one run writes.
const MAX_ROWS: f64 = 1e8;

/// How much of the ships' histories a run keeps, in r_s/c: more than the longest reaction delay.
const KEEP: f64 = 100.0;

/// What is asked of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimulateRequest {
    /// The last T, in r_s/c.
    pub until: Option<f64>,
    /// T between rows, in r_s/c.
    pub every: f64,
    /// For everything that is left to chance.
    pub seed: u64,
    /// At the player's ship.
    pub pilot: PilotKind,
}

impl Default for SimulateRequest {
    fn default() -> Self {
        SimulateRequest { until: None, every: DEFAULT_EVERY, seed: 0, pilot: PilotKind::Expert }
    }
}

impl SimulateRequest {
    /// Whether it can be run on `scene`, and its last T.
    pub fn check(&self, scene: &Scene, config: &GameConfig) -> Result<f64, SimulateError> {
        if scene.ships.is_empty() {
            return Err(SimulateError::Input(format!("scene {}: a simulation needs at least one [[ship]]", scene.name)));
        }
        let chase = scene.ships.iter().any(|ship| matches!(ship.ai, Ai::Flee | Ai::Pursue));
        let until = self.until.unwrap_or(if chase { scene.rules(config).time_limit } else { DEFAULT_UNTIL });
        let every = self.every;
        if !(0.0..=1e9).contains(&until) {
            return Err(SimulateError::Input(format!("--until {until} must be from 0 to 1e9 r_s/c")));
        }
        if !(every > 0.0 && every.is_finite() && until / every <= MAX_ROWS) {
            return Err(SimulateError::Input(format!("--every {every:?} must be above 0 and give at most {MAX_ROWS:e} rows")));
        }
        Ok(until)
    }

    /// As [`SimulateRequest::check`], for a flight that is kept whole: as a replay, which has a length.
    pub fn check_recorded(&self, scene: &Scene, config: &GameConfig) -> Result<f64, SimulateError> {
        let until = self.check(scene, config)?;
        let (step, latest) = (config.clock.step, MOST_STEPS as f64 * config.clock.step);
        if until > latest {
            return Err(SimulateError::Input(format!(
                "--until {until} is too late for a replay: allowed 0 to {latest} r_s/c, {MOST_STEPS} steps of clock.step = {step}"
            )));
        }
        Ok(until)
    }
}

/// Why a run failed.
#[derive(Debug, thiserror::Error)]
pub enum SimulateError {
    /// The input is wrong: exit code 2.
    #[error("{0}")]
    Input(String),
    /// The scene is wrong: exit code 2.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The configuration is wrong: exit code 2.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// Writing failed: exit code 1.
    #[error("{0}")]
    Io(#[from] io::Error),
}

/// How a run went.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Fixed steps taken.
    pub steps: u64,
    /// Wall seconds.
    pub seconds: f64,
    /// Of the final state of all ships, in scene order.
    pub hash: StateHash,
}

/// Runs `scene`; rows by T, then in scene order.
pub fn simulate(
    scene: &Scene,
    config: &GameConfig,
    request: &SimulateRequest,
    out: &mut dyn Write,
    log: &mut dyn Write,
) -> Result<Summary, SimulateError> {
    let mut until = request.check(scene, config)?;
    let mut app = app_of(scene, config, request.seed);
    board(app.world_mut(), request.pilot);
    for mut history in app.world_mut().query::<&mut History>().iter_mut(app.world_mut()) {
        history.forget_beyond(KEEP);
    }
    let started = Instant::now();
    writeln!(out, "{COLUMNS}")?;
    let mut row = 0u64;
    let mut before = departures(app.world());
    loop {
        // Rows inside the step just flown, its end included; at first, T = 0 alone.
        while let due = due_time(row, request.every, until)
            && due <= app.world().resource::<Clock>().time
        {
            write_rows(app.world(), &before, due, out)?;
            if due >= until {
                return finish(app.world(), &before, until, started, out, log);
            }
            row += 1;
        }
        before = departures(app.world());
        app.world_mut().run_schedule(FixedUpdate);
        log_events(app.world_mut(), until, log)?;
        if let Some((_, decided)) = outcome(app.world()) {
            until = until.min(decided);
        }
    }
}

/// T of row `row`: `row`·`every`, freed of the rounding that shows when `every` is a short decimal (3 · 0.1 = 0.30000000000000004); the
/// last row is at `until`.
fn due_time(row: u64, every: f64, until: f64) -> f64 {
    let product = row as f64 * every;
    let decimal: f64 = format!("{product:.14e}").parse().unwrap_or(product);
    let due = if (decimal - product).abs() <= product * f64::EPSILON { decimal } else { product };
    due.min(until)
}

/// T and the flights of all ships, in scene order, before a step.
type Departures = (f64, Vec<Flight>);

fn departures(world: &World) -> Departures {
    let flight = |&entity: &Entity| Some(Flight { state: world.get::<ShipMotion>(entity)?.0, fuel: world.get::<Fuel>(entity)?.left });
    (world.resource::<Clock>().time, world.resource::<Fleet>().0.iter().filter_map(flight).collect())
}

/// The ships at T = `time` in the step just flown, and whether each has ended (its state is then the last). Inside the step it is flown
/// again from its beginning with the same commands, so that looking never changes the flight.
fn ships_at(world: &World, before: &Departures, time: f64) -> Vec<(String, ShipState, bool)> {
    let at_end = time >= world.resource::<Clock>().time;
    let one = |(&entity, departure): (&Entity, &Flight)| {
        let name = world.get::<Ship>(entity)?.name.clone();
        let state = world.get::<ShipMotion>(entity)?.0;
        let ended = world.get::<Ended>(entity);
        if at_end || ended.is_some_and(|ended| ended.time <= time) {
            return Some((name, state, ended.is_some()));
        }
        let thrust = world.get::<Engine>(entity)?.thrust(world.get::<Controls>(entity)?.0.thrust);
        let command = Command { thrust, rates: world.get::<Turning>(entity)?.0 };
        let (end, _) = fly(departure, before.0, time, command, &world.get::<Programme>(entity)?.0, |_| ());
        Some((name, end.state, has_ended(&end.state)))
    };
    world.resource::<Fleet>().0.iter().zip(&before.1).filter_map(one).collect()
}

fn write_rows(world: &World, before: &Departures, time: f64, out: &mut dyn Write) -> io::Result<()> {
    for (name, state, _) in ships_at(world, before, time).into_iter().filter(|&(_, _, ended)| !ended) {
        let (x, p, q, l) = (state.position, state.momentum, state.attitude, angular_momentum(&state));
        write!(out, "{name}")?;
        // Rounding may add an ulp to the proper time of what falls with the rain, for which dτ = dT.
        for number in [time, state.proper_time.min(time), x.x, x.y, x.z, p.x, p.y, p.z, q.w, q.x, q.y, q.z, energy(&state), l.x, l.y, l.z] {
            write!(out, ",{number:.16e}")?;
        }
        writeln!(out)?;
    }
    Ok(())
}

fn log_events(world: &mut World, until: f64, log: &mut dyn Write) -> io::Result<()> {
    for event in world.resource_mut::<Messages<SimEvent>>().drain().filter(|event| event.time() <= until) {
        writeln!(log, "{event}")?;
    }
    Ok(())
}

fn finish(
    world: &World,
    before: &Departures,
    time: f64,
    started: Instant,
    out: &mut dyn Write,
    log: &mut dyn Write,
) -> Result<Summary, SimulateError> {
    out.flush()?;
    let mut hash = StateHash::default();
    for (name, state, _) in ships_at(world, before, time) {
        hash.ship(&name, &state);
    }
    let summary = Summary { steps: world.resource::<Clock>().tick, seconds: started.elapsed().as_secs_f64(), hash };
    let rate = summary.steps as f64 / summary.seconds.max(1e-9);
    writeln!(log, "{rate:.0} steps per second, state {hash}")?;
    Ok(summary)
}
