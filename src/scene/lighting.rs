//! What shines on things: the light that falls on a surface, the same for every renderer of a scene.

use std::f64::consts::TAU;

use glam::DVec3;

use super::assembly::Body;
use super::config::GameConfig;
use super::load::Scene;

/// Light that falls on an object from around it: ambient and first harmonic, per channel, in the scene's unit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Illumination {
    /// The mean of what shines, linear RGB.
    pub ambient: [f32; 3],
    /// For each channel the vector whose product with a surface normal (rain axes) is added.
    pub directed: [[f32; 3]; 3],
}

/// What shines in a scene.
#[derive(Clone, Copy, Debug)]
pub struct Lights {
    /// There are ships. Without any it is a picture of shapes, lit from everywhere.
    has_ships: bool,
    /// There is an accretion disk.
    has_disk: bool,
    /// The light of the scene where nothing else shines.
    ambient: f32,
}

impl Lights {
    /// The lights of a scene.
    pub fn of(scene: &Scene, config: &GameConfig) -> Lights {
        Lights { has_ships: !scene.ships.is_empty(), has_disk: scene.disk(config).is_some(), ambient: config.render.ambient as f32 }
    }

    /// What shines on a body whose centre is at `position` (r_s).
    pub fn on(&self, body: &Body, position: DVec3) -> Illumination {
        match body {
            Body::Planet => on_planet(position, self.has_disk),
            _ => at(position, self.has_ships, self.ambient),
        }
    }
}

/// What shines on an object at `position` (r_s). Without ships it is a picture of shapes: light from everywhere, and a little from above,
/// so that they look round. Flying ships are lit by the disk's inner ring (an annulus at r = 3 to 6 in the plane z = 0, light bent little
/// at this distance) and by the stars, `ambient` being the light of the scene where nothing else shines.
fn at(position: DVec3, has_ships: bool, ambient: f32) -> Illumination {
    if !has_ships {
        return Illumination { ambient: [0.75; 3], directed: [[0.0, 0.25, 0.0]; 3] };
    }
    // Twelve points of the ring, each a patch that sends light as its cosine says.
    let mut directed = DVec3::ZERO;
    let mut total = 0.0;
    for k in 0..12 {
        let azimuth = TAU * f64::from(k) / 12.0;
        let to_source = DVec3::new(4.0 * azimuth.cos(), 4.0 * azimuth.sin(), 0.0) - position;
        let distance = to_source.length().max(0.5);
        let cosine = (to_source.z.abs() / distance).max(0.05);
        let light = cosine / (distance * distance);
        directed += to_source / distance * light;
        total += light;
    }
    // Hot gas, a little warmer than white; strength so that a ship at r = 8 is well lit.
    let colour = [1.0, 0.82, 0.62].map(|c: f32| c * 14.0);
    let tint = |c: f32| (directed.as_vec3() * (0.5 * c)).to_array();
    Illumination { ambient: colour.map(|c| ambient * 1.5 + 0.25 * total as f32 * c), directed: colour.map(tint) }
}

/// Light on a planet's night side, where only stars shine; and on its day side, if a disk shines on it.
const NIGHT: f32 = 0.004;
const DAY: f32 = 0.35;
/// A scene without a disk is lit by the stars beyond the hole, gathered by its lensing: just enough to see the planet by.
const STARLIGHT: f32 = 0.015;

/// What shines on a planet at `position` (r_s): day on the side that faces the hole.
fn on_planet(position: DVec3, has_disk: bool) -> Illumination {
    let to_hole = -position.normalize_or_zero();
    let day = if has_disk { DAY } else { STARLIGHT };
    let directed = [1.0, 0.85, 0.68].map(|c: f32| (to_hole.as_vec3() * (0.5 * day * c)).to_array());
    Illumination { ambient: [NIGHT, NIGHT, 1.2 * NIGHT], directed }
}
