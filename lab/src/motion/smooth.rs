//! One smooth motion about the emission time of the centre: the turn to second order in time, with one jump of its rate. What nodes are set
//! beside.

use glam::{DQuat, DVec3};
use lensrunner::sim::History;
use lensrunner::sim::history::rotation;
use lensrunner::spacetime::matter::gamma;

/// The motion of a body about T₀.
pub struct Smooth {
    attitude: DQuat,
    velocity: DVec3,
    acceleration: DVec3,
    momentum: DVec3,
    force: DVec3,
    spin: DVec3,
    spin_rate: DVec3,
    /// A jump of the angular velocity, and when after T₀.
    jolt: (DVec3, f64),
}

impl Smooth {
    /// Fitted to the history within `w` (r_s/c) of T₀ = `emission`; the clock's step is `step`.
    pub fn new(history: &History, emission: f64, w: f64, step: f64) -> Smooth {
        let [earlier, now, later] = [-w, 0.0, w].map(|s| history.at(emission + s));
        let jolt = jolt(history, emission, 2.0 * w, step);
        let turned = |attitude: DQuat, s: f64| rotation(now.attitude, attitude) - jolt.0 * jolted(s, jolt.1);
        let (back, on) = (turned(earlier.attitude, -w), turned(later.attitude, w));
        Smooth {
            attitude: now.attitude,
            velocity: now.velocity,
            acceleration: (later.position + earlier.position - 2.0 * now.position) / (w * w),
            momentum: now.momentum,
            force: (later.momentum - earlier.momentum) / (2.0 * w),
            spin: (on - back) / (2.0 * w),
            spin_rate: (on + back) / (w * w),
            jolt,
        }
    }

    /// A point of the body (r_s, body axes) `s` after T₀, from the centre at T₀.
    pub fn at(&self, body: DVec3, s: f64) -> DVec3 {
        let turn = (self.spin + self.spin_rate * (0.5 * s)) * s + self.jolt.0 * jolted(s, self.jolt.1);
        let rest = DQuat::from_scaled_axis(turn) * (self.attitude * body);
        let p = self.momentum + self.force * s;
        let g = gamma(p);
        (self.velocity + self.acceleration * (0.5 * s)) * s + rest - p * (p.dot(rest) / (g * (1.0 + g)))
    }
}

/// Time for which the jump at `after` has acted at `s`, less that at s = 0.
fn jolted(s: f64, after: f64) -> f64 {
    (s - after).max(0.0) - (-after).max(0.0)
}

/// The largest jump of the angular velocity within `w` of T₀, beyond what it changes from node to node anyway, and when after T₀.
fn jolt(history: &History, emission: f64, w: f64, step: f64) -> (DVec3, f64) {
    let (anchor, _) = history.node_at(emission);
    let count = (w / step).ceil() as i32;
    let times: Vec<f64> = (-count..=count).map(|k| anchor + f64::from(k) * step).collect();
    let rates: Vec<DVec3> =
        times.windows(2).map(|pair| rotation(history.at(pair[0]).attitude, history.at(pair[1]).attitude) / step).collect();
    let jumps: Vec<DVec3> = rates.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let most = jumps.iter().enumerate().max_by(|a, b| a.1.length_squared().total_cmp(&b.1.length_squared()));
    let Some((k, jump)) = most else { return (DVec3::ZERO, 0.0) };
    let beside = |k: Option<usize>| k.and_then(|k| jumps.get(k)).copied().unwrap_or(DVec3::ZERO);
    (*jump - 0.5 * (beside(k.checked_sub(1)) + beside(Some(k + 1))), times[k + 1] - emission)
}
