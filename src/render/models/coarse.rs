//! Coarse stand-ins for a model whose image is small.

use crate::render::models::collapse::Collapse;
use crate::scene::Model;

/// A stand-in has at most this share of the triangles of the next finer.
const SHARE: f64 = 0.5;
/// A model of fewer triangles needs no stand-in.
const FEW: usize = 60;
/// No stand-in is farther from its model than this share of the diameter: what moves it farther is no longer its shape.
const FARTHEST: f64 = 0.15;

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
    loop {
        let target = (SHARE * collapse.left() as f64) as usize;
        let reached = target >= FEW / 2 && collapse.down_to(target);
        let moved = collapse.moved() / diameter;
        if !reached || moved > FARTHEST {
            found.reverse();
            return found;
        }
        // Where the finer of two is no nearer the coarser serves.
        while found.last().is_some_and(|finer| finer.moved >= moved) {
            found.pop();
        }
        found.push(StandIn { model: collapse.model(), moved: moved.max(f64::EPSILON) });
    }
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
            assert!((model.radius() / fine.radius() - 1.0).abs() < 1e-5, "corners stay on the sphere");
            assert!(*moved > 0.0 && *moved <= FARTHEST, "{moved}");
        }
        let finer = |pair: &[StandIn]| pair[0].moved > pair[1].moved && pair[0].model.triangles.len() < pair[1].model.triangles.len();
        assert!(all.windows(2).all(finer));
        assert!(stand_ins(&shapes::icosphere(20, Material::default())).is_empty());
    }

    /// What shines keeps its place in each stand-in of the ships, and most of its surface.
    #[test]
    fn nozzles_stay() {
        let shining = |model: &Model| -> f64 {
            let area = |triangle: &[u32; 3]| {
                let [a, b, c] = triangle.map(|vertex| glam::Vec3::from(model.vertices[vertex as usize].position));
                f64::from((b - a).cross(c - a).length()) / 2.0
            };
            let shines = |material: u32| model.materials[material as usize].emissive != [0.0; 3];
            let with_material = model.triangles.iter().zip(&model.triangle_materials);
            with_material.filter(|(_, material)| shines(**material)).map(|(triangle, _)| area(triangle)).sum()
        };
        for name in SHIP_MODELS {
            let (fine, fault) = load_or_placeholder(name);
            assert!(fault.is_none(), "{name}");
            let all = stand_ins(&fine);
            assert!(all.len() >= 4 && all[0].model.triangles.len() * 16 <= fine.triangles.len() + 16, "{name}");
            for StandIn { model, moved } in all {
                let kept = shining(&model) / shining(&fine);
                assert!(kept > 0.6 && model.fault().is_none(), "{name}: {} triangles, moved {moved}: {kept}", model.triangles.len());
            }
        }
    }
}
