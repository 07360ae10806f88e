//! What is seen in one direction. The ray is followed backwards in pieces. The chord of each piece is traced through the trees; at the
//! leaves the curve itself is intersected with triangles.
//!
//! A piece from s₀ to s₁ differs from its chord, at equal parameter, by at most |s₁ − s₀|² max|x''| / 8 (the sagitta). So the chord meets
//! every box that the curve meets, if boxes are grown by that much. Flying bodies are tested in their rest frame, where they stand still
//! and the curve moves.

use std::cell::OnceCell;
use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::disk::Crossing;
use super::roots::{Bend, roots};
use super::span::Scope;
use super::sweep::{fastest, fastest_since, is_short};
use super::tree::Chord;
use super::world::{Flying, World};
use super::worldline::{Motion, Pose, Worldline};
use crate::judge::geodesic::{Segment, State, root};
use crate::judge::ray::{End, Follower, Stop, orbit_plane, sky_radius, unwrap};
use crate::judge::trace::Hit;
use crate::spacetime::matter::gamma;
use crate::spacetime::metric::river_speed;

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

/// A piece of a ray between two delays, in the plane of its orbit, which is spanned by `axes`.
struct Piece<'a> {
    segment: &'a Segment,
    axes: [DVec3; 2],
    /// Elapsed time in the segment, from and to.
    from: f64,
    to: f64,
    /// A bound on |d²x/dτ²| in the segment, in 1/r_s.
    bend: f64,
}

impl Piece<'_> {
    fn place(&self, elapsed: f64) -> DVec3 {
        self.embed(self.segment.position(elapsed))
    }

    fn embed(&self, v: DVec2) -> DVec3 {
        self.axes[0] * v.x + self.axes[1] * v.y
    }
}

/// A piece's two ends in the plane of the orbit.
struct Ends {
    places: [DVec2; 2],
    /// dx/dτ, asked for by triangles alone.
    rates: OnceCell<[DVec2; 2]>,
}

impl Ends {
    fn rates(&self, piece: &Piece) -> [DVec2; 2] {
        *self.rates.get_or_init(|| [piece.from, piece.to].map(|elapsed| piece.segment.velocity(elapsed)))
    }
}

/// What a ray may meet in a step: candidates from a larger packet.
#[derive(Clone, Debug, Default)]
pub(super) struct Near {
    /// Leaves of the tree of bodies held in place; None where they are not known.
    pub held: Option<Vec<u32>>,
    /// Indices of flying bodies.
    pub flying: Vec<u32>,
}

impl Near {
    /// Everything.
    pub fn all(world: &World) -> Near {
        Near { held: None, flying: (0..world.flying.len() as u32).collect() }
    }
}

/// The nearest intersection so far.
#[derive(Clone, Copy)]
struct Met {
    elapsed: f64,
    thing: u32,
    triangle: u32,
    barycentrics: [f64; 3],
}

impl Met {
    /// Keeps the nearer one. Of two at the same point, on a shared edge, it keeps the one of lower number, so that the order in which they
    /// were found does not matter.
    fn offer(self, met: &mut Option<Met>) {
        let key = |met: &Met| (met.thing, met.triangle);
        if met.is_none_or(|other| self.elapsed < other.elapsed || self.elapsed == other.elapsed && key(&self) < key(&other)) {
            *met = Some(self);
        }
    }
}

/// A piece that may bend by more than this share of a body's reach, in the body's axes, is halved,
const BENT: f64 = 0.05;
/// unless body and light together move by less than this share of the reach meanwhile.
const SHORT: f64 = 1.0 / 128.0;
/// If light and body together move by less than this share of the bound on their speeds, tighter bounds are asked for.
const CREEPING: f64 = 0.25;

/// Most tests of flying bodies per ray. A ray that needs more is given up and counted. None is known that needs a tenth of it.
pub(super) const MOST_LOOKS: u32 = 1 << 16;

/// Barycentric weights down to minus this count as inside: rounding must not open a gap between neighbours.
const SLACK: f64 = 1e-11;

