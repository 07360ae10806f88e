//! `[mission]`, `[[goal]]`, `[[gate]]` and `[difficulty.…]` in a scene file: what makes a scene a mission.
//!
//! ```toml
//! [mission]
//! title = "First pursuit"
//! idea = "A lower orbit is a faster one."      # what the mission rests on, in one sentence
//! brief = "…"                                  # what the player reads before it begins
//! clock = "T"                                  # what is scored: "T", the far clock; "tau", the player's own; or "fuel", the Δv spent
//! time_limit = 200.0                           # T in r_s/c: later it is lost; rules.time_limit of a difficulty goes before it
//! proper_limit = 50.0                          # the player's own time in r_s/c: later it is lost; no limit if absent
//! inside = false                               # whether the player's ship may cross the horizon
//! caught_by = ["hunter"]                       # ships that win by holding the player's ship as [rules] say
//! now_marker = true                            # whether the HUD shows where the target is at this moment
//!
//! [[goal]]                                     # one after the other, see `goal`
//! kind = "hold"
//! ship = "quarry"
//! text = "Stay with the quarry"
//!
//! [[gate]]                                     # in the order in which they are flown through, see `gate`
//! position = [6.0, 0.0, 0.0]
//! radius = 0.6
//!
//! [difficulty.easy]                            # also normal and hard: keys of game.toml that are otherwise than there
//! stars = [60.0, 100.0]                        # scores of three stars and of two, at most: r_s/c, or c of Δv
//! enemy.thrust = 0.03
//! ship.bolts = 12
//! ```

pub mod buttons;
mod difficulty;
mod gate;
mod goal;

use serde::Deserialize;
use toml::Spanned;

use super::config::GameConfig;
use super::document::fault::{Fault, fault, in_range};
use super::ship::ShipSpec;

pub use difficulty::{Difficulty, DifficultyLevel, levels};
pub use gate::{Gate, GateEntry};
pub use goal::{Goal, GoalEntry, GoalTask};

/// A mission: goals, limits and words over a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Mission {
    /// What it is called.
    pub title: String,
    /// What it rests on, in one sentence.
    pub idea: String,
    /// What the player reads before it begins.
    pub brief: String,
    /// What is scored.
    pub clock: ScoredBy,
    /// T in r_s/c after which it is lost.
    pub time_limit: f64,
    /// Proper time of the player's ship in r_s/c after which it is lost; infinite if there is none.
    pub proper_limit: f64,
    /// The player's ship may cross the horizon.
    pub inside: bool,
    /// Indices of the ships that win by holding the player's ship.
    pub caught_by: Vec<usize>,
    /// The HUD shows where the target is at this moment.
    pub now_marker: bool,
    /// What is to be done, one after the other.
    pub goals: Vec<Goal>,
    /// What is to be flown through, one after the other.
    pub gates: Vec<Gate>,
    /// What is otherwise on each difficulty, in the order of [`Difficulty::ALL`].
    pub levels: [DifficultyLevel; 3],
}

impl Mission {
    /// `game.toml` as it is on a difficulty where nobody has changed it.
    fn on(&self, difficulty: Difficulty) -> GameConfig {
        let mut config = GameConfig::default();
        self.levels[difficulty as usize].apply(&mut config);
        config
    }
}

/// What a mission's score is: the less the better.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum ScoredBy {
    /// Painlevé–Gullstrand T, the time far away.
    #[default]
    #[serde(rename = "T")]
    Far,
    /// The proper time of the player's ship.
    #[serde(rename = "tau")]
    Own,
    /// The velocity change that the player's ship has spent, in c.
    #[serde(rename = "fuel")]
    Fuel,
}

/// `[mission]` as the file has it, before any check.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MissionEntry {
    title: Spanned<String>,
    idea: Spanned<String>,
    brief: Spanned<String>,
    #[serde(default)]
    clock: ScoredBy,
    time_limit: Spanned<f64>,
    proper_limit: Option<Spanned<f64>>,
    #[serde(default)]
    inside: bool,
    #[serde(default)]
    caught_by: Vec<Spanned<String>>,
    #[serde(default = "yes")]
    now_marker: bool,
}

fn yes() -> bool {
    true
}

/// The most characters of a title, an idea, a goal's text; of a briefing ten times as many.
const MOST_LETTERS: usize = 120;
/// The most goals and gates of a mission.
const MOST_PARTS: usize = 64;

