//! How to meet a target: motion against it, the way that braking takes, where both pass. What the HUD shows, and what a person flies by.

use glam::DVec3;

use super::assist::{Reference, drift};
use super::bolts::nearest;
use super::known::Known;
use super::pilot::rollout::{Point, advance, coast};
use crate::spacetime::matter::ShipState;

/// Motion of a ship against its target, on the slice T = const.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guidance {
    /// From the ship to the target, in r_s.
    pub apart: DVec3,
    /// dx/dT of the ship less that of the target, in c.
    pub velocity: DVec3,
    /// The way, in r_s, in which the engine takes that motion away.
    pub stopping: f64,
    /// Whether to brake.
    pub brake: Brake,
}

/// Whether to brake for a target.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Brake {
    /// Room enough.
    #[default]
    Free,
    /// Soon: no more thrust.
    Soon,
    /// At once.
    Now,
}

/// Time to see the sign and to act, in r_s/c: half a second at the usual pace is 0.75.
const REACTION: f64 = 0.75;
/// From this share of the room on the way of braking is near to it.
const SOON: f64 = 0.7;
/// While braking needs less than this share of the distance there is time, wherever the motion leads: who drifts slowly past from afar has
/// a course to mend, not to brake.
const EARLY: f64 = 0.12;
/// Who passes the target farther off than this along their motion, in r_s, has a course to mend as well.
const WIDE: f64 = 2.5;
/// Slower than this against the target, in c, nobody need brake.
const SLOW: f64 = 0.02;
/// The way of braking ends this share of the catch radius before the target, and at most so far, in r_s: who drifts past a wide one need
/// not brake.
const SHORT: (f64, f64) = (0.5, 0.5);

/// The braking is flown ahead in so many steps, if space were flat.
const BRAKING_STEPS: f64 = 8.0;
/// Steps longer than this, in r_s/c, tell nothing of the fall: weak engines, high speeds.
const COARSE: f64 = 2.0;
/// It may last so many times as long as there: where the fall helps no engine, no stop is found.
const LONGEST: f64 = 2.0;

/// The way along their motion (r_s) in which an engine of `thrust` (c²/r_s) takes away the motion of `own` against a target that falls on.
///
/// In the target's frame a ship of speed v and proper acceleration a stops within (γ − 1)/a. What the fall adds on that way is flown.
fn stopping(own: &Point, target: &Point, thrust: f64) -> f64 {
    let velocity = own.velocity() - target.velocity();
    let Some(along) = velocity.try_normalize() else { return 0.0 };
    let speed = velocity.length().min(0.999);
    let gamma = (1.0 - speed * speed).sqrt().recip();
    let flat = (gamma - 1.0) / thrust.max(1e-9);
    let step = gamma * speed / thrust.max(1e-9) / BRAKING_STEPS;
    if step > COARSE {
        return flat;
    }
    let (mut own_then, mut target_then, mut before) = (*own, *target, speed);
    for _ in 0..(LONGEST * BRAKING_STEPS) as usize {
        let rest = target_then.velocity();
        let brakes = |at: &Point| drift(&ShipState::new(at.x, at.p), Reference::Target(rest)).normalize_or_zero() * -thrust;
        let apart = own_then.x - target_then.x;
        [own_then, target_then] = [advance(&own_then, step, 1.0, brakes), coast(&target_then, step)];
        let left = (own_then.velocity() - target_then.velocity()).dot(along);
        if left <= 0.0 {
            // It stops within this step.
            let share = before / (before - left).max(1e-9);
            let stopped = apart.lerp(own_then.x - target_then.x, share);
            return (stopped - (own.x - target.x)).dot(along).max(0.0);
        }
        before = left;
    }
    LONGEST * flat
}

/// The guidance of a ship with an engine of `thrust` (c²/r_s) to a target that is caught within `reach` (r_s).
pub fn guidance(own: &Point, target: &Point, thrust: f64, reach: f64) -> Guidance {
    let apart = target.x - own.x;
    let velocity = own.velocity() - target.velocity();
    let speed = velocity.length().min(0.999);
    let stopping = stopping(own, target, thrust);
    // What is left of the way along the motion, before it is past the target.
    let room = apart.dot(velocity) / speed.max(1e-9) - (SHORT.0 * reach).min(SHORT.1);
    let needed = stopping + REACTION * speed;
    let brake = match () {
        () if speed < SLOW => Brake::Free,
        // Past it: what helps then is thrust towards it.
        () if apart.dot(velocity) < 0.0 && apart.length() > reach => Brake::Free,
        () if needed < EARLY * apart.length() => Brake::Free,
        () if apart.reject_from(velocity).length() > WIDE.max(reach) => Brake::Free,
        () if needed >= room => Brake::Now,
        () if needed >= SOON * room => Brake::Soon,
        () => Brake::Free,
    };
    Guidance { apart, velocity, stopping, brake }
}

impl Guidance {
    /// How fast the distance shrinks, in c.
    pub fn closing(&self) -> f64 {
        self.velocity.dot(self.apart) / self.apart.length().max(1e-9)
    }

    /// The speed across the line to the target, in c.
    pub fn sideways(&self) -> f64 {
        self.velocity.reject_from(self.apart.try_normalize().unwrap_or(DVec3::X)).length()
    }
}

/// Whether two that coast come within `reach` (r_s) of each other in the next `span` (r_s/c).
pub fn meets(own: &Point, target: &Point, span: f64, reach: f64) -> bool {
    let step = AHEAD.0 / AHEAD.1 as f64;
    let (mut own, mut target) = (*own, *target);
    (0..(span / step).ceil().max(0.0) as usize).any(|_| {
        let before = own.x - target.x;
        [own, target] = [own, target].map(|point| coast(&point, step));
        nearest(before, own.x - target.x) <= reach
    })
}

/// How far ahead two ships are looked after, in r_s/c, and in how many pieces.
const AHEAD: (f64, usize) = (24.0, 32);

/// Where and when two that coast come nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// How near, in r_s.
    pub distance: f64,
    /// In how many r_s/c of T.
    pub ahead: f64,
    /// Where both are then, in r_s.
    pub places: [DVec3; 2],
}

/// The nearest approach of one that coasts to what it is after; None if they part from now on.
pub fn approach(own: &Point, known: &Known) -> Option<Approach> {
    let step = AHEAD.0 / AHEAD.1 as f64;
    let (mut own, mut target) = (*own, known.point);
    let (mut best, mut nearest) = (None, own.x.distance(target.x));
    for k in 1..=AHEAD.1 {
        own = coast(&own, step);
        target = if known.rests { target } else { coast(&target, step) };
        let distance = own.x.distance(target.x);
        if distance < nearest {
            nearest = distance;
            best = Some(Approach { distance, ahead: k as f64 * step, places: [own.x, target.x] });
        }
    }
    best
}
