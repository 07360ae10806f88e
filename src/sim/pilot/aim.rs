//! Aiming bolts by shooting: fly a bolt and the target ahead in the real spacetime, see by how much it misses, correct.

use glam::DVec3;

use super::rollout::{PlannedBurn, Point, Span, coast, track};
use crate::sim::bolts::{HIT_RADIUS, LIFE, bolt_momentum, fired_by, nearest};
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

/// What is fired at.
#[derive(Clone, Debug)]
pub struct Mark<'a> {
    /// The shooter.
    own: &'a ShipState,
    /// The target's way for as long as a bolt lives, a place each [`STEP`].
    way: Vec<Point>,
}

/// The direction of the quickest hit; None where no shot is good. Round the hole, too.
pub fn lead(own: &ShipState, target: &Point, burn: &PlannedBurn) -> Option<Aim> {
    Mark::new(own, target, burn).hits().into_iter().min_by(|a, b| a.time.total_cmp(&b.time))
}

impl Mark<'_> {
    /// A target that is now at `target` and burns so, for a shooter.
    pub fn new<'a>(own: &'a ShipState, target: &Point, burn: &PlannedBurn) -> Mark<'a> {
        Mark { own, way: track(*target, burn, Span { step: STEP, count: (LIFE / STEP) as usize }, 1.0) }
    }

    /// The directions that hit, one for each valley of the miss over the plane of shooter, hole and target.
    pub fn hits(&self) -> Vec<Aim> {
        let fan: Vec<_> = (0..FAN).map(|k| self.tried(k)).collect();
        valleys(&fan).into_iter().filter_map(|direction| self.refine(direction)).collect()
    }

    /// A direction of the fan, and by how much its shot misses, in r_s.
    fn tried(&self, k: usize) -> (DVec3, f64) {
        let inward = -self.own.position.normalize();
        let straight = self.way[0].x - self.own.position;
        let side = straight.reject_from(inward).try_normalize().unwrap_or_else(|| inward.any_orthonormal_vector());
        let angle = std::f64::consts::TAU * k as f64 / FAN as f64;
        let direction = inward * libm::cos(angle) + side * libm::sin(angle);
        (direction, self.shoot(direction).miss.length())
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
        let mut best = Trial { miss: self.way[0].x - bolt.x, way: STEP, time: 0.0, round: false };
        let (mut way, mut least) = (0.0, f64::INFINITY);
        let short = self.own.position.cross(self.way[0].x);
        for (index, pair) in self.way.windows(2).enumerate() {
            let before = bolt.x;
            bolt = coast(&bolt, STEP);
            let (from, to) = (pair[0].x - before, pair[1].x - bolt.x);
            let distance = nearest(from, to);
            if distance < least {
                least = distance;
                let change = to - from;
                let share = (-from.dot(change) / change.length_squared().max(1e-30)).clamp(0.0, 1.0);
                best = Trial {
                    miss: from + change * share,
                    way: way + share * bolt.x.distance(before),
                    time: (index as f64 + share) * STEP,
                    round: self.own.position.cross(direction).dot(short) < 0.0,
                };
            }
            way += bolt.x.distance(before);
            if bolt.x.length_squared() < 1.0 {
                break;
            }
        }
        best
    }
}

/// How near a bolt fired now comes to a target that coasts, in r_s.
pub fn shot_passes(own: &ShipState, target: &Point) -> f64 {
    /// T of a piece, in r_s/c; between its ends both fly straight.
    const STEP: f64 = 0.5;
    let mut bolt = Point::from(&fired_by(own));
    let mut other = *target;
    let mut passes = f64::INFINITY;
    for _ in 0..(LIFE / STEP) as usize {
        let before = bolt.x - other.x;
        bolt = coast(&bolt, STEP);
        other = coast(&other, STEP);
        passes = passes.min(nearest(before, bolt.x - other.x));
    }
    passes
}

/// Where the miss of a whole fan is least among its neighbours.
fn valleys(fan: &[(DVec3, f64)]) -> Vec<DVec3> {
    let miss = |k: usize| fan[k % fan.len()].1;
    let is_valley = |k: &usize| miss(*k) <= miss(k + fan.len() - 1) && miss(*k) < miss(k + 1);
    (0..fan.len()).filter(is_valley).map(|k| fan[k].0).collect()
}

/// The directions that hit, followed from frame to frame: each is corrected from where it was, and all are looked for anew all the time, a
/// little in each frame.
#[derive(Clone, Debug, Default)]
pub struct AimMarks {
    found: Vec<Aim>,
    /// What of the fan has been tried.
    fan: Vec<(DVec3, f64)>,
    /// Valleys of it that are still to be corrected, and those that became hits.
    valleys: Vec<DVec3>,
    hits: Vec<Aim>,
    /// Whether there was a first search, which is made at once.
    begun: bool,
}

impl AimMarks {
    /// The directions for a shooter and a target that coasts: the quickest straight one, and the quickest round the hole.
    pub fn follow(&mut self, own: &ShipState, target: Point) -> &[Aim] {
        let mark = Mark::new(own, &target, &PlannedBurn::COAST);
        if !std::mem::replace(&mut self.begun, true) {
            self.found = quickest(mark.hits());
            return &self.found;
        }
        self.found = self.found.iter().filter_map(|aim| mark.refine(aim.direction)).collect();
        if let Some(direction) = self.valleys.pop() {
            self.hits.extend(mark.refine(direction));
            if self.valleys.is_empty() {
                // What was followed may lie between two directions of the fan.
                self.hits.extend(&self.found);
                self.found = quickest(std::mem::take(&mut self.hits));
            }
        } else {
            self.fan.push(mark.tried(self.fan.len()));
            if self.fan.len() == FAN {
                self.valleys = valleys(&std::mem::take(&mut self.fan));
            }
        }
        &self.found
    }
}

/// The quickest straight one, and the quickest round the hole.
fn quickest(mut hits: Vec<Aim>) -> Vec<Aim> {
    hits.sort_by(|a, b| a.time.total_cmp(&b.time));
    [false, true].into_iter().filter_map(|round| hits.iter().copied().find(|hit| hit.round == round)).collect()
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
            let target = Point::from(&target);
            let hits = Mark::new(&own, &target, &PlannedBurn::COAST).hits();
            println!("{phase}: {hits:?}");
            assert!(hits.iter().any(|hit| hit.round) && hits.iter().any(|hit| !hit.round), "{phase}: {hits:?}");
            // Looked for a little at a time, they are the same.
            let mut marks = AimMarks::default();
            for _ in 0..FAN {
                assert_eq!(marks.follow(&own, target).len(), 2);
            }
            let times = |hits: &[Aim]| hits.iter().map(|hit| hit.time).fold(f64::INFINITY, f64::min);
            assert!((times(marks.follow(&own, target)) - times(&hits)).abs() < 0.1, "{phase}");
        }
    }
}
