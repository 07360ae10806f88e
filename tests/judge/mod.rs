//! Tests of `src/judge/`.

pub mod brute;
mod oracles;
mod outwards;
mod picture;
mod seeing;
mod trace;
mod world;

use glam::DVec3;
use lensrunner::judge::picture::{BodyMotion, Thing};
use lensrunner::scene::lighting::Illumination;
use lensrunner::scene::{Material, Model, Vertex};

/// A model from corners.
pub fn model(corners: &[DVec3], triangles: &[[u32; 3]]) -> Model {
    let vertex =
        |v: &DVec3| Vertex { position: v.as_vec3().to_array(), normal: v.as_vec3().normalize_or(glam::Vec3::Y).to_array(), uv: [0.0; 2] };
    Model {
        vertices: corners.iter().map(vertex).collect(),
        triangles: triangles.to_vec(),
        triangle_materials: vec![0; triangles.len()],
        materials: vec![Material::default()],
    }
}

/// A body of the model of this number.
pub fn thing<'a>(model: usize, motion: BodyMotion<'a>) -> Thing<'a> {
    Thing { model, scale: 1.0, motion, light: Illumination::default(), id: model as u32 + 1 }
}
