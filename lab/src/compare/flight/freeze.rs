//! A moment of a flight as a scene file of its own, to be looked at at T = 0.
//!
//! Ships start with the place, momentum and attitude that they have then, so they have coasted there, or hovered: what they burnt before is
//! lost, and where they are seen differs by that. The camera is free, as it is then. Whether it still fails is asked of the judge.

use std::f64::consts::TAU;

use glam::DVec3;
use toml::{Table, Value};

use lensrunner::judge::case::Case;
use lensrunner::spacetime::orbit::orbital_frequency;

/// The scene file `text`, of which `case` is a moment, with that moment at T = 0. None if it is no scene file.
pub fn freeze(text: &str, case: &Case) -> Option<String> {
    let mut table: Table = text.parse().ok()?;
    if let Some(ships) = table.get_mut("ship").and_then(Value::as_array_mut) {
        for (ship, history) in ships.iter_mut().zip(&case.histories) {
            let (ship, sample) = (ship.as_table_mut()?, history.at(case.time));
            ship.remove("orbit");
            ship.remove("thrust");
            ship.insert("position".into(), vector(sample.position));
            ship.insert("momentum".into(), vector(sample.momentum));
            let q = sample.attitude;
            ship.insert("attitude".into(), list(&[q.w, q.x, q.y, q.z]));
        }
    }
    let eye = &case.camera.observer;
    let mut camera = Table::new();
    camera.insert("position".into(), vector(eye.position));
    camera.insert("momentum".into(), vector(eye.momentum));
    camera.insert("look".into(), vector(eye.attitude * DVec3::NEG_Z));
    camera.insert("up".into(), vector(eye.attitude * DVec3::Y));
    camera.insert("fov".into(), Value::Float(eye.field_of_view.to_degrees()));
    table.insert("camera".into(), Value::Table(camera));
    if let (Some(entry), Some(planet)) = (table.get_mut("planet").and_then(Value::as_table_mut), &case.scene.planet) {
        let phase = planet.orbit.phase + orbital_frequency(planet.orbit.semi_latus_rectum) * case.time;
        entry.insert("phase".into(), Value::Float(phase.rem_euclid(TAU)));
    }
    toml::to_string(&table).ok()
}

fn vector(vector: DVec3) -> Value {
    list(&vector.to_array())
}

fn list(numbers: &[f64]) -> Value {
    Value::Array(numbers.iter().map(|number| Value::Float(*number)).collect())
}
