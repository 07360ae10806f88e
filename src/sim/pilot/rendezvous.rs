//! Zero-effort-miss shooting: where would both be if the one coasted and the other went on as it does, and which thrust closes the gap in
//! position and velocity?
//!
//! With the miss z and the velocity difference v at the end of `go` (target minus own, in the real spacetime), the thrust of
//! least ∫a² is linear in time: from 6z/go² − 2v/go to 4v/go − 6z/go² (e.g. Ebrahimi, Bahrami, Roshanian, Acta Astronautica 62 (2008) 556).

use glam::DVec3;

use super::plan::{RESERVE, SAFE_RADIUS, Task, fall_risk};
use super::rollout::{Point, advance, proper_acceleration};

/// Times to go that are tried, shortest first, in r_s/c.
const TIMES_TO_GO: [f64; 9] = [1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 11.0, 15.0];
/// Steps in which each is flown.
const STEPS: usize = 12;
/// A meeting counts if the flight with the planned thrust ends this near, as a share of the first miss, plus [`MISS`].
const SHARE_OF_MISS: f64 = 0.05;
/// See [`SHARE_OF_MISS`], in r_s.
const MISS: f64 = 0.05;
/// Share of the engine's thrust that a plan may use; the rest corrects.
const THRUST_SHARE: f64 = 0.9;

/// The thrust now (proper acceleration, rest-frame axes, c²/r_s) of the soonest meeting the engine can fly without coming near the hole.
pub fn rendezvous(task: &Task) -> Option<DVec3> {
    TIMES_TO_GO.iter().find_map(|&go| meet(task, go))
}

fn meet(task: &Task, go: f64) -> Option<DVec3> {
    let h = go / STEPS as f64;
    let (mut own, mut other) = (task.own, task.other);
    for index in 0..STEPS {
        own = advance(&own, h, task.floor(), |_| DVec3::ZERO);
        other = advance(&other, h, task.floor(), |at| task.other_burn.acceleration(at, index as f64 * h, h));
    }
    let miss = other.x - own.x;
    let drift = other.velocity() - own.velocity();
    let first = miss * (6.0 / (go * go)) - drift * (2.0 / go);
    let last = drift * (4.0 / go) - miss * (6.0 / (go * go));
    let limit = task.max_thrust * THRUST_SHARE;
    if first.length() > limit || last.length() > limit {
        return None;
    }
    let mut now: Point = task.own;
    for index in 0..STEPS {
        let share = (index as f64 + 0.5) / STEPS as f64;
        let wanted = first + (last - first) * share;
        now = advance(&now, h, task.floor(), |at| proper_acceleration(at.p, wanted));
        if !task.inside && now.x.length_squared() < SAFE_RADIUS * SAFE_RADIUS {
            return None;
        }
    }
    if !task.inside && task.fuel < RESERVE && fall_risk(&now, task.fuel) > 0.0 {
        return None;
    }
    let close = now.x.distance(other.x) <= MISS + SHARE_OF_MISS * miss.length();
    close.then(|| proper_acceleration(task.own.p, first).clamp_length_max(task.max_thrust))
}

/// The thrust now (as of [`rendezvous`]) of the soonest flight through the place that the task's target holds, at any speed. The thrust of
/// least ∫a² is then 3z/go², falling to nothing.
pub fn intercept(task: &Task) -> Option<DVec3> {
    TIMES_TO_GO.iter().find_map(|&go| {
        let h = go / STEPS as f64;
        let coast = (0..STEPS).fold(task.own, |own, _| advance(&own, h, task.floor(), |_| DVec3::ZERO));
        let miss = task.other.x - coast.x;
        let first = miss * (3.0 / (go * go));
        if first.length() > task.max_thrust * THRUST_SHARE {
            return None;
        }
        let mut now = task.own;
        for index in 0..STEPS {
            let left = 1.0 - (index as f64 + 0.5) / STEPS as f64;
            now = advance(&now, h, task.floor(), |at| proper_acceleration(at.p, first * left));
            if !task.inside && now.x.length_squared() < SAFE_RADIUS * SAFE_RADIUS {
                return None;
            }
        }
        let close = now.x.distance(task.other.x) <= MISS + SHARE_OF_MISS * miss.length();
        close.then(|| proper_acceleration(task.own.p, first).clamp_length_max(task.max_thrust))
    })
}
