//! Where to thrust to meet a target: the change of velocity now after which a free fall leads to it. What the HUD marks and a person follows.
//!
//! Both fall ahead, the ship also with three small pushes. The change of its place at a later time is linear in the push, so the push that
//! closes the gap of that time is the solution of three linear equations; of all times the cheapest is taken (targeting by the state
//! transition matrix, e.g. Battin, *An Introduction to the Mathematics and Methods of Astrodynamics*, chapter 11). What is not linear is
//! flown and corrected. The fall is that round the hole, not Newton's.

use glam::{DMat3, DVec3};

use super::guidance::approach;
use super::known::Known;
use super::pilot::rollout::{Point, advance};
use crate::spacetime::matter::boosted_acceleration;

/// How far ahead meetings are looked for, in r_s/c, and in how many steps.
const AHEAD: (f64, usize) = (48.0, 32);
/// A small push, in c: what is linear and well above rounding.
const PUSH: f64 = 1e-3;
/// A larger push than this, in c, is none that a person flies.
const LARGEST: f64 = 0.7;
/// No way may come nearer to the hole than this, in r_s, unless the target itself does.
const LOWEST: f64 = 2.3;
/// The engine thrusts for at most this share of the time until the meeting: a push is taken to come at once.
const BURN: f64 = 0.5;
/// What a r_s/c of waiting counts for, in c: whoever is chased does not wait.
const HASTE: f64 = 0.025;
/// So many of the cheapest ways are flown, so many steps apart.
const TRIED: usize = 5;
/// See [`TRIED`].
const APART: usize = 3;
/// Each is corrected so often, until it ends so near, in r_s.
const CORRECTED: (usize, f64) = (4, 0.15);

/// A change of velocity after which a free fall leads to a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intercept {
    /// On rest-frame axes, in c.
    pub push: DVec3,
    /// T until the meeting, in r_s/c.
    pub ahead: f64,
    /// Speed against the target there, in c.
    pub arrival: f64,
}

/// Whoever passes within this share of the catch radius need not thrust.
pub const MEETS: f64 = 0.6;

/// What leads to a ship that is to be flown with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Advice {
    /// The fall does already.
    Coast,
    /// Thrust.
    Thrust(Intercept),
}

/// Nearer than this, in r_s, one flies to the target itself: it has no time to be elsewhere, and its own thrust counts more than a fall.
pub const NEAR: f64 = 4.0;

/// What leads `own`, with an engine of `thrust` (c²/r_s), within `reach` (r_s) of a ship that is to be flown with. None where no fall does,
/// and near it.
pub fn advised(own: &Point, known: &Known, thrust: f64, reach: f64) -> Option<Advice> {
    if own.x.distance(known.point.x) < NEAR {
        return None;
    }
    let meets = approach(own, known).is_some_and(|near| near.distance < MEETS * reach);
    if meets { Some(Advice::Coast) } else { intercept(own, known, thrust).map(Advice::Thrust) }
}

impl Advice {
    /// The thrust that it asks for.
    pub fn thrust(self) -> Option<Intercept> {
        match self {
            Advice::Coast => None,
            Advice::Thrust(intercept) => Some(intercept),
        }
    }
}

/// A meeting in linear approximation.
struct Meeting {
    cost: f64,
    steps: usize,
    found: Intercept,
    place: DVec3,
}

/// The cheapest way of `own`, with an engine of `thrust` (c²/r_s), to what it is after, where its motion has to be taken away. None where
/// no fall leads there.
pub fn intercept(own: &Point, known: &Known, thrust: f64) -> Option<Intercept> {
    let mut left = meetings(own, known, thrust);
    left.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    for _ in 0..TRIED {
        let meeting = left.first()?;
        let (steps, found) = (meeting.steps, corrected(own, meeting));
        if found.is_some() {
            return found;
        }
        // What comes soon before or after it is no other way.
        left.retain(|other| other.steps.abs_diff(steps) > APART);
    }
    None
}

/// A step of both.
fn coasts(point: &Point) -> Point {
    advance(point, AHEAD.0 / AHEAD.1 as f64, 1.0, |_| DVec3::ZERO)
}

/// All meetings within reach of the engine, one for each time.
fn meetings(own: &Point, known: &Known, thrust: f64) -> Vec<Meeting> {
    let (mut own, mut pushed, mut target) = (*own, DVec3::AXES.map(|axis| after(own, axis * PUSH)), known.point);
    let mut meetings = Vec::new();
    for steps in 1..=AHEAD.1 {
        own = coasts(&own);
        pushed = pushed.map(|point| coasts(&point));
        target = if known.rests { target } else { coasts(&target) };
        let change = |of: &dyn Fn(&Point) -> DVec3| {
            let [a, b, c] = pushed.map(|point| (of(&point) - of(&own)) / PUSH);
            DMat3::from_cols(a, b, c)
        };
        let push = change(&|point| point.x).inverse() * (target.x - own.x);
        let ahead = steps as f64 * AHEAD.0 / AHEAD.1 as f64;
        if !push.is_finite() || push.length() > LARGEST.min(BURN * thrust * ahead) {
            continue;
        }
        let arrival = (own.velocity() + change(&Point::velocity) * push - target.velocity()).length();
        let cost = push.length() + arrival + HASTE * ahead;
        meetings.push(Meeting { cost, steps, found: Intercept { push, ahead, arrival }, place: target.x });
    }
    meetings
}

/// The meeting as it is really flown, by Newton's method; None where it is not reached, or the way to it comes near the hole.
fn corrected(own: &Point, meeting: &Meeting) -> Option<Intercept> {
    let lowest = LOWEST.min(meeting.place.length()).powi(2);
    let mut push = meeting.found.push;
    for _ in 0..=CORRECTED.0 {
        let mut point = after(own, push);
        let mut pushed = DVec3::AXES.map(|axis| after(own, push + axis * PUSH));
        let mut is_low = false;
        for _ in 0..meeting.steps {
            point = coasts(&point);
            pushed = pushed.map(|point| coasts(&point));
            is_low |= point.x.length_squared() < lowest;
        }
        let miss = meeting.place - point.x;
        if miss.length() < CORRECTED.1 {
            return (!is_low && push.length() < LARGEST).then_some(Intercept { push, ..meeting.found });
        }
        let [a, b, c] = pushed.map(|pushed| (pushed.x - point.x) / PUSH);
        push += (DMat3::from_cols(a, b, c).inverse() * miss).clamp_length_max(LARGEST);
        if !push.is_finite() {
            return None;
        }
    }
    None
}

/// Just after a push on rest-frame axes, in c.
fn after(point: &Point, push: DVec3) -> Point {
    Point { p: point.p + boosted_acceleration(point.p, push), ..*point }
}
