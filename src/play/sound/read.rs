//! From the game's world to what is heard in it. The ship is the listener: light, gas and acceleration are as they are for it.

use bevy::prelude::{Entity, World};
use glam::DQuat;

use crate::play::camera::state_of;
use crate::play::hud::dials::LOW_FUEL;
use crate::play::hud::goals::{is_held, whole};
use crate::play::hud::instruments::{Countdown, Scale};
use crate::play::pace::{danger, nearness};
use crate::play::picture::now::target_index;
use crate::play::session::Session;
use crate::play::sound::heard::{Alarm, Beacon, Heard, load, loudness};
use crate::play::words::Language;
use crate::scene::disk::Gas;
use crate::sim::bolts::Hits;
use crate::sim::by_hand::Avoiding;
use crate::sim::goals::catch_radius;
use crate::sim::guidance::{Brake, guidance};
use crate::sim::known::known;
use crate::sim::pilot::rollout::Point;
use crate::sim::ship::Manual;
use crate::sim::sight::{direction, emission_time, frequency_ratio};
use crate::sim::{ActiveMission, Bolts, Chase, ChaseRules, Clock, Controls, Engine, Fleet, Fuel, History, Progress, ShipMotion, Turning};
use crate::spacetime::Observer;
use crate::spacetime::frames::relative_velocity;
use crate::spacetime::light::Order;
use crate::spacetime::matter::ShipState;

/// The hole is too near below this radius, in r_s.
const TOO_NEAR: f64 = 2.0;
/// How dangerous it is that the time is nearly out: of 1.
const HURRY: f64 = 0.6;
/// Radii at which the disk's depth is looked at for its greatest.
const RINGS: u32 = 64;

/// What a listener must know of the scene.
#[derive(Clone, Debug)]
pub struct Listener {
    gas: Option<Gas>,
    /// Optical depth of the disk's thickest ring.
    thickest: f64,
    scale: Scale,
}

impl Listener {
    /// For the scene of a session.
    pub fn of(session: &Session) -> Listener {
        let config = session.effective();
        let mass = config.hole.mass_solar;
        let gas = session.scene.disk(&config).map(|disk| Gas::new(&disk, mass));
        let thickest = gas.as_ref().map_or(0.0, |gas| {
            let [inner, outer] = gas.extent();
            (0..=RINGS).map(|k| gas.radial.depth(inner + (outer - inner) * f64::from(k) / f64::from(RINGS))).fold(0.0, f64::max)
        });
        Listener { gas, thickest, scale: Scale::new(mass, Language::English) }
    }

    /// What the player's ship hears at T = `time` (r_s/c); None where no flight has begun. Left and right are those of a head with this
    /// attitude, or else of the ship.
    pub fn heard(&self, world: &World, session: &Session, time: f64, attitude: Option<DQuat>) -> Option<Heard> {
        let fleet = world.get_resource::<Fleet>()?;
        let own = *fleet.0.get(session.player())?;
        let history = world.get::<History>(own)?;
        let state = state_of(&history.at(time));
        let chase = world.get_resource::<Chase>();
        let mission = world.get_resource::<ActiveMission>();
        let target = target_index(session, mission.is_some(), fleet, chase).and_then(|index| world.get::<History>(*fleet.0.get(index)?));
        let (engine, thrusters, load) = self.burn(world, own, history, time);
        let (immersion, wind) = self.gas_at(&state, time);
        let outcome = chase.and_then(|chase| chase.outcome).map(|(outcome, _)| outcome);
        let bolts = world.get_resource::<Bolts>().into_iter().flat_map(|bolts| &bolts.0).filter(|bolt| bolt.owner == own);
        let goals = world.get_resource::<Progress>().map(|progress| progress.goal);
        let won = outcome.is_some_and(|outcome| outcome.is_won());
        Some(Heard {
            running: true,
            engine,
            load,
            thrusters,
            immersion,
            wind,
            beacon: target.and_then(|target| beacon(&state, attitude.unwrap_or(state.attitude), time, target)),
            hold: if outcome.is_none() { hold(world) } else { 0.0 },
            alarm: if outcome.is_none() { alarm(world, own, &state, time, target) } else { None },
            danger: if outcome.is_none() { dangers(world, fleet, own, time) } else { 0.0 },
            bolt: bolts.map(|bolt| bolt.fired).reduce(f64::max),
            hits: fleet.0.iter().filter_map(|&ship| world.get::<Hits>(ship)).map(|hits| hits.0).sum(),
            successes: goals.map_or(u32::from(won), |goals| goals as u32),
            losses: u32::from(outcome.is_some() && !won),
        })
    }

    /// Engines, thrusters and load of a ship.
    fn burn(&self, world: &World, ship: Entity, history: &History, time: f64) -> (f64, f64, f64) {
        let Some(engine) = world.get::<Engine>(ship) else { return (0.0, 0.0, 0.0) };
        let share = |value: f64, most: f64| if most > 0.0 { (value / most).clamp(0.0, 1.0) } else { 0.0 };
        let step = world.get_resource::<Clock>().map_or(1.0 / 32.0, |clock| clock.step);
        // What it has really done in the last step: a thrust programme counts, an empty tank does not.
        let acceleration = history.thrust(time, step);
        let thrust = world.get::<Controls>(ship).map(|controls| engine.thrust(controls.0.thrust)).unwrap_or_default();
        let burns = acceleration > 0.0;
        let aside = if burns { share(thrust.truncate().length(), engine.max_thrust) } else { 0.0 };
        let turns = share(world.get::<Turning>(ship).map_or(0.0, |turning| turning.0.length()), engine.fastest_turn());
        (share(acceleration, engine.max_thrust), aside.max(turns), load(self.scale.gees(acceleration)))
    }

