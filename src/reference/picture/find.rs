//! What one look direction shows: the ray followed backwards in pieces, each held against the trees, the curve itself met at the leaves.
//!
//! A piece from s₀ to s₁ differs from its chord, at equal parameter, by at most |s₁ − s₀|² max|x''| / 8 (the sagitta): so a box that the curve
//! meets, grown by that much, is met by the chord. Flying bodies are asked in their rest frame, where they stand still and the curve moves.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::disk::Crossing;
use super::world::{Flying, Motion, World, Worldline};
use crate::reference::geodesic::{Segment, State, root};
use crate::reference::ray::{End, Follower, Stop, orbit_plane, sky_radius, unwrap};
use crate::reference::trace::Hit;

/// What is seen in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Seen {
    /// The shadow.
    Captured,
    /// The sky.
    Sky {
        /// Unit vector from the hole to the place on the sky.
        direction: DVec3,
        /// The angle Φ∞ swept.
        swept: f64,
        /// The energy of the light, in units of the frequency that a rain observer at the camera sees.
        energy: f64,
    },
    /// A surface; `Hit::object` is the index of the thing.
    Hit(Hit),
}

/// The plane of a ray's orbit and the light in it.
struct Piece<'a> {
    segment: &'a Segment,
    axes: [DVec3; 2],
    /// Elapsed time in the segment, from and to.
    from: f64,
    to: f64,
}

impl Piece<'_> {
    fn place(&self, elapsed: f64) -> DVec3 {
        let v = self.segment.position(elapsed);
        self.axes[0] * v.x + self.axes[1] * v.y
    }
}

/// The nearest meeting up to now.
#[derive(Clone, Copy)]
struct Met {
    elapsed: f64,
    thing: u32,
    triangle: u32,
    barycentrics: [f64; 3],
}

/// Weights this far below 0 still count as inside: rounding of the crossing must not open a gap between neighbours.
const SLACK: f64 = 1e-11;

