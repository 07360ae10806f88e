//! `[expect]` in a scene or mission file: what must become of it, for `check`.
//!
//! ```toml
//! [expect]
//! pilot = "expert"        # who flies the player's ship: "naive", "apprentice", "hands" or "expert" (if absent)
//! difficulty = "normal"   # of a mission
//! seed = 1                # for everything left to chance; 0 if absent
//! until = 100.0           # T in r_s/c at which it ends; the time limit if absent
//! outcome = "done"        # how it ends: see OUTCOMES
//! time = [20.0, 100.0]    # T at the end lies between, in r_s/c
//! own_time = [10.0, 90.0] # so does the proper time of the player's ship (or of the first), in r_s/c
//! radius = [1.5, 20.0]    # and that ship's distance from the hole, always, in r_s
//! fuel = 0.5              # that ship has at least so much Δv left, in c
//! drift = [1e-9, 1e-9]    # E and L (r_s c) of no ship change by more, per mass
//! hash = "17b8f936f8317887"  # of the end state
//! ```

use serde::Deserialize;
use toml::Spanned;

use super::document::exactly_or_none;
use super::document::fault::{Fault, fault, in_range};
use super::mission::Difficulty;
use super::pilot_kind::PilotKind;

/// The words for how a flight ends: `sim::Outcome` by name, and "undecided".
pub const OUTCOMES: [&str; 9] = ["caught", "hunter-lost", "quarry-lost", "time-out", "done", "taken", "ship-lost", "strayed", "undecided"];

/// What must become of a flight. Ranges are from the least to the greatest allowed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Expect {
    /// At the player's ship.
    pub pilot: PilotKind,
    /// Of a mission.
    pub difficulty: Difficulty,
    /// For everything left to chance.
    pub seed: u64,
    /// T at which it ends, in r_s/c.
    pub until: Option<f64>,
    /// One of [`OUTCOMES`].
    pub outcome: Option<String>,
    /// T at the end, in r_s/c.
    pub time: Option<[f64; 2]>,
    /// Proper time at the end, in r_s/c.
    pub own_time: Option<[f64; 2]>,
    /// Distance from the hole, in r_s.
    pub radius: Option<[f64; 2]>,
    /// Δv left at least, in c.
    pub fuel: Option<f64>,
    /// The largest change of E and L per mass, in 1 and r_s c.
    pub drift: Option<[f64; 2]>,
    /// Of the end state.
    pub hash: Option<String>,
}

/// `[expect]` as the file has it, before any check.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExpectEntry {
    pilot: Option<Spanned<String>>,
    difficulty: Option<Spanned<String>>,
    #[serde(default)]
    seed: u64,
    until: Option<Spanned<f64>>,
    outcome: Option<Spanned<String>>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    time: Option<Spanned<[f64; 2]>>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    own_time: Option<Spanned<[f64; 2]>>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    radius: Option<Spanned<[f64; 2]>>,
    fuel: Option<Spanned<f64>>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    drift: Option<Spanned<[f64; 2]>>,
    hash: Option<Spanned<String>>,
}

/// Of [`OUTCOMES`], those that a chase alone can have, and those that a mission alone can have.
const OF_CHASES: [&str; 2] = ["caught", "hunter-lost"];
/// See [`OF_CHASES`].
const OF_MISSIONS: [&str; 4] = ["done", "taken", "ship-lost", "strayed"];

/// Checks `[expect]` of a mission, or of another scene.
pub fn check_expect(entry: &ExpectEntry, is_mission: bool) -> Result<Expect, Fault> {
    let range = |value: &Option<Spanned<[f64; 2]>>, key: &str| match value {
        Some(written) => match *written.get_ref() {
            [low, high] if 0.0 <= low && low <= high => Ok(Some([low, high])),
            [low, high] => fault(written, format!("{key} = [{low}, {high}] must be two numbers from 0 on, the lesser first")),
        },
        None => Ok(None),
    };
    let hash = match &entry.hash {
        Some(hash) if hash.get_ref().len() != 16 || !hash.get_ref().bytes().all(|byte| byte.is_ascii_hexdigit()) => {
            return fault(hash, "hash must be 16 hexadecimal digits, as `simulate` says them".into());
        }
        hash => hash.as_ref().map(|hash| hash.get_ref().to_ascii_lowercase()),
    };
    let outcome = match &entry.outcome {
        Some(outcome) if !OUTCOMES.contains(&outcome.get_ref().as_str()) => {
            return fault(outcome, format!("outcome = {:?} must be one of {}", outcome.get_ref(), OUTCOMES.join(", ")));
        }
        Some(outcome) if (if is_mission { &OF_CHASES[..] } else { &OF_MISSIONS[..] }).contains(&outcome.get_ref().as_str()) => {
            let [own, other] = if is_mission { ["a mission", "a chase"] } else { ["a chase", "a mission"] };
            return fault(outcome, format!("outcome = {:?}: {own} never ends so, only {other}", outcome.get_ref()));
        }
        outcome => outcome.as_ref().map(|outcome| outcome.get_ref().clone()),
    };
    let drift = match &entry.drift {
        Some(written) if written.get_ref().iter().any(|drift| !(0.0..=1e9).contains(drift)) => {
            return fault(written, "drift must be two numbers from 0 to 1e9".into());
        }
        drift => drift.as_ref().map(|drift| *drift.get_ref()),
    };
    Ok(Expect {
        pilot: word(&entry.pilot)?,
        difficulty: word(&entry.difficulty)?,
        seed: entry.seed,
        until: entry.until.as_ref().map(|until| in_range(until, "until", 0.0..=1e6, "r_s/c")).transpose()?,
        outcome,
        time: range(&entry.time, "time")?,
        own_time: range(&entry.own_time, "own_time")?,
        radius: range(&entry.radius, "radius")?,
        fuel: entry.fuel.as_ref().map(|fuel| in_range(fuel, "fuel", 0.0..=1e9, "c")).transpose()?,
        drift,
        hash,
    })
}

/// A word that stands for a value; the usual one where it is absent.
fn word<T: std::str::FromStr<Err = String> + Default>(written: &Option<Spanned<String>>) -> Result<T, Fault> {
    written
        .as_ref()
        .map_or(Ok(T::default()), |written| written.get_ref().parse().map_err(|message| Fault { span: written.span(), message }))
}