    /// How dense the gas is round a ship, and how fast it passes.
    fn gas_at(&self, state: &ShipState, time: f64) -> (f64, f64) {
        let Some(gas) = self.gas.as_ref().filter(|_| self.thickest > 0.0) else { return (0.0, 0.0) };
        let plane = state.position.truncate();
        let r = plane.length();
        let [inner, outer] = gas.extent();
        if !(r > inner && r < outer) {
            return (0.0, 0.0);
        }
        let emission = gas.emission(r, plane.y.atan2(plane.x), time);
        // Gaussian across the disk, as its opacity near the camera is.
        let height = state.position.z / emission.half_height;
        let density = (emission.depth / self.thickest * (-0.5 * height * height).exp()).clamp(0.0, 1.0);
        let in_plane = plane.extend(0.0);
        (density, relative_velocity(state.momentum, gas.momentum(in_plane)).length())
    }
}

/// The beacon of a ship with the worldline `target`, as it is heard in `state` at T = `time` by a head with this attitude: that of the
/// image of order 1.
pub fn beacon(state: &ShipState, attitude: DQuat, time: f64, target: &History) -> Option<Beacon> {
    let order = Order::ALL[0];
    let listener = Observer { position: state.position, momentum: state.momentum, attitude, field_of_view: 1.0 };
    let emission = emission_time(&listener, time, target, order)?;
    let emitted = target.at(emission);
    let age = time - emission;
    let ratio = frequency_ratio(&listener, &emitted, order, age)?;
    let pan = direction(&listener, emitted.position, order, age)?.x;
    Some(Beacon { ratio, emitted: emitted.proper_time, loudness: loudness(ratio, age), pan })
}

/// The share of a hold that is done.
fn hold(world: &World) -> f64 {
    let (Some(chase), Some(rules)) = (world.get_resource::<Chase>(), world.get_resource::<ChaseRules>()) else { return 0.0 };
    let (mission, progress) = (world.get_resource::<ActiveMission>(), world.get_resource::<Progress>());
    let holds = mission.zip(progress).is_none_or(|(mission, progress)| is_held(&mission.0, progress));
    let needed = whole(mission, progress, &rules.0);
    if holds && needed > 0.0 { (chase.held / needed).clamp(0.0, 1.0) } else { 0.0 }
}

/// The most urgent alarm.
fn alarm(world: &World, own: Entity, state: &ShipState, time: f64, target: Option<&History>) -> Option<Alarm> {
    // Where the way leads inside, the hole is no danger.
    let goes_inside = world.get_resource::<ActiveMission>().is_some_and(|mission| mission.0.inside);
    let avoiding = world.get_resource::<Avoiding>().is_some_and(|avoiding| avoiding.0);
    if avoiding || (!goes_inside && state.position.length() < TOO_NEAR) {
        return Some(Alarm::Hole);
    }
    if brakes(world, own, state, time, target) {
        return Some(Alarm::Brake);
    }
    if countdown(world, time).is_some_and(|countdown| countdown.late()) {
        return Some(Alarm::Time);
    }
    let fuel = world.get::<Fuel>(own)?;
    let share = fuel.left / fuel.capacity;
    (fuel.capacity.is_finite() && share > 0.0 && share < LOW_FUEL).then_some(Alarm::Fuel)
}

/// Whether who flies by hand must brake at once to catch the target.
fn brakes(world: &World, own: Entity, state: &ShipState, time: f64, target: Option<&History>) -> bool {
    let (mission, progress) = (world.get_resource::<ActiveMission>(), world.get_resource::<Progress>());
    let marks_now = mission.is_none_or(|mission| mission.0.now_marker);
    let reach = world.get_resource::<ChaseRules>().and_then(|rules| catch_radius(mission, progress, rules));
    let by_hand = world.get::<Manual>(own).is_some();
    let (Some(reach), Some(history), Some(engine), true) = (reach, target, world.get::<Engine>(own), by_hand) else { return false };
    let known = known(state, time, history, marks_now);
    known.is_some_and(|known| guidance(&Point::from(state), &known.point, engine.max_thrust, reach).brake == Brake::Now)
}

/// The time for the flight, where it is limited.
fn countdown(world: &World, time: f64) -> Option<Countdown> {
    let limit = world.get_resource::<ChaseRules>().filter(|_| world.contains_resource::<Chase>())?.0.time_limit;
    (limit.is_finite() && limit > 0.0).then(|| Countdown::at(time, limit))
}

/// How dangerous it is, 0 to 1: what is near or will be if all coast, a pursuer that holds the ship, a time that is nearly out.
fn dangers(world: &World, fleet: &Fleet, own: Entity, time: f64) -> f64 {
    let Some(me) = world.get::<ShipMotion>(own).map(|motion| Point::from(&motion.0)) else { return 0.0 };
    let others = fleet.0.iter().filter(|&&ship| ship != own).filter_map(|&ship| world.get::<ShipMotion>(ship));
    let inside = world.get_resource::<ActiveMission>().is_some_and(|mission| mission.0.inside);
    let near = nearness(danger(me, others.map(|motion| Point::from(&motion.0)).collect(), inside));
    let held = world.get_resource::<Progress>().is_some_and(|progress| progress.held_by > 0.0);
    let late = countdown(world, time).is_some_and(|countdown| countdown.late());
    near.max(if held { 1.0 } else { 0.0 }).max(if late { HURRY } else { 0.0 })
}
