//! What is seen in one direction. The ray is followed backwards in pieces. The chord of each piece is traced through the trees; at the
//! leaves the curve itself is intersected with triangles.
//!
//! A piece from s₀ to s₁ differs from its chord, at equal parameter, by at most |s₁ − s₀|² max|x''| / 8 (the sagitta). So the chord meets
//! every box that the curve meets, if boxes are grown by that much. Flying bodies are tested in their rest frame, where they stand still
//! and the curve moves.
//!
//! `piece`: a piece of a ray and the nearest intersection on it; `static_body`, `flying`: bodies that it may meet; `triangle`: curves and
//! triangles;
//! `packet`: neighbouring rays together.

mod flying;
mod packet;
mod piece;
mod static_body;
mod triangle;

use std::cell::OnceCell;

use glam::{DVec2, DVec3};

use super::disk::PlaneCrossing;
use super::world::World;
use super::world::span::Scope;
use super::world::tree::Chord;
use super::world::worldline::BodyMotion;
use crate::judge::geodesic::{Segment, State};
use crate::judge::ray::{End, RayFollower, Stop, orbit_plane, sky_radius};
use crate::judge::trace::Hit;
use piece::{Ends, Piece, growth, pieces};

/// What is seen in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Seen {
    /// The shadow.
    Captured,
    /// The sky.
    Sky {
        /// Unit vector from the hole to the point on the sky.
        direction: DVec3,
        /// The angle Φ∞ swept.
        swept: f64,
        /// The energy of the light, in units of the frequency that a rain observer at the camera sees.
        energy: f64,
    },
    /// A surface; `Hit::object` is the index of the body.
    Hit(Hit),
}

/// What a ray may meet in a step: candidates from a larger packet.
#[derive(Clone, Debug, Default)]
pub(super) struct Candidates {
    /// Leaves of the tree of static bodies; None where they are not known.
    pub static_leaves: Option<Vec<u32>>,
    /// Indices of flying bodies.
    pub flying: Vec<u32>,
}

impl Candidates {
    /// Everything.
    pub fn all(world: &World) -> Candidates {
        Candidates { static_leaves: None, flying: (0..world.flying.len() as u32).collect() }
    }
}

/// One step of a ray.
#[derive(Clone, Copy)]
struct Step<'a> {
    segment: &'a Segment,
    /// Axes of the plane of its orbit.
    axes: [DVec3; 2],
    /// Φ swept when it begins, in radians.
    swept: f64,
}

/// Most tests of flying bodies per ray. A ray that needs more is given up and counted. None is known that needs a tenth of it.
pub(super) const MOST_LOOKS: u32 = 1 << 16;

impl World<'_> {
    /// Follows the light seen from `position` (r_s) in direction `look` (rain frame) back to the first body that it meets. `tolerance` is
    /// the local error of a step.
    pub fn look(&self, position: DVec3, look: DVec3, tolerance: f64) -> Seen {
        self.look_through(position, look, tolerance, &mut |_| ())
    }

    /// The same; calls `cross` for every crossing of the plane z = 0 on the way, in order.
    pub fn look_through(&self, position: DVec3, look: DVec3, tolerance: f64, cross: &mut dyn FnMut(PlaneCrossing)) -> Seen {
        let (axes, in_plane) = orbit_plane(position, look);
        let near = Candidates::all(self);
        let scope = self.scope(position.length());
        let radius = scope.radius.max(sky_radius(position.length()));
        let mut looks = MOST_LOOKS;
        if !self.hole {
            let state = State { position: DVec2::new(position.length(), 0.0), momentum: -in_plane };
            let segment = Segment::straight(0.0, state, position.length() + radius);
            let direction = axes[0] * in_plane.x + axes[1] * in_plane.y;
            let swept = in_plane.y.atan2(in_plane.x);
            let hit = self.meet(Step { segment: &segment, axes, swept: 0.0 }, &near, &scope, cross, &mut looks);
            self.count_given_up(looks == 0);
            return hit.map_or(Seen::Sky { direction, swept, energy: 1.0 }, Seen::Hit);
        }
        let stop = Stop { radius, horizon_gap: scope.gap, clings_until: scope.clings_until, ..Stop::default() };
        let mut follower = RayFollower::new(position.length(), in_plane, tolerance, stop);
        let mut swept = 0.0;
        while let Some(segment) = follower.step() {
            if let Some(hit) = self.meet(Step { segment: &segment, axes, swept }, &near, &scope, cross, &mut looks) {
                self.count_given_up(looks == 0);
                return Seen::Hit(hit);
            }
            swept = follower.swept;
            if self.is_late() {
                return Seen::Captured;
            }
        }
        self.count_given_up(looks == 0 || follower.end == Some(End::Steps));
        beyond(&follower, axes)
    }

    /// The first intersection in one step of the ray with what is `near` it. `looks` is how many tests of flying bodies are left.
    fn meet(&self, step: Step, near: &Candidates, scope: &Scope, cross: &mut dyn FnMut(PlaneCrossing), looks: &mut u32) -> Option<Hit> {
        let Step { segment, axes, swept } = step;
        let bend = segment.bend();
        let (mut start, last) = (segment.position(0.0), segment.position(segment.length));
        let pieces = pieces(bend, segment.length, start.distance(last));
        let length = segment.length / pieces;
        for k in 0..pieces as usize {
            let is_last = k + 1 == pieces as usize;
            let to = if is_last { segment.length } else { length * (k + 1) as f64 };
            let piece = Piece { segment, axes, from: length * k as f64, to, bend };
            let end = if is_last { last } else { segment.position(to) };
            let ends = Ends { positions: [start, end], rates: OnceCell::new() };
            start = end;
            let grow = growth(bend, to - piece.from, ends.positions);
            let mut met = None;
            self.meet_static(&piece, &ends, grow, near.static_leaves.as_deref(), &mut met);
            for &number in &near.flying {
                if !scope.allows(number, segment.start + piece.from, segment.start + to) {
                    continue;
                }
                let flying = &self.flying[number as usize];
                let [a, b] = ends.positions.map(|position| piece.embed(position));
                let chord = Chord::new(a, b, DVec3::splat(grow));
                if let BodyMotion::Flying(line) = self.things[flying.thing as usize].motion
                    && flying.sweep.touches(&chord, segment.start + piece.from, segment.start + to)
                {
                    self.meet_flying(&piece, flying, line, &mut met, looks);
                }
            }
            if let Some(crossing) = piece.cross_plane(&ends, met.map(|met| met.elapsed)) {
                cross(crossing);
            }
            if let Some(met) = met {
                return Some(met.hit(&piece, swept));
            }
        }
        None
    }
}

/// What is seen by a ray that has met nothing.
fn beyond(follower: &RayFollower, axes: [DVec3; 2]) -> Seen {
    match follower.sky_swept() {
        Some(swept) if follower.end == Some(End::Escaped) => {
            let direction = axes[0] * swept.cos() + axes[1] * swept.sin();
            Seen::Sky { direction, swept, energy: follower.energy() }
        }
        _ => Seen::Captured,
    }
}
