//! Coarse stand-ins for a model whose image is small: vertices clustered in cells (Rossignac & Borrel 1993).

use std::collections::{HashMap, HashSet};

use glam::Vec3;

use crate::scene::{Model, Vertex};

/// Cells along the longest side of the model, the coarsest first.
const CELLS: [u16; 4] = [6, 12, 24, 48];
/// A model of fewer triangles needs no stand-in.
const FEW: usize = 200;
/// A stand-in has at most this share of the triangles of the next finer.
const WORTH: f64 = 0.7;
/// Normals that differ by less than about half of this are one, in the length of a unit vector: flat sides stay flat.
const FLAT: f32 = 0.6;

/// A model that stands in for a finer one.
#[derive(Clone, Debug)]
pub struct StandIn {
    /// The model.
    pub model: Model,
    /// The farthest that a vertex was moved, as a share of the diameter of the finer model.
    pub moved: f64,
}

/// Stand-ins for a model, the coarsest first; none if it is small already.
pub fn stand_ins(model: &Model) -> Vec<StandIn> {
    if model.triangles.len() < FEW {
        return Vec::new();
    }
    let mut found: Vec<StandIn> = Vec::new();
    let mut finer = model.triangles.len();
    for cells in CELLS.into_iter().rev() {
        let Some(coarser) = clustered(model, f32::from(cells)) else { continue };
        if coarser.model.triangles.len() as f64 <= WORTH * finer as f64 {
            finer = coarser.model.triangles.len();
            found.push(coarser);
        }
    }
    found.reverse();
    found
}

/// The model with all vertices of a cell merged into their mean; None if nothing is left.
fn clustered(model: &Model, cells: f32) -> Option<StandIn> {
    let points = || model.vertices.iter().map(|vertex| Vec3::from(vertex.position));
    let low = points().fold(Vec3::INFINITY, Vec3::min);
    let high = points().fold(Vec3::NEG_INFINITY, Vec3::max);
    let cell = (high - low).max_element().max(f32::MIN_POSITIVE) / cells;
    let cell_of = |vertex: &Vertex| ((Vec3::from(vertex.position) - low) / cell).floor().as_ivec3().to_array();
    // Cells are shared by materials and normals in position, so that the surface stays closed.
    let mut means: HashMap<[i32; 3], (Vec3, f32)> = HashMap::new();
    for vertex in &model.vertices {
        let mean = means.entry(cell_of(vertex)).or_default();
        mean.0 += Vec3::from(vertex.position);
        mean.1 += 1.0;
    }
    let mean_of = |cell: [i32; 3]| means[&cell].0 / means[&cell].1;
    let moved = model.vertices.iter().map(|vertex| mean_of(cell_of(vertex)).distance(Vec3::from(vertex.position))).fold(0.0, f32::max);
    let mut result = Model { materials: model.materials.clone(), ..Model::default() };
    let mut places: HashMap<([i32; 3], [i32; 3], u32), u32> = HashMap::new();
    let mut seen = HashSet::new();
    for (triangle, &material) in model.triangles.iter().zip(&model.triangle_materials) {
        let corners = triangle.map(|index| model.vertices[index as usize]);
        let cells = corners.map(|vertex| cell_of(&vertex));
        let mut sorted = cells;
        sorted.sort_unstable();
        if sorted[0] == sorted[1] || sorted[1] == sorted[2] || !seen.insert(sorted) {
            continue;
        }
        let merged = [0, 1, 2].map(|k| {
            let normal = (Vec3::from(corners[k].normal) / FLAT).round().as_ivec3().to_array();
            *places.entry((cells[k], normal, material)).or_insert_with(|| {
                result.vertices.push(Vertex { position: mean_of(cells[k]).to_array(), ..corners[k] });
                result.vertices.len() as u32 - 1
            })
        });
        result.triangles.push(merged);
        result.triangle_materials.push(material);
    }
    let moved = f64::from(moved) / (2.0 * f64::from(model.radius())).max(f64::MIN_POSITIVE);
    (!result.triangles.is_empty()).then_some(StandIn { model: result, moved })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Material;
    use crate::scene::model::shapes;

    #[test]
    fn stand_ins_are_small_sound_and_nearly_as_large() {
        let fine = shapes::icosphere(5120, Material::default());
        let all = stand_ins(&fine);
        assert!(all.len() > 1 && all[0].model.triangles.len() < 600, "{} of {}", all.len(), all[0].model.triangles.len());
        for StandIn { model, moved } in &all {
            assert_eq!(model.fault(), None);
            assert!((model.radius() / fine.radius() - 1.0).abs() < 0.1);
            // A cell's diagonal, of the sphere's diameter.
            assert!(*moved > 0.0 && *moved < 3f64.sqrt() / 6.0, "{moved}");
        }
        let finer = |pair: &[StandIn]| pair[0].moved > pair[1].moved && pair[0].model.triangles.len() < pair[1].model.triangles.len();
        assert!(all.windows(2).all(finer));
        assert!(stand_ins(&shapes::icosphere(80, Material::default())).is_empty());
    }
}
