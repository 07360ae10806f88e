//! Where to thrust to meet a target: the change of velocity now after which a free fall leads to it. What the HUD marks and a person follows.
//!
//! Both fall ahead, the ship also with three small pushes. The change of its place at a later time is linear in the push, so the push that
//! closes the gap of that time is the solution of three linear equations; of all times the cheapest is taken (targeting by the state
//! transition matrix, e.g. Battin, *An Introduction to the Mathematics and Methods of Astrodynamics*, chapter 11). What is not linear is
//! flown and corrected. The fall is that round the hole, not Newton's.

use bevy::ecs::component::Component;
use glam::{DMat3, DVec3};

use super::assist::AssistMode;
use super::guidance::approach;
use super::known::Known;
use super::pilot::rollout::{Point, coast};
use crate::spacetime::matter::boosted_acceleration;

/// Meetings are looked for at so many later times.
const STEPS: usize = 32;
/// Between two of them, in r_s/c.
const STEP: f64 = 1.5;
/// A small push, in c: what is linear and well above rounding.
const PUSH: f64 = 1e-3;
/// A larger push than this, in c, is none that a person flies.
const LARGEST: f64 = 0.7;
/// No way may come nearer to the hole than this, in r_s, unless the target itself does.
const LOWEST: f64 = 2.6;
/// The engine thrusts for at most this share of the time until the meeting: a push is taken to come at once.
const BURN: f64 = 0.5;
/// What a r_s/c of waiting counts for, in c: whoever is chased does not wait.
const HASTE: f64 = 0.025;
/// The way that one is on already counts for so much less, in c: to turn to another costs time, and two that are as cheap would change
/// places.
const KEPT: f64 = 0.1;
/// So many of the cheapest ways are flown, so many steps apart.
const TRIED: usize = 5;
/// See [`TRIED`].
const APART: usize = 3;
/// Each is corrected so often, until it ends so near, in r_s.
const CORRECTED: (usize, f64) = (4, 0.15);

/// A change of velocity after which a free fall leads to a target, or up from the hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intercept {
    /// On rest-frame axes, in c.
    pub push: DVec3,
    /// T until the meeting, in r_s/c.
    pub ahead: f64,
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
    /// No fall that a push begins leads there now: keep the orbit.
    Wait,
}

/// A smaller push than this, in c, is left until it has grown: a turn of the nose for it costs more.
const LEAST: f64 = 0.02;

/// Nearer than this, in r_s, one flies to the target itself: it has no time to be elsewhere, and its own thrust counts more than a fall.
pub const NEAR: f64 = 4.0;

/// What leads `own`, with an engine of `thrust` (c²/r_s), within `reach` (r_s) of a ship that is to be flown with; from deep near the hole
/// first up. None near it. `kept`: see [`intercept`].
pub fn advised(own: &Point, known: &Known, thrust: f64, reach: f64, kept: Option<f64>) -> Option<Advice> {
    if own.x.distance(known.point.x) < NEAR {
        return None;
    }
    let meets = approach(own, known).is_some_and(|near| near.distance < MEETS * reach);
    if meets {
        return Some(Advice::Coast);
    }
    Some(match intercept(own, known, thrust, kept).or_else(|| climb(own, known)) {
        None => Advice::Wait,
        Some(found) if found.push.length() < LEAST => Advice::Coast,
        Some(found) => Advice::Thrust(found),
    })
}

/// The way that whoever flies a ship is on to its target. It is found anew now and then, and one stays on it until another is clearly better.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct Way {
    /// T when it was found, in r_s/c.
    found: f64,
    /// Within this of the target it ends, in r_s.
    reach: f64,
    /// T of the meeting, in r_s/c, while there is one.
    meets: Option<f64>,
    advice: Option<Advice>,
}

/// The way that is shown of a ship, asked for whenever a frame is drawn: what flies must not hang on that.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct ShownWay(pub Way);

/// How long a way is held for found, in r_s/c: a tenth of a second at the usual pace. Frames ask before the step that ends them.
const FOUND: f64 = 0.15;
/// Who has not asked for so long, in r_s/c, is on no way.
const LEFT: f64 = 2.0;

impl Way {
    /// [`advised`] at T = `time`, staying on the way.
    pub fn follow(&mut self, own: &Point, known: &Known, time: f64, thrust: f64, reach: f64) -> Option<Advice> {
        let since = time - self.found;
        let is_same = self.reach == reach;
        if !is_same || !(-FOUND..FOUND).contains(&since) {
            let kept = self.meets.filter(|_| is_same && (-FOUND..LEFT).contains(&since)).map(|meets| meets - time);
            let advice = advised(own, known, thrust, reach, kept);
            let meets = match advice {
                Some(Advice::Thrust(intercept)) => Some(time + intercept.ahead),
                Some(Advice::Coast) => kept.map(|ahead| time + ahead),
                Some(Advice::Wait) | None => None,
            };
            *self = Way { found: time, reach, meets, advice };
        }
        self.advice
    }
}

