//! `[planet]` and `[sky]` in a scene file.
//!
//! ```toml
//! [planet]
//! orbit_radius = 25.0    # r_s: a circular geodesic
//! inclination = 0.2      # radians, of the orbit against z = 0
//! node = 0.0             # radians, azimuth of the ascending node
//! phase = 0.0            # radians from the node to the planet at T = 0
//! radius = 0.8           # r_s
//! day = 40.0             # r_s/c: one turn about its axis
//! axis_tilt = 0.3        # radians between axis and z
//! dipole_tilt = 0.2      # radians between magnetic and rotation axis
//! seed = 1               # which clouds and continents
//! aurora = "oval"        # "oval" round both magnetic poles, "arcs" at the north magnetic meridian, or "none"
//! aurora_flux = 1.0      # energy that comes down in it, times aurora.flux of game.toml: near a bright disk there is more of everything
//!
//! [sky]
//! stars = true
//! milky_way = true
//! brightness = 1.0       # factor on both
//! ```

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DQuat, DVec3};
use serde::Deserialize;
use toml::Spanned;

use super::document::fault::{Fault, in_range};
use super::model::{Material, Model};
use super::model::{shapes, texture};
use crate::spacetime::matter::ShipState;
use crate::spacetime::orbit::{Elements, orbital_frequency};

/// A planet on a circular orbit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Planet {
    /// Its orbit.
    pub orbit: Elements,
    /// In r_s.
    pub radius: f64,
    /// One turn about its axis, in r_s/c.
    pub day: f64,
    /// Between the rotation axis and z, in radians.
    pub axis_tilt: f64,
    /// Between the magnetic and the rotation axis, in radians.
    pub dipole_tilt: f64,
    /// Which clouds and continents.
    pub seed: u32,
    /// Its aurora.
    pub aurora: AuroraShape,
    /// Energy that comes down in it, times `aurora.flux` of game.toml.
    pub aurora_flux: f64,
}

/// Where a planet's aurora is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum AuroraShape {
    /// Curtains round both magnetic poles.
    #[default]
    Oval,
    /// Arcs over the place at magnetic latitude 67.9°, longitude 0.
    Arcs,
    /// There is none.
    None,
}

impl Planet {
    /// The planet's centre at T = `time` as a ship's state; its body axes are the model's: +y the axis of rotation.
    pub fn state(&self, time: f64) -> Option<ShipState> {
        let radius = self.orbit.semi_latus_rectum;
        let phase = self.orbit.phase + orbital_frequency(radius) * time;
        let state = Elements { phase, ..self.orbit }.state().ok()?;
        Some(ShipState { attitude: self.attitude(time), ..state })
    }

    /// Model axes (+y the axis of rotation) to rain axes at T = `time`.
    fn attitude(&self, time: f64) -> DQuat {
        // y to z, tilted about x, then turned about its own axis.
        DQuat::from_rotation_x(self.axis_tilt + FRAC_PI_2) * DQuat::from_rotation_y(TAU * (time / self.day).fract())
    }

    /// The magnetic dipole's axes (+z its north) to the model's.
    pub fn dipole(&self) -> DQuat {
        DQuat::from_rotation_x(-FRAC_PI_2 + self.dipole_tilt)
    }

    /// A unit sphere of diameter 1 with clouds and continents.
    pub fn model(&self) -> Model {
        let material = Material { base_colour: [1.0; 4], texture: Some(texture::planet(self.seed)), ..Material::default() };
        shapes::uv_sphere(TRIANGLES, material)
    }

    /// The same of fewer triangles, for images narrower than so many pixels, the coarsest first; `model` is the full one, whose material
    /// they share.
    ///
    /// They are as large as it is to the eye: a convex body's outline covers a quarter of its surface in the mean over all directions
    /// (Cauchy 1832), so they get its surface. Their corners then stand out as far as their sides cut in, and of an outline two to three
    /// times less is wrong than if the corners lay on the globe.
    pub fn stand_ins(&self, model: &Model) -> Vec<(f64, Model)> {
        let material = model.materials.first().cloned().unwrap_or_default();
        let stand_in = |triangles| {
            let mut globe = shapes::uv_sphere(triangles, material.clone());
            let scale = (surface(model) / surface(&globe)).sqrt() as f32;
            globe.vertices.iter_mut().for_each(|vertex| vertex.position = vertex.position.map(|x| x * scale));
            globe
        };
        STAND_INS.into_iter().map(|(below, triangles)| (below, stand_in(triangles))).collect()
    }
}

