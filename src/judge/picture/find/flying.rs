//! A piece of a ray against a flying body, in the body's rest frame.

use std::cell::OnceCell;

use glam::DVec3;

use super::piece::{Met, Piece};
use super::triangle::{passes_beside, weights};
use crate::judge::picture::roots::{Bend, roots};
use crate::judge::picture::world::sweep::{fastest, fastest_since, is_short};
use crate::judge::picture::world::worldline::{Pose, Worldline};
use crate::judge::picture::world::{Flying, World};
use crate::spacetime::matter::gamma;
use crate::spacetime::metric::river_speed;

/// A piece that may bend by more than this share of a body's reach, in the body's axes, is halved,
const BENT: f64 = 0.05;
/// unless body and light together move by less than this share of the reach meanwhile.
const SHORT: f64 = 1.0 / 128.0;
/// If light and body together move by less than this share of the bound on their speeds, tighter bounds are asked for.
const CREEPING: f64 = 0.25;

impl World<'_> {
    /// Halves the piece until body and light are sure to miss each other, or until they are close for a short time only.
    pub(super) fn meet_flying(&self, piece: &Piece, flying: &Flying, line: &dyn Worldline, met: &mut Option<Met>, looks: &mut u32) {
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
            let ends = [piece.from, piece.to].map(|elapsed| line.at(late - elapsed).to_body(piece.position(elapsed)));
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
        let late = |elapsed: f64| self.time - piece.segment.start - elapsed;
        let body = |elapsed: f64| line.at(late(elapsed)).to_body(piece.position(elapsed));
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
                let hit = weights(corners, normal, body(elapsed), rounding).filter(|_| line.exists_at(late(elapsed)));
                first = hit.map(|barycentrics| (elapsed, barycentrics));
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
