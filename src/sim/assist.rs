//! Flight assist for a player: the nose steers, drift across it fades, the hole is kept away from. A pure function from state and input
//! to a command; without it ([`Command`] straight from the sticks) flight is purely free.

use glam::DVec3;

use crate::scene::GameConfig;
use crate::spacetime::frames::{relative_momentum, rest_to_rain};
use crate::spacetime::matter::{ShipState, gamma, velocity};
use crate::spacetime::metric::river_speed;
use crate::spacetime::orbit::{circular_momentum, static_momentum};

use super::flight::Command;
use super::pilot::rollout::{Point, coast};
use super::ship::Engine;

/// What the flight assist holds to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum AssistMode {
    /// No help: free flight.
    #[default]
    Off,
    /// Drift against the circular orbit through the ship fades.
    Orbit,
    /// Drift across the way to the target fades.
    Target,
}

impl AssistMode {
    /// As `game.toml` says.
    pub fn of(config: &GameConfig) -> AssistMode {
        match (config.assist.enabled, config.assist.reference.as_str()) {
            (false, _) => AssistMode::Off,
            (true, "target") => AssistMode::Target,
            (true, _) => AssistMode::Orbit,
        }
    }

    /// What the key chooses next; without a target there is nothing to hold to but the orbit.
    pub fn next(self, has_target: bool) -> AssistMode {
        match self {
            AssistMode::Off => AssistMode::Orbit,
            AssistMode::Orbit if has_target => AssistMode::Target,
            AssistMode::Orbit | AssistMode::Target => AssistMode::Off,
        }
    }
}

/// How the player deflects the sticks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stick {
    /// Thrust on body axes (right, up, backwards), each in [−1, 1].
    pub thrust: DVec3,
    /// Turn about the body axes (pitch up, yaw left, roll left), each in [−1, 1].
    pub turn: DVec3,
}

/// Against what drift is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Reference {
    /// The far stars: hovering. Inside r = 1, where nothing hovers, the rain.
    #[default]
    Static,
    /// The circular free orbit through the ship, in the plane and sense of its motion.
    Orbit,
    /// What has this dx/dT (c): a ship, or a place for 0.
    Target(DVec3),
}

/// How strongly to help.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AssistSettings {
    /// Drift fades in this proper time, in r_s/c.
    pub damping_time: f64,
    /// The closest approach to the hole that it lets happen, in r_s; None lets everything happen.
    pub avoid_radius: Option<f64>,
}

impl From<&GameConfig> for AssistSettings {
    fn from(config: &GameConfig) -> Self {
        let assist = &config.assist;
        AssistSettings { damping_time: assist.damping_time, avoid_radius: assist.avoid_hole.then_some(assist.avoid_radius) }
    }
}

/// What the assist made of the input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Assisted {
    /// For the ship's controls.
    pub command: Command,
    /// Whether it has taken the thrust from the player to keep off the hole.
    pub avoiding: bool,
}

/// Where it thrusts to keep off the hole, a unit vector outward, along the motion and along the orbit's axis: chosen by hand, outward to
/// stop the fall, and along the motion to raise the orbit.
const AWAY: DVec3 = DVec3::new(0.6, 0.8, 0.0);
/// How far ahead it looks for the hole, in r_s/c, and in how many steps.
const LOOK_AHEAD: (f64, usize) = (12.0, 24);

/// The command without assist: the sticks as they are.
pub fn direct(stick: &Stick, engine: &Engine) -> Command {
    let stick = Stick { thrust: stick.thrust.clamp(DVec3::NEG_ONE, DVec3::ONE), turn: stick.turn.clamp(DVec3::NEG_ONE, DVec3::ONE) };
    Command { thrust: (stick.thrust * engine.max_thrust).clamp_length_max(engine.max_thrust), rates: stick.turn * engine.fastest_turn() }
}

/// The command with assist. Where the stick rests, drift sideways and backwards fades; forward motion is kept, so that the nose steers.
pub fn assisted(state: &ShipState, stick: &Stick, engine: &Engine, reference: Reference, settings: &AssistSettings) -> Assisted {
    let mut command = direct(stick, engine);
    let to_body = state.attitude.conjugate();
    let drift = to_body * drift(state, reference);
    let support = to_body * support(state, reference);
    for axis in 0..3 {
        let forward = axis == 2 && drift.z < 0.0;
        if stick.thrust[axis] == 0.0 && !forward {
            command.thrust[axis] = support[axis] - drift[axis] / settings.damping_time;
        }
    }
    command.thrust = command.thrust.clamp_length_max(engine.max_thrust);
    kept_off(state, command, engine, settings)
}

/// A command, or the way off the hole where the ship falls to it.
pub fn kept_off(state: &ShipState, mut command: Command, engine: &Engine, settings: &AssistSettings) -> Assisted {
    let avoiding = settings.avoid_radius.is_some_and(|radius| falls_below(state, radius));
    if avoiding {
        let away = Point::from(state).from_local(AWAY);
        command.thrust = state.attitude.conjugate() * away * engine.max_thrust;
    }
    Assisted { command, avoiding }
}

/// The command that takes away all motion against `reference`, with the whole engine if need be; turns are the stick's.
pub fn matched(state: &ShipState, stick: &Stick, engine: &Engine, reference: Reference) -> Command {
    let drift = state.attitude.conjugate() * drift(state, reference);
    let thrust = (-drift / MATCHING_TIME).clamp_length_max(engine.max_thrust);
    Command { thrust, ..direct(stick, engine) }
}

/// Motion against the target is taken away in this time where the engine is strong enough, in r_s/c: a few steps of the clock, so that it
/// brakes fully almost to the end and does not swing past it.
const MATCHING_TIME: f64 = 0.25;

/// The rain-frame momentum (c) of what rests in `reference` at the ship's place; the rain's own where there is no such thing.
fn reference_momentum(state: &ShipState, reference: Reference) -> DVec3 {
    let momentum = match reference {
        Reference::Static => static_momentum(state.position),
        Reference::Orbit => circular_momentum(state.position, velocity(state)),
        Reference::Target(velocity) => {
            let r = state.position.length();
            let against_rain = velocity + state.position * (river_speed(r) / r);
            let rest = 1.0 - against_rain.length_squared();
            (rest > 1e-6).then(|| against_rain / rest.sqrt())
        }
    };
    momentum.unwrap_or(DVec3::ZERO)
}

/// The ship's velocity (c) against `reference`, on its own rest-frame axes (by pure boost).
pub fn drift(state: &ShipState, reference: Reference) -> DVec3 {
    let passing = relative_momentum(state.momentum, reference_momentum(state, reference));
    -passing / gamma(passing)
}

/// The proper acceleration (rest-frame axes) that keeps something in `reference` where it is: against the fall for hovering, else none.
fn support(state: &ShipState, reference: Reference) -> DVec3 {
    let r = state.position.length();
    match reference {
        Reference::Static if r > 1.0 => {
            let outward = rest_to_rain(-state.momentum, state.position / r);
            outward.normalize_or_zero() * (0.5 / (r * r * (1.0 - 1.0 / r).sqrt()))
        }
        _ => DVec3::ZERO,
    }
}

fn falls_below(state: &ShipState, radius: f64) -> bool {
    let mut point = Point::from(state);
    let h = LOOK_AHEAD.0 / LOOK_AHEAD.1 as f64;
    (0..LOOK_AHEAD.1).any(|_| {
        point = coast(&point, h);
        point.x.length_squared() < radius * radius
    })
}
