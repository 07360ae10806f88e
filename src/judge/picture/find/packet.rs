//! Packets of neighbouring geodesics: the idea of Sei 2008, along curves.
//!
//! The rays of a packet take their steps together, [`LANES`] at a time. A sheaf is the chord in their middle with a box around it that
//! holds all of them. It is traced through the tree once. Where it may meet something, the quarters of the packet are tested, and so on
//! down to single rays, which do what a ray alone does with what is left. Where rays diverge, so that the sheaf is wide relative to its
//! length, the packet is split in four for good. A ray sees the same bits as when it is traced alone: sheaves only leave out what cannot be
//! met.

use std::ops::Range;
use std::sync::atomic::Ordering;

use glam::{DVec2, DVec3};

use super::piece::{growth, pieces};
use super::{Candidates, MOST_LOOKS, Seen, Step, beyond};
use crate::judge::picture::disk::PlaneCrossing;
use crate::judge::picture::world::World;
use crate::judge::picture::world::span::Scope;
use crate::judge::picture::world::tree::Chord;
use crate::judge::ray::{End, RayFollower, Stop, orbit_plane, sky_radius};
use crate::judge::segments::{LANES, PIECES, Segments};

/// A packet is split if its sheaf is wider than this share of its length. A third more or less costs at most 2 %.
const WIDE: f64 = 0.5;
/// So few rays are tested one by one where their sheaf may meet something.
const FEW: usize = 2;
/// If there are more leaves than this, a single ray is faster through the tree itself.
const MOST_LEAVES: usize = 24;

/// A ray on its way.
struct Walk {
    follower: RayFollower,
    axes: [DVec3; 2],
    seen: Option<Seen>,
    /// How many tests of flying bodies it has left.
    looks: u32,
    /// The step that it has just taken.
    stride: Stride,
}

/// What a packet needs to know of a step of one of its rays.
#[derive(Clone, Copy, Default)]
struct Stride {
    /// Index among the rays that took the step, [`LANES`] at a time.
    slot: usize,
    /// Φ at the start of the step, radians.
    swept: f64,
    /// Positions at the ends of the step's pieces, in r_s.
    positions: [DVec3; PIECES + 1],
    /// How far the curve, and the grown boxes of a ray alone, may be from the chords between the positions, in r_s.
    strays: f64,
    /// Delay at the start, and how much of it the step covers, in r_s/c.
    start: f64,
    length: f64,
    /// Whether it may go through z = 0.
    crosses: bool,
}

impl World<'_> {
    /// What [`World::look_through`] sees from `position` (r_s) in each of these directions (rain frame), with the same bits. It takes less
    /// time if neighbours in the list are neighbours in the picture: every quarter of the list, and every quarter of that, should be a
    /// patch. `cross` also gets the number of the ray.
    pub fn look_together(
        &self,
        position: DVec3,
        looks: &[DVec3],
        tolerance: f64,
        cross: &mut dyn FnMut(usize, PlaneCrossing),
    ) -> Vec<Seen> {
        if !self.hole {
            let alone = |(i, &look): (usize, &DVec3)| self.look_through(position, look, tolerance, &mut |crossing| cross(i, crossing));
            return looks.iter().enumerate().map(alone).collect();
        }
        let scope = self.scope(position.length());
        let radius = scope.radius.max(sky_radius(position.length()));
        let stop = Stop { radius, horizon_gap: scope.gap, clings_until: scope.clings_until, ..Stop::default() };
        let walk = |&look: &DVec3| {
            let (axes, in_plane) = orbit_plane(position, look);
            let follower = RayFollower::new(position.length(), in_plane, tolerance, stop);
            Walk { follower, axes, seen: None, looks: MOST_LOOKS, stride: Stride::default() }
        };
        let mut march = March { world: self, scope: &scope, walks: looks.iter().map(walk).collect(), steps: Vec::new(), tolerance, cross };
        let everything = Candidates::all(self);
        let mut packets: Vec<Range<usize>> = std::iter::once(0..looks.len()).collect();
        while !self.is_late() && march.step() {
            let mut split = Vec::with_capacity(packets.len());
            packets.drain(..).for_each(|packet| march.split(packet, &mut split));
            packets = split;
            for packet in &packets {
                march.meet(packet.clone(), &everything);
            }
        }
        let is_lost =
            |walk: &&Walk| walk.looks == 0 || walk.seen.is_some_and(|seen| seen == Seen::Captured) && walk.follower.end == Some(End::Steps);
        self.given_up.fetch_add(march.walks.iter().filter(is_lost).count(), Ordering::Relaxed);
        // Every ray has ended and has seen something, unless the deadline has passed.
        march.walks.iter().map(|walk| walk.seen.unwrap_or(Seen::Captured)).collect()
    }
}

