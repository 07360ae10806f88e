//! The crates that stand beside ours: obvhs and bvh, each with its own tree and its own triangle test.

use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::ray::RayHit;

use crate::straight::scenes::Triangle;
use crate::straight::{Hit, Ray};

/// How long another's tree may take to build, and then its single rays for one picture.
const LONGEST: Duration = Duration::from_secs(30);

/// How many rays tell how long all take.
const TRIED: usize = 64;

/// What `build` makes of the triangles; None, and a sentence, where that takes too long. It cannot be stopped: it goes on beside what is
/// measured then.
pub fn within<T: Send + 'static>(
    scene: &str,
    name: &str,
    triangles: &[Triangle],
    build: impl FnOnce(&[Triangle]) -> T + Send + 'static,
) -> Option<T> {
    let (done, built) = mpsc::channel();
    let own = triangles.to_vec();
    // Nobody may be waiting any more.
    thread::spawn(move || done.send(build(&own)));
    let built = built.recv_timeout(LONGEST).ok();
    if built.is_none() {
        eprintln!("{scene}: {name} is left out: its tree is not built after {} s", LONGEST.as_secs());
    }
    built
}

/// Whether all these rays take no longer than they may, by some of them; says where not.
pub fn bearable(scene: &str, name: &str, rays: &[Ray], trace: impl Fn(&Ray) -> Hit) -> bool {
    let started = Instant::now();
    let mut tried = 0;
    for ray in rays.iter().step_by(rays.len().div_ceil(TRIED).max(1)) {
        std::hint::black_box(trace(ray));
        tried += 1;
        if started.elapsed() > LONGEST {
            break;
        }
    }
    let all = started.elapsed().as_secs_f64() * rays.len() as f64 / f64::from(tried.max(1));
    let bearable = all <= LONGEST.as_secs_f64();
    if !bearable {
        eprintln!("{scene}: {name} is left out: its {} rays would take {all:.0} s, and may take {}", rays.len(), LONGEST.as_secs());
    }
    bearable
}

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

    /// Whether anything is hit.
    pub fn occluded(&self, ray: &Ray) -> bool {
        let theirs = obvhs::ray::Ray::new(ray.origin.into(), ray.direction.into(), 0.0, ray.until);
        !self.tree.ray_traverse_miss(theirs, |ray, id| self.triangles[id].intersect(ray))
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
