//! Where a ship was: its worldline as nodes in T with cubic Hermite interpolation between, in the past before T = 0 as a free orbit. Where
//! that came out of the hole, the ship hovered until then.

use std::sync::{PoisonError, RwLock};

use bevy::prelude::Component;
use glam::{DQuat, DVec3};

use crate::spacetime::matter::{STEP_SHARE, ShipState, came_out_of_the_hole, gamma, has_ended, rate, runge_kutta, step, velocity};
use crate::spacetime::metric::river_speed;
use crate::spacetime::orbit::static_momentum;

use super::flight::Command;

/// Backwards in T, ingoing coordinates do not reach the white hole: a ship inside the horizon that came out of it hugs r = 1 with momentum
/// growing as exp(|T|/2). Past this momentum (c) it is held where it is; its light is redshifted beyond sight long before.
const MAX_PAST_MOMENTUM: f64 = 1e6;

/// Nodes that a look beyond the known past leaves behind, at most; what is still older is integrated at each look.
const MAX_LOOKED_UP: usize = 100_000;

/// In this time, in r_s/c, a ship that hovered takes up the motion that it starts with.
const START: f64 = 1.0 / 32.0;

/// A ship at one instant T.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Position on the slice, in r_s.
    pub position: DVec3,
    /// dx/dT, in c.
    pub velocity: DVec3,
    /// Rain-frame momentum per mass, in c.
    pub momentum: DVec3,
    /// Body to rain axes through the pure boost of `momentum`.
    pub attitude: DQuat,
    /// Proper time, in r_s/c.
    pub proper_time: f64,
}

impl From<&ShipState> for Sample {
    fn from(state: &ShipState) -> Self {
        Sample {
            position: state.position,
            velocity: velocity(state),
            momentum: state.momentum,
            attitude: state.attitude,
            proper_time: state.proper_time,
        }
    }
}

#[derive(Clone, Copy, Debug)]
struct Node {
    time: f64,
    state: ShipState,
    velocity: DVec3,
    /// dp/dT just before and just after the node: they differ where the thrust changes.
    force_before: DVec3,
    force_after: DVec3,
    /// Whether it was here, at rest, at all times before.
    held: bool,
}

impl Node {
    fn coasting(time: f64, state: &ShipState) -> Self {
        let force = rate(state, DVec3::ZERO, DVec3::ZERO).momentum;
        Node { time, state: *state, velocity: velocity(state), force_before: force, force_after: force, held: false }
    }

    /// Held in place from here backwards, hovering where anything can; its nozzles stay dark.
    fn held(time: f64, state: &ShipState) -> Self {
        let hovers = if is_frozen(state) { None } else { static_momentum(state.position) };
        let state = ShipState { momentum: hovers.unwrap_or(state.momentum), ..*state };
        Node { time, state, velocity: DVec3::ZERO, force_before: DVec3::ZERO, force_after: DVec3::ZERO, held: true }
    }

    /// The node before this one, of the past; of one that is held there is none.
    fn before(&self) -> Node {
        if is_frozen(&self.state) {
            // It comes to rest within a step: what holds between nodes holds here too.
            Node::held(self.time - past_step(&self.state), &self.state)
        } else if came_out_of_the_hole(&self.state) {
            Node::held(self.time - START, &self.state)
        } else {
            let h = past_step(&self.state);
            Node::coasting(self.time - h, &runge_kutta(&self.state, -h, DVec3::ZERO, DVec3::ZERO))
        }
    }
}

/// Bounds on how a ship moves over a while, in r_s, c and radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotionBounds {
    /// |dx/dT|.
    pub velocity: f64,
    /// |d²x/dT²|.
    pub acceleration: f64,
    /// The least and the greatest |p| of the momentum per mass.
    pub momentum: [f64; 2],
    /// |dp/dT|.
    pub force: f64,
    /// |d²p/dT²|, but at nodes.
    pub surge: f64,
    /// The angular velocity of the attitude, constant between nodes.
    pub turning: f64,
    /// All jumps of dp/dT at nodes together, and all of the angular velocity.
    pub jumps: [f64; 2],
}

