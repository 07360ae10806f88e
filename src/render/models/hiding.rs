//! How much of each triangle the rest of its model hides, seen from directions all around.
//!
//! A thin image has no depth: its brightness is the sum of the areas of its triangles. Triangles inside or behind another part would count
//! too. So for each triangle it is known from which directions the rest of its model does not hide it, by a depth map for each direction.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use glam::{BVec4A, Vec2, Vec3, Vec4};
use rayon::prelude::*;

use crate::render::models::outside::{AGAINST, ALONG, LONE};
use crate::scene::model::Model;

/// Nodes along each side of the map of directions: a sphere's octahedron, unfolded onto a square (Cigolle et al. 2014, "A survey of efficient
/// representations for independent unit vectors").
pub const NODES: u32 = 11;
/// Directions: the nodes of the map, a bit for each. They are 9° to 18° apart.
pub const DIRECTIONS: u32 = NODES * NODES;
/// Bits of a triangle, a bit for each direction.
pub type SeenFrom = [u32; 4];
/// The fewest and the most cells along each side of a depth map.
const SIDES: [usize; 2] = [32, 256];
/// Cells of a map for each triangle of the model, up to the largest map: the triangles that are seen are a few cells wide.
const CELLS: f64 = 16.0;
/// The most cells that the triangles of a model cover together; of one with more, the map is coarser. Half a million triangles that all
/// cover the whole map would take minutes.
const MOST_CELLS: f64 = 16_777_216.0;
/// Four points of a triangle that are tested where it covers no middle of a cell: for each of its corners the weights by which they are
/// made. They are the middles of its quarters.
const POINTS: [Vec4; 3] = [
    Vec4::new(1.0 / 3.0, 2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0),
    Vec4::new(1.0 / 3.0, 1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0),
    Vec4::new(1.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0),
];
/// Cells after each row of a depth map: four are written at once.
const SPARE: usize = 3;
/// Steps of the thresholds from direction to direction and from triangle to triangle: powers of the root of x³ = x + 1, which fill a square
/// evenly.
const THRESHOLD_STEPS: [f32; 2] = [0.754_877_7, 0.569_840_3];

/// Direction `k` of [`DIRECTIONS`] (unit); the twin of `direction_of` in `shaders/models/hiding.wgsl`.
pub fn direction_of(k: u32) -> Vec3 {
    let [x, y] = [k % NODES, k / NODES].map(|node| node as f32 / (NODES - 1) as f32 * 2.0 - 1.0);
    let z = 1.0 - x.abs() - y.abs();
    let [x, y] = if z < 0.0 { folded([x, y]) } else { [x, y] };
    Vec3::new(x, y, z).normalize()
}

/// The lower half of the octahedron lies outside of the upper one, folded over its edges.
fn folded([x, y]: [f32; 2]) -> [f32; 2] {
    [(1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y)]
}

/// For each triangle of the model, in its order, a bit for each direction: it is set in as large a share of the directions around as the
/// share of the triangle that is seen from there. `sides` are those of the model.
pub fn seen_from(model: &Model, sides: &[u32]) -> Vec<SeenFrom> {
    let corners: Vec<[Vec3; 3]> =
        model.triangles.iter().map(|triangle| triangle.map(|vertex| Vec3::from(model.vertices[vertex as usize].position))).collect();
    let lock = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, known)) = lock().iter().find(|(other, _)| *other == corners) {
        return known.clone();
    }
    let outward: Vec<Option<Vec3>> = corners.iter().zip(sides).map(|(corners, side)| outward(corners, *side)).collect();
    if sides.iter().all(|side| side & LONE != 0) && is_convex(&corners, &outward) {
        return vec![[u32::MAX; 4]; corners.len()];
    }
    let seen: Vec<Vec<f32>> =
        (0..DIRECTIONS).into_par_iter().map_init(Vec::new, |depths, k| seen_in(&corners, &outward, direction_of(k), depths)).collect();
    let mut found = vec![SeenFrom::default(); corners.len()];
    for (k, shares) in seen.iter().enumerate() {
        for (i, (share, bits)) in shares.iter().zip(&mut found).enumerate() {
            let threshold = (k as f32 * THRESHOLD_STEPS[0] + (i % 4096) as f32 * THRESHOLD_STEPS[1]).fract();
            bits[k / 32] |= u32::from(*share > threshold) << (k % 32);
        }
    }
    let mut known = lock();
    known.truncate(MOST_KNOWN - 1);
    known.insert(0, (corners, found.clone()));
    found
}

