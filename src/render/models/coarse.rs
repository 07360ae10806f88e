//! Coarse stand-ins for a model whose image is small.

use glam::Vec3;

use crate::render::models::collapse::Collapse;
use crate::scene::Model;

/// How far stand-ins are from their model, the finest first, as shares of the diameter: for images half as wide twice as far. What moves it
/// farther is no longer its shape.
const ERRORS: [f64; 5] = [0.005, 0.01, 0.02, 0.04, 0.09];
/// Share of an error up to which edges are collapsed: a corner may come to lie a little farther than each of its steps cost.
const SURELY: f64 = 0.9;
/// A stand-in has at most this share of the triangles of the next finer.
const FEWER: f64 = 0.85;
/// A model of fewer triangles needs no stand-in.
const FEW: usize = 60;
/// A stand-in farther from its model than this share of the diameter is for images of some twenty-five pixels at most: there edges between faces
/// of one material are shown by their shapes alone, and its vertices are a third.
const SMOOTH: f64 = 0.015;

/// A model that stands in for a finer one.
#[derive(Clone, Debug)]
pub struct StandIn {
    /// The model.
    pub model: Model,
    /// The farthest that a corner of the finer model lies from it, as a share of the diameter.
    pub moved: f64,
}

/// Stand-ins for a model, the coarsest first; none if it is small already.
pub fn stand_ins(model: &Model) -> Vec<StandIn> {
    let diameter = 2.0 * f64::from(model.radius());
    if model.triangles.len() < FEW || !(diameter > 0.0 && diameter.is_finite()) {
        return Vec::new();
    }
    let mut found: Vec<StandIn> = Vec::new();
    let mut collapse = Collapse::new(model);
    for error in ERRORS {
        collapse.within(SURELY * error * diameter);
        let moved = collapse.moved() / diameter;
        if moved > ERRORS[ERRORS.len() - 1] {
            break;
        }
        let finer = found.last().map_or(model, |finer| &finer.model);
        if collapse.left() as f64 <= FEWER * finer.triangles.len() as f64 && collapse.left() > 0 {
            let mut coarser = collapse.model(moved > SMOOTH);
            keep_light(&mut coarser, model);
            found.push(StandIn { model: coarser, moved: moved.max(f64::EPSILON) });
        }
    }
    found.reverse();
    found
}

/// Most by which the light of a material is changed so that its smaller surface sends out as much.
const MOST_BRIGHTENED: f64 = 3.0;

/// Of each material that shines: a stand-in with less of its surface shines so much more. Else the exposure of the picture would follow.
fn keep_light(coarser: &mut Model, finer: &Model) {
    let areas = [areas(finer), areas(coarser)];
    for (number, material) in coarser.materials.iter_mut().enumerate() {
        let [before, after] = [0, 1].map(|k| areas[k].get(number).copied().unwrap_or(0.0));
        if after > 0.0 {
            let factor = (before / after).clamp(1.0 / MOST_BRIGHTENED, MOST_BRIGHTENED) as f32;
            material.emissive = material.emissive.map(|light| light * factor);
        }
    }
}

/// The surface of each material, in squares of the model's unit.
fn areas(model: &Model) -> Vec<f64> {
    let mut areas = vec![0.0; model.materials.len()];
    for (triangle, &material) in model.triangles.iter().zip(&model.triangle_materials) {
        let [a, b, c] = triangle.map(|vertex| Vec3::from(model.vertices[vertex as usize].position).as_dvec3());
        if let Some(area) = areas.get_mut(material as usize) {
            *area += 0.5 * (b - a).cross(c - a).length();
        }
    }
    areas
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Material;
    use crate::scene::model::import::load_or_placeholder;
    use crate::scene::model::{SHIP_MODELS, shapes};

    #[test]
    fn stand_ins_are_small_sound_and_nearly_as_large() {
        let fine = shapes::icosphere(5120, Material::default());
        let all = stand_ins(&fine);
        assert!(all.len() > 1 && all[0].model.triangles.len() < 600, "{} of {}", all.len(), all[0].model.triangles.len());
        for StandIn { model, moved } in &all {
            assert_eq!(model.fault(), None);
            assert!(f64::from(model.radius() / fine.radius() - 1.0).abs() < 2.0 * moved, "{moved}: corners stay by the sphere");
            assert!(*moved > 0.0 && *moved <= 0.09, "{moved}");
        }
        let finer = |pair: &[StandIn]| pair[0].moved > pair[1].moved && pair[0].model.triangles.len() < pair[1].model.triangles.len();
        assert!(all.windows(2).all(finer));
        assert!(stand_ins(&shapes::icosphere(20, Material::default())).is_empty());
    }

    /// What shines keeps its place in each stand-in of the ships, most of its surface and all of its light.
    #[test]
    fn nozzles_stay() {
        let shines = |model: &Model, k: usize| model.materials[k].emissive != [0.0; 3];
        let shining = |model: &Model| -> Vec<f64> {
            areas(model).into_iter().enumerate().filter(|(k, _)| shines(model, *k)).map(|(_, area)| area).collect()
        };
        let light = |model: &Model| -> f64 { areas(model).iter().zip(&model.materials).map(|(a, m)| a * f64::from(m.emissive[2])).sum() };
        for name in SHIP_MODELS {
            let (fine, fault) = load_or_placeholder(name);
            assert!(fault.is_none(), "{name}");
            let all = stand_ins(&fine);
            assert!(all.len() >= 4 && all[0].model.triangles.len() * 16 <= fine.triangles.len() + 16, "{name}");
            for StandIn { model, moved } in all {
                let kept = shining(&model).iter().sum::<f64>() / shining(&fine).iter().sum::<f64>();
                let bright = light(&model) / light(&fine);
                println!("{name}: {} triangles, moved {moved:.4}: surface {kept:.2}, light {bright:.2}", model.triangles.len());
                assert!(kept > 0.6 && model.fault().is_none() && (0.9..1.02).contains(&bright), "{name}");
            }
        }
    }
}