struct March<'a> {
    world: &'a World<'a>,
    scope: &'a Scope,
    walks: Vec<Walk>,
    steps: Vec<Segments>,
    tolerance: f64,
    cross: &'a mut dyn FnMut(usize, PlaneCrossing),
}

impl March<'_> {
    /// Takes the next step of every ray that is still on its way; false if there is none.
    fn step(&mut self) -> bool {
        for walk in self.walks.iter_mut().filter(|walk| walk.seen.is_none() && walk.follower.end.is_some()) {
            walk.seen = Some(beyond(&walk.follower, walk.axes));
        }
        let alive: Vec<usize> = (0..self.walks.len()).filter(|&i| self.walks[i].seen.is_none()).collect();
        while self.steps.len() < alive.len().div_ceil(LANES) {
            self.steps.push(Segments::empty());
        }
        for (group, (step, rays)) in self.steps.iter_mut().zip(alive.chunks(LANES)).enumerate() {
            // If rays are too few for all lanes, the last one fills the rest.
            let here = std::array::from_fn::<_, LANES, _>(|lane| self.walks[rays[lane.min(rays.len() - 1)]].follower.here());
            step.step(here.map(|here| here.0), &here.map(|here| here.1), self.tolerance);
            for (lane, &ray) in rays.iter().enumerate() {
                let walk = &mut self.walks[ray];
                walk.stride = Stride::new(step, LANES * group + lane, walk.axes, walk.follower.swept);
                walk.follower.advance(step.start[lane] + step.length[lane], step.end[lane]);
            }
        }
        !alive.is_empty()
    }

    /// How many rays of a packet are still on their way.
    fn count(&self, packet: &Range<usize>) -> usize {
        self.strides(packet).count()
    }

    /// Adds the packet to the list, or its quarters if its rays have diverged.
    fn split(&self, packet: Range<usize>, list: &mut Vec<Range<usize>>) {
        match self.count(&packet) {
            0 => {}
            1 => list.push(packet),
            _ if Sheaf::around(self.strides(&packet)).is_wide() => quarters(packet).for_each(|quarter| self.split(quarter, list)),
            _ => list.push(packet),
        }
    }

    fn strides(&self, packet: &Range<usize>) -> impl Iterator<Item = &Stride> {
        self.walks[packet.clone()].iter().filter(|walk| walk.seen.is_none()).map(|walk| &walk.stride)
    }

    /// Intersects the rays of a packet, in their step, with what is `near` the larger packet.
    fn meet(&mut self, packet: Range<usize>, near: &Candidates) {
        let count = self.count(&packet);
        if count <= 1 {
            return self.meet_each(packet, near, |_| true);
        }
        let near = Sheaf::around(self.strides(&packet)).near(self.world, self.scope, near);
        if near.static_leaves.as_ref().is_some_and(|leaves| leaves.is_empty()) && near.flying.is_empty() {
            self.meet_each(packet, &near, |stride| stride.crosses);
        } else if count <= FEW {
            self.meet_each(packet, &near, |_| true);
        } else {
            quarters(packet).for_each(|quarter| self.meet(quarter, &near));
        }
    }

    /// Tests one by one those rays of a packet whose step satisfies `asked`.
    fn meet_each(&mut self, packet: Range<usize>, near: &Candidates, asked: impl Fn(&Stride) -> bool) {
        for ray in packet {
            let Walk { axes, seen, looks, stride, .. } = &mut self.walks[ray];
            if seen.is_none() && asked(stride) {
                let segment = self.steps[stride.slot / LANES].lane(stride.slot % LANES);
                let step = Step { segment: &segment, axes: *axes, swept: stride.swept };
                let mut cross = |crossing| (self.cross)(ray, crossing);
                *seen = self.world.meet(step, near, self.scope, &mut cross, looks).map(Seen::Hit);
            }
        }
    }
}

/// Four parts of as equal length as possible, or fewer.
fn quarters(packet: Range<usize>) -> impl Iterator<Item = Range<usize>> {
    let length = packet.len().div_ceil(4).max(1);
    packet.clone().step_by(length).map(move |start| start..(start + length).min(packet.end))
}

