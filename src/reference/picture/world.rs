//! What the judge looks at: a scene's things with their models, places and worldlines.

use std::sync::{Arc, Mutex};

use glam::{DMat3, DQuat, DVec3};

use super::span::Scope;
use super::sweep::Sweep;
use super::tree::Tree;
use crate::scene::lighting::Surroundings;
use crate::scene::model::Model;
use crate::spacetime::matter::gamma;

/// A body at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Its centre on the slice, in r_s.
    pub position: DVec3,
    /// Rain-frame momentum per mass, in c.
    pub momentum: DVec3,
    /// Body axes to rain axes, through the pure boost of `momentum`.
    pub attitude: DQuat,
}

impl Pose {
    /// From a place on the slice to the body's rest frame and axes: the rest length is longer along the momentum by γ.
    pub fn to_body(&self, place: DVec3) -> DVec3 {
        let away = place - self.position;
        let p = self.momentum;
        self.attitude.conjugate() * (away + p * (p.dot(away) / (1.0 + gamma(p))))
    }

    /// The inverse of [`Pose::to_body`].
    pub fn place_of(&self, body: DVec3) -> DVec3 {
        let v = self.attitude * body;
        let p = self.momentum;
        let g = gamma(p);
        self.position + v - p * (p.dot(v) / (g * (1.0 + g)))
    }
}

/// How something flies: where it is at any T.
pub trait Worldline: Sync {
    /// The body at T = `time`, in r_s/c.
    fn at(&self, time: f64) -> Pose;
}

/// How a thing moves.
#[derive(Clone, Copy)]
pub enum Motion<'a> {
    /// Held in place, at rest in Schwarzschild's coordinates.
    Held {
        /// In r_s.
        position: DVec3,
        /// Model axes to coordinate axes.
        attitude: DQuat,
    },
    /// Along a worldline, its shape at rest in its own frame.
    Flying(&'a dyn Worldline),
}

/// One visible thing.
#[derive(Clone, Copy)]
pub struct Thing<'a> {
    /// Index into the models.
    pub model: usize,
    /// Length of the model's unit, in r_s.
    pub scale: f64,
    /// How it moves.
    pub motion: Motion<'a>,
    /// What shines on it.
    pub light: Surroundings,
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
    pub(super) held: Held,
    pub(super) flying: Vec<Flying>,
    /// Beyond this radius nothing is held, in r_s.
    pub(super) held_radius: f64,
    /// What light to the latest camera may meet where.
    pub(super) scope: Mutex<Option<Arc<Scope>>>,
}

/// All triangles that are held in place, together.
pub(super) struct Held {
    pub vertices: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle its thing and its number in the model.
    pub owners: Vec<(u32, u32)>,
    pub tree: Tree,
}

/// A flying thing in its rest frame.
pub(super) struct Flying {
    pub thing: u32,
    /// Corners in body axes, in r_s.
    pub vertices: Vec<DVec3>,
    pub tree: Tree,
    /// The farthest corner from the centre, in r_s.
    pub reach: f64,
    /// Where it may be at which delay.
    pub sweep: Sweep,
}

/// Windows of delay are kept back to this and twice the body's radius (r_s/c): beyond are cameras far away, and light that winds.
const OLDEST: f64 = 100.0;

impl<'a> World<'a> {
    /// Builds the trees. `time` is T at the camera.
    pub fn new(models: &'a [Model], things: Vec<Thing<'a>>, time: f64, hole: bool) -> World<'a> {
        let mut held = Held { vertices: vec![], triangles: vec![], owners: vec![], tree: Tree::new(&[], &[]) };
        let mut flying = Vec::new();
        for (index, thing) in things.iter().enumerate() {
            let model = &models[thing.model];
            let corners = model.vertices.iter().map(|v| DVec3::from(v.position.map(f64::from)) * thing.scale);
            match thing.motion {
                Motion::Held { position, attitude } => {
                    let first = held.vertices.len() as u32;
                    let turn = DMat3::from_quat(attitude);
                    held.vertices.extend(corners.map(|v| position + turn * v));
                    held.triangles.extend(model.triangles.iter().map(|t| t.map(|i| i + first)));
                    held.owners.extend((0..model.triangles.len() as u32).map(|t| (index as u32, t)));
                }
                Motion::Flying(line) => {
                    let vertices: Vec<DVec3> = corners.collect();
                    let tree = Tree::new(&vertices, &model.triangles);
                    let reach = vertices.iter().map(|v| v.length()).fold(0.0, f64::max);
                    let far = line.at(time).position.length();
                    let sweep = Sweep::new(line, time, OLDEST + 2.0 * far, reach);
                    flying.push(Flying { thing: index as u32, vertices, tree, reach, sweep });
                }
            }
        }
        held.tree = Tree::new(&held.vertices, &held.triangles);
        let held_radius = held.vertices.iter().map(|v| v.length()).fold(0.0, f64::max);
        World { models, things, time, hole, held, flying, held_radius, scope: Mutex::new(None) }
    }
}
