//! The disk as triangles (paper 2, section 2.1): an annulus of equal sectors, for the chart.

use std::f64::consts::TAU;

use crate::scene::config;
use crate::scene::model::{Material, Model, Vertex};

use super::radial::Radial;

/// Sectors for every ring of a polygon disk.
const SECTORS_PER_RING: f64 = 4.8;

/// About `disk.polygons` triangles in the plane z = 0. Texture coordinates hold the azimuth in turns and the radius in r_s.
pub fn model(disk: &config::Disk, radial: &Radial) -> Model {
    let [start, end] = radial.extent();
    let rings = (f64::from(disk.polygons) / (2.0 * SECTORS_PER_RING)).sqrt().round().max(1.0) as u32;
    let sectors = (f64::from(disk.polygons) / f64::from(2 * rings)).round().max(3.0) as u32;
    let mut vertices = Vec::new();
    for ring in 0..=rings {
        let r = start + (end - start) * f64::from(ring) / f64::from(rings);
        for sector in 0..=sectors {
            let turn = f64::from(sector) / f64::from(sectors);
            let (sine, cosine) = (turn * TAU).sin_cos();
            vertices.push(Vertex {
                position: [(r * cosine) as f32, (r * sine) as f32, 0.0],
                normal: [0.0, 0.0, 1.0],
                uv: [turn as f32, r as f32],
            });
        }
    }
    let mut triangles = Vec::new();
    for ring in 0..rings {
        for sector in 0..sectors {
            let a = ring * (sectors + 1) + sector;
            let b = a + sectors + 1;
            triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
        }
    }
    let triangle_materials = vec![0; triangles.len()];
    Model { vertices, triangles, triangle_materials, materials: vec![Material::default()] }
}
