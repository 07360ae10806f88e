//! `[rules]` in a scene file: what ends the chase. All times in Painlevé–Gullstrand T.
//!
//! ```toml
//! [rules]
//! capture_radius = 0.5   # r_s: distance on the slice T = const
//! hold_time = 2.0        # r_s/c without a break inside the capture radius
//! time_limit = 400.0     # r_s/c
//! arena_radius = 20.0    # r_s: the AI keeps inside
//! ```

use serde::Deserialize;
use toml::Spanned;

use super::config::{self, Allowed, RulesConfig};
use super::document::fault::{Fault, fault, in_range};

/// What ends the chase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// A catch needs the hunter this close to its target, in r_s on the slice T = const.
    pub capture_radius: f64,
    /// ... for this long without a break, in r_s/c of T.
    pub hold_time: f64,
    /// The hunter loses when this much T has passed, in r_s/c.
    pub time_limit: f64,
    /// The AI turns back before this radius, in r_s.
    pub arena_radius: f64,
}

impl Default for Rules {
    fn default() -> Self {
        Rules::from(&RulesConfig::default())
    }
}

impl From<&RulesConfig> for Rules {
    fn from(config: &RulesConfig) -> Self {
        Rules {
            capture_radius: config.capture_radius,
            hold_time: config.hold_time,
            time_limit: config.time_limit,
            arena_radius: config.arena_radius,
        }
    }
}

/// `[rules]` as the file has it; keys left out keep their default.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RulesEntry {
    capture_radius: Option<Spanned<f64>>,
    hold_time: Option<Spanned<f64>>,
    time_limit: Option<Spanned<f64>>,
    arena_radius: Option<Spanned<f64>>,
}

impl RulesEntry {
    /// The rules, each value checked against its range, the missing ones from `base`.
    pub fn check(&self, base: Rules) -> Result<Rules, Fault> {
        let or = |value: &Option<Spanned<f64>>, key, base| value.as_ref().map_or(Ok(base), |value| ranged(value, key));
        Ok(Rules {
            capture_radius: or(&self.capture_radius, "capture_radius", base.capture_radius)?,
            hold_time: or(&self.hold_time, "hold_time", base.hold_time)?,
            time_limit: or(&self.time_limit, "time_limit", base.time_limit)?,
            arena_radius: or(&self.arena_radius, "arena_radius", base.arena_radius)?,
        })
    }
}

/// A value inside the range that `game.toml` allows for `rules.KEY`.
fn ranged(value: &Spanned<f64>, key: &str) -> Result<f64, Fault> {
    match config::setting(&format!("rules.{key}")).map(|setting| (setting.allowed, setting.unit)) {
        Some((Allowed::Number { min, max }, unit)) => in_range(value, key, min..=max, unit),
        _ => fault(value, format!("{key} is no rule")),
    }
}
