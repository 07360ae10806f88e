//! The crates that stand beside ours: obvhs and bvh, each with its own tree and its own triangle test.

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::ray::RayHit;

use crate::straight::scenes::Triangle;
use crate::straight::{Hit, Ray};

/// obvhs: its tree of two at its slowest, best setting, which was the fastest of its trees for these rays.
pub struct Obvhs {
    tree: Bvh2,
    triangles: Vec<obvhs::triangle::Triangle>,
}

impl Obvhs {
    /// Builds the tree.
    pub fn new(triangles: &[Triangle]) -> Obvhs {
        let all: Vec<_> =
            triangles.iter().map(|&[a, b, c]| obvhs::triangle::Triangle { v0: a.into(), v1: b.into(), v2: c.into() }).collect();
        let tree = obvhs::bvh2::builder::build_bvh2_from_tris(&all, BvhBuildParams::very_slow_build(), &mut std::time::Duration::default());
        let triangles = tree.primitive_indices.iter().map(|&i| all[i as usize]).collect();
        Obvhs { tree, triangles }
    }

    /// The nearest hit.
    pub fn closest(&self, ray: &Ray) -> Hit {
        let mut hit = RayHit::none();
        let theirs = obvhs::ray::Ray::new(ray.origin.into(), ray.direction.into(), 0.0, ray.until);
        if self.tree.ray_traverse(theirs, &mut hit, |ray, id| self.triangles[id].intersect(ray)) {
            Hit { t: hit.t, triangle: self.tree.primitive_indices[hit.primitive_id as usize] }
        } else {
            Hit::MISS
        }
    }

    /// Some hit before the ray's end, where there is one.
    pub fn any(&self, ray: &Ray) -> Hit {
        let theirs = obvhs::ray::Ray::new(ray.origin.into(), ray.direction.into(), 0.0, ray.until);
        if self.tree.ray_traverse_miss(theirs, |ray, id| self.triangles[id].intersect(ray)) { Hit::MISS } else { Hit::SOME }
    }
}

/// A triangle as the crate bvh wants it.
pub struct Shape {
    corners: Triangle,
    number: u32,
    node: usize,
}

impl Bounded<f32, 3> for Shape {
    fn aabb(&self) -> Aabb<f32, 3> {
        let [a, b, c] = self.corners;
        Aabb::empty().grow(&a.into()).grow(&b.into()).grow(&c.into())
    }
}

impl BHShape<f32, 3> for Shape {
    fn set_bh_node_index(&mut self, node: usize) {
        self.node = node;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

/// The crate bvh.
pub struct Svenstaro {
    tree: bvh::bvh::Bvh<f32, 3>,
    shapes: Vec<Shape>,
}

impl Svenstaro {
    /// Builds the tree.
    pub fn new(triangles: &[Triangle]) -> Svenstaro {
        let mut shapes: Vec<Shape> =
            triangles.iter().enumerate().map(|(i, &corners)| Shape { corners, number: i as u32, node: 0 }).collect();
        Svenstaro { tree: bvh::bvh::Bvh::build(&mut shapes), shapes }
    }

    /// The nearest hit.
    pub fn closest(&self, ray: &Ray) -> Hit {
        let theirs = bvh::ray::Ray::new(ray.origin.into(), ray.direction.into());
        let mut best = Hit::MISS;
        for shape in self.tree.traverse_iterator(&theirs, &self.shapes) {
            let [a, b, c] = shape.corners;
            let t = theirs.intersects_triangle(&a.into(), &b.into(), &c.into()).distance;
            if t < best.t {
                best = Hit { t, triangle: shape.number };
            }
        }
        best
    }
}