impl World<'_> {
    /// Follows the light seen from `position` (r_s) in direction `look` (rain frame) back to the first body that it meets. `tolerance` is
    /// the local error of a step.
    pub fn look(&self, position: DVec3, look: DVec3, tolerance: f64) -> Seen {
        self.look_through(position, look, tolerance, &mut |_| ())
    }

    /// The same; calls `cross` for every crossing of the plane z = 0 on the way, in order.
    pub fn look_through(&self, position: DVec3, look: DVec3, tolerance: f64, cross: &mut dyn FnMut(Crossing)) -> Seen {
        let (axes, in_plane) = orbit_plane(position, look);
        let near = Near::all(self);
        let scope = self.scope(position.length());
        let radius = scope.radius.max(sky_radius(position.length()));
        let mut looks = MOST_LOOKS;
        if !self.hole {
            let state = State { position: DVec2::new(position.length(), 0.0), momentum: -in_plane };
            let segment = Segment::straight(0.0, state, position.length() + radius);
            let direction = axes[0] * in_plane.x + axes[1] * in_plane.y;
            let swept = in_plane.y.atan2(in_plane.x);
            let hit = self.meet(&segment, axes, 0.0, &near, &scope, cross, &mut looks);
            self.count_given_up(looks == 0);
            return hit.map_or(Seen::Sky { direction, swept, energy: 1.0 }, Seen::Hit);
        }
        let stop = Stop { radius, horizon_gap: scope.gap, clings_until: scope.clings_until, ..Stop::default() };
        let mut follower = Follower::new(position.length(), in_plane, tolerance, stop);
        let mut swept = 0.0;
        while let Some(segment) = follower.step() {
            if let Some(hit) = self.meet(&segment, axes, swept, &near, &scope, cross, &mut looks) {
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

    /// The first intersection in one step of the ray with what is `near` it. `swept` is the angle swept when the step began. `looks` is how
    /// many tests of flying bodies are left.
    #[allow(clippy::too_many_arguments)]
    pub(super) fn meet(
        &self,
        segment: &Segment,
        axes: [DVec3; 2],
        swept: f64,
        near: &Near,
        scope: &Scope,
        cross: &mut dyn FnMut(Crossing),
        looks: &mut u32,
    ) -> Option<Hit> {
        let bend = segment.bend();
        let (mut start, last) = (segment.position(0.0), segment.position(segment.length));
        let pieces = pieces(bend, segment.length, start.distance(last));
        let step = segment.length / pieces;
        for k in 0..pieces as usize {
            let is_last = k + 1 == pieces as usize;
            let to = if is_last { segment.length } else { step * (k + 1) as f64 };
            let piece = Piece { segment, axes, from: step * k as f64, to, bend };
            let end = if is_last { last } else { segment.position(to) };
            let ends = Ends { places: [start, end], rates: OnceCell::new() };
            start = end;
            let grow = growth(bend, to - piece.from, ends.places);
            let mut met = None;
            self.meet_held(&piece, &ends, grow, near.held.as_deref(), &mut met);
            for &number in &near.flying {
                if !scope.allows(number, segment.start + piece.from, segment.start + to) {
                    continue;
                }
                let flying = &self.flying[number as usize];
                let [a, b] = ends.places.map(|place| piece.embed(place));
                let chord = Chord::new(a, b, DVec3::splat(grow));
                if let Motion::Flying(line) = self.things[flying.thing as usize].motion
                    && flying.sweep.touches(&chord, segment.start + piece.from, segment.start + to)
                {
                    self.meet_flying(&piece, flying, line, &mut met, looks);
                }
            }
            if let Some(crossing) = cross_plane(&piece, &ends, met.map(|met| met.elapsed)) {
                cross(crossing);
            }
            if let Some(met) = met {
                return Some(self.hit(&piece, &met, swept));
            }
        }
        None
    }

    fn hit(&self, piece: &Piece, met: &Met, swept: f64) -> Hit {
        let state = piece.segment.at(met.elapsed);
        let swept = unwrap(state.position.y.atan2(state.position.x), swept);
        let embed = |v: DVec2| piece.axes[0] * v.x + piece.axes[1] * v.y;
        Hit {
            object: met.thing as usize,
            triangle: met.triangle as usize,
            barycentrics: met.barycentrics,
            order: (swept / PI) as u32 + 1,
            swept,
            delay: piece.segment.start + met.elapsed,
            position: embed(state.position),
            momentum: embed(state.momentum),
        }
    }

    fn meet_held(&self, piece: &Piece, ends: &Ends, grow: f64, leaves: Option<&[u32]>, met: &mut Option<Met>) {
        let [from, to] = ends.places.map(|place| piece.embed(place));
        let span = piece.to - piece.from;
        let meet = |item: u32, until: f64| {
            let corners = self.held.triangles[item as usize].map(|i| self.held.vertices[i as usize]);
            let Some((elapsed, barycentrics)) = cross_held(piece, ends, corners) else { return until };
            let (thing, triangle) = self.held.owners[item as usize];
            Met { elapsed, thing, triangle, barycentrics }.offer(met);
            (elapsed - piece.from) / span
        };
        match leaves {
            Some(leaves) => self.held.tree.along_leaves(leaves, from, to, grow, meet),
            None => self.held.tree.along(from, to, grow, 1.0, meet),
        }
    }

    /// Halves the piece until body and light are sure to miss each other, or until they are close for a short time only.
    fn meet_flying(&self, piece: &Piece, flying: &Flying, line: &dyn Worldline, met: &mut Option<Met>, looks: &mut u32) {
        if *looks == 0 || met.is_some_and(|met| met.elapsed <= piece.from) {
            return;
        }
        *looks -= 1;
        let half = 0.5 * (piece.to - piece.from);
        let middle = piece.from + half;
        let light = piece.segment.at(middle).position;
        let pose = line.at(self.time - piece.segment.start - middle);
        let centre = pose.position;
        // Followed backwards, neither light nor body comes nearer to the hole than at the late end of the piece, or than r = 1.
        let speed = |r: f64, late: &dyn Fn() -> f64| if is_short(half, r) { fastest(r) } else { fastest_since(late()) };
        let light_speed = if self.hole { speed(light.length(), &|| piece.segment.position(piece.from).length()) } else { 1.0 };
        let body_speed = speed(centre.length(), &|| line.at(self.time - piece.segment.start - piece.from).position.length());
        let most = half * (light_speed + body_speed);
        let apart = piece.embed(light).distance(centre);
        // A length on the slice is at most that at rest.
        if apart > flying.reach + most {
            return;
        }
        let can_halve = half > 1e-9 * (1.0 + piece.segment.start);
        let late = self.time - piece.segment.start;
        let ask = || line.sway(late - piece.to, late - piece.from);
        // Next to the horizon light and body move far more slowly than those bounds: there the actual motion is asked for.
        let (mut straying, mut light_speed, mut sway) = (most, light_speed, None);
        if self.hole && can_halve && most > 0.5 * flying.reach {
            let light_rate = piece.segment.velocity(middle).length();
            if light_rate + drift(&pose) < CREEPING * (light_speed + body_speed) {
                sway = ask().filter(|sway| sway.velocity.is_finite());
            }
            if let Some(sway) = &sway {
                light_speed = light_speed.min(light_rate + half * piece.bend);
                straying = half * (light_speed + body_speed.min(sway.velocity));
                if apart > flying.reach + straying {
                    return;
                }
            }
        }
        let is_long = can_halve && straying > 0.5 * flying.reach;
        // Bounds on the motion are asked for late: most pieces are long, and are halved or dropped without them.
        let bend = (!is_long).then(|| sway.or_else(ask)).flatten().map(|sway| sway.bend(apart + straying, light_speed, piece.bend));
        let sagitta = bend.map_or(0.0, |bend| bend.sagitta(2.0 * half));
        let bends = sagitta > BENT * flying.reach && most > SHORT * flying.reach;
        if bends && can_halve {
            // The bend grows with γ. So does, in the body's axes, the distance of light that passes beside it.
            let ends = [piece.from, piece.to].map(|elapsed| line.at(late - elapsed).to_body(piece.place(elapsed)));
            let rounding = self.rounding(piece, middle) * gamma(pose.momentum) + 1e-9 * flying.reach;
            if from_origin(ends) > flying.reach + sagitta + rounding {
                return;
            }
        }
        if is_long || bends && can_halve {
            let first = Piece { to: middle, ..*piece };
            self.meet_flying(&first, flying, line, met, looks);
            if met.is_none_or(|met| met.elapsed > middle) {
                self.meet_flying(&Piece { from: middle, ..*piece }, flying, line, met, looks);
            }
            return;
        }
        self.cross_flying(piece, flying, line, bend, met);
    }

    /// How exactly a point on a piece is known in the axes of a body, in r_s: to a few ulp of its distance from the hole and of the times.
    fn rounding(&self, piece: &Piece, elapsed: f64) -> f64 {
        let delay = piece.segment.start + elapsed;
        8.0 * f64::EPSILON * (1.0 + piece.segment.position(elapsed).length() + self.time.abs() + delay)
    }

    /// Intersects the piece, in the body's rest frame, with the body's tree. `bend` bounds how much it bends there, if that is known.
    fn cross_flying(&self, piece: &Piece, flying: &Flying, line: &dyn Worldline, bend: Option<Bend>, met: &mut Option<Met>) {
        let body = |elapsed: f64| line.at(self.time - piece.segment.start - elapsed).to_body(piece.place(elapsed));
        let span = piece.to - piece.from;
        let at = |k: usize| piece.from + span * k as f64 / 4.0;
        let ends = [body(at(0)), body(at(4))];
        let quarters = OnceCell::new();
        let points = || {
            let [a, b, c] = *quarters.get_or_init(|| [1, 2, 3].map(|k| body(at(k))));
            [ends[0], a, b, c, ends[1]]
        };
        let bend = bend.filter(|bend| bend.sagitta(span) <= flying.reach).unwrap_or_else(|| {
            // Not known: measured at a quarter, a half and three quarters, and doubled.
            let points = points();
            let off = [1, 2, 3].map(|k| points[k].distance(points[0].lerp(points[4], k as f64 / 4.0)));
            Bend { curve: 16.0 * off.into_iter().fold(0.0, f64::max) / (span * span), kink: 0.0 }
        });
        let rounding = self.rounding(piece, piece.from);
        let least = 1e-9 * flying.reach + rounding;
        let grow = bend.sagitta(span) + least;
        let model = &self.models[self.things[flying.thing as usize].model];
        flying.tree.along(ends[0], ends[1], grow, 1.0, |item, until| {
            let corners = model.triangles[item as usize].map(|i| flying.vertices[i as usize]);
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            if passes_beside(corners, normal, ends, grow) {
                return until;
            }
            let height = |y: DVec3| normal.dot(y - corners[0]);
            let heights = points().map(height);
            let size = normal.length();
            let rising = bend.times(size);
            let mut first = None;
            let mut visit = |elapsed: f64| {
                if met.is_some_and(|met| met.elapsed < elapsed) {
                    return true;
                }
                first = weights(corners, normal, body(elapsed), rounding).map(|barycentrics| (elapsed, barycentrics));
                first.is_some()
            };
            // Only the first crossing of this triangle counts.
            (0..4)
                .any(|k| roots(&|s| height(body(s)), (at(k), heights[k]), (at(k + 1), heights[k + 1]), &rising, least * size, &mut visit));
            let Some((elapsed, barycentrics)) = first else { return until };
            Met { elapsed, thing: flying.thing, triangle: item, barycentrics }.offer(met);
            // The tree's own bound stays loose by the sagitta.
            ((elapsed - piece.from) / span).min(until)
        });
    }
}

/// |dx/dT| of a body, in c.
fn drift(pose: &Pose) -> f64 {
    let r = pose.position.length();
    (pose.momentum / gamma(pose.momentum) - pose.position * (river_speed(r) / r)).length()
}

/// Least distance of the line from `from` to `to` from the origin.
fn from_origin([from, to]: [DVec3; 2]) -> f64 {
    let chord = to - from;
    let part = (-from.dot(chord) / chord.length_squared()).clamp(0.0, 1.0);
    if part.is_nan() { from.length() } else { (from + chord * part).length() }
}

/// What is seen by a ray that has met nothing.
pub(super) fn beyond(follower: &Follower, axes: [DVec3; 2]) -> Seen {
    match follower.sky_swept() {
        Some(swept) if follower.end == Some(End::Escaped) => {
            let direction = axes[0] * swept.cos() + axes[1] * swept.sin();
            Seen::Sky { direction, swept, energy: follower.energy() }
        }
        _ => Seen::Captured,
    }
}

/// Number of pieces into which a step of this bend, length and chord is cut, so that the sagitta of each is at most a fiftieth of its
/// chord. Then boxes hardly grow, and pieces are few.
pub(super) fn pieces(bend: f64, length: f64, chord: f64) -> f64 {
    let sagitta = bend * length * length / 8.0;
    (50.0 * sagitta / chord.max(1e-300)).ceil().clamp(1.0, 64.0)
}

/// How far a piece of the delay `span` is from the chord between its ends at most, with rounding: a few ulp of the distance from the hole.
pub(super) fn growth(bend: f64, span: f64, ends: [DVec2; 2]) -> f64 {
    bend * span * span / 8.0 + 1e-15 * (1.0 + ends[0].length().max(ends[1].length()))
}

/// Where a piece crosses z = 0, before it has met something at the elapsed time `met`. The plane goes through the hole, and a segment turns
/// round the hole by less than half a turn, so it crosses at most once. If a piece starts on the plane, the one before has reported it.
fn cross_plane(piece: &Piece, ends: &Ends, met: Option<f64>) -> Option<Crossing> {
    let a = DVec2::new(piece.axes[0].z, piece.axes[1].z);
    let end = met.unwrap_or(piece.to);
    let h0 = a.dot(ends.places[0]);
    let h1 = a.dot(met.map_or(ends.places[1], |elapsed| piece.segment.position(elapsed)));
    if h0 == 0.0 || h0 * h1 > 0.0 {
        return None;
    }
    let elapsed = piece.segment.cross_line(a, 0.0, piece.from, end);
    let state = piece.segment.at(elapsed);
    let embed = |v: DVec2| piece.axes[0] * v.x + piece.axes[1] * v.y;
    let position = embed(state.position);
    Some(Crossing {
        position: DVec3::new(position.x, position.y, 0.0),
        momentum: embed(state.momentum),
        delay: piece.segment.start + elapsed,
    })
}

/// The first crossing of a piece with a triangle that does not move.
///
/// The triangle's plane cuts the plane of the orbit in a line a·x = c. The path of light is strictly convex (u'' + u = (3/2)u² > 0) and
/// turns by less than half a turn in a segment, so it crosses a line at most twice, once on each side of where it runs parallel to it.
fn cross_held(piece: &Piece, ends: &Ends, corners: [DVec3; 3]) -> Option<(f64, [f64; 3])> {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let a = DVec2::new(normal.dot(piece.axes[0]), normal.dot(piece.axes[1]));
    let c = normal.dot(corners[0]);
    let segment = piece.segment;
    let height = |s: f64| a.dot(segment.position(s)) - c;
    let (from, to) = (piece.from, piece.to);
    let [h0, h1] = ends.places.map(|place| a.dot(place) - c);
    let rounding = 8.0 * f64::EPSILON * ends.places[0].length().max(ends.places[1].length());
    let try_at = |elapsed: f64| weights(corners, normal, piece.place(elapsed), rounding).map(|weights| (elapsed, weights));
    if a == DVec2::ZERO || h0 == 0.0 && h1 == 0.0 && height(0.5 * (from + to)) == 0.0 {
        // The ray is in the plane of the triangle, which it sees edge on.
        return None;
    }
    if h0 * h1 < 0.0 {
        return try_at(segment.cross_line(a, c, from, to));
    }
    let at_start = || (h0 == 0.0).then(|| try_at(from)).flatten();
    let at_end = || (h1 == 0.0).then(|| try_at(to)).flatten();
    // Both ends are on one side, or on the line. In between the ray crosses the line only if it first approaches and then recedes.
    let [rate0, rate1] = ends.rates(piece).map(|rate| a.dot(rate));
    if rate0 * rate1 >= 0.0 || h0 * rate0 > 0.0 || h1 * rate1 < 0.0 {
        return at_start().or_else(at_end);
    }
    let middle = root(from, to, |s| (a.dot(segment.velocity(s)), a.dot(segment.acceleration(s))));
    let turned = height(middle);
    let between = |across: bool, from: f64, to: f64| across.then(|| try_at(segment.cross_line(a, c, from, to))).flatten();
    at_start()
        .or_else(|| between(h0 * turned < 0.0 || h0 != 0.0 && turned == 0.0, from, middle))
        .or_else(|| between(turned * h1 < 0.0, middle, to))
        .or_else(at_end)
}

/// Whether a curve within `grow` (r_s) of the chord between two points is sure to miss a triangle.
///
/// Where the curve is in the triangle's plane, its chord is within `grow` of the plane. So that point of the chord is within `grow` times
/// the chord's length over its rise of where the chord crosses the plane, and the curve within `grow` more. A barycentric weight changes
/// per length by at most the longest edge over twice the area.
fn passes_beside(corners: [DVec3; 3], normal: DVec3, [from, to]: [DVec3; 2], grow: f64) -> bool {
    let chord = to - from;
    let rise = normal.dot(chord);
    let through = from + chord * (normal.dot(corners[0] - from) / rise);
    let area = normal.length_squared();
    let edges = [corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]];
    let longest = edges.map(DVec3::length_squared).into_iter().fold(0.0, f64::max);
    let away = grow * (1.0 + chord.length() * area.sqrt() / rise.abs());
    let slack = SLACK + away * (longest / area).sqrt();
    // NaN if the chord is parallel to the plane: then nothing is sure.
    (0..3).any(|k| edges[k].cross(through - corners[k]).dot(normal) < -slack * area)
}

/// Barycentric weights of a point of the triangle's plane that is known to `rounding` (r_s), or None outside.
fn weights(corners: [DVec3; 3], normal: DVec3, point: DVec3, rounding: f64) -> Option<[f64; 3]> {
    let area = normal.length_squared();
    let [a, b, c] = corners.map(|v| v - point);
    let weights = [b.cross(c), c.cross(a), a.cross(b)].map(|part| part.dot(normal) / area);
    // Rounding weighs the more the lower the triangle is: its least height is twice the area over the longest edge.
    if weights.iter().any(|&w| w < -SLACK) {
        let longest = (corners[1] - corners[0]).length().max((corners[2] - corners[1]).length()).max((corners[0] - corners[2]).length());
        let slack = rounding * longest / area.sqrt();
        return weights.iter().all(|&w| w >= -slack).then_some(weights);
    }
    Some(weights)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_that_meets_a_triangle_does_not_pass_beside_it() {
        let corners = [DVec3::new(-0.3, -0.2, 0.0), DVec3::new(0.4, -0.1, 0.1), DVec3::new(0.0, 0.5, -0.1)];
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        // Evenly spread numbers.
        let spread = |i: u32, k: i32| (f64::from(i) * 0.8566748838545029f64.powi(k)).fract() - 0.5;
        let (mut met, mut let_go) = (0, 0);
        for i in 1..20_000 {
            let [from, way, off] = [1, 4, 7].map(|k| DVec3::new(spread(i, k), spread(i, k + 1), spread(i, k + 2)));
            let grow = 0.2 * f64::from(i % 11) / 11.0;
            let curve = |t: f64| from + way * (2.0 * t) + off.normalize() * (grow * 4.0 * t * (1.0 - t));
            let ends = [curve(0.0), curve(1.0)];
            let height = |t: f64| normal.dot(curve(t) - corners[0]);
            let hit = (0..64).any(|k| {
                let [a, b] = [f64::from(k) / 64.0, f64::from(k + 1) / 64.0];
                let least = &Bend { curve: 0.0, kink: 0.0 };
                roots(&height, (a, height(a)), (b, height(b)), least, 0.0, &mut |t| weights(corners, normal, curve(t), 1e-15).is_some())
            });
            let beside = passes_beside(corners, normal, ends, grow);
            assert!(!hit || !beside, "{i}");
            met += u32::from(hit);
            let_go += u32::from(beside);
        }
        assert!(met > 1000 && let_go > 5000, "{met} {let_go}");
    }
}
