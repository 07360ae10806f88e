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

use super::document::fault::{Fault, in_range};

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
        Rules { capture_radius: 0.5, hold_time: 2.0, time_limit: 400.0, arena_radius: 20.0 }
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
        let or = |value: &Option<Spanned<f64>>, key, low, high, unit, base| match value {
            Some(value) => in_range(value, key, low..=high, unit),
            None => Ok(base),
        };
        Ok(Rules {
            capture_radius: or(&self.capture_radius, "capture_radius", 0.01, 100.0, "r_s", base.capture_radius)?,
            hold_time: or(&self.hold_time, "hold_time", 0.0, 1000.0, "r_s/c", base.hold_time)?,
            time_limit: or(&self.time_limit, "time_limit", 1.0, 1e9, "r_s/c", base.time_limit)?,
            arena_radius: or(&self.arena_radius, "arena_radius", 5.0, 1e6, "r_s", base.arena_radius)?,
        })
    }
}
