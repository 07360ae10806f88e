//! `[[goal]]`: one thing to be done in a mission.
//!
//! ```toml
//! [[goal]]
//! kind = "hold"          # what is to be done, with its own keys:
//! #   "burn"     amount (Δv in c): use the engine
//! #   "turn"     angle (radians): turn the ship
//! #   "coast"    for (r_s/c of T): fly with less than a twentieth of the thrust
//! #   "look"     ship, angle (radians, 0.2 if absent), for: have its image ahead, or look at it
//! #   "reach"    radius = [least, most] (r_s), for (0 if absent): be between two radii
//! #   "hold"     ship, distance (r_s), for (r_s/c of T): stay near a ship; absent: as [rules] say
//! #   "hit"      ship, times (1 if absent): hit it with bolts
//! #   "survive"  until (T in r_s/c), radius = [least, most] (any if absent): still be there, and never out of these radii
//! #   "gates"    fly through every [[gate]] in order
//! #   "whirl"    turns, radius = [least, most]: go round the hole so often between two radii
//! text = "Stay with the quarry"   # what the HUD says
//! hint = "Hold [boost]"           # how, for those who are slow; none if absent. [action]: the button bound to it
//! before = 100.0                  # T in r_s/c: the mission is lost when this is not done by then; no limit if absent
//! ```

use std::ops::Range;

use serde::Deserialize;
use toml::Spanned;

use super::{MOST_LETTERS, buttons, ship_named, short};
use crate::scene::document::exactly_or_none;
use crate::scene::document::fault::{Fault, fault, in_range};
use crate::scene::ship::ShipSpec;

/// One thing to be done.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// What the HUD says.
    pub text: String,
    /// How, for those who are slow.
    pub hint: Option<String>,
    /// What it is.
    pub task: GoalTask,
    /// T in r_s/c by which it must be done; infinite if there is no hurry.
    pub before: f64,
}

/// What is to be done. Ships by their index in the scene, lengths in r_s, times in r_s/c of T.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GoalTask {
    /// Spend this Δv, in c.
    Burn {
        /// In c.
        amount: f64,
    },
    /// Turn the ship by this angle in all.
    Turn {
        /// In radians.
        angle: f64,
    },
    /// Fly without thrust for so long.
    Coast {
        /// Without a break.
        span: f64,
    },
    /// Have the primary image of a ship ahead, or look at it.
    Look {
        /// Which.
        ship: usize,
        /// At most so far from the nose, in radians.
        angle: f64,
        /// Without a break.
        span: f64,
    },
    /// Be between two radii.
    Reach {
        /// The lower.
        least: f64,
        /// The upper.
        most: f64,
        /// Without a break.
        span: f64,
    },
    /// Stay near a ship. None: as the scene's rules say.
    Hold {
        /// Which.
        ship: usize,
        /// At most so far, on the slice T = const.
        distance: Option<f64>,
        /// Without a break.
        span: f64,
    },
    /// Hit a ship with bolts.
    Hit {
        /// Which.
        ship: usize,
        /// How often.
        times: u32,
    },
    /// Still be there at T = `until`.
    Survive {
        /// T.
        until: f64,
        /// The lower radius.
        least: f64,
        /// The upper: beyond it the mission is lost.
        most: f64,
    },
    /// Fly through all gates in order.
    Gates,
    /// Go round the hole, either way, between two radii.
    Whirl {
        /// How often; counted while between the radii.
        turns: f64,
        /// The lower radius.
        least: f64,
        /// The upper.
        most: f64,
    },
}

impl GoalTask {
    /// The ship that it is about.
    pub fn ship(&self) -> Option<usize> {
        match *self {
            GoalTask::Look { ship, .. } | GoalTask::Hold { ship, .. } | GoalTask::Hit { ship, .. } => Some(ship),
            _ => None,
        }
    }
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
enum Kind {
    Burn,
    Turn,
    Coast,
    Look,
    Reach,
    Hold,
    Hit,
    Survive,
    Gates,
    Whirl,
}

impl Kind {
    /// The keys that go with it, those that must be there first.
    fn keys(self) -> (&'static [&'static str], &'static [&'static str]) {
        match self {
            Kind::Burn => (&["amount"], &[]),
            Kind::Turn => (&["angle"], &[]),
            Kind::Coast => (&["for"], &[]),
            Kind::Look => (&["ship"], &["angle", "for"]),
            Kind::Reach => (&["radius"], &["for"]),
            Kind::Hold => (&["ship"], &["distance", "for"]),
            Kind::Hit => (&["ship"], &["times"]),
            Kind::Survive => (&["until"], &["radius"]),
            Kind::Gates => (&[], &[]),
            Kind::Whirl => (&["turns", "radius"], &[]),
        }
    }
}

/// `[[goal]]` as the file has it, before any check.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GoalEntry {
    kind: Spanned<Kind>,
    text: Spanned<String>,
    hint: Option<Spanned<String>>,
    before: Option<Spanned<f64>>,
    amount: Option<Spanned<f64>>,
    angle: Option<Spanned<f64>>,
    #[serde(rename = "for")]
    span: Option<Spanned<f64>>,
    ship: Option<Spanned<String>>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    radius: Option<Spanned<[f64; 2]>>,
    distance: Option<Spanned<f64>>,
    times: Option<Spanned<u32>>,
    until: Option<Spanned<f64>>,
    turns: Option<Spanned<f64>>,
}

/// The farthest a goal may lie, in r_s, and the longest it may take, in r_s/c.
const FARTHEST: f64 = 1e4;
/// See [`FARTHEST`].
const LONGEST: f64 = 1e6;

