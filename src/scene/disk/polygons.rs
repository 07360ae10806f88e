//! The disk as triangles (Yamashita 2025, section 2.1), for the chart: rings of equal sectors that turn with the gas, or one annulus at
//! rest.

use std::f64::consts::{PI, TAU};

use crate::scene::config;
use crate::scene::model::{Material, Model, Vertex};

use super::radial::Radial;

/// Sectors for every ring of a polygon disk: 960 triangles, as many as in Yamashita 2025, are 10 rings of 48.
const SECTORS_PER_RING: f64 = 4.8;

/// A ring of the disk that turns as a whole, in the plane z = 0.
#[derive(Clone, Debug)]
pub struct Ring {
    /// Its triangles; texture coordinates hold the azimuth in turns and the radius in r_s.
    pub model: Model,
    /// dφ/dT in c/r_s: that of the gas in its middle, and inside the last stable orbit that of the orbit.
    pub rate: f64,
    /// The radii of the disk's own inner and outer rim in r_s, where this ring has them.
    pub rims: [Option<f64>; 2],
}

/// About `disk.polygons` triangles at rest, in the plane z = 0. Texture coordinates hold the azimuth in turns and the radius in r_s.
pub fn model(disk: &config::Disk, radial: &Radial) -> Model {
    let (radii, sectors) = division(disk, radial);
    annulus(&radii, sectors)
}

/// How far a ring extends under the next inner one beyond that one's chords, over its width: both are tessellated separately and drawn to a
/// pixel.
const UNDER: f64 = 0.1;

/// The same triangles as rings that turn with the gas, the innermost first. Each extends under the next inner one, so that no gap opens
/// between rings that slide along each other.
pub fn rings(disk: &config::Disk, radial: &Radial) -> Vec<Ring> {
    let (radii, sectors) = division(disk, radial);
    let last = radii.len() - 2;
    let under = (PI / f64::from(sectors)).cos();
    let ring = |(k, pair): (usize, &[f64])| Ring {
        model: annulus(&[(pair[0] * under - UNDER * (pair[1] - pair[0])).max(radii[0]), pair[1]], sectors),
        rate: radial.turning_rate(0.5 * (pair[0] + pair[1])),
        rims: [(k == 0).then_some(pair[0]), (k == last).then_some(pair[1])],
    };
    radii.windows(2).enumerate().map(ring).collect()
}

/// The radii of the rings, in r_s, and the number of their sectors.
fn division(disk: &config::Disk, radial: &Radial) -> (Vec<f64>, u32) {
    let [start, end] = radial.extent();
    let rings = (f64::from(disk.polygons) / (2.0 * SECTORS_PER_RING)).sqrt().round().max(1.0) as u32;
    let sectors = (f64::from(disk.polygons) / f64::from(2 * rings)).round().max(3.0) as u32;
    ((0..=rings).map(|ring| start + (end - start) * f64::from(ring) / f64::from(rings)).collect(), sectors)
}

/// Equal sectors between circles.
fn annulus(radii: &[f64], sectors: u32) -> Model {
    let mut vertices = Vec::new();
    for &r in radii {
        for sector in 0..=sectors {
            // The last is where the first is, with the same bits.
            let (sine, cosine) = (f64::from(sector % sectors) / f64::from(sectors) * TAU).sin_cos();
            vertices.push(Vertex {
                position: [(r * cosine) as f32, (r * sine) as f32, 0.0],
                normal: [0.0, 0.0, 1.0],
                uv: [(f64::from(sector) / f64::from(sectors)) as f32, r as f32],
            });
        }
    }
    let mut triangles = Vec::new();
    for ring in 0..radii.len() as u32 - 1 {
        for sector in 0..sectors {
            let a = ring * (sectors + 1) + sector;
            let b = a + sectors + 1;
            triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
        }
    }
    let triangle_materials = vec![0; triangles.len()];
    Model { vertices, triangles, triangle_materials, materials: vec![Material::default()] }
}