impl World<'_> {
    /// Follows the light seen from `position` (r_s) in direction `look` (rain frame) back to the first thing that it meets, with a local error
    /// of `tolerance` in each step.
    pub fn look(&self, position: DVec3, look: DVec3, tolerance: f64) -> Seen {
        self.look_through(position, look, tolerance, &mut |_| ())
    }

    /// The same, telling on the way of every crossing of the plane z = 0, in order.
    pub fn look_through(&self, position: DVec3, look: DVec3, tolerance: f64, cross: &mut dyn FnMut(Crossing)) -> Seen {
        let (axes, in_plane) = orbit_plane(position, look);
        let radius = self.held.radius.max(sky_radius(position.length())).max(self.flying_radius());
        if !self.hole {
            let state = State { position: DVec2::new(position.length(), 0.0), momentum: -in_plane };
            let segment = Segment::straight(0.0, state, position.length() + radius);
            let direction = axes[0] * in_plane.x + axes[1] * in_plane.y;
            let swept = in_plane.y.atan2(in_plane.x);
            return match self.meet(&segment, axes, 0.0, cross) {
                Some(hit) => Seen::Hit(hit),
                None => Seen::Sky { direction, swept, energy: 1.0 },
            };
        }
        let mut follower = Follower::new(position.length(), in_plane, tolerance, Stop { radius, ..Stop::default() });
        let mut swept = 0.0;
        while let Some(segment) = follower.step() {
            if let Some(hit) = self.meet(&segment, axes, swept, cross) {
                return Seen::Hit(hit);
            }
            swept = follower.swept;
        }
        match follower.sky_swept() {
            Some(swept) if follower.end == Some(End::Escaped) => {
                let direction = axes[0] * swept.cos() + axes[1] * swept.sin();
                Seen::Sky { direction, swept, energy: follower.energy() }
            }
            _ => Seen::Captured,
        }
    }

    /// Beyond this radius nothing flies at any time that matters.
    fn flying_radius(&self) -> f64 {
        self.flying
            .iter()
            .map(|flying| match self.things[flying.thing as usize].motion {
                Motion::Flying(line) => 2.0 * line.at(self.time).position.length() + flying.reach,
                Motion::Held { .. } => 0.0,
            })
            .fold(0.0, f64::max)
    }

    /// The first meeting in one step of the ray, which had swept `swept` when it began.
    fn meet(&self, segment: &Segment, axes: [DVec3; 2], swept: f64, cross: &mut dyn FnMut(Crossing)) -> Option<Hit> {
        let bend = segment.bend();
        let whole = Piece { segment, axes, from: 0.0, to: segment.length };
        let chord = whole.place(0.0).distance(whole.place(segment.length));
        // Pieces whose sagitta is a fiftieth of their chord: boxes hardly grow, and there are few of them.
        let sagitta = bend * segment.length * segment.length / 8.0;
        let pieces = (50.0 * sagitta / chord.max(1e-300)).ceil().clamp(1.0, 64.0);
        let step = segment.length / pieces;
        for k in 0..pieces as usize {
            let to = if k + 1 == pieces as usize { segment.length } else { step * (k + 1) as f64 };
            let piece = Piece { segment, axes, from: step * k as f64, to };
            let mut met = None;
            self.meet_held(&piece, bend, &mut met);
            for flying in &self.flying {
                if let Motion::Flying(line) = self.things[flying.thing as usize].motion {
                    self.meet_flying(&piece, flying, line, &mut met);
                }
            }
            if let Some(crossing) = cross_plane(&piece, met.map_or(piece.to, |met| met.elapsed)) {
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

    fn meet_held(&self, piece: &Piece, bend: f64, met: &mut Option<Met>) {
        let (from, to) = (piece.place(piece.from), piece.place(piece.to));
        let span = piece.to - piece.from;
        // Rounding of positions: a few ulp of the distance from the hole.
        let grow = bend * span * span / 8.0 + 1e-15 * (1.0 + from.length().max(to.length()));
        self.held.tree.along(from, to, grow, 1.0, |item, until| {
            let end = (piece.from + until * span).min(piece.to);
            let corners = self.held.triangles[item as usize].map(|i| self.held.vertices[i as usize]);
            if let Some((elapsed, barycentrics)) = cross_held(piece, corners, end)
                && met.is_none_or(|met| elapsed < met.elapsed)
            {
                let (thing, triangle) = self.held.owners[item as usize];
                *met = Some(Met { elapsed, thing, triangle, barycentrics });
                return (elapsed - piece.from) / span;
            }
            until
        });
    }

    /// Nearer and nearer halves of the piece, until body and light are sure to miss each other or are close for a moment only.
    fn meet_flying(&self, piece: &Piece, flying: &Flying, line: &dyn Worldline, met: &mut Option<Met>) {
        if met.is_some_and(|met| met.elapsed <= piece.from) {
            return;
        }
        let half = 0.5 * (piece.to - piece.from);
        let middle = piece.from + half;
        let light = piece.segment.at(middle).position;
        let centre = line.at(self.time - piece.segment.start - middle).position;
        // Nothing outruns light: |dx/dT| ≤ 1 + β, of which 1 + 1.6/√r is a bound while r stays above 0.4 of itself, as it does for this long.
        let fastest = |r: f64| 1.0 + 1.6 / r.sqrt();
        let (r_light, r_body) = (light.length(), centre.length());
        let straying = half * (fastest(r_light) + fastest(r_body));
        let short = half * fastest(r_light) <= 0.25 * r_light && half * fastest(r_body) <= 0.25 * r_body;
        let apart = (piece.axes[0] * light.x + piece.axes[1] * light.y).distance(centre);
        // A length is never longer on the slice than at rest.
        if (short || !self.hole && straying < apart) && apart > flying.reach + straying {
            return;
        }
        if (!short || straying > 0.5 * flying.reach) && half > 1e-9 * (1.0 + piece.segment.start) {
            let first = Piece { to: middle, ..*piece };
            self.meet_flying(&first, flying, line, met);
            if met.is_none_or(|met| met.elapsed > middle) {
                self.meet_flying(&Piece { from: middle, ..*piece }, flying, line, met);
            }
            return;
        }
        self.cross_flying(piece, flying, line, met);
    }

    /// The piece in the body's rest frame, against its tree.
    fn cross_flying(&self, piece: &Piece, flying: &Flying, line: &dyn Worldline, met: &mut Option<Met>) {
        let body = |elapsed: f64| line.at(self.time - piece.segment.start - elapsed).to_body(piece.place(elapsed));
        let span = piece.to - piece.from;
        let at = |k: usize| piece.from + span * k as f64 / 4.0;
        let points = [0, 1, 2, 3, 4].map(|k| body(at(k)));
        // The sagitta, measured at a quarter, a half and three quarters, and doubled: the body's history has no closed form to bound it by.
        let off = [1, 2, 3].map(|k| points[k].distance(points[0].lerp(points[4], k as f64 / 4.0)));
        let grow = 2.0 * off.into_iter().fold(0.0, f64::max) + 1e-9 * flying.reach;
        let model = &self.models[self.things[flying.thing as usize].model];
        flying.tree.along(points[0], points[4], grow, 1.0, |item, until| {
            let corners = model.triangles[item as usize].map(|i| flying.vertices[i as usize]);
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let height = |y: DVec3| normal.dot(y - corners[0]);
            let heights = points.map(height);
            for k in 0..4 {
                if heights[k] * heights[k + 1] > 0.0 || heights[k] == 0.0 && heights[k + 1] == 0.0 {
                    continue;
                }
                let elapsed = falsi((at(k), heights[k]), (at(k + 1), heights[k + 1]), |s| height(body(s)));
                if met.is_some_and(|met| met.elapsed <= elapsed) {
                    break;
                }
                if let Some(barycentrics) = weights(corners, normal, body(elapsed)) {
                    *met = Some(Met { elapsed, thing: flying.thing, triangle: item, barycentrics });
                    // A later crossing of this triangle is of no interest. The tree's own bound stays loose by the sagitta.
                    return ((elapsed - piece.from) / span).min(until);
                }
            }
            until
        });
    }
}

/// Where a piece goes through z = 0 before the elapsed time `end`. The plane goes through the hole, round which a segment turns by less than
/// half a turn, so it does so at most once. A piece that starts on the plane has been told of by the one before.
fn cross_plane(piece: &Piece, end: f64) -> Option<Crossing> {
    let a = DVec2::new(piece.axes[0].z, piece.axes[1].z);
    let height = |s: f64| a.dot(piece.segment.position(s));
    let (h0, h1) = (height(piece.from), height(end));
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

/// The first crossing of a piece with a triangle that does not move, up to the elapsed time `end`.
///
/// The triangle's plane cuts the plane of the orbit in a line a·x = c. The path of light is strictly convex (u'' + u = (3/2)u² > 0) and turns
/// by less than half a turn in a segment, so it crosses a line at most twice, once on each side of where it runs parallel to it.
fn cross_held(piece: &Piece, corners: [DVec3; 3], end: f64) -> Option<(f64, [f64; 3])> {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let a = DVec2::new(normal.dot(piece.axes[0]), normal.dot(piece.axes[1]));
    let c = normal.dot(corners[0]);
    let segment = piece.segment;
    let height = |s: f64| a.dot(segment.position(s)) - c;
    let rate = |s: f64| a.dot(segment.velocity(s));
    let (from, to) = (piece.from, end);
    let (h0, h1) = (height(from), height(to));
    let try_at = |elapsed: f64| weights(corners, normal, piece.place(elapsed)).map(|weights| (elapsed, weights));
    if h0 == 0.0 && h1 == 0.0 {
        // The ray runs in the plane of the triangle: it sees no surface.
        return None;
    }
    if h0 * h1 <= 0.0 {
        return try_at(segment.cross_line(a, c, from, to));
    }
    // Both ends on one side: only a piece that first nears the line and then leaves it can touch it in between.
    if h0 * rate(from) >= 0.0 || h1 * rate(to) <= 0.0 {
        return None;
    }
    let middle = root(from, to, |s| (rate(s), a.dot(segment.acceleration(s))));
    if h0 * height(middle) > 0.0 {
        return None;
    }
    try_at(segment.cross_line(a, c, from, middle)).or_else(|| try_at(segment.cross_line(a, c, middle, to)))
}

/// The weights of the corners at a point of the triangle's plane, or None outside.
fn weights(corners: [DVec3; 3], normal: DVec3, point: DVec3) -> Option<[f64; 3]> {
    let area = normal.length_squared();
    let [a, b, c] = corners.map(|v| v - point);
    let weights = [b.cross(c), c.cross(a), a.cross(b)].map(|part| part.dot(normal) / area);
    // Rounding of the point, a few ulp of its distance from the hole, weighs the more the smaller the triangle is.
    let slack = SLACK.max(8.0 * f64::EPSILON * point.length() / area.sqrt().sqrt());
    weights.iter().all(|&w| w >= -slack).then_some(weights)
}

/// A root of f between two points with values of opposite signs: regula falsi with the weight of the end that stays halved (Illinois).
fn falsi((mut a, mut fa): (f64, f64), (mut b, mut fb): (f64, f64), f: impl Fn(f64) -> f64) -> f64 {
    if fa == 0.0 {
        return a;
    }
    let scale = fa.abs().max(fb.abs());
    // About seven evaluations reach rounding; sixty are enough for any f.
    for _ in 0..60 {
        if fb == 0.0 || (b - a).abs() <= 2.0 * f64::EPSILON * b.abs() || fb.abs() <= 1e-15 * scale {
            break;
        }
        let c = (b * fa - a * fb) / (fa - fb);
        let fc = f(c);
        if fc * fb < 0.0 {
            (a, fa) = (b, fb);
        } else {
            fa *= 0.5;
        }
        (b, fb) = (c, fc);
    }
    b
}
