//! Edges collapsed one by one, the least error first (Ronfard & Rossignac 1996), each vertex into a neighbour, so that a closed surface
//! stays closed. The neighbour may move to where both stand best for their planes (Garland & Heckbert 1997).

use std::cmp::Ordering;
use std::collections::{BTreeMap, BinaryHeap, HashMap, HashSet};

use glam::{DMat3, DVec3, Vec3};

use crate::render::models::patches::{contrast, sizes};
use crate::scene::{Model, Vertex};

/// The least cosine between the normals of a triangle before and after: more would fold the surface.
const LEAST_TURN: f64 = 0.0;
/// The least cosine between two normals at a vertex that are taken as one.
const SAME_NORMAL: f32 = 0.8;
/// Share of its length added to the price of an edge, so that of edges in one plane the shortest goes first.
const SHORT_FIRST: f64 = 1e-6;
/// Weight of the distance from the middle of an edge against one from a plane, so that planes that leave a direction open have a best place.
const MIDDLE: f64 = 1e-3;
/// A new place is taken where it costs at most this share of the cheaper end.
const CHEAPER: f64 = 0.8;

/// A plane with the weight of distances from it: weighted distance = normal · p + offset.
#[derive(Clone, Copy, Debug)]
struct Plane {
    normal: DVec3,
    offset: f64,
}

impl Plane {
    fn through(point: DVec3, normal: DVec3, weight: f64) -> Plane {
        Plane { normal: normal * weight, offset: -normal.dot(point) * weight }
    }

    fn distance(&self, p: DVec3) -> f64 {
        (self.normal.dot(p) + self.offset).abs()
    }
}

/// A vertex that may go to a neighbour, ordered so that the greatest is the cheapest.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    price: f64,
    from: u32,
    to: u32,
    /// Where the neighbour moves to, if it does.
    place: Option<DVec3>,
    /// How often the two had changed when the price was made.
    changes: [u32; 2],
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        other.price.total_cmp(&self.price).then_with(|| (other.from, other.to).cmp(&(self.from, self.to)))
    }
}

/// A model whose vertices at one position are one point, while it is made coarser.
#[derive(Debug)]
pub struct Collapse<'a> {
    model: &'a Model,
    points: Vec<DVec3>,
    /// Where they were in the model.
    places: Vec<DVec3>,
    /// The points of each triangle, and the vertices of the model that say its normals and texture coordinates there. None: it is gone.
    triangles: Vec<Option<([u32; 3], [u32; 3])>>,
    left: usize,
    /// The triangles at each point.
    around: Vec<Vec<u32>>,
    /// The planes that each point stands for.
    planes: Vec<Vec<Plane>>,
    /// Edges of one triangle: their ends stay on them.
    rim: HashSet<[u32; 2]>,
    on_rim: Vec<bool>,
    /// Points of edges where three triangles or more meet stay.
    locked: Vec<bool>,
    changes: Vec<u32>,
    queue: BinaryHeap<Candidate>,
    /// What each point may not do as things are.
    refused: Vec<Vec<Candidate>>,
    /// For each point of the model the one that it went to, if it went.
    went: Vec<u32>,
    /// The materials that meet at each point, each with the size of the patch that it belongs to.
    patches: Vec<Vec<(u32, f64)>>,
    /// The greatest size of a patch that is gone.
    lost: f64,
}

