//! How to meet a target: motion against it, the way that braking takes, where both pass. What the HUD shows, and what a person flies by.

use glam::DVec3;

use super::bolts::nearest;
use super::pilot::rollout::{Point, advance};

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
/// Slower than this against the target, in c, nobody need brake.
const SLOW: f64 = 0.02;
/// The way of braking ends this share of the catch radius before the target, and at most so far, in r_s: who drifts past a wide one need
/// not brake.
const SHORT: (f64, f64) = (0.5, 0.5);

/// The guidance of a ship with an engine of `thrust` (c²/r_s) to a target that is caught within `reach` (r_s).
///
/// In the target's frame a ship of speed v and proper acceleration a stops within (γ − 1)/a; tides over that way are left out.
pub fn guidance(own: &Point, target: &Point, thrust: f64, reach: f64) -> Guidance {
    let apart = target.x - own.x;
    let velocity = own.velocity() - target.velocity();
    let speed = velocity.length().min(0.999);
    let gamma = (1.0 - speed * speed).sqrt().recip();
    let stopping = (gamma - 1.0) / thrust.max(1e-9);
    // What is left of the way along the motion, before it is past the target.
    let room = apart.dot(velocity) / speed.max(1e-9) - (SHORT.0 * reach).min(SHORT.1);
    let needed = stopping + REACTION * speed;
    let brake = match () {
        () if speed < SLOW => Brake::Free,
        // Past it: what helps then is thrust towards it.
        () if apart.dot(velocity) < 0.0 && apart.length() > reach => Brake::Free,
        () if needed < EARLY * apart.length() => Brake::Free,
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
        [own, target] = [own, target].map(|point| advance(&point, step, 1.0, |_| DVec3::ZERO));
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

/// The nearest approach of two that coast; None if they part from now on.
pub fn approach(own: &Point, target: &Point) -> Option<Approach> {
    let step = AHEAD.0 / AHEAD.1 as f64;
    let (mut own, mut target) = (*own, *target);
    let (mut best, mut nearest) = (None, own.x.distance(target.x));
    for k in 1..=AHEAD.1 {
        [own, target] = [own, target].map(|point| advance(&point, step, 1.0, |_| DVec3::ZERO));
        let distance = own.x.distance(target.x);
        if distance < nearest {
            nearest = distance;
            best = Some(Approach { distance, ahead: k as f64 * step, places: [own.x, target.x] });
        }
    }
    best
}
