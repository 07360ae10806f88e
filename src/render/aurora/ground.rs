//! The aurora's light on the ground of its planet in a frame: maps for the last two rows of the curtains' history, and what the planet's
//! surface needs to read them.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::{DQuat, DVec2, Mat3};
use half::f16;

use crate::render::aurora::node_history::{NodeRow, place};
use crate::scene::aurora::curve::Curve;
use crate::scene::aurora::dipole::{PLANET_RADIUS, REFERENCE_HEIGHT};
use crate::scene::aurora::ground::GroundMap;
use crate::scene::aurora::lines::kilorayleigh_xyz;
use crate::scene::aurora::motion::NodeLayout;
use crate::scene::aurora::quantiles::{FLUXES, KINDS, PARTS, Quantiles, ROWS};
use crate::scene::blackbody::xyz_to_rgb;

/// `GroundLight` in shaders/shading/aurora_light.wgsl.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs, reason = "documented once, in shaders/shading/aurora_light.wgsl")]
pub struct GroundLight {
    pub dipole_x: [f32; 3],
    pub planet: u32,
    pub dipole_y: [f32; 3],
    pub both_poles: u32,
    pub dipole_z: [f32; 3],
    pub per_radian: f32,
    pub colour: [f32; 3],
    pub older: f32,
    pub pole: [f32; 2],
    pub half_texel: f32,
    pub unused: f32,
}

/// The light on the ground as the shading of surfaces needs it.
#[derive(Clone, Debug, Default)]
pub struct GroundFrame {
    /// Numbers for the shader; the stage fills in the planet's object id.
    pub light: GroundLight,
    /// Texels along a side of the map.
    pub size: u32,
    /// The texels in half precision: the light by the newest row of the history, and by the one before.
    pub texels: Arc<Vec<[u16; 2]>>,
}

/// How much light a curtain of a given brightness sends to the ground, from the tables of its electrons' light ([`Quantiles`]).
#[derive(Clone, Debug)]
pub struct Glow {
    /// CIE XYZ of the light of 10⁹ collisions of 35 eV per s and cm² (a kilorayleigh, if each made a photon) at the mean energy flux.
    xyz: [f64; 3],
    /// Luminance by row of the tables, over that at the mean energy flux.
    luminance: [f64; ROWS],
    /// Height, in km, with as much of the green, blue and crimson light above as below it, at the mean energy flux. Red light, which is
    /// higher, is treated as if it came from there too: at the default energy it is a hundredth of the luminance, for the softest electrons
    /// most of it.
    pub height: f64,
}

impl Glow {
    /// From the tables of a spectrum of electrons.
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

    /// Luminance of a curtain's light at so many times the mean energy flux, over that at the mean: with more flux there is more light, and
    /// electrons are harder.
    fn brightness(&self, flux: f64) -> f64 {
        let row = row_of(flux);
        let below = row as usize;
        flux * (self.luminance[below] + (row - below as f64) * (self.luminance[below + 1] - self.luminance[below]))
    }

    /// The linear sRGB colour of `kilo` thousand collisions a cm² and second. Colours outside sRGB are cut off, as in
    /// shaders/aurora/levels/resolve.wgsl.
    fn colour(&self, kilo: f64) -> [f64; 3] {
        xyz_to_rgb(self.xyz.map(|x| kilo * x)).map(|x| x.max(0.0))
    }
}

/// Row of the tables, with fraction, at so many times the mean energy flux; less than the last row by a rounding. Twin of `fall_at` in
/// shaders/aurora/streaks.wgsl.
fn row_of(flux: f64) -> f64 {
    let [first, last] = FLUXES.map(f64::sqrt);
    let row = (flux.clamp(FLUXES[0], FLUXES[1]).sqrt() - first) / (last - first) * (ROWS - 1) as f64;
    row.min((ROWS - 1) as f64 - 1e-9)
}

/// How far midnight may turn before maps are made anew, as a share of the brightness that it adds: about three degrees.
const TURNED: f64 = 0.03;

/// The light by the newest row of the history, and by the one before.
#[derive(Clone, Debug)]
pub struct GroundMaps {
    rows: [NodeRow; 2],
    /// The midnight for which each map was made.
    midnights: [DVec2; 2],
    lights: [Arc<Vec<f32>>; 2],
    /// Both in half precision.
    texels: Arc<Vec<[u16; 2]>>,
}

impl GroundMaps {
    /// Whether they are still those of these rows, seen `older` of the way from the newest to the one before.
    pub fn serve(&self, rows: [&NodeRow; 2], midnight: DVec2, older: f64) -> bool {
        let [newest, before] = self.midnights;
        let same = self.rows.iter().zip(rows).all(|(own, row)| Arc::ptr_eq(own, row));
        same && newest.lerp(before, older).distance(midnight) < TURNED
    }

    /// The light by the newest row and by the one before, in half precision, row by row.
    pub fn texels(&self) -> &Arc<Vec<[u16; 2]>> {
        &self.texels
    }

