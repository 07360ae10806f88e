//! Aiming bolts by shooting: fly a bolt and the target ahead in the real spacetime, see by how much it misses, correct.

use glam::DVec3;

use super::rollout::{PlannedBurn, Point, advance};
use crate::sim::bolts::{HIT_RADIUS, LIFE, bolt_momentum, nearest};
use crate::spacetime::matter::ShipState;

/// Step of a trial, in r_s/c.
const STEP: f64 = 0.25;
/// Directions tried in the plane of shooter, hole and target.
const FAN: usize = 32;
/// Corrections of a direction before it is given up.
const CORRECTIONS: usize = 6;
/// Turn by which the change of the miss is measured, in radians.
const PROBE: f64 = 2e-3;
/// A correction turns by at most this, in radians: farther off, the miss is no guide.
const MOST_TURN: f64 = 0.15;
/// A shot is good that misses by less than this share of the hit radius: the rest is for what the pilot does not know.
const SHARE: f64 = 0.5;

/// Where to fire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aim {
    /// On rest-frame axes, a unit vector.
    pub direction: DVec3,
    /// By how much it may be off, in radians.
    pub tolerance: f64,
    /// T until the hit, in r_s/c.
    pub time: f64,
    /// The bolt goes round the hole the other way than the target is.
    pub round: bool,
}

/// A trial shot.
#[derive(Clone, Copy, Debug)]
struct Trial {
    /// From the bolt to the target where they are nearest, in r_s.
    miss: DVec3,
    /// How far the bolt has come by then, in r_s, and in which T.
    way: f64,
    time: f64,
    /// Whether it went round the hole the other way.
    round: bool,
}

/// What is fired at: where it is, and what it burns.
#[derive(Clone, Copy, Debug)]
pub struct Mark<'a> {
    /// The shooter.
    pub own: &'a ShipState,
    /// The target.
    pub target: Point,
    /// What it burns.
    pub burn: PlannedBurn,
}

/// The direction of the quickest hit; None where no shot is good. Round the hole, too.
pub fn lead(own: &ShipState, target: &Point, burn: &PlannedBurn) -> Option<Aim> {
    let mark = Mark { own, target: *target, burn: *burn };
    mark.hits().into_iter().min_by(|a, b| a.time.total_cmp(&b.time))
}

