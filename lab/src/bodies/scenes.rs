//! The scenes: nothing but bodies, all of them before the camera, each of the same size however many there are.

use std::f64::consts::TAU;
use std::fmt;
use std::path::Path;

use glam::DVec3;
use lensrunner::scene::{Complaints, Scene};
use rand::{RngExt, SeedableRng, rngs::StdRng};

/// Whether bodies stay where they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Balls, held.
    Held,
    /// Ships on circular orbits.
    Flying,
}

/// All bodies lie between these distances from the hole, in r_s: the flying ones may go in to the first.
const NEAREST: [f64; 2] = [2.2, 4.0];
/// See [`NEAREST`].
const FARTHEST: f64 = 9.0;
/// Where the camera is held, in r_s: all bodies are before it, and each is about a pixel wide at 320 × 180.
const CAMERA: &str = "[camera]\nposition = [0.0, -28.0, 10.8]\n[sky]\nstars = false\nmilky_way = false\n";
/// Diameter of a ball in r_s.
const SIZE: f64 = 0.1;
/// Seed of the balls' places.
const SEED: u64 = 55;

impl Kind {
    /// As the tables write it.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Held => "held",
            Kind::Flying => "flying",
        }
    }

    /// So many bodies: balls at random places, ships spread over their orbits.
    pub fn scene(self, bodies: u32) -> Result<Scene, Complaints> {
        let [held, flying] = NEAREST;
        let section = match self {
            Kind::Held => format!("[[prop]]\nmodel = \"icosphere\"\nposition = [{FARTHEST}, 0.0, 0.0]\nsize = {SIZE}\ntriangles = 20\n"),
            Kind::Flying => {
                format!("[[swarm]]\nname = \"ship\"\ncount = {bodies}\nradius = [{flying:?}, {FARTHEST:?}]\nmodel = \"quarry.glb\"\n")
            }
        };
        let mut scene = Scene::from_toml(Path::new(self.name()), &format!("{CAMERA}{section}"))?;
        let mut chance = StdRng::seed_from_u64(SEED);
        for prop in &mut scene.props {
            prop.positions = (0..bodies).map(|_| place(&mut chance, held)).collect();
        }
        Ok(scene)
    }
}

/// A place at random in the shell between `nearest` and [`FARTHEST`].
fn place(chance: &mut StdRng, nearest: f64) -> DVec3 {
    let radius = chance.random_range(nearest.powi(3)..FARTHEST.powi(3)).cbrt();
    let (z, azimuth) = (chance.random_range(-1.0..1.0_f64), chance.random_range(0.0..TAU));
    let across = (1.0 - z * z).sqrt();
    radius * DVec3::new(across * azimuth.cos(), across * azimuth.sin(), z)
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
