//! The scenes of the chart and the rays through them.

use std::path::Path;

use glam::{DVec3, Vec3};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::chart::ChartError;
use crate::straight::scenes::{TestScene, bunny, castle, spd};
use crate::straight::{Hit, Ray, Wide, order};

/// Every scene of Sei 2008, in its order.
pub const SCENES: [&str; 6] = ["bunny", "castle", "tree10", "balls4A", "balls4B", "balls4C"];

/// Width and height of the picture.
const SIZE: [usize; 2] = [1024, 768];

/// Edges of packets in pixels.
pub const SIZES: [usize; 6] = [2, 4, 8, 16, 32, 64];

/// Traces rays and writes their hits.
pub type Trace<'a> = Box<dyn FnMut(&mut [Hit]) + 'a>;

/// A scene with the rays that it is measured with.
pub struct Job {
    pub scene: TestScene,
    /// Whether the bunny is not the bunny.
    pub stand_in: bool,
    /// The camera's axes to the right and upwards.
    pub screen: [[f32; 3]; 2],
    /// Through the centres of pixels, row by row.
    pub primary: Vec<Ray>,
    /// On from the first hits, tile by tile: name and rays.
    pub secondary: Vec<(&'static str, Vec<Ray>)>,
    pub size: [usize; 2],
}

impl Job {
    /// Of one of [`SCENES`], with the bunny of this file.
    pub fn new(name: &str, bunny_file: &Path) -> Result<Job, ChartError> {
        let stand_in = name == "bunny" && !bunny_file.exists();
        let (triangles, view) = match name {
            "bunny" if stand_in => (bunny::stand_in(), bunny::VIEW),
            "bunny" => (bunny::read(bunny_file).map_err(ChartError::Input)?, bunny::VIEW),
            "castle" => (castle::castle(), castle::VIEW),
            "tree10" => (spd::tree(10), spd::TREE_VIEW),
            "balls4A" => (spd::balls(4), spd::BALLS_VIEW),
            "balls4B" => (spd::balls(4), spd::BALLS_VIEW.from_distance(0.5)),
            _ => (spd::balls(4), spd::BALLS_VIEW.from_distance(4.0)),
        };
        let name = SCENES.into_iter().find(|scene| *scene == name).unwrap_or_default();
        let scene = TestScene { name, triangles, view };
        let forward = (DVec3::from(view.target) - DVec3::from(view.eye)).normalize();
        let right = forward.cross(DVec3::Z).normalize();
        let screen = [right, right.cross(forward)].map(|axis| axis.as_vec3().to_array());
        let eye = view.eye.map(|c| c as f32);
        let primary: Vec<Ray> = view.directions(SIZE).into_iter().map(|direction| Ray::new(eye, direction)).collect();
        let secondary = secondary(&scene, &primary);
        Ok(Job { scene, stand_in, screen, primary, secondary, size: SIZE })
    }
}

/// Shadow rays to a light, mirrored rays, and rays in random directions, from every first hit.
fn secondary(scene: &TestScene, primary: &[Ray]) -> Vec<(&'static str, Vec<Ray>)> {
    let rays: Vec<Ray> = order::tiles(SIZE, 32).0.iter().map(|&i| primary[i as usize]).collect();
    let mut hits = vec![Hit::MISS; rays.len()];
    Wide::new(&scene.triangles).closest_each(&rays, &mut hits);
    let light = Vec3::from(scene.view.eye.map(|c| c as f32)) + Vec3::new(1.0, -2.0, 4.0);
    let random = &mut StdRng::seed_from_u64(4);
    let mut sets = [("shadow", Vec::new()), ("mirrored", Vec::new()), ("scattered", Vec::new())];
    for (ray, hit) in rays.iter().zip(&hits).filter(|(_, hit)| hit.is_hit()) {
        let [a, b, c] = scene.triangles[hit.triangle as usize].map(Vec3::from);
        let direction = Vec3::from(ray.direction);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let normal = if normal.dot(direction) > 0.0 { -normal } else { normal };
        let at = Vec3::from(ray.origin) + direction * hit.t;
        // Off the surface by more than the rounding of the hit.
        let start = at + normal * (1e-5 * (1.0 + hit.t));
        let anywhere = Vec3::from_array(std::array::from_fn(|_| random.random_range(-1.0f32..1.0))).normalize_or(Vec3::Z);
        sets[0].1.push(Ray { origin: start.to_array(), direction: (light - start).to_array(), until: 1.0 });
        sets[1].1.push(Ray::new(start.to_array(), (direction - 2.0 * normal * normal.dot(direction)).to_array()));
        sets[2].1.push(Ray::new(start.to_array(), anywhere.to_array()));
    }
    sets.into()
}
