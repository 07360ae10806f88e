//! From a scene and `game.toml` to a world at T = 0.

use bevy::ecs::schedule::SingleThreadedExecutor;
use bevy::prelude::*;
use rand::{RngExt, SeedableRng, rngs::StdRng};

use crate::scene::assembly::model_of;
use crate::scene::model::SHIP_MODELS;
use crate::scene::pilot_kind::PilotKind;
use crate::scene::ship::{Ai, ShipSpec};
use crate::scene::{GameConfig, Scene};
use crate::spacetime::Observer;
use crate::spacetime::matter::ShipState;

use super::assist::AssistMode;
use super::bolts::{Bolts, Gun, Hits, Trigger};
use super::clock::Clock;
use super::goals::{ActiveMission, Progress};
use super::history::History;
use super::intercept::{ShownWay, Way};
use super::pilot::beginner::Beginner;
use super::pilot::jerky::Jerky;
use super::pilot::person::Person;
use super::pilot::{Chance, PilotState, Skill, Skills};
use super::player_commands::{ManualControl, PlayerCommands};
use super::rules::{Chase, ChaseRules, begin_chase};
use super::ship::{Controls, Engine, Fleet, Fuel, Pilot, PilotOrder, Player, Programme, Ship, ShipMotion, Turning};
use super::{SimulationPlugins, sight};

/// Starts `scene` (again): clock at T = 0, ships where the scene puts them, chance from `seed`, a mission at its first goal. `config` is
/// that of the difficulty ([`Scene::config`]). The plugins [`super::SimulationPlugins`] must be there. The player's ship, too, is flown by
/// its AI until the [`PlayerCommands`] take it over.
pub fn start(world: &mut World, scene: &Scene, config: &GameConfig, seed: u64) {
    world.insert_resource(Clock::new(config.clock.step));
    world.insert_resource(Chance::from_seed(seed));
    world.insert_resource(skills(config));
    world.insert_resource(ChaseRules(scene.rules(config)));
    world.insert_resource(ManualControl::from(config));
    world.insert_resource(PlayerCommands {
        autopilot: true,
        assist: AssistMode::of(config),
        pace: config.clock.pace,
        ..PlayerCommands::default()
    });
    world.insert_resource(Bolts::default());
    world.remove_resource::<Progress>();
    world.remove_resource::<ActiveMission>();
    muster(world, &scattered(&scene.ships, seed), &defaults(config), 0.0);
    begin_chase(world);
    if scene.mission.is_some() {
        begin_mission(world, scene, config.ship.bolts);
    }
}

/// The ships, each where chance lets it start.
fn scattered(specs: &[ShipSpec], seed: u64) -> Vec<ShipSpec> {
    // Of its own, so that who starts where does not change what pilots draw.
    let mut chance = StdRng::seed_from_u64(seed ^ SCATTER);
    let one = |spec: &ShipSpec| {
        let shares = [(); 3].map(|()| chance.random_range(-1.0..=1.0));
        let state = spec.scatter.and_then(|scatter| scatter.apply(&spec.state, shares)).unwrap_or(spec.state);
        ShipSpec { state, ..spec.clone() }
    };
    let placed: Vec<ShipSpec> = specs.iter().map(one).collect();
    placed.iter().map(|spec| ShipSpec { state: facing(spec, &placed), ..spec.clone() }).collect()
}

/// The start of a ship, turned to the one that it faces.
fn facing(spec: &ShipSpec, all: &[ShipSpec]) -> ShipState {
    let state = spec.state;
    let Some(other) = spec.facing.as_ref().and_then(|name| all.iter().find(|other| &other.name == name)) else { return state };
    let eye = Observer { position: state.position, momentum: state.momentum, attitude: state.attitude, field_of_view: 1.0 };
    let seen = sight::facing(&eye, 0.0, &History::new(0.0, &other.state), glam::DVec3::Z);
    ShipState { attitude: seen.unwrap_or(state.attitude), ..state }
}

/// Keeps the chance of starts apart from that of pilots: any number does.
const SCATTER: u64 = 0x5ca7_7e12;

