//! The game without graphics: ship physics, pilots, the rules of the chase, histories. Everything here runs without a GPU, and nothing
//! here knows of one.
//!
//! One fixed step is the schedule `FixedUpdate` with the sets [`SimSet`] in their order. The same scene, seed and inputs give the same
//! bits: ships go in scene order, chance comes from one seeded generator, time from [`Clock`] alone.

pub mod agent;
pub mod assist;
pub mod balance;
pub mod bolts;
pub mod by_hand;
pub mod check;
pub mod clock;
pub mod flight;
pub mod goals;
pub mod guidance;
pub mod hash;
pub mod history;
pub mod intercept;
pub mod known;
pub mod moment;
pub mod physics;
pub mod pilot;
pub mod player_commands;
pub mod replay;
pub mod rules;
pub mod run;
pub mod seeing;
pub mod setup;
pub mod ship;
pub mod sight;
pub mod simulate;
pub mod snapshot;
pub mod sweep;
pub mod target;

use bevy::app::PluginGroupBuilder;
use bevy::prelude::*;

pub use bolts::{Bolts, BoltsPlugin};
pub use by_hand::PlayerCommandsPlugin;
pub use clock::Clock;
pub use flight::Command;
pub use goals::{ActiveMission, GoalsPlugin, Progress};
pub use history::{History, Sample};
pub use moment::Moment;
pub use physics::ShipPhysicsPlugin;
pub use pilot::{Chance, EnemyAiPlugin, Skill, Skills};
pub use player_commands::PlayerCommands;
pub use replay::PlaybackPlugin;
pub use rules::{Chase, ChaseRules, ChaseRulesPlugin, Outcome, begin_chase};
pub use setup::{app_of, board, outcome, start, step};
pub use ship::{Controls, Ended, Engine, Fleet, Fuel, Manual, Ship, ShipMotion, Turning};

/// The order of a fixed step.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SimSet {
    /// A player's input becomes [`Controls`].
    Input,
    /// The pilots plan and set the [`Controls`] of their ships.
    Ai,
    /// Ships fly one step; histories grow; the clock goes on.
    Integrate,
    /// Catches, losses.
    Rules,
    /// For those who watch: logs, replays.
    Record,
}

/// Something worth telling.
#[derive(Message, Clone, Debug, PartialEq)]
pub enum SimEvent {
    /// A tank ran dry in the step that ended at `time`.
    FuelSpent {
        /// The ship's name.
        ship: String,
        /// T in r_s/c.
        time: f64,
    },
    /// A ship went through r = 1.
    CrossedHorizon {
        /// The ship's name.
        ship: String,
        /// T in r_s/c.
        time: f64,
    },
    /// A ship is no more.
    Ended {
        /// The ship's name.
        ship: String,
        /// T in r_s/c.
        time: f64,
        /// Its own time, in r_s/c.
        proper_time: f64,
        /// Why.
        reason: ship::EndReason,
    },
    /// A bolt hit a ship.
    Hit {
        /// The ship's name.
        ship: String,
        /// T in r_s/c.
        time: f64,
    },
    /// A goal of the mission is done.
    GoalDone {
        /// Which, from 1.
        goal: usize,
        /// T in r_s/c.
        time: f64,
    },
    /// The chase is decided.
    Decided {
        /// How.
        outcome: Outcome,
        /// T in r_s/c.
        time: f64,
    },
}

impl SimEvent {
    /// When it happened, T in r_s/c.
    pub fn time(&self) -> f64 {
        match self {
            SimEvent::FuelSpent { time, .. }
            | SimEvent::CrossedHorizon { time, .. }
            | SimEvent::Ended { time, .. }
            | SimEvent::Hit { time, .. }
            | SimEvent::GoalDone { time, .. }
            | SimEvent::Decided { time, .. } => *time,
        }
    }
}

impl std::fmt::Display for SimEvent {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            SimEvent::FuelSpent { ship, time } => write!(f, "{ship}: out of fuel at T = {time}"),
            SimEvent::CrossedHorizon { ship, time } => write!(f, "{ship}: crossed the horizon at T = {time}"),
            SimEvent::Hit { ship, time } => write!(f, "{ship}: hit at T = {time}"),
            SimEvent::GoalDone { goal, time } => write!(f, "goal {goal} done at T = {time}"),
            SimEvent::Decided { outcome, time } => write!(f, "{outcome} at T = {time}"),
            SimEvent::Ended { ship, time, proper_time, reason } => {
                write!(f, "{ship}: {reason} at T = {time}, tau = {proper_time}")
            }
        }
    }
}

/// The sets of a fixed step in their order.
pub struct SimSchedulePlugin;

impl Plugin for SimSchedulePlugin {
    fn build(&self, app: &mut App) {
        app.configure_sets(FixedUpdate, (SimSet::Input, SimSet::Ai, SimSet::Integrate, SimSet::Rules, SimSet::Record).chain());
    }
}

/// Everything the game is made of, without its graphics.
pub struct SimulationPlugins;

impl PluginGroup for SimulationPlugins {
    fn build(self) -> PluginGroupBuilder {
        PluginGroupBuilder::start::<Self>()
            .add(SimSchedulePlugin)
            .add(PlayerCommandsPlugin)
            .add(EnemyAiPlugin)
            .add(ShipPhysicsPlugin)
            .add(BoltsPlugin)
            .add(ChaseRulesPlugin)
            .add(GoalsPlugin)
            .add(PlaybackPlugin)
    }
}
