//! `[[goal]]`: one thing to be done in a mission.
//!
//! ```toml
//! [[goal]]
//! kind = "hold"                   # what is to be done, with its own keys: see `KINDS` and docs/scenes.md
//! ship = "quarry"
//! text = "Stay with the quarry"   # what the HUD says
//! hint = "Hold [boost]"           # how, for those who are slow; none if absent. [action]: the button bound to it
//! before = 100.0                  # T in r_s/c: the mission is lost when this is not done by then; no limit if absent
//! ```

use std::ops::Range;

use serde::de::Error;
use serde::{Deserialize, Deserializer};
use toml::Spanned;

use super::{Difficulty, MOST_LETTERS, Mission, buttons, ship_named, short};
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

impl Goal {
    /// Whether it can be reached at all in its mission, on each difficulty, else why not. `before`: its own limit, if it has one.
    pub(super) fn reachable(&self, mission: &Mission, before: Option<f64>) -> Result<(), String> {
        let limits = Difficulty::ALL.map(|difficulty| match mission.levels[difficulty as usize].number("rules.time_limit") {
            Some(limit) => (format!("rules.time_limit = {limit} of [difficulty.{difficulty}]"), limit),
            None => (format!("time_limit = {} of [mission]", mission.time_limit), mission.time_limit),
        });
        let mut limits: Vec<(String, f64)> = limits.into();
        if let Some(before) = before {
            if before > mission.time_limit {
                return Err(format!("before = {before} is later than time_limit = {} of [mission]: it never counts", mission.time_limit));
            }
            if before == 0.0 {
                return Err("before = 0 is the beginning: it cannot be reached".into());
            }
            limits.push((format!("before = {before}"), before));
        }
        let in_time = |value: f64, key: &str| match limits.iter().find(|(_, limit)| value > *limit) {
            Some((what, _)) => Err(format!("{key} = {value} is later than {what}: it cannot be reached")),
            None => Ok(()),
        };
        if let GoalTask::Reach { most, .. } | GoalTask::Whirl { most, .. } | GoalTask::Survive { most, .. } = self.task
            && most <= 1.0
            && !mission.inside
        {
            return Err(format!("radius = [.., {most}] lies inside the horizon, where a mission with inside = false is lost"));
        }
        match self.task {
            GoalTask::Survive { until, .. } => in_time(until, "until")?,
            GoalTask::Gates if mission.gates.is_empty() => return Err("kind = \"gates\" needs at least one [[gate]]".into()),
            GoalTask::Hold { span, .. }
            | GoalTask::Match { span, .. }
            | GoalTask::Reach { span, .. }
            | GoalTask::Look { span, .. }
            | GoalTask::Coast { span } => {
                in_time(span, "for")?;
            }
            _ => (),
        }
        Ok(())
    }
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
    /// Move as a ship does, near it.
    Match {
        /// Which.
        ship: usize,
        /// At most so far, on the slice T = const.
        distance: f64,
        /// At most so fast against it, in c.
        speed: f64,
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
            GoalTask::Look { ship, .. } | GoalTask::Hold { ship, .. } | GoalTask::Match { ship, .. } | GoalTask::Hit { ship, .. } => {
                Some(ship)
            }
            _ => None,
        }
    }
}

/// A kind of goal.
#[derive(Clone, Copy, Debug)]
struct Kind {
    name: &'static str,
    /// The keys that must be there.
    needed: Keys,
    /// Those that may be.
    optional: Keys,
    /// Its task from them.
    task: ReadTask,
}

type Keys = &'static [&'static str];
type ReadTask = fn(&GoalEntry, &[ShipSpec]) -> Result<GoalTask, Fault>;

const fn kind(name: &'static str, needed: Keys, optional: Keys, task: ReadTask) -> Kind {
    Kind { name, needed, optional, task }
}

