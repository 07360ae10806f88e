//! A coarse stand-in for a model whose image is a few pixels wide: vertices clustered in cells (Rossignac & Borrel 1993).

use std::collections::HashMap;

use glam::Vec3;

use crate::scene::{Model, Vertex};

/// Cells along the longest side of the model.
const CELLS: f32 = 6.0;
/// A model of fewer triangles is its own stand-in.
const FEW: usize = 200;

/// The model with all vertices of a cell and material merged into their mean; None if it is small already.
pub fn coarse(model: &Model) -> Option<Model> {
    if model.triangles.len() < FEW {
        return None;
    }
    let points = || model.vertices.iter().map(|vertex| Vec3::from(vertex.position));
    let low = points().fold(Vec3::INFINITY, Vec3::min);
    let high = points().fold(Vec3::NEG_INFINITY, Vec3::max);
    let cell = (high - low).max_element().max(f32::MIN_POSITIVE) / CELLS;
    // Cells are shared by materials in position, so that the surface stays closed; normal and uv are those of the first vertex.
    let mut means: HashMap<[i32; 3], (Vec3, f32)> = HashMap::new();
    let key = |vertex: &Vertex| ((Vec3::from(vertex.position) - low) / cell).floor().as_ivec3().to_array();
    for vertex in &model.vertices {
        let mean = means.entry(key(vertex)).or_default();
        mean.0 += Vec3::from(vertex.position);
        mean.1 += 1.0;
    }
    let mut result = Model { materials: model.materials.clone(), ..Model::default() };
    let mut places: HashMap<([i32; 3], u32), u32> = HashMap::new();
    let mut seen = std::collections::HashSet::new();
    for (triangle, &material) in model.triangles.iter().zip(&model.triangle_materials) {
        let keys = triangle.map(|index| key(&model.vertices[index as usize]));
        if keys[0] == keys[1] || keys[1] == keys[2] || keys[2] == keys[0] {
            continue;
        }
        let mut sorted = keys;
        sorted.sort_unstable();
        if !seen.insert(sorted) {
            continue;
        }
        let corners = [0, 1, 2].map(|k| {
            *places.entry((keys[k], material)).or_insert_with(|| {
                let (sum, count) = means[&keys[k]];
                let position = (sum / count).to_array();
                result.vertices.push(Vertex { position, ..model.vertices[triangle[k] as usize] });
                result.vertices.len() as u32 - 1
            })
        });
        result.triangles.push(corners);
        result.triangle_materials.push(material);
    }
    (!result.triangles.is_empty()).then_some(result)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Material;
    use crate::scene::model::shapes;

    #[test]
    fn a_coarse_sphere_is_small_sound_and_nearly_as_large() {
        let fine = shapes::icosphere(5120, Material::default());
        let coarse = coarse(&fine).unwrap();
        assert!(coarse.triangles.len() < 600, "{} triangles", coarse.triangles.len());
        assert_eq!(coarse.fault(), None);
        assert!((coarse.radius() / fine.radius() - 1.0).abs() < 0.1);
    }
}