/// The mission of a scene with these ships, checked. `levels` come from [`levels`].
pub fn check_mission(
    entry: &MissionEntry,
    goals: &[Spanned<GoalEntry>],
    gates: &[Spanned<GateEntry>],
    ships: &[ShipSpec],
    levels: [DifficultyLevel; 3],
) -> Result<Mission, Fault> {
    for (words, most) in [(&entry.title, MOST_LETTERS), (&entry.idea, MOST_LETTERS), (&entry.brief, 10 * MOST_LETTERS)] {
        short(words, most)?;
    }
    let players: Vec<usize> = (0..ships.len()).filter(|&index| ships[index].player).collect();
    let &[own] = players.as_slice() else {
        return fault(&entry.title, format!("a mission needs one [[ship]] with player = true, not {}", players.len()));
    };
    if !entry.inside && ships[own].state.position.length() <= 1.0 {
        return fault(&entry.title, "the player's ship starts inside the horizon, where a mission with inside = false is lost".into());
    }
    for parts in [goals.iter().map(Spanned::span).collect::<Vec<_>>(), gates.iter().map(Spanned::span).collect()] {
        if let Some(span) = parts.get(MOST_PARTS) {
            return Err(Fault { span: span.clone(), message: format!("a mission has at most {MOST_PARTS} goals and as many gates") });
        }
    }
    let mission = Mission {
        title: entry.title.get_ref().clone(),
        idea: entry.idea.get_ref().clone(),
        brief: entry.brief.get_ref().trim().to_owned(),
        clock: entry.clock,
        time_limit: in_range(&entry.time_limit, "time_limit", 1.0..=1e6, "r_s/c")?,
        proper_limit: entry.proper_limit.as_ref().map_or(Ok(f64::INFINITY), |limit| in_range(limit, "proper_limit", 0.1..=1e6, "r_s/c"))?,
        inside: entry.inside,
        caught_by: entry.caught_by.iter().map(|name| ship_named(name, ships)).collect::<Result<_, _>>()?,
        now_marker: entry.now_marker,
        goals: goals.iter().map(|goal| goal.get_ref().check(ships)).collect::<Result<_, _>>()?,
        gates: gates.iter().map(|gate| gate.get_ref().check()).collect::<Result<_, _>>()?,
        levels,
    };
    if mission.goals.is_empty() {
        return fault(&entry.title, "a mission needs at least one [[goal]]".into());
    }
    if let Some(index) = mission.caught_by.iter().position(|&ship| ship == own) {
        return fault(&entry.caught_by[index], "caught_by names the player's own ship".into());
    }
    let burns: f64 = mission.goals.iter().map(|goal| if let GoalTask::Burn { amount } = goal.task { amount } else { 0.0 }).sum();
    for difficulty in Difficulty::ALL {
        let tank = if ships[own].fuel.is_finite() { ships[own].fuel } else { mission.on(difficulty).ship.fuel };
        if burns > tank {
            return fault(
                &entry.title,
                format!("its goals burn {burns} c, more than the {tank} c in the tanks on {difficulty}: it cannot be won"),
            );
        }
    }
    enough_bolts(&mission, goals)?;
    for (goal, written) in mission.goals.iter().zip(goals) {
        if goal.task.ship() == Some(own) {
            return Err(Fault { span: written.get_ref().ship_span(), message: "the goal's ship is the player's own".into() });
        }
        goal.reachable(&mission, written.get_ref().given_before())
            .map_err(|message| Fault { span: written.get_ref().kind_span(), message })?;
    }
    Ok(mission)
}

/// Whether there is a bolt for each hit that is asked for, on each difficulty.
fn enough_bolts(mission: &Mission, goals: &[Spanned<GoalEntry>]) -> Result<(), Fault> {
    let mut times_so_far = 0;
    // Hits on one ship count for all goals about it.
    let mut ships = Vec::new();
    for (goal, written) in mission.goals.iter().zip(goals) {
        let GoalTask::Hit { ship, times } = goal.task else { continue };
        if !ships.contains(&ship) {
            ships.push(ship);
            times_so_far += times;
        }
        if let Some(difficulty) = Difficulty::ALL.into_iter().find(|&difficulty| mission.on(difficulty).ship.bolts < times_so_far) {
            let bolts = mission.on(difficulty).ship.bolts;
            let message = format!("{times_so_far} hits up to here need as many bolts; [difficulty.{difficulty}] has ship.bolts = {bolts}");
            return Err(Fault { span: written.get_ref().kind_span(), message });
        }
    }
    Ok(())
}

/// The index of the ship of that name.
fn ship_named(name: &Spanned<String>, ships: &[ShipSpec]) -> Result<usize, Fault> {
    match ships.iter().position(|ship| &ship.name == name.get_ref()) {
        Some(index) => Ok(index),
        None => {
            let names: Vec<&str> = ships.iter().map(|ship| ship.name.as_str()).collect();
            fault(name, format!("{:?} must be a ship of the scene: {names:?}", name.get_ref()))
        }
    }
}

/// Words that are there and fit.
fn short(words: &Spanned<String>, most: usize) -> Result<(), Fault> {
    let length = words.get_ref().chars().count();
    if words.get_ref().chars().any(|letter| letter.is_control() && letter != '\n') {
        return fault(words, "the text has control characters".into());
    }
    if (1..=most).contains(&length) { Ok(()) } else { fault(words, format!("the text has {length} characters, allowed 1 to {most}")) }
}