/// The last models, by their corners, with the result: the same models are uploaded again and again where many pictures are drawn.
static KNOWN: Mutex<Vec<Known>> = Mutex::new(Vec::new());
/// How many are kept.
const MOST_KNOWN: usize = 32;

/// A model's corners, and for each triangle a bit for each direction.
type Known = (Vec<[Vec3; 3]>, Vec<SeenFrom>);

/// The part of a triangle that is seen from `direction`: the twin of `seen_part` in `shaders/models/hiding.wgsl`.
pub fn seen_part(seen_from: SeenFrom, outward: Vec3, direction: Vec3) -> f32 {
    let on_octahedron = direction / (direction.x.abs() + direction.y.abs() + direction.z.abs());
    let place = [on_octahedron.x, on_octahedron.y];
    let place = if on_octahedron.z < 0.0 { folded(place) } else { place };
    let [x, y] = place.map(|x| (0.5 * x + 0.5) * (NODES - 1) as f32);
    let [left, low] = [x, y].map(|x| (x as u32).min(NODES - 2));
    let (right_share, high_share) = (x - left as f32, y - low as f32);
    let (mut sum, mut all) = (0.0, 0.0);
    for corner in 0..4 {
        let (right, high) = (corner % 2, corner / 2);
        let k = (low + high) * NODES + left + right;
        let weight = (if right == 1 { right_share } else { 1.0 - right_share }) * (if high == 1 { high_share } else { 1.0 - high_share });
        if outward.dot(direction_of(k)) < 0.0 {
            continue;
        }
        all += weight;
        sum += if seen_from[k as usize / 32] & (1 << (k % 32)) != 0 { weight } else { 0.0 };
    }
    if all < 1e-6 { 1.0 } else { sum / all }
}

/// The normal of a triangle of a closed body on its outer side; None for one of an open sheet.
fn outward([a, b, c]: &[Vec3; 3], side: u32) -> Option<Vec3> {
    let normal = (b - a).cross(c - a).normalize_or_zero();
    if side & ALONG != 0 { Some(normal) } else { (side & AGAINST != 0).then_some(-normal) }
}

/// Whether a closed body is convex, so that nothing hides another part of it: no triangle rises over the plane of one beside it.
fn is_convex(triangles: &[[Vec3; 3]], outward: &[Option<Vec3>]) -> bool {
    let key = |a: Vec3, b: Vec3| {
        let [a, b] = [a, b].map(|p| (p + 0.0).to_array().map(f32::to_bits));
        [a.min(b), a.max(b)]
    };
    let mut third: HashMap<[[u32; 3]; 2], Vec<(Vec3, Vec3)>> = HashMap::new();
    let size = triangles.iter().flatten().fold(0f32, |size, p| size.max(p.length()));
    for ([a, b, c], outward) in triangles.iter().zip(outward) {
        let Some(outward) = *outward else { return false };
        for (edge, opposite) in [(key(*a, *b), *c), (key(*b, *c), *a), (key(*c, *a), *b)] {
            let beside = third.entry(edge).or_default();
            if beside
                .iter()
                .any(|(other, normal)| (opposite - *a).dot(*normal).max((*other - *a).dot(outward)) > FLAT * size && edge[0] != edge[1])
            {
                return false;
            }
            beside.push((opposite, outward));
        }
    }
    true
}

/// A corner so far over a plane, as a share of the model's size, is on it.
const FLAT: f32 = 1e-5;