impl GoalEntry {
    /// Where the file says the kind.
    pub(super) fn kind_span(&self) -> Range<usize> {
        self.kind.span()
    }

    /// Where the file names the ship, else the kind.
    pub(super) fn ship_span(&self) -> Range<usize> {
        self.ship.as_ref().map_or_else(|| self.kind.span(), Spanned::span)
    }

    /// T by which it must be done, if the file says so.
    pub(super) fn given_before(&self) -> Option<f64> {
        self.before.as_ref().map(|before| *before.get_ref())
    }

    /// The keys that are there, and where.
    fn given(&self) -> impl Iterator<Item = (&'static str, Range<usize>)> + '_ {
        fn at<T>(value: &Option<Spanned<T>>) -> Option<Range<usize>> {
            value.as_ref().map(Spanned::span)
        }
        [
            ("amount", at(&self.amount)),
            ("angle", at(&self.angle)),
            ("for", at(&self.span)),
            ("ship", at(&self.ship)),
            ("radius", at(&self.radius)),
            ("distance", at(&self.distance)),
            ("times", at(&self.times)),
            ("until", at(&self.until)),
            ("turns", at(&self.turns)),
        ]
        .into_iter()
        .filter_map(|(key, span)| Some((key, span?)))
    }

    /// The goal, checked against the ships of its scene.
    pub(super) fn check(&self, ships: &[ShipSpec]) -> Result<Goal, Fault> {
        short(&self.text, MOST_LETTERS)?;
        if let Some(hint) = &self.hint {
            short(hint, 2 * MOST_LETTERS)?;
            buttons::check(hint)?;
        }
        let kind = *self.kind.get_ref();
        let (needed, allowed) = kind.keys();
        if let Some((key, span)) = self.given().find(|(key, _)| !needed.contains(key) && !allowed.contains(key)) {
            let known = [needed, allowed].concat().join(", ");
            return Err(Fault { span, message: format!("{key} does not go with this kind; its keys: {known}") });
        }
        if let Some(missing) = needed.iter().find(|key| !self.given().any(|(given, _)| given == **key)) {
            return fault(&self.kind, format!("this kind needs {missing}"));
        }
        let before = number(&self.before, "before", 0.0..=LONGEST, "r_s/c", f64::INFINITY)?;
        Ok(Goal {
            text: self.text.get_ref().clone(),
            hint: self.hint.as_ref().map(|hint| hint.get_ref().clone()),
            task: self.task(kind, ships)?,
            before,
        })
    }

    fn task(&self, kind: Kind, ships: &[ShipSpec]) -> Result<GoalTask, Fault> {
        let span = |default| number(&self.span, "for", 0.0..=LONGEST, "r_s/c", default);
        let ship = || self.ship.as_ref().map_or(Ok(0), |name| ship_named(name, ships));
        let angle = |default| number(&self.angle, "angle", 1e-3..=100.0, "rad", default);
        Ok(match kind {
            Kind::Burn => GoalTask::Burn { amount: number(&self.amount, "amount", 1e-3..=100.0, "c", 0.1)? },
            Kind::Turn => GoalTask::Turn { angle: angle(1.0)? },
            Kind::Coast => GoalTask::Coast { span: span(1.0)? },
            Kind::Look => GoalTask::Look { ship: ship()?, angle: angle(0.2)?, span: span(0.0)? },
            Kind::Reach => {
                let [least, most] = self.radii()?;
                GoalTask::Reach { least, most, span: span(0.0)? }
            }
            Kind::Hold => {
                let distance = self.distance.as_ref().map(|distance| in_range(distance, "distance", 0.01..=FARTHEST, "r_s")).transpose()?;
                GoalTask::Hold { ship: ship()?, distance, span: span(f64::NAN)? }
            }
            Kind::Hit => GoalTask::Hit { ship: ship()?, times: self.times()? },
            Kind::Survive => {
                let [least, most] = self.radii()?;
                GoalTask::Survive { until: number(&self.until, "until", 0.0..=LONGEST, "r_s/c", 0.0)?, least, most }
            }
            Kind::Gates => GoalTask::Gates,
            Kind::Whirl => {
                let [least, most] = self.radii()?;
                GoalTask::Whirl { turns: number(&self.turns, "turns", 0.01..=1000.0, "turns", 1.0)?, least, most }
            }
        })
    }

    fn radii(&self) -> Result<[f64; 2], Fault> {
        let Some(radii) = &self.radius else { return Ok([0.0, FARTHEST]) };
        let [least, most] = *radii.get_ref();
        if 0.0 <= least && least < most && most <= FARTHEST {
            Ok([least, most])
        } else {
            fault(radii, format!("radius = [{least}, {most}] must be two radii, the lesser first, from 0 to {FARTHEST} r_s"))
        }
    }

    fn times(&self) -> Result<u32, Fault> {
        match &self.times {
            Some(times) if !(1..=100).contains(times.get_ref()) => {
                fault(times, format!("times = {} must be from 1 to 100", times.get_ref()))
            }
            times => Ok(times.as_ref().map_or(1, |times| *times.get_ref())),
        }
    }
}

/// A number inside `range`, or the default where the key is absent.
fn number(value: &Option<Spanned<f64>>, key: &str, range: std::ops::RangeInclusive<f64>, unit: &str, default: f64) -> Result<f64, Fault> {
    value.as_ref().map_or(Ok(default), |value| in_range(value, key, range, unit))
}
