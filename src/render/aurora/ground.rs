//! The aurora's light on its planet's ground, for a frame: maps of the last two rows of the curtains' history, and how the planet's surface reads them.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::{DQuat, DVec2, Mat3};
use half::f16;

use crate::render::aurora::node_history::{NodeHistory, Row, place};
use crate::scene::aurora::curve::Curve;
use crate::scene::aurora::dipole::{PLANET_RADIUS, REFERENCE_HEIGHT};
use crate::scene::aurora::ground::GroundMap;
use crate::scene::aurora::lines::kilorayleigh_xyz;
use crate::scene::aurora::motion::Motion;
use crate::scene::aurora::quantiles::{FLUXES, KINDS, PARTS, Quantiles, ROWS};
use crate::scene::blackbody::xyz_to_rgb;

/// `GroundLight` in shaders/geometry/aurora_light.wgsl.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/geometry/aurora_light.wgsl")]
pub struct GroundLight {
    pub dipole: [[f32; 4]; 3],
    pub colour: [f32; 4],
    pub map: [f32; 4],
    pub planet: [u32; 4],
}

/// What a frame's surfaces are told of it.
#[derive(Clone, Debug, Default)]
pub struct GroundFrame {
    /// Numbers for the shader; the planet's object id is the stage's to write.
    pub light: GroundLight,
    /// Texels along a side of the map.
    pub size: u32,
    /// The texels, halves: by the newest row of the history, and by the one before.
    pub texels: Arc<Vec<[u16; 2]>>,
}

/// What a curtain's brightness comes to on the ground, by the tables of its electrons' fall.
#[derive(Clone, Debug)]
pub struct Glow {
    /// CIE XYZ of the light of a thousand collisions of 35 eV (10⁹ s⁻¹ cm⁻² of them, a kilorayleigh if each made a photon) where the flux is the mean.
    xyz: [f64; 3],
    /// By row of the tables, luminance over that where the flux is the mean.
    luminance: [f64; ROWS],
    /// Height that has as much of the green, blue and crimson light above as below it where the flux is the mean, km. Red, which is higher, is taken with them: at the
    /// default energy it is a hundredth of the luminance, of the softest electrons most of it.
    pub height: f64,
}

impl Glow {
    /// By the tables of a spectrum of electrons.
    pub fn of(falls: &Quantiles) -> Glow {
        let lines = kilorayleigh_xyz(1.0);
        let xyz = |row: usize| -> [f64; 3] {
            let made = falls.photons[row * (PARTS + 1) + PARTS];
            std::array::from_fn(|c| made.iter().zip(lines).map(|(photons, line)| f64::from(*photons) * line[c]).sum())
        };
        let mean = row_of(1.0);
        let (below, part) = (mean as usize, mean.fract());
        let mix = |a: f64, b: f64| a + part * (b - a);
        let (a, b) = (xyz(below), xyz(below + 1));
        let whole: [f64; 3] = std::array::from_fn(|c| mix(a[c], b[c]));
        let middle = |row: usize| f64::from(falls.heights[row * KINDS * (PARTS + 1) + PARTS / 2]);
        Glow {
            xyz: whole,
            luminance: std::array::from_fn(|row| xyz(row)[1] / whole[1].max(1e-12)),
            height: mix(middle(below), middle(below + 1)),
        }
    }

    /// Luminance of a curtain's light over that where the energy flux is the mean: there is more of it, and it is harder.
    fn brightness(&self, flux: f64) -> f64 {
        let row = row_of(flux);
        let below = row as usize;
        flux * (self.luminance[below] + (row - below as f64) * (self.luminance[below + 1] - self.luminance[below]))
    }

    /// The linear colour of so many thousand collisions a cm² and a second, as shaders/aurora/resolve.wgsl has it: what is outside sRGB is cut off.
    fn colour(&self, kilo: f64) -> [f64; 3] {
        xyz_to_rgb(self.xyz.map(|x| kilo * x)).map(|x| x.max(0.0))
    }
}

/// Row of the tables where the energy flux is so many times its mean; the last but one and more for the last. Twin of `fall_at` in shaders/aurora/streaks.wgsl.
fn row_of(flux: f64) -> f64 {
    let [first, last] = FLUXES.map(f64::sqrt);
    let row = (flux.clamp(FLUXES[0], FLUXES[1]).sqrt() - first) / (last - first) * (ROWS - 1) as f64;
    row.min((ROWS - 1) as f64 - 1e-9)
}

/// How far midnight may turn before a row's map is made anew, as a part of the whole brightness that it adds: some three degrees.
const TURNED: f64 = 0.03;

/// A row's map.
#[derive(Clone, Debug)]
struct Kept {
    row: Row,
    /// Midnight as it was then.
    midnight: DVec2,
    light: Arc<Vec<f32>>,
}