impl MotionBounds {
    /// Widens them by what lies between two nodes. A cubic and its derivatives stay among their Bézier points.
    fn take(&mut self, earlier: &Node, later: &Node, turn: DVec3) {
        let span = later.time - earlier.time;
        let points = |a: DVec3, da: DVec3, b: DVec3, db: DVec3| [a, a + da * (span / 3.0), b - db * (span / 3.0), b];
        // The first derivatives at the points between, and the second at both ends.
        let rates = |p: [DVec3; 4]| [p[1] - p[0], p[2] - p[1], p[3] - p[2]].map(|d| d.length() * 3.0 / span);
        let bends = |p: [DVec3; 4]| [p[2] - 2.0 * p[1] + p[0], p[3] - 2.0 * p[2] + p[1]].map(|d| d.length() * 6.0 / (span * span));
        let most = |bound: &mut f64, values: &[f64]| *bound = values.iter().copied().fold(*bound, f64::max);
        let place = points(earlier.state.position, earlier.velocity, later.state.position, later.velocity);
        let momentum = points(earlier.state.momentum, earlier.force_after, later.state.momentum, later.force_before);
        most(&mut self.velocity, &rates(place));
        most(&mut self.acceleration, &bends(place));
        most(&mut self.force, &rates(momentum));
        most(&mut self.surge, &bends(momentum));
        let strays = momentum.map(|p| p.distance(momentum[0])).into_iter().fold(0.0, f64::max);
        self.momentum[0] = self.momentum[0].min((momentum[0].length() - strays).max(0.0));
        most(&mut self.momentum[1], &momentum.map(DVec3::length));
        // Small turns go along a normalised chord instead of an arc, at a rate that is even to a thousandth: a tenth covers its change.
        most(&mut self.turning, &[1.1 * turn.length()]);
    }
}

/// The proper acceleration (c²/r_s) by the engines from a node on. Of dp/dT, γ times what they add to free fall is the thrust a, boosted:
/// a + p (p·a)/(1 + γ).
fn burn(node: &Node) -> f64 {
    let (p, g) = (node.state.momentum, gamma(node.state.momentum));
    let boosted = (node.force_after - rate(&node.state, DVec3::ZERO, DVec3::ZERO).momentum) * g;
    (boosted - p * (p.dot(boosted) / (g * (1.0 + g)))).length()
}

/// Nodes older than the past of a history, times decreasing: what was integrated for a look that far is kept for the next one.
#[derive(Debug, Default)]
struct LookedUp(RwLock<Vec<Node>>);

impl Clone for LookedUp {
    fn clone(&self) -> Self {
        LookedUp(RwLock::new(self.0.read().unwrap_or_else(PoisonError::into_inner).clone()))
    }
}

impl LookedUp {
    fn clear(&mut self) {
        self.0.get_mut().unwrap_or_else(PoisonError::into_inner).clear();
    }

    /// The ship at T = `time`, before the node `oldest`.
    fn at(&self, oldest: &Node, time: f64) -> Sample {
        let reaches = |nodes: &[Node]| nodes.last().is_some_and(|node| node.held || node.time <= time);
        let nodes = self.0.read().unwrap_or_else(PoisonError::into_inner);
        if reaches(&nodes) {
            return sample(oldest, &nodes, time);
        }
        drop(nodes);
        let mut nodes = self.0.write().unwrap_or_else(PoisonError::into_inner);
        while !reaches(&nodes) && nodes.len() < MAX_LOOKED_UP {
            let earlier = nodes.last().unwrap_or(oldest).before();
            nodes.push(earlier);
        }
        if reaches(&nodes) {
            return sample(oldest, &nodes, time);
        }
        let mut later = *nodes.last().unwrap_or(oldest);
        drop(nodes);
        loop {
            let earlier = later.before();
            if earlier.held || earlier.time <= time {
                return sample(&later, &[earlier], time);
            }
            later = earlier;
        }
    }
}

/// The ship at T = `time` among nodes that go back to then, or to where it was held; `first` is the node after them.
fn sample(first: &Node, nodes: &[Node], time: f64) -> Sample {
    let after = nodes.partition_point(|node| node.time > time);
    let later = if after == 0 { first } else { &nodes[after - 1] };
    match nodes.get(after) {
        Some(earlier) => between(earlier, later, time),
        None => Sample { velocity: DVec3::ZERO, ..Sample::from(&later.state) },
    }
}

/// The worldline of one ship. Every node is kept (some 180 bytes a step), so what crossed the horizon is seen for ever, unless
/// [`History::forget_beyond`] says that nobody will look that far.
#[derive(Component, Clone, Debug)]
pub struct History {
    /// From T = 0 on, times increasing.
    nodes: Vec<Node>,
    /// Before T = 0, times decreasing.
    past: Vec<Node>,
    /// Before that.
    looked_up: LookedUp,
    /// How far back from the latest node is surely kept, in r_s/c.
    keep: f64,
    /// From which T to which there is such a thing at all, in r_s/c.
    exists: [f64; 2],
}

impl History {
    /// A ship that has this state at T = `time` and coasted before, or hovered.
    pub fn new(time: f64, state: &ShipState) -> Self {
        History {
            nodes: vec![Node::coasting(time, state)],
            past: Vec::new(),
            looked_up: LookedUp::default(),
            keep: f64::INFINITY,
            exists: [f64::NEG_INFINITY, f64::INFINITY],
        }
    }