    /// The midnight for which the map of this row was made, and the map, if that is near `midnight`.
    fn of_row(&self, row: &NodeRow, midnight: DVec2) -> Option<(DVec2, Arc<Vec<f32>>)> {
        let serves = |k: &usize| Arc::ptr_eq(&self.rows[*k], row) && self.midnights[*k].distance(midnight) < TURNED;
        [0, 1].into_iter().find(serves).map(|k| (self.midnights[k], self.lights[k].clone()))
    }
}

/// Makes the maps of a planet's curtains.
#[derive(Debug)]
pub struct Ground {
    glow: Glow,
    map: GroundMap,
    /// For each node of a row the area of curtain that it stands for, in km².
    areas: Vec<f64>,
}

/// How the ground is lit in a frame.
#[derive(Clone, Copy, Debug)]
pub struct GroundView {
    /// How far the newest row is ahead of the time that is seen, as a share of the time between rows.
    pub ahead: f64,
    /// Thousands of collisions a cm² and second in a curtain, times the value of a unit of luminance in the picture.
    pub kilo: f64,
    /// From the dipole's axes to the model's.
    pub dipole: DQuat,
    /// Whether there are curtains at both poles.
    pub both: bool,
}

impl Ground {
    /// For curtains that move about these curves.
    pub fn new(curves: &[Curve], layout: &NodeLayout, glow: Glow) -> Ground {
        Ground { map: GroundMap::new(curves, glow.height), areas: areas(curves, layout), glow }
    }

    /// The maps of the newest row and the one before, as far as they are not among `old` ones. Each `midnight` points to magnetic midnight;
    /// its length is by how much an oval is brighter there.
    pub fn maps(&self, rows: [&NodeRow; 2], midnights: [DVec2; 2], old: Option<&GroundMaps>) -> GroundMaps {
        let make = |k: usize| (midnights[k], Arc::new(self.light(rows[k], midnights[k])));
        let kept = |k: usize| old.and_then(|old| old.of_row(rows[k], midnights[k]));
        let newest = kept(0).unwrap_or_else(|| make(0));
        // At the start both are one row.
        let before = if Arc::ptr_eq(rows[0], rows[1]) { newest.clone() } else { kept(1).unwrap_or_else(|| make(1)) };
        let half = |light: &f32| f16::from_f32(*light).to_bits();
        let texels = newest.1.iter().zip(before.1.iter()).map(|(a, b)| [half(a), half(b)]).collect();
        GroundMaps { rows: rows.map(Arc::clone), midnights: [newest.0, before.0], lights: [newest.1, before.1], texels: Arc::new(texels) }
    }

    fn light(&self, row: &NodeRow, midnight: DVec2) -> Vec<f32> {
        self.map.of(self.areas.iter().enumerate().filter(|(_, area)| **area > 0.0).map(|(k, area)| {
            let at = place(row, k);
            // As `night` in shaders/aurora/ends.wgsl.
            let night = 1.0 + midnight.dot(at) / at.length().max(1.0);
            (at, night * area * self.glow.brightness(f64::from(row[k].flux)))
        }))
    }

    /// The light of these maps in a frame.
    pub fn frame(&self, maps: &GroundMaps, view: &GroundView) -> GroundFrame {
        let (corner, side) = self.map.square();
        let [dipole_x, dipole_y, dipole_z] = Mat3::from_quat(view.dipole.inverse().as_quat()).to_cols_array_2d();
        GroundFrame {
            light: GroundLight {
                dipole_x,
                planet: 0,
                dipole_y,
                both_poles: u32::from(view.both),
                dipole_z,
                per_radian: ((PLANET_RADIUS + REFERENCE_HEIGHT) / side) as f32,
                colour: self.glow.colour(view.kilo).map(|x| x as f32),
                older: view.ahead.clamp(0.0, 1.0) as f32,
                pole: [-corner.x / side, -corner.y / side].map(|x| x as f32),
                half_texel: 0.5 / self.map.size() as f32,
                unused: 0.0,
            },
            size: self.map.size() as u32,
            texels: maps.texels.clone(),
        }
    }
}

/// For each node of a row the area of curtain that it stands for, in km²: its share of the length at rest, half as much at the ends of a
/// curve. The extra nodes beyond the ends stand for none.
fn areas(curves: &[Curve], layout: &NodeLayout) -> Vec<f64> {
    let mut areas = Vec::new();
    for ((window, curve), length) in layout.starts.windows(2).zip(curves).zip(&layout.lengths) {
        let nodes = window[1] - window[0];
        let share = length / (nodes - 1).max(1) as f64 * curve.width;
        let ends = |k: usize| if k == 0 || k + 1 == nodes { 0.5 } else { 1.0 };
        areas.push(0.0);
        areas.extend((0..nodes).map(|k| share * ends(k)));
        areas.push(0.0);
    }
    areas
}