/// All of them.
const KINDS: [Kind; 11] = [
    kind("burn", &["amount"], &[], |entry, _| Ok(GoalTask::Burn { amount: number(&entry.amount, "amount", 1e-3..=100.0, "c", 0.1)? })),
    kind("turn", &["angle"], &[], |entry, _| Ok(GoalTask::Turn { angle: entry.angle(1.0)? })),
    kind("coast", &["for"], &[], |entry, _| Ok(GoalTask::Coast { span: entry.span(1.0)? })),
    kind("look", &["ship"], &["angle", "for"], |entry, ships| {
        Ok(GoalTask::Look { ship: entry.ship(ships)?, angle: entry.angle(0.2)?, span: entry.span(0.0)? })
    }),
    kind("reach", &["radius"], &["for"], |entry, _| {
        let [least, most] = entry.radii()?;
        Ok(GoalTask::Reach { least, most, span: entry.span(0.0)? })
    }),
    kind("hold", &["ship"], &["distance", "for"], |entry, ships| {
        let distance = entry.distance.as_ref().map(|distance| in_range(distance, "distance", 0.01..=FARTHEST, "r_s")).transpose()?;
        Ok(GoalTask::Hold { ship: entry.ship(ships)?, distance, span: entry.span(f64::NAN)? })
    }),
    kind("match", &["ship", "distance", "speed"], &["for"], |entry, ships| {
        let distance = number(&entry.distance, "distance", 0.01..=FARTHEST, "r_s", 0.0)?;
        let speed = number(&entry.speed, "speed", 1e-3..=1.0, "c", 0.0)?;
        Ok(GoalTask::Match { ship: entry.ship(ships)?, distance, speed, span: entry.span(0.0)? })
    }),
    kind("hit", &["ship"], &["times"], |entry, ships| Ok(GoalTask::Hit { ship: entry.ship(ships)?, times: entry.times()? })),
    kind("survive", &["until"], &["radius"], |entry, _| {
        let [least, most] = entry.radii()?;
        Ok(GoalTask::Survive { until: number(&entry.until, "until", 0.0..=LONGEST, "r_s/c", 0.0)?, least, most })
    }),
    kind("gates", &[], &[], |_, _| Ok(GoalTask::Gates)),
    kind("whirl", &["turns", "radius"], &[], |entry, _| {
        let [least, most] = entry.radii()?;
        Ok(GoalTask::Whirl { turns: number(&entry.turns, "turns", 0.01..=1000.0, "turns", 1.0)?, least, most })
    }),
];

impl<'de> Deserialize<'de> for Kind {
    fn deserialize<D: Deserializer<'de>>(reader: D) -> Result<Kind, D::Error> {
        let name = String::deserialize(reader)?;
        KINDS.into_iter().find(|kind| kind.name == name).ok_or_else(|| {
            let known = KINDS.map(|kind| format!("`{}`", kind.name)).join(", ");
            Error::custom(format!("unknown variant `{name}`, expected one of {known}"))
        })
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
    speed: Option<Spanned<f64>>,
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
            ("speed", at(&self.speed)),
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
        let Kind { needed, optional, task, .. } = *self.kind.get_ref();
        if let Some((key, span)) = self.given().find(|(key, _)| !needed.contains(key) && !optional.contains(key)) {
            let known = [needed, optional].concat().join(", ");
            return Err(Fault { span, message: format!("{key} does not go with this kind; its keys: {known}") });
        }
        if let Some(missing) = needed.iter().find(|key| !self.given().any(|(given, _)| given == **key)) {
            return fault(&self.kind, format!("this kind needs {missing}"));
        }
        let before = number(&self.before, "before", 0.0..=LONGEST, "r_s/c", f64::INFINITY)?;
        Ok(Goal {
            text: self.text.get_ref().clone(),
            hint: self.hint.as_ref().map(|hint| hint.get_ref().clone()),
            task: task(self, ships)?,
            before,
        })
    }

    fn span(&self, default: f64) -> Result<f64, Fault> {
        number(&self.span, "for", 0.0..=LONGEST, "r_s/c", default)
    }

    fn angle(&self, default: f64) -> Result<f64, Fault> {
        number(&self.angle, "angle", 1e-3..=100.0, "rad", default)
    }

    fn ship(&self, ships: &[ShipSpec]) -> Result<usize, Fault> {
        self.ship.as_ref().map_or(Ok(0), |name| ship_named(name, ships))
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
