//! `[[swarm]]` in a scene file: many ships alike on circular orbits, which nobody flies.
//!
//! ```toml
//! [[swarm]]
//! name = "drone"                 # the ships are "drone 1", "drone 2", …; they come after those of [[ship]]
//! count = 80
//! radius = [4.0, 9.0]            # least and greatest radius of the orbits, r_s, above 1.5
//! inclination = [0.0, 3.1415926] # least and greatest, rad; above π/2 they go round the other way
//! model = "quarry.glb"
//! ```
//! Radius, inclination, node and phase are spread evenly and alike in every run; each ship begins with its nose along its course.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DQuat, DVec3};
use serde::Deserialize;
use toml::Spanned;

use super::document::fault::{Fault, fault};
use super::document::{exactly, exactly_or_none};
use super::ship::{MAX_START_RADIUS, MOST_SHIPS, ShipSpec};
use crate::spacetime::orbit::{Elements, OrbitError};

/// `[[swarm]]` as the file has it, before any check.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SwarmEntry {
    name: Spanned<String>,
    count: Spanned<u32>,
    #[serde(deserialize_with = "exactly")]
    radius: Spanned<[f64; 2]>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    inclination: Option<Spanned<[f64; 2]>>,
    model: Option<Spanned<String>>,
}

/// Checks all swarms of a scene of so many other ships, and makes their ships.
pub fn check_swarms(entries: &[SwarmEntry], others: usize) -> Result<Vec<ShipSpec>, Fault> {
    let mut ships = Vec::new();
    for (number, swarm) in entries.iter().enumerate() {
        if entries[..number].iter().any(|other| other.name.get_ref() == swarm.name.get_ref()) {
            return fault(&swarm.name, format!("name = {:?} is taken by an earlier swarm; names must differ", swarm.name.get_ref()));
        }
        ships.extend(swarm.check(MOST_SHIPS.saturating_sub(others + ships.len()))?);
    }
    Ok(ships)
}

/// φ⁵ = φ + 1. Multiples of (1/φ, 1/φ², 1/φ³, 1/φ⁴), without their whole parts, fill the cube of four dimensions evenly, however many are
/// taken.
const PHI: f64 = 1.167_303_978_261_418_7;

impl SwarmEntry {
    /// What it says of its model, and where.
    pub(super) fn model(&self) -> Option<&Spanned<String>> {
        self.model.as_ref()
    }

    /// Its ships, checked; `room`: how many the scene may still have.
    fn check(&self, room: usize) -> Result<Vec<ShipSpec>, Fault> {
        let name = self.name.get_ref();
        // A number is added to it.
        if !(1..=50).contains(&name.len()) || name.chars().any(|c| c == ',' || c == '"' || c.is_control()) {
            return fault(
                &self.name,
                format!("name = {name:?} must have 1 to 50 characters, without commas, quotes and control characters"),
            );
        }
        let count = *self.count.get_ref();
        if count == 0 || count as usize > room {
            return fault(&self.count, format!("count = {count} must be from 1 to {room}: all ships of a scene are at most {MOST_SHIPS}"));
        }
        let radius = self.range(&self.radius, "radius", [1.5, MAX_START_RADIUS], "r_s")?;
        let inclination = match &self.inclination {
            Some(written) => self.range(written, "inclination", [0.0, PI], "rad")?,
            None => [0.0, PI],
        };
        let ship = |number: u32| -> Result<ShipSpec, OrbitError> {
            let [r, tilt, node, phase] = [1.0, 2.0, 3.0, 4.0].map(|power| (f64::from(number) * libm::pow(PHI, -power)).fract());
            let between = |[least, most]: [f64; 2], share: f64| least + share * (most - least);
            let circle = Elements::circle(between(radius, r), phase * TAU);
            let mut state = Elements { inclination: between(inclination, tilt), node: node * TAU, ..circle }.state()?;
            state.attitude = nose_along(state.momentum, state.position);
            let model = self.model.as_ref().map(|model| model.get_ref().clone());
            Ok(ShipSpec { model, ..ShipSpec::coasting(format!("{name} {number}"), state) })
        };
        let nearest = Elements::circle(radius[0], 0.0).state();
        let ships = nearest.and_then(|_| (1..=count).map(ship).collect());
        ships.or_else(|error| fault(&self.radius, format!("radius: {error}")))
    }

    /// A least and a greatest number within a range.
    fn range(&self, value: &Spanned<[f64; 2]>, key: &str, [from, to]: [f64; 2], unit: &str) -> Result<[f64; 2], Fault> {
        let [least, most] = *value.get_ref();
        if from <= least && least <= most && most <= to {
            return Ok([least, most]);
        }
        fault(value, format!("{key} = [{least}, {most}] must be a least and a greatest number from {from} to {to} {unit}"))
    }
}

/// Body axes to rain axes, −z along `course` and +y away from the hole.
fn nose_along(course: DVec3, outward: DVec3) -> DQuat {
    let back = -course.normalize();
    let right = outward.cross(back).normalize();
    DQuat::from_mat3(&DMat3::from_cols(right, back.cross(right), back))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phi_solves_its_equation() {
        assert!((PHI.powi(5) - PHI - 1.0).abs() < 1e-14);
    }
}
