//! The scene as the judge sees it: bodies with their models, positions and worldlines.
//!
//! - `worldline`: how they move.
//! - [`tree`]: bounding volume hierarchies over triangles, traced along pieces of a curve.
//! - `sweep`: where flying bodies may be, by delay; `span`: the delays between which a camera may see them.

pub(in crate::judge::picture) mod span;
pub(in crate::judge::picture) mod sweep;
pub mod tree;
pub(in crate::judge::picture) mod worldline;

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use web_time::Instant;

use glam::{DMat3, DVec3};

use crate::scene::lighting::Illumination;
use crate::scene::model::Model;
use span::{CLINGING, Scope};
use sweep::Sweep;
use tree::TriangleTree;
use worldline::BodyMotion;

/// One visible thing.
#[derive(Clone, Copy)]
pub struct Thing<'a> {
    /// Index into the models.
    pub model: usize,
    /// Length of the model's unit, in r_s.
    pub scale: f64,
    /// How it moves.
    pub motion: BodyMotion<'a>,
    /// What shines on it.
    pub light: Illumination,
    /// Its number in the layers of a picture, from 1.
    pub id: u32,
}

/// A scene as the judge sees it at one T.
pub struct World<'a> {
    /// The models that the things have.
    pub models: &'a [Model],
    /// Everything visible.
    pub things: Vec<Thing<'a>>,
    /// The clock T at the camera, in r_s/c.
    pub time: f64,
    /// Whether there is a hole; without one light goes straight and nothing falls.
    pub hole: bool,
    pub(in crate::judge::picture) static_bodies: StaticBodies,
    pub(in crate::judge::picture) flying: Vec<Flying>,
    /// No static body is beyond this radius, in r_s.
    pub(in crate::judge::picture) static_radius: f64,
    /// What light to the latest camera may meet, and at which delays.
    pub(in crate::judge::picture) scope: Mutex<Option<Arc<Scope>>>,
    /// How many rays were given up.
    pub(in crate::judge::picture) given_up: AtomicUsize,
    /// The deadline; below, whether it has passed.
    deadline: Option<Instant>,
    late: AtomicBool,
}

/// All triangles of static bodies, together.
pub(in crate::judge::picture) struct StaticBodies {
    pub vertices: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle its thing and its number in the model.
    pub owners: Vec<(u32, u32)>,
    pub tree: TriangleTree,
}

/// A flying thing in its rest frame.
pub(in crate::judge::picture) struct Flying {
    pub thing: u32,
    /// Corners in body axes, in r_s.
    pub vertices: Vec<DVec3>,
    pub tree: TriangleTree,
    /// The farthest corner from the centre, in r_s.
    pub reach: f64,
    /// Where it may be, by delay.
    pub sweep: Sweep,
}

/// Windows of delay go back to this and twice the body's radius, in r_s/c. Beyond are far cameras, and light that winds.
const OLDEST: f64 = 100.0;

impl<'a> World<'a> {
    /// Builds the trees. `time` is T at the camera.
    pub fn new(models: &'a [Model], things: Vec<Thing<'a>>, time: f64, hole: bool) -> World<'a> {
        let mut static_bodies = StaticBodies { vertices: vec![], triangles: vec![], owners: vec![], tree: TriangleTree::new(&[], &[]) };
        let mut flying = Vec::new();
        for (index, thing) in things.iter().enumerate() {
            let model = &models[thing.model];
            let corners = model.vertices.iter().map(|v| DVec3::from(v.position.map(f64::from)) * thing.scale);
            match thing.motion {
                BodyMotion::Static { position, attitude } => {
                    let first = static_bodies.vertices.len() as u32;
                    let turn = DMat3::from_quat(attitude);
                    static_bodies.vertices.extend(corners.map(|v| position + turn * v));
                    static_bodies.triangles.extend(model.triangles.iter().map(|t| t.map(|i| i + first)));
                    static_bodies.owners.extend((0..model.triangles.len() as u32).map(|t| (index as u32, t)));
                }
                BodyMotion::Flying(line) => {
                    let vertices: Vec<DVec3> = corners.collect();
                    let tree = TriangleTree::new(&vertices, &model.triangles);
                    let reach = vertices.iter().map(|v| v.length()).fold(0.0, f64::max);
                    let far = line.at(time).position.length();
                    let oldest = OLDEST + 2.0 * far;
                    // A body that lingers at the hole may be met by light that clings to the horizon.
                    let lingers = line.at(time - oldest).position.length() <= 2.0 + 2.0 * reach;
                    let sweep = Sweep::new(line, time, if lingers { oldest + CLINGING } else { oldest }, reach);
                    flying.push(Flying { thing: index as u32, vertices, tree, reach, sweep });
                }
            }
        }
        static_bodies.tree = TriangleTree::new(&static_bodies.vertices, &static_bodies.triangles);
        let static_radius = static_bodies.vertices.iter().map(|v| v.length()).fold(0.0, f64::max);
        World {
            models,
            things,
            time,
            hole,
            static_bodies,
            flying,
            static_radius,
            scope: Mutex::new(None),
            given_up: AtomicUsize::new(0),
            deadline: None,
            late: AtomicBool::new(false),
        }
    }

    /// From `deadline` on rays are stopped where they are; what they show is meaningless, see [`World::is_late`].
    pub fn stop_at(&mut self, deadline: Instant) {
        self.deadline = Some(deadline);
    }

    /// Whether the deadline is past.
    pub fn is_late(&self) -> bool {
        let Some(deadline) = self.deadline else { return false };
        if !self.late.load(Ordering::Relaxed) && Instant::now() >= deadline {
            self.late.store(true, Ordering::Relaxed);
        }
        self.late.load(Ordering::Relaxed)
    }

    pub(in crate::judge::picture) fn count_given_up(&self, is: bool) {
        self.given_up.fetch_add(usize::from(is), Ordering::Relaxed);
    }

    /// Number of rays that were given up since the world was built: they wound at the photon sphere to within rounding, or needed too many
    /// tests of flying bodies. Each counts as one that met nothing.
    pub fn given_up(&self) -> usize {
        self.given_up.load(Ordering::Relaxed)
    }
}

impl World<'_> {
    /// What light to a camera at radius `camera` (r_s) may meet; kept for the next ray.
    pub(in crate::judge::picture) fn scope(&self, camera: f64) -> Arc<Scope> {
        let mut kept = self.scope.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        match &*kept {
            Some(scope) if scope.is_of(camera) => scope.clone(),
            _ => {
                let lines = self.flying.iter().filter_map(|flying| match self.things[flying.thing as usize].motion {
                    BodyMotion::Flying(line) => Some((line, flying.reach)),
                    BodyMotion::Static { .. } => None,
                });
                let scope = Arc::new(Scope::new(camera, self.static_radius, self.time, self.hole, lines));
                *kept = Some(scope.clone());
                scope
            }
        }
    }
}
