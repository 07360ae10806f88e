//! Sampling model-predictive control: try many burns, fly each a while ahead, keep the best.
//!
//! Laws that steer along the line of sight fly into the hole, because the line of sight crosses it. Here the hole is part of every
//! flight that is judged.

use glam::DVec3;
use rand::{RngExt, rngs::StdRng};
use rayon::prelude::*;

use super::rollout::{PlannedBurn, Point, Span, advance, track};

/// A ship that comes under this radius (r_s) in a plan is judged as nearly lost: twice the horizon, above the photon sphere.
pub const SAFE_RADIUS: f64 = 2.0;

/// What a pilot wants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aim {
    /// To be where the target is, soon.
    Catch,
    /// To stay away from it.
    Escape,
    /// To fly through the place where the target is held, at any speed.
    Pass,
    /// To stay about this radius, in r_s.
    Keep(f64),
}

// The cost of a plan is in r_s of distance to the other ship; every other thing has a weight that says how many r_s it is worth. All of
// them were chosen by hand and kept for how chases go: over 12 seeds of `chase` nobody comes below 1.5 r_s and at least 9 of the quarries
// are caught (tests/sim/chase.rs).

/// Of the hunter: r_s for each r_s/c that a meeting is later.
const LATER: f64 = 0.03;
/// Of the hunter: r_s for each c of velocity difference at a meeting, less the farther off it is: a fast fly-by cannot be held.
const FLY_BY: f64 = 2.0;
/// Of the hunter: weight of the distance at the end of the plan beside that of the meeting.
const HUNTER_END: f64 = 0.15;
/// Of the hunter: r_s for each c of velocity change spent.
const HUNTER_FUEL: f64 = 0.1;
/// Of the quarry: weights of the mean distance and of that at the end beside the least.
const QUARRY_MEAN: f64 = 0.3;
/// See [`QUARRY_MEAN`].
const QUARRY_END: f64 = 0.3;
/// Of the quarry: r_s for each c of velocity change spent.
const QUARRY_FUEL: f64 = 0.05;
/// Of the quarry: r_s for each r_s/c that the hunter comes into [`REACH`] later.
const HELD_OFF: f64 = 0.15;
/// A hunter so near, in r_s, has come.
const REACH: f64 = 1.0;
/// Distance, in r_s, beyond which a quarry gains nothing by its mean or its end.
const FAR: f64 = 12.0;
/// r_s for a plan that comes below [`SAFE_RADIUS`]: more than distances come to; and for each r_s that it comes lower, so that the least
/// bad way out is still the best.
const DANGER: f64 = 1000.0;
/// See [`DANGER`].
const DEEPER: f64 = 100.0;
/// r_s for an orbit that falls in when there is no fuel to leave it.
const STRANDED: f64 = 500.0;
/// What an orbit that falls in costs, in r_s of distance per unit of E² over the barrier.
const FALL: f64 = 20.0;
/// The fuel, in c, with which a pilot stops risking such orbits.
pub const RESERVE: f64 = 1.0;
/// What leaving the arena costs, in r_s of distance per unit of energy.
const UNBOUND: f64 = 200.0;

impl Task {
    /// The energy of the circular orbit at half the arena's radius. Less than this, and the apoapsis lies in the arena.
    fn arena_energy(&self) -> f64 {
        let r = 0.5 * self.arena_radius;
        (1.0 - 1.0 / r) / (1.0 - 1.5 / r).sqrt()
    }
}

/// What a plan is made from.
#[derive(Clone, Copy, Debug)]
pub struct Task {
    /// What for.
    pub aim: Aim,
    /// The ship now.
    pub own: Point,
    /// The other ship now, as far as the pilot knows.
    pub other: Point,
    /// What the other is thought to burn next, from what it was seen to do.
    pub other_burn: PlannedBurn,
    /// The most proper acceleration, c²/r_s.
    pub max_thrust: f64,
    /// Δv left, in c.
    pub fuel: f64,
    /// The other's engine as the pilot reckons it, c²/r_s: one who flees expects to be followed with it.
    pub other_thrust: f64,
    /// How far ahead, in r_s/c.
    pub horizon: f64,
    /// Keep within this radius, in r_s.
    pub arena_radius: f64,
    /// The hole is no danger: the way may lead below the horizon.
    pub inside: bool,
}

impl Task {
    /// The radius, in r_s, below which flights of a plan end.
    pub fn floor(&self) -> f64 {
        if self.inside { DEEPEST } else { 1.0 }
    }
}