/// The area of a model's triangles, in its unit squared.
fn surface(model: &Model) -> f64 {
    let area = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| DVec3::from(model.vertices[i as usize].position.map(f64::from)));
        0.5 * (b - a).cross(c - a).length()
    };
    model.triangles.iter().map(area).sum()
}

/// Triangles of the planet: their chords leave the sphere by a ten-thousandth of its radius.
const TRIANGLES: u32 = 16_000;
/// Triangles that do for images narrower than so many pixels.
const STAND_INS: [(f64, u32); 2] = [(12.0, 1200), (220.0, 4500)];

/// `[planet]` as the file has it, before any check.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanetEntry {
    orbit_radius: Spanned<f64>,
    inclination: Option<Spanned<f64>>,
    node: Option<Spanned<f64>>,
    phase: Option<Spanned<f64>>,
    radius: Spanned<f64>,
    day: Option<Spanned<f64>>,
    axis_tilt: Option<Spanned<f64>>,
    dipole_tilt: Option<Spanned<f64>>,
    #[serde(default)]
    seed: u32,
    #[serde(default)]
    aurora: AuroraShape,
    aurora_flux: Option<Spanned<f64>>,
}

/// The fastest that a point of a planet's surface goes round its axis, in c: motion across a body is drawn up to c/2.
const FASTEST_EQUATOR: f64 = 0.4;

/// Checks the planet against its ranges.
pub fn check_planet(entry: &PlanetEntry) -> Result<Planet, Fault> {
    let or = |value: &Option<Spanned<f64>>, key, low, high, unit, default| {
        value.as_ref().map_or(Ok(default), |value| in_range(value, key, low..=high, unit))
    };
    let orbit_radius = in_range(&entry.orbit_radius, "orbit_radius", 3.0..=1e4, "r_s")?;
    let radius = in_range(&entry.radius, "radius", 1e-3..=0.5 * orbit_radius, "r_s")?;
    let shortest_day = TAU * radius / FASTEST_EQUATOR;
    Ok(Planet {
        orbit: Elements {
            inclination: or(&entry.inclination, "inclination", 0.0, PI, "rad", 0.0)?,
            node: or(&entry.node, "node", -1e6, 1e6, "rad", 0.0)?,
            ..Elements::circle(orbit_radius, or(&entry.phase, "phase", -1e6, 1e6, "rad", 0.0)?)
        },
        radius,
        day: or(&entry.day, "day", shortest_day, 1e9, "r_s/c", f64::max(40.0, shortest_day))?,
        axis_tilt: or(&entry.axis_tilt, "axis_tilt", 0.0, PI, "rad", 0.0)?,
        dipole_tilt: or(&entry.dipole_tilt, "dipole_tilt", 0.0, PI, "rad", 0.0)?,
        seed: entry.seed,
        aurora: entry.aurora,
        aurora_flux: or(&entry.aurora_flux, "aurora_flux", 0.0, 1e4, "", 1.0)?,
    })
}

/// What shines at infinity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SkySwitches {
    /// The stars of the catalogue.
    pub stars: bool,
    /// The Milky Way.
    pub milky_way: bool,
    /// A factor on both.
    pub brightness: f64,
}

impl Default for SkySwitches {
    fn default() -> Self {
        SkySwitches { stars: true, milky_way: true, brightness: 1.0 }
    }
}

/// `[sky]` as the file has it, before any check.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SkyEntry {
    stars: Option<bool>,
    milky_way: Option<bool>,
    brightness: Option<Spanned<f64>>,
}

/// Checks the sky against its ranges.
pub fn check_sky(entry: &SkyEntry) -> Result<SkySwitches, Fault> {
    let brightness = entry.brightness.as_ref().map_or(Ok(1.0), |value| in_range(value, "brightness", 0.0..=1e4, ""))?;
    Ok(SkySwitches { stars: entry.stars.unwrap_or(true), milky_way: entry.milky_way.unwrap_or(true), brightness })
}