/// The share of each triangle that is seen from `direction`, far away; `depths` is room for a depth map. Triangles of closed bodies hide
/// nothing with their inner side, for another one is before it.
fn seen_in(triangles: &[[Vec3; 3]], outward: &[Option<Vec3>], direction: Vec3, depths: &mut Vec<f32>) -> Vec<f32> {
    let (right, up) = direction.any_orthonormal_pair();
    // On the map x and y, and z towards the eye.
    let turned: Vec<[Vec3; 3]> =
        triangles.iter().map(|corners| corners.map(|p| Vec3::new(p.dot(right), p.dot(up), p.dot(direction)))).collect();
    let low = turned.iter().flatten().fold(Vec3::INFINITY, |low, p| low.min(*p));
    let high = turned.iter().flatten().fold(Vec3::NEG_INFINITY, |high, p| high.max(*p));
    let width = (high - low).truncate().max_element().max(1e-30);
    let side = side_of(&turned, width);
    let cell = width / side as f32;
    let place = |p: Vec3| (p - low).truncate() / cell;
    depths.clear();
    depths.resize((side + SPARE) * side, f32::NEG_INFINITY);
    let turned_away = |k: usize| outward[k].is_some_and(|outward| outward.dot(direction) < 0.0);
    for (_, corners) in turned.iter().enumerate().filter(|(k, _)| !turned_away(*k)) {
        cells_of(corners, side, place, |first, inside, depth| {
            let cells = &mut depths[first..][..4];
            let here = Vec4::from_slice(cells);
            Vec4::select(inside & depth.cmpgt(here), depth, here).write_to_slice(cells);
        });
    }
    let slack_of_all = 1e-4 * (high - low).max_element();
    turned
        .iter()
        .enumerate()
        .map(|(k, corners)| {
            let (mut covers, mut shows) = (0, 0);
            if turned_away(k) {
                return 0.0;
            }
            cells_of(corners, side, place, |first, inside, depth| {
                let seen = inside & (depth + slack_of_all).cmpge(Vec4::from_slice(&depths[first..][..4]));
                covers += inside.bitmask().count_ones();
                shows += seen.bitmask().count_ones();
            });
            if covers > 0 {
                return shows as f32 / covers as f32;
            }
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
            // The map has the depth at the middle of a cell: on a plane this much nearer at most, and rounding.
            let slope = normal.truncate().length() / normal.z.abs().max(0.05);
            let slack = 0.5 * slope * cell + slack_of_all;
            let [x, y, z] =
                [0, 1, 2].map(|axis| POINTS[0] * corners[0][axis] + POINTS[1] * corners[1][axis] + POINTS[2] * corners[2][axis]);
            let [x, y] = [(x - low.x) / cell, (y - low.y) / cell].map(|place| place.to_array());
            let seen = (0..4).filter(|&k| {
                let [x, y] = [x[k], y[k]].map(|place| (place as usize).min(side - 1));
                z[k] + slack >= depths[y * (side + SPARE) + x]
            });
            seen.count() as f32 / 4.0
        })
        .collect()
}

/// Cells along each side of the depth map of triangles on a square so wide.
fn side_of(triangles: &[[Vec3; 3]], width: f32) -> usize {
    let [fewest, most] = SIDES;
    let mut side = ((CELLS * triangles.len() as f64).sqrt() as usize).clamp(fewest, most);
    while side > 1 && covered(triangles, side as f32 / width) > MOST_CELLS {
        side /= 2;
    }
    side
}

/// Cells that are looked at for triangles: those of a box around each.
fn covered(triangles: &[[Vec3; 3]], cells_per_length: f32) -> f64 {
    let cells = |[a, b, c]: &[Vec3; 3]| {
        let [x, y] = ((a.max(*b).max(*c) - a.min(*b).min(*c)).truncate() * cells_per_length + 1.0).to_array();
        f64::from(x) * f64::from(y)
    };
    triangles.iter().map(cells).sum()
}