impl Stride {
    fn new(step: &Segments, slot: usize, axes: [DVec3; 2], swept: f64) -> Stride {
        let lane = slot % LANES;
        let (bend, length) = (step.bend[lane], step.length[lane]);
        let along = step.along(lane);
        let ends = [along[0], along[PIECES]];
        let own = length / pieces(bend, length, ends[0].distance(ends[1]));
        let height = |position: DVec2| axes[0].z * position.x + axes[1].z * position.y;
        Stride {
            slot,
            swept,
            positions: along.map(|position| axes[0] * position.x + axes[1] * position.y),
            // From the sheaf's chords to the curve, from the curve to the chords of a ray alone, and from those to the limit of the boxes
            // grown for it.
            strays: growth(bend, length / PIECES as f64, ends) + 2.0 * growth(bend, own, ends),
            start: step.start[lane],
            length,
            // The plane goes through the hole, and a step turns round the hole by less than half a turn: it crosses the plane at most once.
            crosses: height(ends[0]) * height(ends[1]) <= 0.0,
        }
    }
}

/// All rays of a packet in one step: at the end of each piece a box that holds them.
struct Sheaf {
    low: [DVec3; PIECES + 1],
    high: [DVec3; PIECES + 1],
    strays: f64,
    /// The least and the greatest delay at the ends of the pieces, in r_s/c.
    times: [[f64; 2]; PIECES + 1],
}

impl Sheaf {
    fn around<'a>(strides: impl Iterator<Item = &'a Stride>) -> Sheaf {
        let mut sheaf = Sheaf {
            low: [DVec3::INFINITY; PIECES + 1],
            high: [DVec3::NEG_INFINITY; PIECES + 1],
            strays: 0.0,
            times: [[f64::INFINITY, f64::NEG_INFINITY]; PIECES + 1],
        };
        for stride in strides {
            for k in 0..=PIECES {
                sheaf.low[k] = sheaf.low[k].min(stride.positions[k]);
                sheaf.high[k] = sheaf.high[k].max(stride.positions[k]);
                let time = stride.start + stride.length * (k as f64 / PIECES as f64);
                sheaf.times[k] = [sheaf.times[k][0].min(time), sheaf.times[k][1].max(time)];
            }
            sheaf.strays = sheaf.strays.max(stride.strays);
        }
        sheaf
    }

    fn is_wide(&self) -> bool {
        let width = (0..=PIECES).map(|k| (self.high[k] - self.low[k]).max_element()).fold(0.0, f64::max);
        let length = (self.low[0] + self.high[0]).distance(self.low[PIECES] + self.high[PIECES]) / 2.0;
        width > WIDE * length
    }

    /// The chord in the middle of a piece, and how far along each axis the rays may be from it.
    fn chord(&self, piece: usize) -> Chord {
        let ends = [piece, piece + 1];
        let [from, to] = ends.map(|k| 0.5 * (self.low[k] + self.high[k]));
        let [a, b] = ends.map(|k| 0.5 * (self.high[k] - self.low[k]));
        // Rounding: a few ulp of the distance from the hole.
        let rounding = 4e-15 * (1.0 + from.length().max(to.length()));
        Chord::new(from, to, a.max(b) + self.strays + rounding)
    }

    /// The part of `outer` that the rays may meet.
    fn near(&self, world: &World, scope: &Scope, outer: &Candidates) -> Candidates {
        let chords: [Chord; PIECES] = std::array::from_fn(|piece| self.chord(piece));
        let tree = &world.static_bodies.tree;
        let static_leaves = match &outer.static_leaves {
            Some(leaves) => {
                let passes = |leaf: &&u32| chords.iter().any(|chord| tree.passes(**leaf, chord));
                Some(leaves.iter().filter(passes).copied().collect())
            }
            None => {
                let mut leaves = Vec::new();
                chords.iter().all(|chord| tree.gather(chord, MOST_LEAVES, &mut leaves)).then_some(leaves)
            }
        };
        let touched = |number: &&u32| {
            (0..PIECES).any(|k| {
                let [from, to] = [self.times[k][0], self.times[k + 1][1]];
                scope.allows(**number, from, to) && world.flying[**number as usize].sweep.touches(&chords[k], from, to)
            })
        };
        Candidates { static_leaves, flying: outer.flying.iter().filter(touched).copied().collect() }
    }
}