impl Mark<'_> {
    /// The directions that hit, one for each valley of the miss over the plane of shooter, hole and target.
    pub fn hits(&self) -> Vec<Aim> {
        let inward = -self.own.position.normalize();
        let straight = self.target.x - self.own.position;
        let side = straight.reject_from(inward).try_normalize().unwrap_or_else(|| inward.any_orthonormal_vector());
        let fan: Vec<_> = (0..FAN)
            .map(|k| {
                let angle = std::f64::consts::TAU * k as f64 / FAN as f64;
                let direction = inward * angle.cos() + side * angle.sin();
                (direction, self.shoot(direction).miss.length())
            })
            .collect();
        let valley = |k: &usize| {
            let [before, here, after] = [k + FAN - 1, *k, k + 1].map(|k| fan[k % FAN].1);
            here <= before && here < after
        };
        (0..FAN).filter(valley).filter_map(|k| self.refine(fan[k].0)).collect()
    }

    /// Corrects a direction until its shot is good: Newton's steps over the two angles by which it can turn.
    pub fn refine(&self, mut direction: DVec3) -> Option<Aim> {
        for _ in 0..CORRECTIONS {
            let trial = self.shoot(direction);
            if trial.miss.length() < SHARE * HIT_RADIUS {
                let tolerance = SHARE * HIT_RADIUS / trial.way.max(1.0);
                return Some(Aim { direction, tolerance, time: trial.time, round: trial.round });
            }
            let axes = [direction.any_orthonormal_vector(), direction.cross(direction.any_orthonormal_vector())];
            let [a, b] = axes.map(|axis| (self.shoot((direction + axis * PROBE).normalize()).miss - trial.miss) / PROBE);
            // Least squares of miss + a·x + b·y.
            let [aa, ab, bb] = [a.dot(a), a.dot(b), b.dot(b)];
            let [am, bm] = [a.dot(trial.miss), b.dot(trial.miss)];
            let determinant = aa * bb - ab * ab;
            if determinant <= 1e-12 * aa * bb {
                return None;
            }
            let turn = axes[0] * ((ab * bm - bb * am) / determinant) + axes[1] * ((ab * am - aa * bm) / determinant);
            direction = (direction + turn.clamp_length_max(MOST_TURN)).try_normalize()?;
        }
        None
    }

    fn shoot(&self, direction: DVec3) -> Trial {
        let mut bolt = Point { x: self.own.position, p: bolt_momentum(self.own.momentum, direction) };
        let mut target = self.target;
        let mut best = Trial { miss: target.x - bolt.x, way: STEP, time: 0.0, round: false };
        let (mut way, mut least) = (0.0, f64::INFINITY);
        let short = self.own.position.cross(self.target.x);
        for index in 0..(LIFE / STEP) as usize {
            let before = [bolt.x, target.x];
            bolt = advance(&bolt, STEP, 1.0, |_| DVec3::ZERO);
            target = advance(&target, STEP, 1.0, |at| self.burn.acceleration(at, index as f64 * STEP, STEP));
            let (from, to) = (before[1] - before[0], target.x - bolt.x);
            let distance = nearest(from, to);
            if distance < least {
                least = distance;
                let change = to - from;
                let share = (-from.dot(change) / change.length_squared().max(1e-30)).clamp(0.0, 1.0);
                best = Trial {
                    miss: from + change * share,
                    way: way + share * bolt.x.distance(before[0]),
                    time: (index as f64 + share) * STEP,
                    round: self.own.position.cross(direction).dot(short) < 0.0,
                };
            }
            way += bolt.x.distance(before[0]);
            if bolt.x.length_squared() < 1.0 {
                break;
            }
        }
        best
    }
}

/// The directions that hit, followed from frame to frame: each is corrected from where it was, and all are looked for anew now and then.
#[derive(Clone, Debug, Default)]
pub struct AimMarks {
    found: Vec<Aim>,
    /// Frames until they are looked for anew.
    wait: u32,
}

/// Frames between two searches: half a second of a fast display.
const SEARCH_EACH: u32 = 30;

impl AimMarks {
    /// The directions for a shooter and a target that coasts: the quickest straight one, and the quickest round the hole.
    pub fn follow(&mut self, own: &ShipState, target: Point) -> &[Aim] {
        let mark = Mark { own, target, burn: PlannedBurn::COAST };
        if self.wait == 0 {
            let mut hits = mark.hits();
            hits.sort_by(|a, b| a.time.total_cmp(&b.time));
            self.found = [false, true].into_iter().filter_map(|round| hits.iter().copied().find(|hit| hit.round == round)).collect();
            self.wait = SEARCH_EACH;
        } else {
            self.found = self.found.iter().filter_map(|aim| mark.refine(aim.direction)).collect();
            self.wait -= 1;
        }
        &self.found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spacetime::orbit::circular_orbit;

    /// Straight and round the hole, at what coasts on the other side of it: the ways that paper and pencil say there are.
    #[test]
    fn what_is_behind_the_hole_is_hit_on_both_ways() {
        for phase in [2.6, 3.0, 3.4] {
            let own = circular_orbit(8.0, 0.0).expect("a circle");
            let target = circular_orbit(8.0, phase).expect("a circle");
            let mark = Mark { own: &own, target: Point::from(&target), burn: PlannedBurn::COAST };
            let hits = mark.hits();
            println!("{phase}: {hits:?}");
            assert!(hits.iter().any(|hit| hit.round) && hits.iter().any(|hit| !hit.round), "{phase}: {hits:?}");
        }
    }
}
