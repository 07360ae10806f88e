//! `[[gate]]`: a ring held in place, to be flown through.
//!
//! ```toml
//! [[gate]]
//! position = [6.0, 0.0, 0.0]   # r_s; outside r = 1, where alone a thing can be held
//! radius = 0.6                 # r_s
//! normal = [0.0, 1.0, 0.0]     # across the ring's plane; round the hole's z axis if absent
//! ```

use glam::DVec3;
use serde::Deserialize;
use toml::Spanned;

use crate::scene::document::fault::{Fault, fault, in_range};
use crate::scene::document::{exactly, exactly_or_none};

/// A ring held in place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gate {
    /// Its middle, in r_s.
    pub position: DVec3,
    /// In r_s.
    pub radius: f64,
    /// The unit vector across its plane.
    pub normal: DVec3,
}

impl Gate {
    /// Whether the straight line from `from` to `to` (r_s) goes through the ring, either way.
    pub fn is_passed(&self, from: DVec3, to: DVec3) -> bool {
        let [before, after] = [from, to].map(|place| (place - self.position).dot(self.normal));
        if before * after > 0.0 || before == after {
            return false;
        }
        let place = from + (to - from) * (before / (before - after));
        place.distance(self.position) <= self.radius
    }
}

/// `[[gate]]` as the file has it, before any check.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GateEntry {
    #[serde(deserialize_with = "exactly")]
    position: Spanned<[f64; 3]>,
    radius: Spanned<f64>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    normal: Option<Spanned<[f64; 3]>>,
}

/// The nearest to the hole that a gate may be held, in r_s, and the farthest.
const NEAREST: f64 = 1.05;
/// See [`NEAREST`].
const FARTHEST: f64 = 1e4;

impl GateEntry {
    /// The gate, checked.
    pub(super) fn check(&self) -> Result<Gate, Fault> {
        let position = DVec3::from_array(*self.position.get_ref());
        let r = position.length();
        if !(NEAREST..=FARTHEST).contains(&r) {
            let message =
                format!("the gate is {r} r_s from the hole, allowed {NEAREST} to {FARTHEST} r_s: inside r = 1 nothing can be held");
            return fault(&self.position, message);
        }
        let radius = in_range(&self.radius, "radius", 0.05..=100.0, "r_s")?;
        let around = DVec3::Z.cross(position).try_normalize().unwrap_or(DVec3::X);
        let normal = match &self.normal {
            None => around,
            Some(written) => match DVec3::from_array(*written.get_ref()).try_normalize() {
                Some(normal) => normal,
                None => return fault(written, "normal must be a vector of finite length, not zero".into()),
            },
        };
        Ok(Gate { position, radius, normal })
    }
}
