//! Patches of a model: triangles of one material that are connected by points. A coarser model loses the smallest first.

use std::collections::HashMap;

use glam::DVec3;

use crate::scene::{Material, Model};

/// How much more the place of an outline counts where a part shines: a nozzle stays until ten times its size may be lost.
const SHINING: f64 = 10.0;

/// How much two materials differ beside each other: 1 for black and white, more if one shines.
pub fn contrast(model: &Model, materials: [u32; 2]) -> f64 {
    let [Some(one), Some(other)] = materials.map(|number| model.materials.get(number as usize)) else { return 1.0 };
    let shines = |material: &Material| material.emissive != [0.0; 3] || material.temperature > 0.0;
    if shines(one) || shines(other) {
        return SHINING;
    }
    if one.texture.is_some() || other.texture.is_some() {
        return 1.0;
    }
    let differences = one.base_colour.iter().zip(other.base_colour).map(|(a, b)| f64::from((a - b).abs()));
    differences.fold(f64::from((one.metallic - other.metallic).abs()), f64::max).min(1.0)
}

/// The materials that meet at each point, each with the size of its patch there: half the diagonal of what holds it, times the greatest
/// contrast that its material has with another. `triangles` are the points of each and its material.
pub fn sizes(model: &Model, points: &[DVec3], triangles: impl Iterator<Item = ([u32; 3], u32)>) -> Vec<Vec<(u32, f64)>> {
    let mut number_of: HashMap<(u32, u32), usize> = HashMap::new();
    // Each number names another of its patch, up to one that names itself.
    let mut chief: Vec<usize> = Vec::new();
    for (corners, material) in triangles {
        let numbers = corners.map(|point| {
            *number_of.entry((point, material)).or_insert_with(|| {
                chief.push(chief.len());
                chief.len() - 1
            })
        });
        let [a, b, c] = numbers.map(|number| chief_of(&mut chief, number));
        (chief[b], chief[c]) = (a, a);
    }
    let mut boxes = vec![[DVec3::INFINITY, DVec3::NEG_INFINITY]; chief.len()];
    for (&(point, _), &number) in &number_of {
        let [low, high] = &mut boxes[chief_of(&mut chief, number)];
        let place = points[point as usize];
        (*low, *high) = (low.min(place), high.max(place));
    }
    let materials = 0..model.materials.len() as u32;
    let weights: Vec<f64> = materials
        .clone()
        .map(|one| materials.clone().filter(|&other| other != one).map(|other| contrast(model, [one, other])).fold(0.0, f64::max))
        .collect();
    let mut found = vec![Vec::new(); points.len()];
    for ((point, material), number) in number_of {
        let [low, high] = boxes[chief_of(&mut chief, number)];
        let weight = weights.get(material as usize).copied().unwrap_or(1.0);
        found[point as usize].push((material, weight * 0.5 * low.distance(high)));
    }
    found
}

fn chief_of(chief: &mut [usize], mut number: usize) -> usize {
    while chief[number] != number {
        chief[number] = chief[chief[number]];
        number = chief[number];
    }
    number
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles of one material that share a point are one patch; a third lies apart, of another material.
    #[test]
    fn a_patch_is_as_large_as_what_holds_it() {
        let [dark, light] = [0.0, 1.0].map(|grey| Material { base_colour: [grey, grey, grey, 1.0], ..Material::default() });
        let model = Model { materials: vec![dark, light], ..Model::default() };
        let points: Vec<DVec3> = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [-3.0, 0.0], [0.0, -4.0], [9.0, 9.0], [9.0, 10.0], [9.0, 11.0]]
            .map(|[x, y]| DVec3::new(x, y, 0.0))
            .to_vec();
        let found = sizes(&model, &points, [([0, 1, 2], 0), ([0, 3, 4], 0), ([5, 6, 7], 1)].into_iter());
        let diagonal = 4f64.hypot(5.0);
        for at_point in &found[..5] {
            assert_eq!(at_point.len(), 1);
            assert!((at_point[0].1 - 0.5 * diagonal).abs() < 1e-12, "{at_point:?}");
        }
        assert_eq!(found[6], [(1, 1.0)]);
    }
}