    /// The worldline of nothing: a place in a list of worldlines that nobody takes.
    pub fn nobody() -> Self {
        let mut history = History::new(0.0, &ShipState::new(DVec3::new(1e3, 0.0, 0.0), DVec3::ZERO));
        history.begins(f64::INFINITY);
        history
    }

    /// Adds the state at `time`, later than all before, reached under `command`.
    pub fn push(&mut self, time: f64, state: &ShipState, command: &Command) {
        let force = |state: &ShipState| rate(state, command.thrust, command.rates).momentum;
        if let Some(last) = self.nodes.last_mut() {
            last.force_after = force(&last.state);
        }
        if self.nodes[0].time < time - 2.0 * self.keep {
            let old = self.nodes.partition_point(|node| node.time < time - self.keep);
            self.nodes.drain(..old.saturating_sub(1));
            self.past.clear();
            self.looked_up.clear();
        }
        let force = force(state);
        self.nodes.push(Node { time, state: *state, velocity: velocity(state), force_before: force, force_after: force, held: false });
    }

    /// From now on keeps at least the last `keep` r_s/c and lets go what is older than twice that; a look farther back then shows a free
    /// orbit through the oldest node kept, or has it hover there.
    pub fn forget_beyond(&mut self, keep: f64) {
        self.keep = keep;
    }

    /// There was nothing before T = `time`.
    pub fn begins(&mut self, time: f64) {
        self.exists[0] = time;
    }

    /// There is nothing after T = `time`.
    pub fn ends(&mut self, time: f64) {
        self.exists[1] = time;
    }

    /// Whether there is such a thing at T = `time`.
    pub fn exists_at(&self, time: f64) -> bool {
        (self.exists[0]..=self.exists[1]).contains(&time)
    }

    /// The latest T known, in r_s/c.
    pub fn latest(&self) -> f64 {
        self.last().time
    }

    /// Number of nodes from the start on.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Never: a history has at least its start.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Integrates the past back to T = `time` (or to where it freezes), so that [`History::at`] is quick from there on.
    pub fn reach_back(&mut self, time: f64) {
        let mut oldest = *self.oldest();
        while oldest.time > time && !oldest.held {
            oldest = oldest.before();
            self.past.push(oldest);
            self.looked_up.clear();
        }
    }

    /// The ship at T = `time`. Beyond the latest node it coasts on; before the oldest it coasted there or hovered (integrated at the first
    /// look that far, as [`History::reach_back`] does it).
    pub fn at(&self, time: f64) -> Sample {
        let (first, last) = (&self.nodes[0], self.last());
        if time >= last.time {
            return Sample::from(&step(&last.state, time - last.time, DVec3::ZERO, DVec3::ZERO));
        }
        if time >= first.time {
            let after = self.nodes.partition_point(|node| node.time <= time);
            return between(&self.nodes[after - 1], &self.nodes[after], time);
        }
        let oldest = self.oldest();
        if time >= oldest.time || oldest.held {
            return sample(first, &self.past, time);
        }
        self.looked_up.at(oldest, time)
    }

    /// The last node at or before T = `time` and the T from there to the next, in r_s/c. Before the nodes from the start on, and after
    /// them, the ship coasts: there the nearest of them, and no next.
    pub fn node_at(&self, time: f64) -> (f64, f64) {
        match self.nodes.partition_point(|node| node.time <= time) {
            0 => (self.nodes[0].time, f64::INFINITY),
            after => {
                let (node, next) = (self.nodes[after - 1].time, self.nodes.get(after).map(|node| node.time));
                (node, next.map_or(f64::INFINITY, |next| next - node))
            }
        }
    }

    /// The proper acceleration by the engines in c²/r_s, its mean over the `span` r_s/c of T before `time`: from what they add to the
    /// momentum of free fall. 0 where the ship coasts, as it does before the first node and after the last.
    pub fn thrust(&self, time: f64, span: f64) -> f64 {
        let from = time - span;
        let first = self.nodes.partition_point(|node| node.time <= from).saturating_sub(1);
        let after = self.nodes.partition_point(|node| node.time < time);
        let legs = self.nodes[first..(after + 1).clamp(first, self.nodes.len())].windows(2);
        let burnt: f64 = legs.map(|leg| burn(&leg[0]) * (leg[1].time.min(time) - leg[0].time.max(from)).max(0.0)).sum();
        burnt / span
    }