/// Plans below the horizon end here, in r_s: the rain falls from there to the singularity in 0.04 r_s/c.
const DEEPEST: f64 = 0.15;

/// T per planning step, in r_s/c.
const STEP: f64 = 1.0;
/// How long a burn may be, in r_s/c.
const DURATIONS: [f64; 3] = [4.0, 12.0, 30.0];
/// Directions drawn by chance for each plan, besides the six axes.
const DIRECTIONS: usize = 18;
/// Variations of the best burn tried at the end: each pushed off by a part of the full thrust in a direction drawn by chance, and made
/// shorter or longer by a factor. Like all of these, chosen by hand: 99 flights are a plan.
const REFINEMENTS: usize = 24;
/// See [`REFINEMENTS`].
const PUSH: f64 = 0.4;
/// See [`REFINEMENTS`].
const STRETCH: std::ops::Range<f64> = 0.6..1.5;

/// The best burn found, and its cost.
pub fn plan(task: &Task, previous: &PlannedBurn, chance: &mut StdRng) -> (PlannedBurn, f64) {
    let span = Span { step: STEP, count: (task.horizon / STEP) as usize };
    let other = match task.aim {
        Aim::Catch | Aim::Escape => track(task.other, &task.other_burn, span, task.floor()),
        // What is held stays where it is.
        Aim::Pass | Aim::Keep(_) => vec![task.other; span.count + 1],
    };
    let judged = |burn: PlannedBurn| {
        let endurance = if burn.thrust == DVec3::ZERO { 0.0 } else { task.fuel / burn.thrust.length() };
        let burn = PlannedBurn { duration: burn.duration.min(endurance), ..burn };
        (burn, cost(task, &burn, &other, span))
    };
    // Of equals the first.
    let better = |best: (PlannedBurn, f64), next: (PlannedBurn, f64)| if next.1 < best.1 { next } else { best };
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
    let directions: Vec<DVec3> = axes.chain((0..DIRECTIONS).map(|_| unit_vector(chance))).collect();
    let straight = directions
        .into_iter()
        .flat_map(|direction| DURATIONS.map(|duration| PlannedBurn { thrust: direction * task.max_thrust, duration }));
    let burns: Vec<PlannedBurn> = [PlannedBurn::COAST, *previous].into_iter().chain(straight).collect();
    // A frame waits for its plan: all threads make it. Who flies many games at once has a thread for each.
    let costs: Vec<_> = if rayon::current_thread_index().is_none() {
        burns.into_par_iter().map(judged).collect()
    } else {
        burns.into_iter().map(judged).collect()
    };
    let mut best = costs.into_iter().fold((PlannedBurn::COAST, f64::INFINITY), better);
    for _ in 0..REFINEMENTS {
        let thrust = (best.0.thrust + unit_vector(chance) * (PUSH * task.max_thrust)).clamp_length_max(task.max_thrust);
        let duration = (best.0.duration * chance.random_range(STRETCH)).max(STEP);
        best = better(best, judged(PlannedBurn { thrust, duration }));
    }
    best
}

