//! The scenes of the chart and the rays through them.

use super::request::{ALL, SCENES};
use std::time::Instant;

use glam::Vec3;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use super::request::{BvhRequest, ChartError};
use crate::straight::scenes::{Scene, View, bunny, castle, needles, spd};
use crate::straight::{Hit, Ray, Wide, order};

/// No method of ours should take longer than some times this (seconds of single rays in the tree of eight) for a picture: else the picture
/// is made smaller.
const LONGEST: f64 = 2.0;

/// Edges of packets in pixels.
pub const SIZES: [usize; 6] = [2, 4, 8, 16, 32, 64];

/// Frames of a walk.
const STEPS: usize = 6;

/// A scene with the rays that it is measured with.
pub struct Job {
    pub scene: Scene,
    /// Whether the bunny is not the bunny.
    pub stand_in: bool,
    /// The camera's axes to the right and upwards.
    pub screen: [[f32; 3]; 2],
    /// Through the centres of pixels, row by row.
    pub primary: Vec<Ray>,
    /// The same for a camera that walks on at each step.
    pub walk: Vec<Vec<Ray>>,
    /// On from the first hits, tile by tile: name and rays.
    pub secondary: Vec<(&'static str, Vec<Ray>)>,
    pub size: [usize; 2],
}

impl Job {
    pub fn new(name: &str, request: &BvhRequest) -> Result<Job, ChartError> {
        let mut stand_in = false;
        let (name, triangles, view) = match name {
            "bunny" => {
                stand_in = !request.bunny.exists();
                let triangles = if stand_in { bunny::stand_in() } else { bunny::read(&request.bunny)? };
                (SCENES[0], triangles, bunny::VIEW)
            }
            "castle" => (SCENES[1], castle::castle(), castle::VIEW),
            "tree10" => (SCENES[2], spd::tree(10), spd::TREE_VIEW),
            "balls4A" => (SCENES[3], spd::balls(4), spd::BALLS_VIEW),
            "balls4B" => (SCENES[4], spd::balls(4), spd::BALLS_VIEW.from_distance(0.5)),
            "needles" => (ALL[6], needles::needles(needles::COUNT), needles::VIEW),
            _ => (SCENES[5], spd::balls(4), spd::BALLS_VIEW.from_distance(4.0)),
        };
        let scene = Scene { name, triangles, view };
        let forward = (glam::DVec3::from(view.target) - glam::DVec3::from(view.eye)).normalize();
        let right = forward.cross(glam::DVec3::Z).normalize();
        let screen = [right, right.cross(forward)].map(|axis| axis.as_vec3().to_array());
        let wide = Wide::new(&scene.triangles);
        let size = bearable(&scene, &wide, request.size);
        let primary = rays_of(&view, size);
        let walk = (0..STEPS)
            .map(|step| {
                // A slow circle around what is looked at.
                let turn = glam::DQuat::from_rotation_z(0.01 * step as f64);
                let from = turn * (glam::DVec3::from(view.eye) - glam::DVec3::from(view.target));
                let eye = (glam::DVec3::from(view.target) + from).to_array();
                rays_of(&View { eye, ..view }, size)
            })
            .collect();
        let secondary = secondary(&scene, &wide, &primary, size);
        Ok(Job { scene, stand_in, screen, primary, walk, secondary, size })
    }
}

/// The size of a picture that single rays make in [`LONGEST`], by rays through the middle; the one asked for, unless the scene is such a
/// bad one. Says so.
fn bearable(scene: &Scene, wide: &Wide, size: [usize; 2]) -> [usize; 2] {
    let middle = rays_of(&scene.view, [32, 24]);
    let mut hits = vec![Hit::MISS; middle.len()];
    let started = Instant::now();
    wide.closest_each(&middle, &mut hits);
    let each = started.elapsed().as_secs_f64() / middle.len() as f64;
    let mut found = size;
    while (found[0] * found[1]) as f64 * each > LONGEST && found[1] > 32 {
        found = found.map(|side| side / 2);
    }
    if found != size {
        let seconds = each * (size[0] * size[1]) as f64;
        eprintln!(
            "{}: {} × {} pixels would take single rays {seconds:.0} s: the picture has {} × {}",
            scene.name, size[0], size[1], found[0], found[1]
        );
    }
    found
}

fn rays_of(view: &View, size: [usize; 2]) -> Vec<Ray> {
    let eye = view.eye.map(|c| c as f32);
    view.directions(size).into_iter().map(|direction| Ray::new(eye, direction)).collect()
}

/// Rays in the order of packets of `size` × `size` pixels, and where packets begin.
pub fn tiled(rays: &[Ray], picture: [usize; 2], size: usize) -> (Vec<Ray>, Vec<usize>) {
    let (pixels, starts) = order::tiles(picture, size);
    (pixels.iter().map(|&i| rays[i as usize]).collect(), starts)
}

/// Shadow rays to a light, mirrored rays, and rays in random directions, from every first hit.
fn secondary(scene: &Scene, wide: &Wide, primary: &[Ray], picture: [usize; 2]) -> Vec<(&'static str, Vec<Ray>)> {
    let (rays, _) = tiled(primary, picture, 32);
    let mut hits = vec![Hit::MISS; rays.len()];
    wide.closest_each(&rays, &mut hits);
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