    /// Bounds on how the ship moves from T = `from` to `to`, from the nodes; None beyond the first and the last of them, but where it is
    /// held in place.
    pub fn bounds(&self, from: f64, to: f64) -> Option<MotionBounds> {
        let oldest = self.oldest();
        if from < oldest.time && oldest.held {
            let p = oldest.state.momentum.length();
            let held = MotionBounds { momentum: [p, p], ..MotionBounds::default() };
            if to <= oldest.time {
                return Some(held);
            }
            // Place, momentum and their rates go over into rest without a jump, and in the last step it does not turn.
            let mut bounds = self.bounds(oldest.time, to)?;
            bounds.momentum = [bounds.momentum[0].min(p), bounds.momentum[1].max(p)];
            return Some(bounds);
        }
        if from < oldest.time || to > self.last().time {
            return None;
        }
        // From the last node not after `from` to the first not before `to`; those of the past run backwards.
        let later = self.past.partition_point(|node| node.time >= to);
        let past = if from < self.nodes[0].time {
            &self.past[later.saturating_sub(1)..=self.past.partition_point(|node| node.time > from)]
        } else {
            &[]
        };
        let since = if later == 0 {
            let first = self.nodes.partition_point(|node| node.time <= from).saturating_sub(1);
            &self.nodes[first..=self.nodes.partition_point(|node| node.time < to)]
        } else {
            &[]
        };
        let mut bounds = MotionBounds { momentum: [f64::INFINITY, 0.0], ..MotionBounds::default() };
        let mut before: Option<(&Node, DVec3)> = None;
        let mut nodes = past.iter().rev().chain(since);
        let mut earlier = nodes.next()?;
        for later in nodes {
            let turn = turning(earlier, later);
            bounds.take(earlier, later, turn);
            if let Some((node, turn_before)) = before {
                bounds.jumps[0] += node.force_before.distance(earlier.force_after);
                bounds.jumps[1] += turn_before.distance(turn);
            }
            before = Some((later, turn));
            earlier = later;
        }
        before.map(|_| bounds)
    }

    fn last(&self) -> &Node {
        &self.nodes[self.nodes.len() - 1]
    }

    fn oldest(&self) -> &Node {
        self.past.last().unwrap_or(&self.nodes[0])
    }
}

/// The mean angular velocity between two nodes, rain axes, in c/r_s.
fn turning(earlier: &Node, later: &Node) -> DVec3 {
    rotation(earlier.state.attitude, later.state.attitude) / (later.time - earlier.time)
}

/// The rotation vector that turns attitude `a` into `b` on the shorter way, radians about an axis in the axes that they turn into.
pub fn rotation(a: DQuat, b: DQuat) -> DVec3 {
    let turn = b * a.conjugate();
    (if turn.w < 0.0 { -turn } else { turn }).to_scaled_axis()
}

fn is_frozen(state: &ShipState) -> bool {
    has_ended(state) || state.momentum.length_squared() > MAX_PAST_MOMENTUM * MAX_PAST_MOMENTUM
}

/// The span from a node of the past to the one before, in r_s/c: in proportion to the radius, so that what came from far away needs few.
/// Between two of them a cubic is off by (r/8)⁴/384 times the fourth derivative, v²/2r⁴: 3e-7 r_s at most, wherever it is.
fn past_step(state: &ShipState) -> f64 {
    let r = state.position.length();
    STEP_SHARE * r / (1.0 + river_speed(r))
}

/// Cubic Hermite in position and momentum, the shorter arc in attitude.
fn between(earlier: &Node, later: &Node, time: f64) -> Sample {
    let span = later.time - earlier.time;
    let s = (time - earlier.time) / span;
    let cubic = |a: DVec3, da: DVec3, b: DVec3, db: DVec3| {
        let (s2, s3) = (s * s, s * s * s);
        a * (2.0 * s3 - 3.0 * s2 + 1.0) + da * ((s3 - 2.0 * s2 + s) * span) + b * (3.0 * s2 - 2.0 * s3) + db * ((s3 - s2) * span)
    };
    let (a, b) = (&earlier.state, &later.state);
    let state = ShipState {
        position: cubic(a.position, earlier.velocity, b.position, later.velocity),
        momentum: cubic(a.momentum, earlier.force_after, b.momentum, later.force_before),
        attitude: a.attitude.slerp(b.attitude, s),
        proper_time: a.proper_time + (b.proper_time - a.proper_time) * s,
    };
    Sample::from(&state)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What came from far away at nearly the speed of light is looked up in few steps.
    #[test]
    fn a_long_past_has_few_nodes() {
        let mut history = History::new(0.0, &ShipState::new(DVec3::X * 10.0, DVec3::Z * 1000.0));
        history.reach_back(-1e7);
        assert!(history.past.len() < 500, "{}", history.past.len());
        let away = history.at(-1e6).position.length();
        assert!((away / 1e6 - 1.0).abs() < 1e-2, "{away}");
    }
}