/// The smaller the better; distances in r_s, times in r_s/c.
fn cost(task: &Task, burn: &PlannedBurn, other: &[Point], span: Span) -> f64 {
    let mut own = task.own;
    let mut before = own.x;
    let mut hunter = task.other;
    let mut nearest = f64::INFINITY;
    let mut mean = 0.0;
    let mut penalty = 0.0;
    let mut lowest = f64::INFINITY;
    let mut end = 0.0;
    let mut free = task.horizon;
    for (index, seen) in other.iter().enumerate() {
        let time = index as f64 * span.step;
        if index > 0 {
            before = own.x;
            own = advance(&own, span.step, task.floor(), |at| burn.acceleration(at, time - span.step, span.step));
            if task.aim == Aim::Escape {
                hunter = follow(&hunter, &own, task.other_thrust, span.step);
            }
        }
        let target = if task.aim == Aim::Escape { &hunter } else { seen };
        let r = own.x.length();
        let distance = match task.aim {
            Aim::Catch | Aim::Escape => own.x.distance(target.x),
            // A step may be longer than what is flown through.
            Aim::Pass => off_the_way(before, own.x, target.x),
            Aim::Keep(radius) => (r - radius).abs(),
        };
        lowest = lowest.min(r);
        if distance < REACH {
            free = free.min(time);
        }
        // Who hunts follows wherever the other goes.
        if task.aim != Aim::Catch {
            penalty += (r - task.arena_radius).max(0.0);
        }
        mean += distance.min(FAR);
        end = distance;
        let weighted = match task.aim {
            Aim::Catch => distance + LATER * time + FLY_BY * (own.velocity() - target.velocity()).length() / (1.0 + distance),
            Aim::Pass => distance + LATER * time,
            Aim::Escape | Aim::Keep(_) => distance,
        };
        nearest = nearest.min(weighted);
    }
    mean /= other.len() as f64;
    let spent = burn.thrust.length() * burn.duration.min(task.horizon);
    if task.inside {
        return nearest + HUNTER_END * end + HUNTER_FUEL * spent;
    }
    let danger = if lowest < SAFE_RADIUS { DANGER + DEEPER * (SAFE_RADIUS - lowest) } else { 0.0 };
    // Who flees stays bound to the hole, and so does who is short of fuel: an empty tank must not carry it out of the arena for ever.
    let unbound = if task.aim == Aim::Escape || (task.aim != Aim::Catch && task.fuel - spent < RESERVE) {
        (own.energy() - task.arena_energy()).max(0.0) * UNBOUND
    } else {
        0.0
    };
    danger
        + unbound
        + fall_risk(&own, task.fuel - spent)
        + match task.aim {
            Aim::Keep(_) => mean + QUARRY_END * end.min(FAR) + HUNTER_FUEL * spent + penalty,
            Aim::Pass => nearest + HUNTER_FUEL * spent + penalty,
            Aim::Catch => nearest + HUNTER_END * end + HUNTER_FUEL * spent + penalty,
            Aim::Escape => -HELD_OFF * free - nearest - QUARRY_MEAN * mean - QUARRY_END * end.min(FAR) + QUARRY_FUEL * spent + penalty,
        }
}

/// How near the straight way between two places comes to a third, in r_s.
fn off_the_way(from: DVec3, to: DVec3, place: DVec3) -> f64 {
    let way = to - from;
    let share = ((place - from).dot(way) / way.length_squared().max(1e-30)).clamp(0.0, 1.0);
    (from + way * share).distance(place)
}

/// What it costs to be on an orbit that leads down to [`SAFE_RADIUS`]: some while there is fuel to leave it, nearly all when there is not.
pub fn fall_risk(own: &Point, fuel_left: f64) -> f64 {
    let energy = own.energy();
    let barrier = (1.0 - 1.0 / SAFE_RADIUS) * (1.0 + own.x.cross(own.p).length_squared() / (SAFE_RADIUS * SAFE_RADIUS));
    let leaves = energy >= 1.0 && own.x.dot(own.velocity()) > 0.0;
    let lacking = energy * energy - barrier;
    if leaves || lacking < 0.0 { 0.0 } else { lacking * FALL + if fuel_left < RESERVE { STRANDED } else { 0.0 } }
}

/// Thrust of the reckoned hunter (c²/r_s) for each r_s of distance and for each c of velocity difference: a spring and its damping, chosen
/// by hand.
const PULL: f64 = 0.05;
/// See [`PULL`].
const BRAKE: f64 = 0.5;
/// Nearer to the hole than this, in r_s, it does not thrust inwards.
const NO_DIVE: f64 = 3.0;

/// How one who flees reckons the hunter: it thrusts towards the prey and brakes its sideways drift, but not into the hole.
fn follow(hunter: &Point, prey: &Point, thrust: f64, h: f64) -> Point {
    advance(hunter, h, 1.0, |at| {
        let gap = prey.x - at.x;
        let drift = prey.velocity() - at.velocity();
        let wish = gap * PULL + drift * BRAKE;
        let outward = at.x / at.x.length();
        let wish = if at.x.length_squared() < NO_DIVE * NO_DIVE { wish - outward * wish.dot(outward).min(0.0) } else { wish };
        wish.clamp_length_max(thrust)
    })
}

/// A direction drawn evenly from the sphere: a point of the ball, by rejection from the cube (no trigonometry).
fn unit_vector(chance: &mut StdRng) -> DVec3 {
    loop {
        let mut draw = || chance.random_range(-1.0..1.0);
        let v = DVec3::new(draw(), draw(), draw());
        let length_squared = v.length_squared();
        if length_squared > 1e-4 && length_squared <= 1.0 {
            return v / length_squared.sqrt();
        }
    }
}
