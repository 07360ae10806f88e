//! The rules of the chase, in `SimSet::Rules`: a catch is being within the capture radius for the hold time; the hunter loses by its own
//! fall through the horizon or when the time is out.

use bevy::prelude::*;

use crate::scene::rules::Rules;

use super::clock::Clock;
use super::ship::{CrossedHorizon, Ended, Fleet, Pilot, PilotOrder, Player, ShipMotion};
use super::{SimEvent, SimSet};

/// The rules in force.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub struct ChaseRules(pub Rules);

/// How a chase ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The hunter held the quarry within the capture radius.
    Caught,
    /// The hunter crossed the horizon.
    HunterLost,
    /// The quarry crossed the horizon, uncaught.
    QuarryLost,
    /// The time is out.
    TimeOut,
    /// All goals of the mission are done.
    Done,
    /// The player's ship was caught.
    Taken,
    /// The player's ship is lost.
    ShipLost,
    /// The player's ship has left where it was to stay.
    Strayed,
}

impl Outcome {
    /// All.
    pub const ALL: [Outcome; 8] = [
        Outcome::Caught,
        Outcome::HunterLost,
        Outcome::QuarryLost,
        Outcome::TimeOut,
        Outcome::Done,
        Outcome::Taken,
        Outcome::ShipLost,
        Outcome::Strayed,
    ];

    /// As `[expect]` and tables write it.
    pub fn name(self) -> &'static str {
        match self {
            Outcome::Caught => "caught",
            Outcome::HunterLost => "hunter-lost",
            Outcome::QuarryLost => "quarry-lost",
            Outcome::TimeOut => "time-out",
            Outcome::Done => "done",
            Outcome::Taken => "taken",
            Outcome::ShipLost => "ship-lost",
            Outcome::Strayed => "strayed",
        }
    }

    /// Whether the player has won.
    pub fn is_won(self) -> bool {
        matches!(self, Outcome::Caught | Outcome::Done)
    }
}

impl std::fmt::Display for Outcome {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Outcome::Caught => "the quarry is caught",
            Outcome::HunterLost => "the hunter crossed the horizon",
            Outcome::QuarryLost => "the quarry crossed the horizon",
            Outcome::TimeOut => "the time is out",
            Outcome::Done => "the mission is done",
            Outcome::Taken => "the ship is caught",
            Outcome::ShipLost => "the ship is lost",
            Outcome::Strayed => "the ship strayed too far",
        })
    }
}

/// The chase of a scene: present when a ship has an AI and there are a hunter and a quarry.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct Chase {
    /// The player's ship, or the first that pursues.
    pub hunter: Entity,
    /// Whom it hunts; in a mission the ship that the present goal is about, if there was one yet.
    pub quarry: Option<Entity>,
    /// For how long the quarry has been within the capture radius, in r_s/c of T; in a mission how much of the present goal is done.
    pub held: f64,
    /// A mission's goals decide it, not these rules.
    pub by_goals: bool,
    /// How it ended, and at which T; None while it goes on.
    pub outcome: Option<(Outcome, f64)>,
}

/// Judges the chase after each step.
pub struct ChaseRulesPlugin;

impl Plugin for ChaseRulesPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ChaseRules>()
            .add_message::<SimEvent>()
            .add_systems(FixedUpdate, judge_chase.run_if(resource_exists::<Chase>).in_set(SimSet::Rules));
    }
}

/// Finds hunter and quarry among the ships and inserts the [`Chase`]; removes it when no ship has an AI or there is no such pair.
pub fn begin_chase(world: &mut World) {
    world.remove_resource::<Chase>();
    let Some(fleet) = world.get_resource::<Fleet>().cloned() else { return };
    let order = |entity: Entity| world.get::<Pilot>(entity).map(|pilot| pilot.order);
    if !fleet.0.iter().any(|&entity| order(entity).is_some()) {
        return;
    }
    let player = fleet.0.iter().find(|&&entity| world.get::<Player>(entity).is_some());
    let Some(&hunter) = player.or_else(|| fleet.0.iter().find(|&&entity| matches!(order(entity), Some(PilotOrder::Catch(_))))) else {
        return;
    };
    let target = order(hunter).and_then(PilotOrder::target);
    let fleeing = || fleet.0.iter().copied().find(|&entity| matches!(order(entity), Some(PilotOrder::Escape(_))) && entity != hunter);
    let other = || fleet.0.iter().copied().find(|&entity| entity != hunter);
    let Some(quarry) = target.or_else(fleeing).or_else(other) else { return };
    world.insert_resource(Chase { hunter, quarry: Some(quarry), held: 0.0, by_goals: false, outcome: None });
}

/// Runs after the ships have flown: `clock.time` is the T of their states.
pub fn judge_chase(
    clock: Res<Clock>,
    rules: Res<ChaseRules>,
    mut chase: ResMut<Chase>,
    ships: Query<(&ShipMotion, Has<CrossedHorizon>, Has<Ended>)>,
    mut events: MessageWriter<SimEvent>,
) {
    if chase.outcome.is_some() || chase.by_goals {
        return;
    }
    let (Ok(hunter), Some(Ok(quarry))) = (ships.get(chase.hunter), chase.quarry.map(|quarry| ships.get(quarry))) else { return };
    let lost = |ship: (&ShipMotion, bool, bool)| ship.1 || ship.2;
    let near = hunter.0.0.position.distance(quarry.0.0.position) <= rules.0.capture_radius;
    chase.held = if near { chase.held + clock.step } else { 0.0 };
    let outcome = if lost(hunter) {
        Outcome::HunterLost
    } else if near && chase.held >= rules.0.hold_time {
        Outcome::Caught
    } else if lost(quarry) {
        Outcome::QuarryLost
    } else if clock.time >= rules.0.time_limit {
        Outcome::TimeOut
    } else {
        return;
    };
    chase.outcome = Some((outcome, clock.time));
    events.write(SimEvent::Decided { outcome, time: clock.time });
}