fn key(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

impl<'a> Collapse<'a> {
    /// Nothing is collapsed yet.
    pub fn new(model: &'a Model) -> Self {
        let mut numbers: HashMap<[u32; 3], u32> = HashMap::new();
        let mut points = Vec::new();
        let point_of: Vec<u32> = model
            .vertices
            .iter()
            .map(|vertex| {
                // −0 and 0 are one place.
                *numbers.entry(vertex.position.map(|x| (x + 0.0).to_bits())).or_insert_with(|| {
                    points.push(Vec3::from(vertex.position).as_dvec3());
                    points.len() as u32 - 1
                })
            })
            .collect();
        let of = |vertices: &[u32; 3]| {
            let corners = vertices.map(|vertex| point_of[vertex as usize]);
            let [a, b, c] = corners;
            (a != b && b != c && a != c).then_some((corners, *vertices))
        };
        let triangles: Vec<_> = model.triangles.iter().map(of).collect();
        let mut around = vec![Vec::new(); points.len()];
        for (number, (corners, _)) in (0u32..).zip(&triangles).filter_map(|(number, triangle)| Some((number, (*triangle)?))) {
            corners.iter().for_each(|&point| around[point as usize].push(number));
        }
        let count = points.len();
        let mut this = Collapse {
            model,
            places: points.clone(),
            points,
            left: triangles.iter().flatten().count(),
            triangles,
            around,
            planes: vec![Vec::new(); count],
            rim: HashSet::new(),
            on_rim: vec![false; count],
            locked: vec![false; count],
            changes: vec![0; count],
            queue: BinaryHeap::new(),
            refused: vec![Vec::new(); count],
            went: (0..count as u32).collect(),
            patches: vec![Vec::new(); count],
            lost: 0.0,
        };
        this.patches = sizes(model, &this.points, this.with_materials().map(|((corners, _), &material)| (*corners, material)));
        this.weigh();
        (0..count as u32).for_each(|point| this.offer(point));
        this
    }

    /// Triangles that are left.
    pub fn left(&self) -> usize {
        self.left
    }

    /// The triangles that are left, with their materials.
    fn with_materials(&self) -> impl Iterator<Item = (&([u32; 3], [u32; 3]), &u32)> {
        self.triangles.iter().zip(&self.model.triangle_materials).filter_map(|(triangle, material)| Some((triangle.as_ref()?, material)))
    }

    /// The greatest size of a patch that would have no triangle left at `to`.
    fn loss(&self, from: u32, to: u32) -> f64 {
        let stays = |material: u32| {
            let kept = |point: u32, other: u32| {
                self.around[point as usize].iter().any(|&triangle| {
                    self.model.triangle_materials[triangle as usize] == material
                        && self.triangles[triangle as usize].is_some_and(|(corners, _)| !corners.contains(&other))
                })
            };
            kept(from, to) || kept(to, from)
        };
        let there = self.patches[from as usize].iter().chain(&self.patches[to as usize]);
        there.filter(|(material, _)| !stays(*material)).map(|(_, size)| *size).fold(0.0, f64::max)
    }

    /// The planes of triangles, and those that stand on borders.
    fn weigh(&mut self) {
        // In their order, for sums of planes are rounded by it.
        let mut sides: BTreeMap<[u32; 2], Vec<(u32, usize)>> = BTreeMap::new();
        for (number, (corners, _)) in (0u32..).zip(&self.triangles).filter_map(|(number, triangle)| Some((number, (*triangle)?))) {
            let [a, b, c] = corners.map(|point| self.points[point as usize]);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            for k in 0..3 {
                self.planes[corners[k] as usize].push(Plane::through(a, normal, 1.0));
                sides.entry(key(corners[k], corners[(k + 1) % 3])).or_default().push((number, k));
            }
        }
        for (edge, triangles) in sides {
            let ends = edge.map(|point| point as usize);
            if triangles.len() > 2 {
                ends.iter().for_each(|&end| self.locked[end] = true);
                continue;
            }
            let Some(weight) = self.border(&triangles) else { continue };
            if triangles.len() == 1 {
                self.rim.insert(edge);
                ends.iter().for_each(|&end| self.on_rim[end] = true);
            }
            let [from, to] = ends.map(|end| self.points[end]);
            for (triangle, _) in triangles {
                let normal = self.normal(triangle).unwrap_or(DVec3::ZERO);
                let upright = (to - from).cross(normal).normalize_or_zero();
                for end in ends {
                    self.planes[end].push(Plane::through(from, upright, weight));
                }
            }
        }
    }

    /// The weight of an edge where its triangles, each with the number of the corner where the edge begins, have a border; None if not.
    fn border(&self, triangles: &[(u32, usize)]) -> Option<f64> {
        let &[(one, i), (other, j)] = triangles else { return Some(1.0) };
        let materials = [one, other].map(|triangle| self.model.triangle_materials[triangle as usize]);
        if materials[0] != materials[1] {
            return Some(contrast(self.model, materials));
        }
        self.model.materials.get(materials[0] as usize)?.texture.as_ref()?;
        let vertices = [one, other].map(|triangle| self.triangles[triangle as usize].map_or([0; 3], |(_, vertices)| vertices));
        let uv = |side: usize, corner: usize| self.model.vertices[vertices[side][corner % 3] as usize].uv;
        // The other triangle passes the edge the other way.
        (uv(0, i) != uv(1, j + 1) || uv(0, i + 1) != uv(1, j)).then_some(1.0)
    }

    fn normal(&self, triangle: u32) -> Option<DVec3> {
        let (corners, _) = self.triangles[triangle as usize]?;
        let [a, b, c] = corners.map(|point| self.points[point as usize]);
        Some((b - a).cross(c - a))
    }

    /// The triangles at a point.
    fn at(&self, point: u32) -> impl Iterator<Item = ([u32; 3], [u32; 3])> {
        self.around[point as usize].iter().filter_map(|&triangle| self.triangles[triangle as usize])
    }

    /// The points that share a triangle with one, each once.
    fn neighbours(&self, point: u32) -> Vec<u32> {
        let mut found: Vec<u32> = self.at(point).flat_map(|(corners, _)| corners).filter(|&other| other != point).collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Queues what a point can do with its neighbours, and they with it.
    fn offer(&mut self, point: u32) {
        for other in self.neighbours(point) {
            let mut cheapest = f64::INFINITY;
            let changes = |from: u32, to: u32| [from, to].map(|point| self.changes[point as usize]);
            for (from, to) in [(point, other), (other, point)] {
                let [p, q] = [from, to].map(|point| self.points[point as usize]);
                if self.locked[from as usize] || !(p - q).is_finite() {
                    continue;
                }
                // The planes at `to` have had their say when it took them over.
                let price = self.farthest(from, q) + SHORT_FIRST * p.distance(q);
                cheapest = cheapest.min(price);
                self.queue.push(Candidate { price, from, to, place: None, changes: changes(from, to) });
            }
            let (from, to) = (point, other);
            if let Some(place) = self.best_place(from, to) {
                let length = self.points[from as usize].distance(self.points[to as usize]);
                let price = self.farthest(from, place).max(self.farthest(to, place)) + SHORT_FIRST * length;
                if price < CHEAPER * cheapest {
                    self.queue.push(Candidate { price, from, to, place: Some(place), changes: changes(from, to) });
                }
            }
        }
    }

    /// The distance of a place from the farthest of the planes that a point stands for.
    fn farthest(&self, point: u32, place: DVec3) -> f64 {
        self.planes[point as usize].iter().map(|plane| plane.distance(place)).fold(0.0, f64::max)
    }

    /// Where the squares of the distances from the planes of two points are least together; None where one of them must stay.
    fn best_place(&self, from: u32, to: u32) -> Option<DVec3> {
        let ends = [from, to].map(|point| point as usize);
        if ends.iter().any(|&end| self.locked[end] || self.on_rim[end]) {
            return None;
        }
        let middle = 0.5 * (self.points[ends[0]] + self.points[ends[1]]);
        let weight = MIDDLE * (self.planes[ends[0]].len() + self.planes[ends[1]].len()) as f64;
        let (mut squares, mut right) = (DMat3::from_diagonal(DVec3::splat(weight)), DVec3::ZERO);
        for plane in ends.iter().flat_map(|&end| &self.planes[end]) {
            let normal = plane.normal;
            squares += DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z);
            right -= normal * (plane.offset + normal.dot(middle));
        }
        let place = middle + squares.inverse() * right;
        place.is_finite().then_some(place)
    }

    /// Collapses what costs at most `error`, in the model's unit.
    pub fn within(&mut self, error: f64) {
        while self.queue.peek().is_some_and(|next| next.price <= error)
            && let Some(next) = self.queue.pop()
        {
            let Candidate { price, from, to, place, changes } = next;
            if changes != [from, to].map(|point| self.changes[point as usize]) {
                continue;
            }
            let place = place.unwrap_or(self.points[to as usize]);
            if !self.may(from, to, place) {
                // It may later, when what is beside it has changed.
                self.refused[from as usize].push(next);
                continue;
            }
            let loss = self.loss(from, to);
            let dearer = loss.max(self.away(from, to, place));
            if dearer > price {
                self.queue.push(Candidate { price: dearer, ..next });
                continue;
            }
            self.lost = self.lost.max(loss);
            self.collapse(from, to, place);
        }
    }

    /// Whether the surface stays one that does not meet itself at more points than before, and does not fold, where both go to `place`.
    fn may(&self, from: u32, to: u32, place: DVec3) -> bool {
        if self.on_rim[from as usize] && !self.rim.contains(&key(from, to)) {
            return false;
        }
        let has = |point: u32| move |corners: &[u32; 3]| corners.contains(&point);
        let shared = self.at(from).filter(|(corners, _)| has(to)(corners)).count();
        let (mine, theirs) = (self.neighbours(from), self.neighbours(to));
        if shared == 0 || mine.iter().filter(|point| theirs.contains(point)).count() != shared {
            return false;
        }
        let folds = |corners: [u32; 3]| {
            let normal = |points: [DVec3; 3]| (points[1] - points[0]).cross(points[2] - points[0]);
            let before = normal(corners.map(|point| self.points[point as usize]));
            let after = normal(corners.map(|point| if point == from || point == to { place } else { self.points[point as usize] }));
            before.dot(after) <= LEAST_TURN * before.length() * after.length()
        };
        let stays = |corners: &[u32; 3], other: u32| !has(other)(corners);
        self.at(from).filter(|(corners, _)| stays(corners, to)).all(|(corners, _)| {
            let moved = corners.map(|point| if point == from { to } else { point });
            !folds(corners) && !self.at(to).any(|(other, _)| moved.iter().all(|point| other.contains(point)))
        }) && (place == self.points[to as usize]
            || self.at(to).filter(|(corners, _)| stays(corners, from)).all(|(corners, _)| !folds(corners)))
    }

    /// How far the two would lie from the surface: a sharp tip can lie far from it and yet near the planes of its sides.
    fn away(&self, from: u32, to: u32, place: DVec3) -> f64 {
        let ends = [from, to];
        let is_one = |corners: &[u32; 3]| corners.iter().filter(|point| ends.contains(point)).count() == 1;
        let moved = |point: u32| if ends.contains(&point) { place } else { self.points[point as usize] };
        let around = || self.at(from).chain(self.at(to)).map(|(corners, _)| corners).filter(is_one).map(|corners| corners.map(moved));
        let distance = |p: DVec3| around().map(|corners| distance_to(p, corners)).reduce(f64::min).unwrap_or(0.0);
        ends.map(|point| self.points[point as usize]).into_iter().filter(|&p| p != place).map(distance).fold(0.0, f64::max)
    }

    fn collapse(&mut self, from: u32, to: u32, place: DVec3) {
        self.points[to as usize] = place;
        let (gone, kept): (Vec<u32>, Vec<u32>) = std::mem::take(&mut self.around[from as usize])
            .into_iter()
            .filter(|&triangle| self.triangles[triangle as usize].is_some())
            .partition(|&triangle| self.triangles[triangle as usize].is_some_and(|(corners, _)| corners.contains(&to)));
        let chosen: Vec<Option<u32>> = kept.iter().map(|&triangle| self.vertex_at(triangle, from, to, &gone)).collect();
        for (&triangle, chosen) in kept.iter().zip(chosen) {
            if let Some((corners, vertices)) = &mut self.triangles[triangle as usize] {
                for (corner, vertex) in corners.iter_mut().zip(vertices).filter(|(corner, _)| **corner == from) {
                    *corner = to;
                    *vertex = chosen.unwrap_or(*vertex);
                }
            }
        }
        self.left -= gone.len();
        for &triangle in &gone {
            self.triangles[triangle as usize] = None;
        }
        self.around[to as usize].extend(kept);
        let triangles = &self.triangles;
        self.around[to as usize].retain(|&triangle| triangles[triangle as usize].is_some());
        // The rim goes along.
        for other in self.neighbours(to) {
            if self.rim.contains(&key(from, other)) {
                self.rim.insert(key(to, other));
            }
        }
        self.on_rim[to as usize] |= self.on_rim[from as usize];
        let mut patches = std::mem::take(&mut self.patches[from as usize]);
        patches.append(&mut self.patches[to as usize]);
        patches.sort_by(|a, b| (a.0, b.1).partial_cmp(&(b.0, a.1)).unwrap_or(Ordering::Equal));
        patches.dedup_by_key(|patch| patch.0);
        let here =
            |material: u32| self.around[to as usize].iter().any(|&triangle| self.model.triangle_materials[triangle as usize] == material);
        patches.retain(|patch| here(patch.0));
        self.patches[to as usize] = patches;
        let mut planes = std::mem::take(&mut self.planes[from as usize]);
        self.planes[to as usize].append(&mut planes);
        self.went[from as usize] = to;
        self.changes[from as usize] += 1;
        self.changes[to as usize] += 1;
        self.offer(to);
        for beside in self.neighbours(to) {
            self.queue.extend(self.refused[beside as usize].drain(..));
        }
    }

    /// The vertex whose normal and texture coordinates a triangle takes over at `to`: by way of a triangle that goes, else the one with
    /// the same material and nearest normal. None: it keeps its own.
    fn vertex_at(&self, triangle: u32, from: u32, to: u32, gone: &[u32]) -> Option<u32> {
        let material = |triangle: u32| self.model.triangle_materials[triangle as usize];
        let at = |triangle: u32, point: u32| {
            let (corners, vertices) = self.triangles[triangle as usize]?;
            Some(vertices[corners.iter().position(|&corner| corner == point)?])
        };
        let own = at(triangle, from)?;
        let alike = |&&other: &&u32| material(other) == material(triangle);
        if let Some(&side) = gone.iter().filter(alike).find(|&&side| at(side, from) == Some(own)) {
            return at(side, to);
        }
        let normal = |vertex: u32| Vec3::from(self.model.vertices[vertex as usize].normal);
        let nearness = |&vertex: &u32| normal(vertex).dot(normal(own));
        let there = self.around[to as usize].iter().filter(alike).filter_map(|&other| at(other, to));
        there.filter(|vertex| nearness(vertex) > SAME_NORMAL).max_by(|a, b| nearness(a).total_cmp(&nearness(b)))
    }

    /// The model as it is now. `is_smooth`: triangles of one material share their vertices at a point, with the mean of their normals.
    pub fn model(&self, is_smooth: bool) -> Model {
        let mut result = Model { materials: self.model.materials.clone(), ..Model::default() };
        let mut places: HashMap<(u32, u32), u32> = HashMap::new();
        let mut normals: Vec<Vec3> = Vec::new();
        for ((corners, vertices), &material) in self.with_materials() {
            let merged = [0, 1, 2].map(|k| {
                let vertex = self.model.vertices[vertices[k] as usize];
                let number = *places.entry((corners[k], if is_smooth { material } else { vertices[k] })).or_insert_with(|| {
                    let position = self.points[corners[k] as usize].as_vec3().to_array();
                    result.vertices.push(Vertex { position, ..vertex });
                    normals.push(Vec3::ZERO);
                    result.vertices.len() as u32 - 1
                });
                normals[number as usize] += Vec3::from(vertex.normal);
                number
            });
            result.triangles.push(merged);
            result.triangle_materials.push(material);
        }
        if is_smooth {
            for (vertex, normal) in result.vertices.iter_mut().zip(normals) {
                vertex.normal = normal.try_normalize().map_or(vertex.normal, |normal| normal.to_array());
            }
        }
        result
    }

    /// The farthest that a corner of the model lies from the surface now: from the triangles at the point that it went to, so it is an
    /// upper bound. A patch that is gone counts with its size.
    pub fn moved(&self) -> f64 {
        let mut went = self.went.clone();
        for point in 0..went.len() {
            while went[went[point] as usize] != went[point] {
                went[point] = went[went[point] as usize];
            }
        }
        let distance = |(&now, &place): (&u32, &DVec3)| {
            let triangles = self.at(now).map(|(corners, _)| corners.map(|corner| self.points[corner as usize]));
            triangles.map(|corners| distance_to(place, corners)).reduce(f64::min)
        };
        went.iter().zip(&self.places).filter_map(distance).fold(self.lost, f64::max)
    }
}

/// The distance of a point from a triangle.
fn distance_to(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let outside = |from: DVec3, to: DVec3| normal.cross(to - from).dot(p - from) < 0.0;
    let to_side = |from: DVec3, to: DVec3| {
        let along = to - from;
        let share = ((p - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        p.distance(from + along * share)
    };
    let sides = [(a, b), (b, c), (c, a)];
    if normal == DVec3::ZERO || sides.iter().any(|&(from, to)| outside(from, to)) {
        return sides.iter().map(|&(from, to)| to_side(from, to)).fold(f64::INFINITY, f64::min);
    }
    (p - a).dot(normal).abs() / normal.length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Material;
    use crate::scene::model::shapes;

    #[test]
    fn distance_from_a_triangle_at_face_side_and_corner() {
        let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
        for (p, expected) in [
            (DVec3::new(0.25, 0.25, 2.0), 2.0),
            (DVec3::new(0.5, -3.0, 0.0), 3.0),
            (DVec3::new(1.0, 1.0, 0.0), 0.5f64.sqrt()),
            (DVec3::new(-3.0, -4.0, 0.0), 5.0),
        ] {
            assert!((distance_to(p, triangle) - expected).abs() < 1e-12, "{p}");
        }
    }

    /// Every edge of a closed surface is passed once each way, before and after.
    #[test]
    fn a_closed_surface_stays_closed() {
        let fine = shapes::icosphere(1280, Material::default());
        let mut collapse = Collapse::new(&fine);
        collapse.within(0.1);
        assert!(collapse.left() < 200);
        let mut edges: HashMap<[u32; 2], i32> = HashMap::new();
        for (corners, _) in collapse.triangles.iter().flatten() {
            for k in 0..3 {
                *edges.entry([corners[k], corners[(k + 1) % 3]]).or_default() += 1;
            }
        }
        assert!(edges.iter().all(|([a, b], &count)| count == 1 && edges.get(&[*b, *a]) == Some(&1)));
        assert_eq!(collapse.left(), collapse.triangles.iter().flatten().count());
    }
}