/// With the nose nearer to a mark than this it is on it, in radians.
pub const ON_MARK: f64 = 0.3;

impl Advice {
    /// The assist of who turns to it, from `radius` (r_s), with the mark at `ahead` on body axes. It rests, since it would fly another way; but
    /// near the hole it holds the ship until the nose is there.
    pub fn assist(self, radius: f64, ahead: DVec3) -> AssistMode {
        let turns = radius < DEEP && ahead.angle_between(DVec3::NEG_Z) > ON_MARK;
        match self {
            Advice::Thrust(_) if turns => AssistMode::Orbit,
            Advice::Wait => AssistMode::Orbit,
            Advice::Thrust(_) | Advice::Coast => AssistMode::Off,
        }
    }

    /// The thrust that it asks for.
    pub fn thrust(self) -> Option<Intercept> {
        match self {
            Advice::Coast | Advice::Wait => None,
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
/// no fall leads there. One that is on a way that meets in `kept` r_s/c stays on it until another is clearly cheaper.
pub fn intercept(own: &Point, known: &Known, thrust: f64, kept: Option<f64>) -> Option<Intercept> {
    let mut left = meetings(own, known, thrust);
    for meeting in &mut left {
        let is_kept = kept.is_some_and(|kept| (meeting.found.ahead - kept).abs() <= APART as f64 * STEP);
        meeting.cost -= if is_kept { KEPT } else { 0.0 };
    }
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

/// Who is nearer to the hole than this, in r_s, with no way to a target above, goes up first.
const DEEP: f64 = 4.0;
/// So far, in r_s: from there a way is found.
const UP: f64 = 6.0;
/// Pushes of so many sizes are tried, and from the least on so many more: who thrusts too little there falls.
const SIZES: (u32, u32) = (14, 2);

/// A push along the own motion after which a fall from near the hole goes up.
fn climb(own: &Point, known: &Known) -> Option<Intercept> {
    let radius = own.x.length();
    if radius > DEEP || known.point.x.length() < radius {
        return None;
    }
    let along = own.velocity().reject_from(own.x).try_normalize()?;
    (1..=SIZES.0).find_map(|size| {
        let push = |size| along * (LARGEST * f64::from(size) / f64::from(SIZES.0));
        let mut point = after(own, push(size));
        let up = (1..=STEPS).find(|_| {
            point = coast(&point, STEP);
            point.x.length_squared() > UP * UP
        })?;
        Some(Intercept { push: push(size + SIZES.1), ahead: up as f64 * STEP })
    })
}

/// All meetings within reach of the engine, one for each time.
fn meetings(own: &Point, known: &Known, thrust: f64) -> Vec<Meeting> {
    let (mut own, mut pushed, mut target) = (*own, DVec3::AXES.map(|axis| after(own, axis * PUSH)), known.point);
    let mut meetings = Vec::new();
    for steps in 1..=STEPS {
        own = coast(&own, STEP);
        pushed = pushed.map(|point| coast(&point, STEP));
        target = if known.rests { target } else { coast(&target, STEP) };
        let change = |of: &dyn Fn(&Point) -> DVec3| {
            let [a, b, c] = pushed.map(|point| (of(&point) - of(&own)) / PUSH);
            DMat3::from_cols(a, b, c)
        };
        let push = change(&|point| point.x).inverse() * (target.x - own.x);
        let ahead = steps as f64 * STEP;
        if !push.is_finite() || push.length() > LARGEST.min(BURN * thrust * ahead) {
            continue;
        }
        let arrival = (own.velocity() + change(&Point::velocity) * push - target.velocity()).length();
        let cost = push.length() + arrival + HASTE * ahead;
        meetings.push(Meeting { cost, steps, found: Intercept { push, ahead }, place: target.x });
    }
    meetings
}

/// The meeting as it is really flown, by Newton's method; None where it is not reached, or the way to it comes near the hole.
fn corrected(own: &Point, meeting: &Meeting) -> Option<Intercept> {
    let lowest = LOWEST.min(meeting.place.length());
    let mut push = meeting.found.push;
    for _ in 0..=CORRECTED.0 {
        let mut point = after(own, push);
        let mut pushed = DVec3::AXES.map(|axis| after(own, push + axis * PUSH));
        let mut is_low = false;
        for _ in 0..meeting.steps {
            point = coast(&point, STEP);
            pushed = pushed.map(|point| coast(&point, STEP));
            is_low |= point.x.length_squared() < lowest * lowest;
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