/// An app with the ships of `scene` at T = 0 whose `FixedUpdate` is the game's fixed step: run that schedule to go on.
pub fn app_of(scene: &Scene, config: &GameConfig, seed: u64) -> App {
    let mut app = App::new();
    app.add_plugins(SimulationPlugins);
    app.edit_schedule(FixedUpdate, |schedule| {
        schedule.set_executor(SingleThreadedExecutor::new());
    });
    app.finish();
    app.cleanup();
    start(app.world_mut(), scene, config, seed);
    app
}

/// How well the autopilot of a kind of pilot flies.
fn skill(pilot: PilotKind) -> Skill {
    match pilot {
        PilotKind::Naive | PilotKind::Ignoring | PilotKind::Person | PilotKind::Practised | PilotKind::Expert | PilotKind::Hands => {
            Skill::default()
        }
        PilotKind::Apprentice => Skill { replan_period: 6.0, horizon: 20.0, reaction_delay: 4.0 },
    }
}

/// Puts a pilot at the controls of the player's ship in a world that was just started.
pub fn board(world: &mut World, pilot: PilotKind) {
    world.resource_mut::<Skills>().own = skill(pilot);
    let own: Vec<Entity> = world.query_filtered::<Entity, With<Player>>().iter(world).collect();
    for ship in own {
        match pilot {
            PilotKind::Naive => _ = world.entity_mut(ship).insert(Beginner::default()),
            PilotKind::Ignoring | PilotKind::Person | PilotKind::Practised => give_to_person(world, ship, pilot),
            PilotKind::Hands => give_to_hands(world, ship),
            PilotKind::Apprentice | PilotKind::Expert => (),
        }
    }
}

/// Lets somebody with a person's limits fly a ship.
fn give_to_person(world: &mut World, ship: Entity, kind: PilotKind) {
    let seed = world.get_resource_mut::<Chance>().map_or(0, |mut chance| chance.0.random());
    world.entity_mut(ship).insert(Person::new(kind, seed));
}

/// Lets seeded hands fly a ship.
fn give_to_hands(world: &mut World, ship: Entity) {
    let seed = world.get_resource_mut::<Chance>().map_or(0, |mut chance| chance.0.random());
    world.entity_mut(ship).insert(Jerky::from_seed(seed));
}

/// Arms the player's ship and puts the mission at its first goal.
fn begin_mission(world: &mut World, scene: &Scene, bolts: u32) {
    let Some(mission) = scene.mission.clone() else { return };
    let Some(own) = scene.ships.iter().position(|ship| ship.player).map(|index| world.resource::<Fleet>().0[index]) else { return };
    let (Some(&motion), Some(&fuel)) = (world.get::<ShipMotion>(own), world.get::<Fuel>(own)) else { return };
    let mut ship = world.entity_mut(own);
    ship.insert((Gun { left: bolts, ready: 0.0 }, Trigger::default()));
    if !ship.contains::<Pilot>() {
        ship.insert((Pilot { order: PilotOrder::Rest, sees: Default::default() }, PilotState::default()));
    }
    let quarry = world.get_resource::<Chase>().and_then(|chase| chase.quarry);
    world.insert_resource(Chase { hunter: own, quarry, held: 0.0, by_goals: true, outcome: None });
    world.insert_resource(Progress::new(own, &motion.0, fuel.left));
    world.insert_resource(ActiveMission(mission));
}

/// One fixed step of a started world.
pub fn step(world: &mut World) {
    world.run_schedule(FixedUpdate);
}

/// How the chase ended, if it has, and at which T.
pub fn outcome(world: &World) -> Option<(super::Outcome, f64)> {
    world.get_resource::<Chase>().and_then(|chase| chase.outcome)
}

/// The others' skill from `[enemy]`; the autopilot's is its own default.
pub fn skills(config: &GameConfig) -> Skills {
    let enemy = &config.enemy;
    Skills {
        own: Skill::default(),
        enemy: Skill { replan_period: enemy.replan_period, horizon: enemy.horizon, reaction_delay: enemy.reaction_delay },
    }
}