/// Goes through the cells whose middle a triangle covers, four at once: the number of the first in a map whose rows have [`SPARE`] cells
/// more, which of them it covers, and its depths there.
fn cells_of(corners: &[Vec3; 3], side: usize, place: impl Fn(Vec3) -> Vec2, mut each: impl FnMut(usize, BVec4A, Vec4)) {
    let row = side + SPARE;
    // The first cell whose number is at least `x`.
    let first = |x: f32| {
        let whole = x.max(0.0) as usize;
        whole + usize::from((whole as f32) < x)
    };
    let [a, b, c] = corners.map(&place);
    let area = (b - a).perp_dot(c - a);
    if area == 0.0 {
        return;
    }
    let from = (a.min(b).min(c) - 0.5).to_array().map(first);
    let to = (a.max(b).max(c) + 0.5).to_array().map(|x| first(x).min(side));
    let turn = Vec4::splat(area.signum());
    for y in from[1]..to[1] {
        let [ay, by, cy] = [a, b, c].map(|corner| corner.y - (y as f32 + 0.5));
        for x in (from[0]..to[0]).step_by(4) {
            let middle = Vec4::splat(x as f32) + Vec4::new(0.5, 1.5, 2.5, 3.5);
            let [ax, bx, cx] = [a, b, c].map(|corner| Vec4::splat(corner.x) - middle);
            let weights = [bx * cy - cx * by, cx * ay - ax * cy, ax * by - bx * ay];
            let inside =
                weights.iter().fold(middle.cmplt(Vec4::splat(to[0] as f32)), |inside, weight| inside & (*weight * turn).cmpge(Vec4::ZERO));
            if inside.any() {
                each(y * row + x, inside, (weights[0] * corners[0].z + weights[1] * corners[1].z + weights[2] * corners[2].z) / area);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::render::models::outside::{OPEN, sides};
    use crate::scene::Material;
    use crate::scene::model::import::load_model;
    use crate::scene::model::shapes;

    /// A ball, one inside it and one beside it, wound outward.
    fn balls() -> Model {
        let mut model = shapes::icosphere(320, Material::default());
        let one = model.clone();
        for (size, away) in [(0.5, Vec3::ZERO), (1.0, Vec3::X * 1.5)] {
            let first = model.vertices.len() as u32;
            model.vertices.extend(one.vertices.iter().map(|v| {
                let mut vertex = *v;
                vertex.position = (Vec3::from(v.position) * size + away).to_array();
                vertex
            }));
            model.triangles.extend(one.triangles.iter().map(|t| t.map(|i| i + first)));
            model.triangle_materials.extend(&one.triangle_materials);
        }
        model
    }

    #[test]
    fn hidden_parts_do_not_count() {
        let model = balls();
        let radius = Vec3::from(model.vertices[0].position).length();
        let disc = std::f32::consts::PI * radius * radius;
        let seen = seen_from(&model, &sides(&model));
        // Discs seen: both from the side, one along the line of the two; from the nearest of the directions much of the other is still
        // seen.
        for (direction, least, most) in
            [(Vec3::Y, 1.5, 2.1), (Vec3::new(0.0, 0.6, 0.8), 1.5, 2.1), (Vec3::X, 0.9, 1.7), (-Vec3::X, 0.9, 1.7)]
        {
            let (mut all, mut counted) = (0.0, 0.0);
            for (triangle, &seen) in model.triangles.iter().zip(&seen) {
                let [a, b, c] = triangle.map(|i| Vec3::from(model.vertices[i as usize].position));
                let normal = (b - a).cross(c - a);
                let area = 0.5 * normal.dot(direction);
                if area > 0.0 {
                    all += area;
                    counted += area * seen_part(seen, normal.normalize(), direction);
                }
            }
            assert!((all / disc - 2.25).abs() < 0.05, "{all} {disc}");
            assert!((least..most).contains(&(counted / disc)), "from {direction}: {}", counted / disc);
        }
        let apart = (0..DIRECTIONS).flat_map(|k| (0..k).map(move |l| direction_of(k).angle_between(direction_of(l))));
        // The border of the map is folded: nodes there are one direction twice.
        assert!(apart.filter(|angle| *angle > 1e-3).fold(f32::INFINITY, f32::min) > 0.15);
    }

    /// Area and lamps of the ships in a hundred directions: the sums of parts beside a map of a million cells.
    #[test]
    fn sums_of_parts_are_the_light_of_a_ship() {
        let project = Path::new(env!("CARGO_MANIFEST_DIR"));
        for name in ["hunter.glb", "quarry.glb"] {
            let model = load_model(&project.join("assets/models").join(name)).expect("a ship of the game");
            let corners = corners_of(&model);
            let sides = sides(&model);
            let seen = seen_from(&model, &sides);
            let lamp = |i: usize| model.materials[model.triangle_materials[i] as usize].emissive.iter().sum::<f32>();
            let mut sums = Vec::new();
            for k in 0..100u32 {
                let (z, angle) = ((k as f32 + 0.5) / 50.0 - 1.0, k as f32 * 2.399_963);
                let direction = (Vec3::new(angle.cos(), angle.sin(), 0.0) * (1.0 - z * z).sqrt()).with_z(z);
                let mut sum = Vec4::ZERO;
                for (i, triangle) in corners.iter().enumerate() {
                    let [a, b, c] = *triangle;
                    let plane = outward(triangle, sides[i]).unwrap_or((b - a).cross(c - a).normalize_or_zero());
                    let cosine = plane.dot(direction);
                    if cosine > 0.0 || sides[i] == OPEN {
                        let area = 0.5 * (b - a).cross(c - a).length() * cosine.abs();
                        let part = area * seen_part(seen[i], plane * cosine.signum(), direction);
                        sum += Vec4::new(part, part * lamp(i), 0.0, 0.0);
                    }
                }
                let [area, lamps] = exact(&corners, direction, lamp);
                sums.push(sum + Vec4::new(0.0, 0.0, area, lamps));
            }
            let mean = sums.iter().sum::<Vec4>() / sums.len() as f32;
            assert!((mean.x / mean.z - 1.0).abs() < 0.01 && (mean.y / mean.w - 1.0).abs() < 0.1, "{name}: {mean}");
            // Lamps in nozzles are seen from a narrow cone, whose border the directions blur.
            for (k, most) in [(0, 0.05), (1, 0.65)] {
                let mut off: Vec<f32> = sums.iter().map(|sum| (sum[k] / mean[k + 2] - sum[k + 2] / mean[k + 2]).abs()).collect();
                off.sort_by(f32::total_cmp);
                assert!(off[90] < most, "{name}: {} of the mean at 90 %", off[90]);
            }
        }
    }

    fn corners_of(model: &Model) -> Vec<[Vec3; 3]> {
        model.triangles.iter().map(|t| t.map(|i| Vec3::from(model.vertices[i as usize].position))).collect()
    }

    #[test]
    fn a_convex_body_hides_nothing_of_itself() {
        let sphere = |model: Model| is_convex(&corners_of(&model), &outward_of(&model));
        assert!(sphere(shapes::icosphere(5000, Material::default())) && sphere(shapes::uv_sphere(5000, Material::default())));
        let mut dented = shapes::icosphere(320, Material::default());
        dented.vertices[17].position = dented.vertices[17].position.map(|x| 0.9 * x);
        assert!(!sphere(dented));
    }

    fn outward_of(model: &Model) -> Vec<Option<Vec3>> {
        corners_of(model).iter().zip(sides(model)).map(|(corners, side)| outward(corners, side)).collect()
    }

    /// The area of a body on a map, and that times the lamp of each of its triangles.
    fn exact(triangles: &[[Vec3; 3]], direction: Vec3, lamp: impl Fn(usize) -> f32) -> [f32; 2] {
        let (right, up) = direction.any_orthonormal_pair();
        let turned: Vec<[Vec3; 3]> = triangles.iter().map(|c| c.map(|p| Vec3::new(p.dot(right), p.dot(up), p.dot(direction)))).collect();
        let low = turned.iter().flatten().fold(Vec3::INFINITY, |l, p| l.min(*p));
        let high = turned.iter().flatten().fold(Vec3::NEG_INFINITY, |h, p| h.max(*p));
        let side = 1024;
        let cell = (high - low).truncate().max_element() / side as f32;
        let place = |p: Vec3| (p - low).truncate() / cell;
        let mut depths = vec![f32::NEG_INFINITY; (side + SPARE) * side];
        let mut nearest = vec![u32::MAX; (side + SPARE) * side];
        for (i, c) in turned.iter().enumerate() {
            cells_of(c, side, place, |first, inside, depth| {
                for k in 0..4 {
                    if inside.test(k) && depth[k] > depths[first + k] {
                        (depths[first + k], nearest[first + k]) = (depth[k], i as u32);
                    }
                }
            });
        }
        let shown = nearest.iter().filter(|i| **i != u32::MAX);
        [shown.clone().count() as f32 * cell * cell, shown.map(|i| lamp(*i as usize)).sum::<f32>() * cell * cell]
    }

    #[test]
    fn many_triangles_on_one_another_get_a_coarser_map() {
        let one = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let side = |triangles: usize| side_of(&vec![one; triangles], 1.0);
        assert_eq!([side(1), side(200), side(2_000), side(100_000)], [32, 56, 89, 8]);
        assert!(covered(&vec![one; 100_000], side(100_000) as f32) <= MOST_CELLS);
        // None of them hides another.
        assert!(seen_in(&vec![one; 100_000], &vec![None; 100_000], Vec3::Z, &mut Vec::new()).iter().all(|seen| *seen == 1.0));
        let ball = shapes::icosphere(20_000, Material::default());
        let corners: Vec<[Vec3; 3]> =
            ball.triangles.iter().map(|triangle| triangle.map(|i| Vec3::from(ball.vertices[i as usize].position))).collect();
        assert_eq!(side_of(&corners, 1.0), SIDES[1]);
    }
}
