//! What the judge looks at: a scene's things with their models, places and worldlines.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Instant;

use glam::{DMat3, DQuat, DVec3};

use super::roots::Bend;
use super::span::{CLINGING, Scope};
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

    /// Bounds on how it moves from T = `from` to `to`; None where it knows none, and how far light strays from its chord in the body's axes is then
    /// measured instead.
    fn sway(&self, _from: f64, _to: f64) -> Option<Sway> {
        None
    }
}

/// Bounds on how a body moves over a while, in r_s, c and radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sway {
    /// |dx/dT| of the centre.
    pub velocity: f64,
    /// |d²x/dT²|.
    pub acceleration: f64,
    /// The least |p| of the momentum per mass, and the greatest.
    pub momentum: [f64; 2],
    /// |dp/dT|.
    pub force: f64,
    /// |d²p/dT²|, but at jumps of the force.
    pub surge: f64,
    /// The angular velocity of the attitude, constant between jumps.
    pub turning: f64,
    /// All jumps of the force and of the angular velocity together.
    pub jumps: [f64; 2],
}

impl Sway {
    /// How much the path of light bends in the body's axes, that comes no farther from its centre than `away` (r_s), at a speed of `light` and with
    /// |d²x/dT²| up to `bend` on the slice.
    ///
    /// A place there is y = M (x − c), M = Rᵀ B with the rotation R of the attitude and the boost B = 1 + p pᵀ/(1 + γ), |B| = γ. With
    /// f = 1/(1 + γ), |p| f < 1 and |γ'| ≤ |p'|: |B'| ≤ 3|p'| and |B''| ≤ 3|p''| + (8f + 1/γ)|p'|². The rest is the product rule.
    pub(super) fn bend(&self, away: f64, light: f64, bend: f64) -> Bend {
        let [least, gamma] = self.momentum.map(|p| p.hypot(1.0));
        let rate = self.turning * gamma + 3.0 * self.force;
        let boost = 3.0 * self.surge + (8.0 / (1.0 + least) + 1.0 / least) * self.force * self.force;
        let twice = self.turning * (self.turning * gamma + 6.0 * self.force) + boost;
        let curve = twice * away + 2.0 * rate * (light + self.velocity) + gamma * (bend + self.acceleration);
        Bend { curve, kink: away * (self.jumps[1] * gamma + 3.0 * self.jumps[0]) }
    }
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
    /// How many rays were given up.
    pub(super) given_up: AtomicUsize,
    /// When there is no time left, and whether that is past.
    deadline: Option<Instant>,
    late: AtomicBool,
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
                    let oldest = OLDEST + 2.0 * far;
                    // What lingers at the hole may be met by light that clings to the horizon.
                    let lingers = line.at(time - oldest).position.length() <= 2.0 + 2.0 * reach;
                    let sweep = Sweep::new(line, time, if lingers { oldest + CLINGING } else { oldest }, reach);
                    flying.push(Flying { thing: index as u32, vertices, tree, reach, sweep });
                }
            }
        }
        held.tree = Tree::new(&held.vertices, &held.triangles);
        let held_radius = held.vertices.iter().map(|v| v.length()).fold(0.0, f64::max);
        World {
            models,
            things,
            time,
            hole,
            held,
            flying,
            held_radius,
            scope: Mutex::new(None),
            given_up: AtomicUsize::new(0),
            deadline: None,
            late: AtomicBool::new(false),
        }
    }

    /// From `deadline` on rays are left where they are: what they show then is nothing to go by, see [`World::is_late`].
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

    pub(super) fn count_given_up(&self, is: bool) {
        self.given_up.fetch_add(usize::from(is), Ordering::Relaxed);
    }

    /// How many rays have been given up since the world was built: they wound at the photon sphere to within rounding, or took more looks at flying bodies than
    /// one ray is worth. Each counts as one that met nothing where it was left.
    pub fn given_up(&self) -> usize {
        self.given_up.load(Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Everything at once: a bent path, a momentum that grows and turns, an even turn.
    struct Wild(f64);

    impl Worldline for Wild {
        fn at(&self, time: f64) -> Pose {
            let k = self.0;
            let momentum = DVec3::new(1.2 * k + 0.8 * time, 0.5 * (2.0 * time).sin(), 0.3 * k);
            let position = DVec3::new(0.3 * time, 0.4 * time * time, 0.2 * (1.5 * time).cos());
            Pose { position, momentum, attitude: DQuat::from_scaled_axis(DVec3::new(0.4, -0.7, 0.5) * time) }
        }
    }

    #[test]
    fn light_strays_from_its_chord_in_a_bodys_axes_by_less_than_the_bound() {
        let light = |time: f64| DVec3::new(0.1, 0.9 * time, 0.3 + 0.4 * time * time);
        let mut tightest = f64::INFINITY;
        for (k, from, span) in [(-1.0, -0.2, 0.5), (0.0, 0.0, 0.3), (2.0, 0.4, 0.2), (6.0, -0.5, 0.4), (0.0, -1.0, 1.0)] {
            let line = Wild(k);
            let times: Vec<f64> = (0..=400).map(|i| from + span * f64::from(i) / 400.0).collect();
            let most = |of: &dyn Fn(f64) -> f64| times.iter().map(|t| of(*t)).fold(0.0, f64::max);
            let p = |t: f64| line.at(t).momentum.length();
            let sway = Sway {
                velocity: most(&|t| DVec3::new(0.3, 0.8 * t, -0.3 * (1.5 * t).sin()).length()),
                acceleration: most(&|t| DVec3::new(0.0, 0.8, -0.45 * (1.5 * t).cos()).length()),
                momentum: [times.iter().map(|t| p(*t)).fold(f64::INFINITY, f64::min), most(&p)],
                force: most(&|t| DVec3::new(0.8, (2.0 * t).cos(), 0.0).length()),
                surge: most(&|t| 2.0 * (2.0 * t).sin().abs()),
                turning: DVec3::new(0.4, -0.7, 0.5).length(),
                jumps: [0.0; 2],
            };
            let away = most(&|t| light(t).distance(line.at(t).position));
            let bound = sway.bend(away, most(&|t| 0.9f64.hypot(0.8 * t)), 0.8).sagitta(span);
            let body = |t: f64| line.at(t).to_body(light(t));
            let strays = most(&|t| body(t).distance(body(from).lerp(body(from + span), (t - from) / span)));
            assert!(strays <= bound, "{k}: {strays} {bound}");
            tightest = tightest.min(bound / strays);
        }
        assert!(tightest < 15.0, "a bound of no use: {tightest}");
    }
}