fn defaults(config: &GameConfig) -> Defaults {
    Defaults {
        own_thrust: config.ship.thrust,
        own_fuel: config.ship.fuel,
        enemy_thrust: config.enemy.thrust,
        enemy_fuel: config.enemy.fuel,
        // Turns are given by the wall second; the simulation wants them by the r_s/c.
        max_rate: config.ship.turn_rate / config.clock.pace,
        sizes: [config.ship.size, config.enemy.size],
    }
}

/// Distances of the farthest vertices of the [`SHIP_MODELS`] from their centres, in lengths of the ship. Flights do not depend on what
/// other file a player puts in their place.
pub const RADII: [f64; 2] = [0.580613374710083, 0.6264112591743469];

/// Distance of the farthest vertex of a ship from its centre, in r_s; `sizes` are the lengths of hunters and of those who flee. A ship with
/// a model of its own flies as the first of the game's.
pub fn reach_of(spec: &ShipSpec, sizes: [f64; 2]) -> f64 {
    let model = SHIP_MODELS.iter().position(|name| *name == model_of(spec)).unwrap_or(0);
    RADII[model] * sizes[usize::from(spec.ai == Ai::Flee)]
}

/// What a scene leaves open, from the game's configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Defaults {
    /// For the player, and ships that nobody flies, c²/r_s.
    pub own_thrust: f64,
    /// Δv, in c.
    pub own_fuel: f64,
    /// For all others, c²/r_s.
    pub enemy_thrust: f64,
    /// Δv, in c.
    pub enemy_fuel: f64,
    /// The fastest turn, rad per proper r_s/c.
    pub max_rate: f64,
    /// Lengths of ships that hunt, and of those that flee, in r_s.
    pub sizes: [f64; 2],
}

/// Spawns the ships of a scene in its order and inserts the [`Fleet`]. Ships of an earlier scene are despawned.
fn muster(world: &mut World, specs: &[ShipSpec], defaults: &Defaults, time: f64) {
    if let Some(old) = world.remove_resource::<Fleet>() {
        for entity in old.0 {
            world.despawn(entity);
        }
    }
    let fleet = Fleet(specs.iter().enumerate().map(|(index, spec)| spawn(world, index, spec, defaults, time)).collect());
    for (index, spec) in specs.iter().enumerate() {
        let first_other = (0..specs.len()).find(|&other| other != index);
        let target = spec.target.as_ref().map_or(first_other.map(|other| fleet.0[other]), |name| fleet.find(name, specs));
        let order = match (spec.ai, target) {
            (Ai::Flee, Some(target)) => Some(PilotOrder::Escape(target)),
            (Ai::Pursue, Some(target)) => Some(PilotOrder::Catch(target)),
            _ => None,
        };
        if spec.ai == Ai::Hands {
            give_to_hands(world, fleet.0[index]);
        }
        if let Some(order) = order {
            world.entity_mut(fleet.0[index]).insert((Pilot { order, sees: spec.sees }, PilotState::default()));
        }
    }
    world.insert_resource(fleet);
}

fn spawn(world: &mut World, index: usize, spec: &ShipSpec, defaults: &Defaults, time: f64) -> Entity {
    let (thrust, tank) = match (spec.player, spec.ai) {
        (true, _) => (defaults.own_thrust, defaults.own_fuel),
        (false, Ai::None | Ai::Hands) => (defaults.own_thrust, f64::INFINITY),
        (false, Ai::Flee | Ai::Pursue) => (defaults.enemy_thrust, defaults.enemy_fuel),
    };
    let fuel = if spec.fuel.is_finite() { spec.fuel } else { tank };
    let mut entity = world.spawn((
        Ship { name: spec.name.clone(), index },
        ShipMotion(spec.state),
        Controls::default(),
        Fuel { left: fuel, capacity: fuel },
        Engine { max_thrust: spec.max_thrust.unwrap_or(thrust), max_rate: defaults.max_rate, reach: reach_of(spec, defaults.sizes) },
        (Turning::default(), Way::default(), ShownWay::default()),
        Programme(spec.programme.clone()),
        History::new(time, &spec.state),
        Hits::default(),
    ));
    if spec.player {
        entity.insert(Player);
    }
    entity.id()
}
