//! Aiming bolts by shooting: fly a bolt and the target ahead in the real spacetime, see by how much it misses, correct.

use glam::DVec3;

use super::rollout::{PlannedBurn, Point, advance};
use crate::sim::bolts::{HIT_RADIUS, LIFE, bolt_momentum};
use crate::spacetime::matter::ShipState;

/// Step of a trial, in r_s/c.
const STEP: f64 = 0.25;
/// Corrections of a direction before it is given up.
const CORRECTIONS: usize = 6;
/// Directions tried in the plane of shooter, hole and target where the direct one fails.
const FAN: usize = 16;
/// A shot is good that misses by less than this share of the hit radius: the rest is for what the pilot does not know.
const SHARE: f64 = 0.5;
/// A correction turns by at most this, in radians: farther off, the miss is no guide.
const MOST_TURN: f64 = 0.4;

/// A trial shot.
#[derive(Clone, Copy, Debug)]
struct Trial {
    /// From the bolt to the target where they are nearest, in r_s.
    miss: DVec3,
    /// How far the bolt has come by then, in r_s.
    way: f64,
}

/// The direction in which to fire at `target`, on rest-frame axes, and by how much it may be off, in radians; None where no shot is good.
/// Round the hole, too, if need be.
pub fn lead(own: &ShipState, target: &Point, burn: &PlannedBurn) -> Option<(DVec3, f64)> {
    let straight = (target.x - own.position).try_normalize()?;
    let shoot = |direction| try_shot(own, direction, target, burn);
    refine(straight, shoot).or_else(|| {
        let inward = -own.position.normalize();
        let side = straight.reject_from(inward).try_normalize().unwrap_or_else(|| inward.any_orthonormal_vector());
        let fan = (0..FAN).map(|k| {
            let angle = std::f64::consts::PI * (2.0 * (k as f64 + 0.5) / FAN as f64 - 1.0);
            inward * angle.cos() + side * angle.sin()
        });
        let best = fan.map(|direction| (direction, shoot(direction).miss.length_squared())).min_by(|a, b| a.1.total_cmp(&b.1))?;
        refine(best.0, shoot)
    })
}

/// Corrects a direction until its shot is good.
fn refine(mut direction: DVec3, shoot: impl Fn(DVec3) -> Trial) -> Option<(DVec3, f64)> {
    for _ in 0..CORRECTIONS {
        let trial = shoot(direction);
        if trial.miss.length() < SHARE * HIT_RADIUS {
            return Some((direction, SHARE * HIT_RADIUS / trial.way.max(1.0)));
        }
        let turn = (trial.miss / trial.way.max(STEP)).clamp_length_max(MOST_TURN);
        direction = (direction + turn.reject_from(direction)).try_normalize()?;
    }
    None
}

fn try_shot(own: &ShipState, direction: DVec3, target: &Point, burn: &PlannedBurn) -> Trial {
    let mut bolt = Point { x: own.position, p: bolt_momentum(own.momentum, direction) };
    let mut target = *target;
    let mut best = Trial { miss: target.x - bolt.x, way: STEP };
    let mut way = 0.0;
    for index in 0..(LIFE / STEP) as usize {
        let before = [bolt.x, target.x];
        bolt = advance(&bolt, STEP, 1.0, |_| DVec3::ZERO);
        target = advance(&target, STEP, 1.0, |at| burn.acceleration(at, index as f64 * STEP, STEP));
        let (from, to) = (before[1] - before[0], target.x - bolt.x);
        let change = to - from;
        let share = (-from.dot(change) / change.length_squared().max(1e-30)).clamp(0.0, 1.0);
        let miss = from + change * share;
        if miss.length_squared() < best.miss.length_squared() {
            best = Trial { miss, way: way + share * bolt.x.distance(before[0]) };
        }
        way += bolt.x.distance(before[0]);
        if bolt.x.length_squared() < 1.0 {
            break;
        }
    }
    best
}