impl Kept {
    /// Whether it is still the map of `row`.
    fn serves(&self, row: &Row, midnight: DVec2) -> bool {
        Arc::ptr_eq(&self.row, row) && self.midnight.distance(midnight) < TURNED
    }
}

/// The maps of a planet's curtains.
#[derive(Clone, Debug)]
pub struct Ground {
    glow: Glow,
    map: GroundMap,
    /// Of each node of a row the area (km²) of the curtain that it stands for.
    areas: Vec<f64>,
    /// Maps of the newest row and the one before, and both as texels.
    kept: [Option<Kept>; 2],
    texels: Arc<Vec<[u16; 2]>>,
}

impl Ground {
    /// Of curtains that move about these curves.
    pub fn new(curves: &[Curve], motion: &Motion, glow: Glow) -> Ground {
        Ground { map: GroundMap::new(curves, glow.height), areas: areas(curves, motion), glow, kept: [None, None], texels: Arc::default() }
    }

    /// The light of the two newest rows; `midnight` points to magnetic midnight, as long as an oval is brighter there. What was made of a row before is kept.
    fn follow(&mut self, rows: &NodeHistory, midnight: DVec2) {
        let wanted = [0, 1].map(|ago| rows.row(ago));
        let [Some(newest), Some(before)] = wanted else { return };
        let serves = |kept: &Option<Kept>, row: &Row| kept.as_ref().is_some_and(|kept| kept.serves(row, midnight));
        if serves(&self.kept[0], newest) && serves(&self.kept[1], before) {
            return;
        }
        let old = self.kept.clone();
        for (k, row) in [newest, before].into_iter().enumerate() {
            let made = old.iter().chain(&self.kept[..k]).flatten().find(|kept| kept.serves(row, midnight)).cloned();
            let make = || Kept { row: row.clone(), midnight, light: Arc::new(self.light(row, midnight)) };
            self.kept[k] = Some(made.unwrap_or_else(make));
        }
        if let [Some(newest), Some(before)] = &self.kept {
            let both = newest.light.iter().zip(before.light.iter());
            self.texels = Arc::new(both.map(|(a, b)| [a, b].map(|light| f16::from_f32(*light).to_bits())).collect());
        }
    }

    fn light(&self, row: &Row, midnight: DVec2) -> Vec<f32> {
        self.map.of(self.areas.iter().enumerate().filter(|(_, area)| **area > 0.0).map(|(k, area)| {
            let at = place(row, k);
            // As `night` in shaders/aurora/ends.wgsl.
            let night = 1.0 + midnight.dot(at) / at.length().max(1.0);
            (at, night * area * self.glow.brightness(f64::from(row[k][2])))
        }))
    }

    /// What a frame is told: `ahead` is the part of the time between the rows by which the newest is ahead of what is seen, `kilo` the thousands of collisions a cm² and a
    /// second in a curtain, times what a unit of luminance is in the picture. `dipole` turns the dipole's axes into the model's.
    pub fn frame(&mut self, rows: &NodeHistory, ahead: f64, midnight: DVec2, kilo: f64, dipole: DQuat, both: bool) -> GroundFrame {
        self.follow(rows, midnight);
        let (corner, side) = self.map.square();
        let [x, y] = [-corner.x / side, -corner.y / side].map(|x| x as f32);
        let [red, green, blue] = self.glow.colour(kilo).map(|x| x as f32);
        let turn = Mat3::from_quat(dipole.inverse().as_quat());
        GroundFrame {
            light: GroundLight {
                dipole: turn.to_cols_array_2d().map(|[x, y, z]| [x, y, z, 0.0]),
                colour: [red, green, blue, ahead.clamp(0.0, 1.0) as f32],
                map: [x, y, ((PLANET_RADIUS + REFERENCE_HEIGHT) / side) as f32, 0.5 / self.map.size() as f32],
                planet: [0, u32::from(both), 0, 0],
            },
            size: self.map.size() as u32,
            texels: self.texels.clone(),
        }
    }
}

/// Of each node of a row, as it is drawn, the area (km²) of the curtain that it stands for: its share of the length at rest, half as much at the ends. What a row has beyond
/// the ends of a curve stands for none.
fn areas(curves: &[Curve], motion: &Motion) -> Vec<f64> {
    let mut areas = Vec::new();
    for ((window, curve), length) in motion.starts().windows(2).zip(curves).zip(motion.lengths()) {
        let nodes = window[1] - window[0];
        let share = length / (nodes - 1).max(1) as f64 * curve.width;
        let ends = |k: usize| if k == 0 || k + 1 == nodes { 0.5 } else { 1.0 };
        areas.push(0.0);
        areas.extend((0..nodes).map(|k| share * ends(k)));
        areas.push(0.0);
    }
    areas
}
