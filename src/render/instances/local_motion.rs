//! How a moving body moves, turns and contracts while its light crosses it. Its centre goes a smooth way, to fourth order in time; its
//! attitude, and where centre and momentum stray from that way, are read from its history at even times, the nodes. They go to the GPU with
//! the instance; [`local_motion_at`] is the twin of the shader's functions.

use glam::{DQuat, DVec3, Quat, Vec3, Vec4};

use crate::sim::History;
use crate::sim::history::{Sample, rotation};
use crate::spacetime::matter::gamma;
use crate::spacetime::metric::river_speed;

use crate::render::gpu::types::Instance;
use crate::render::gpu::types::placed::STRAYS as STRAYS_FLAG;

/// A node as the GPU reads it: the attitude (x, y, z, w, body to rain axes); what to add to the smooth way, in r_s; what to add to the
/// smooth momentum, in c.
pub type MotionNode = [[f32; 4]; 3];

/// The fewest and the most times between the nodes of an image.
const INTERVALS: (f64, f64) = (4.0, 48.0);
/// The most nodes: up to twice those times where every second node of the history would be too few, and one more at either end.
pub const MOST_NODES: usize = 100;
/// So many times between nodes, times the root of the image's width in pixels, show a body that takes up its turn as quickly as a ship can
/// to a hundredth of a pixel: with n times over its length 2R the turn is off by (c/4)/2R² · (2R/n)²/8 at most, and half the width is R.
const PER_ROOT_PIXEL: f64 = 2.0;
/// What a point may stray from the smooth way and contraction without its nodes being read, in pixels.
const STRAYS: f64 = 0.02;
/// A centre that strays by more than this share of the body's reach has no smooth way.
const WILD: f64 = 0.25;
/// The fastest that a vertex goes round the centre, or to and from it as the contraction changes, in c of the slice. A ship's turn is 1/4.
/// Beyond 1 a point would be seen at several times at once.
const FASTEST: f64 = 0.5;
/// The fastest that a centre goes against the rain, in c: with rounding, and the way between two nodes, which is a cubic.
const FASTEST_WAY: f64 = 1.001;

/// What is known of the image that a body is drawn in.
#[derive(Clone, Copy, Debug)]
pub struct ImageExtent {
    /// Its light leaves so long before and after that of the centre, at most, in r_s/c.
    pub span: f64,
    /// Width, in pixels.
    pub width: f64,
    /// What a pixel spans at the body, in r_s.
    pub pixel: f64,
}

/// How a body moves about the emission time T₀ of its centre.
#[derive(Clone, Debug)]
pub struct LocalMotion {
    /// d²x/dT² of the centre, in c²/r_s.
    pub acceleration: DVec3,
    /// d³x/dT³ of the centre, in c³/r_s².
    pub jerk: DVec3,
    /// d⁴x/dT⁴ of the centre, in c⁴/r_s³.
    pub snap: DVec3,
    /// dp/dT, p being the rain-frame momentum per mass, in c²/r_s.
    pub force: DVec3,
    /// Mean angular velocity, rain axes, in c/r_s.
    pub spin: DVec3,
    /// By how much the sine of light against a surface may be off what that turn tells.
    pub slack: f64,
    /// Time of the first node after T₀, and between two nodes, in r_s/c.
    pub times: [f64; 2],
    /// The nodes, at even times.
    pub nodes: Vec<MotionNode>,
    /// Whether the centre or the momentum strays from its smooth way.
    pub strays: bool,
    /// Whether the body turned or sprang faster than any can, so that it is drawn going straight on.
    pub calmed: bool,
}

impl LocalMotion {
    /// From a body of this `reach` (r_s) and its history.
    ///
    /// The way is fitted to positions at T₀ − `reach`, T₀ and T₀ + `reach`, and to positions halfway. The fourth order is needed for what
    /// falls inside the horizon beside the camera: without it a ship of 0.16 r_s at r = 0.6 is off by 10⁻⁴ r_s, a pixel at a distance of a
    /// thirtieth of r_s. A Taylor series about T₀ would be worst at the ends, where it matters.
    ///
    /// Nodes are at those of the history, or at every second or third, so that between two of them the turn is as even as it was flown. They
    /// come in place of what `nodes` holds.
    pub fn new(history: &History, emission: f64, reach: f64, seen: &ImageExtent, nodes: Vec<MotionNode>) -> LocalMotion {
        // For bodies smaller than a thousandth of r_s differences would be lost in rounding, and no motion is visible.
        let w = reach.max(1e-3);
        let now = history.at(emission);
        let [earlier, half_back, half_on, later] = [-w, -0.5 * w, 0.5 * w, w].map(|s| history.at(emission + s));
        let moved = |sample: &Sample, s: f64| sample.position - now.position - now.velocity * s;
        let (moved_back, moved_on) = (moved(&earlier, -w), moved(&later, w));
        // The even part in s is a s² + k s⁴/12.
        let (even, even_half) = (moved_on + moved_back, moved(&half_back, -0.5 * w) + moved(&half_on, 0.5 * w));
        let force = (later.momentum - earlier.momentum) / (2.0 * w);
        let mut local_motion = LocalMotion {
            acceleration: (even_half * 16.0 - even) / (3.0 * w * w),
            jerk: (moved_on - moved_back) * (3.0 / (w * w * w)),
            snap: (even - even_half * 4.0) * (16.0 / (w * w * w * w)),
            force,
            spin: DVec3::ZERO,
            slack: 0.0,
            times: [0.0; 2],
            nodes,
            strays: false,
            calmed: false,
        };
        local_motion.take_nodes(history, emission, &now, reach, seen);
        local_motion
    }

    /// Without a turn and along a straight line, for a time `span` (r_s/c) before and after.
    fn go_straight_on(&mut self, attitude: DQuat, span: f64) {
        (self.acceleration, self.jerk, self.snap, self.force) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        self.times = [-span, 2.0 * span];
        at_rest(attitude, &mut self.nodes);
    }

    fn take_nodes(&mut self, history: &History, emission: f64, now: &Sample, reach: f64, seen: &ImageExtent) {
        let most = (PER_ROOT_PIXEL * seen.width.max(1.0).sqrt()).clamp(INTERVALS.0, INTERVALS.1);
        let (anchor, apart) = history.node_at(emission);
        let (coarse, fine) = (2.0 * seen.span / INTERVALS.0, 2.0 * seen.span / most);
        // Where nodes are far apart nothing happened between them.
        let step = if apart < coarse { apart * (fine / apart).floor().max(1.0) } else { fine };
        let first = ((emission - seen.span - anchor) / step).floor();
        let last = ((emission + seen.span - anchor) / step).ceil().max(first + 1.0);
        let count = ((last - first) as usize).min(MOST_NODES - 1);
        let time = |k: usize| anchor + (first + k as f64) * step;
        let mut flown = [*now; MOST_NODES];
        flown[..=count].iter_mut().enumerate().for_each(|(k, sample)| *sample = history.at(time(k)));
        // Nodes end where no body goes on: the singularity may lie within the time of what is seen of a ship that falls towards it.
        let mut fastest = 0.0;
        let mut is_wild = |k: &usize| {
            let [earlier, later] = [&flown[*k], &flown[k + 1]];
            let turn = rotation(earlier.attitude, later.attitude).length() / step;
            let is_sound = turn * reach <= FASTEST && is_possible(earlier, later, reach, step);
            if is_sound {
                fastest = f64::max(fastest, turn);
            }
            !is_sound
        };
        let middle = (0..=count).filter(|k| time(*k) <= emission).count().clamp(1, count) - 1;
        let end = (middle..count).find(&mut is_wild).unwrap_or(count);
        let start = (0..middle).rev().find(&mut is_wild).map_or(0, |k| k + 1);
        self.calmed |= end == middle || time(start) > emission - reach.min(seen.span) || time(end) < emission + reach.min(seen.span);
        if self.calmed {
            return self.go_straight_on(now.attitude, seen.span);
        }
        // Each with its time after T₀.
        let samples = || (start..=end).map(|k| (&flown[k], time(k) - emission));
        let aside = |local_motion: &LocalMotion, (sample, s): (&Sample, f64)| {
            let way =
                now.velocity + (local_motion.acceleration + (local_motion.jerk + local_motion.snap * (0.25 * s)) * (s / 3.0)) * (0.5 * s);
            sample.position - (now.position + way * s)
        };
        let force = self.force;
        let pushed = |(sample, s): (&Sample, f64)| sample.momentum - now.momentum - force * s;
        let farthest = |local_motion: &LocalMotion| samples().map(|at| aside(local_motion, at).length()).fold(0.0, f64::max);
        let mut beside = farthest(self);
        if beside > WILD * reach {
            (self.acceleration, self.jerk, self.snap) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
            beside = farthest(self);
        }
        // A momentum that is off by δ contracts a point's place by at most the reach times δ.
        self.strays = beside.max(samples().map(|at| pushed(at).length()).fold(0.0, f64::max) * reach) > STRAYS * seen.pixel;
        let turn = |k: usize| rotation(now.attitude, flown[k].attitude);
        self.spin = (turn(end) - turn(start)) / (time(end) - time(start));
        let uneven = samples().map(|(sample, s)| rotation(now.attitude, sample.attitude).distance(self.spin * s)).fold(0.0, f64::max);
        self.slack = uneven + fastest * reach;
        self.times = [time(start) - emission, step];
        let mut nodes = std::mem::take(&mut self.nodes);
        let mut before = now.attitude;
        nodes.clear();
        nodes.extend(samples().map(|(sample, s)| {
            before = if sample.attitude.dot(before) < 0.0 { -sample.attitude } else { sample.attitude };
            let [aside, pushed] = [aside(self, (sample, s)), pushed((sample, s))].map(|off| off.as_vec3().extend(0.0).to_array());
            [before.as_quat().to_array(), aside, pushed]
        }));
        self.nodes = nodes;
    }
}

/// Whether a body can go from one sample to another in `step` (r_s/c): no centre outruns light, and no contraction moves a vertex faster
/// than [`FASTEST`]. What is not a number cannot.
fn is_possible(earlier: &Sample, later: &Sample, reach: f64, step: f64) -> bool {
    let outward = (earlier.position + later.position).normalize_or_zero();
    let way = (later.position - earlier.position) / step;
    // The river's speed on the way is between those at both ends: that which the body goes most nearly with.
    let [a, b] = [earlier, later].map(|sample| river_speed(sample.position.length().max(1e-3)));
    let against_rain = way + outward * (-way.dot(outward)).clamp(a.min(b), a.max(b));
    // The contraction changes the points' places by at most reach |dp/dT| / γ² a time.
    let slowest = gamma(earlier.momentum).min(gamma(later.momentum));
    let spring = earlier.momentum.distance(later.momentum) * reach / (step * slowest * slowest);
    against_rain.length() <= FASTEST_WAY && spring <= FASTEST
}

/// A point of a body some time after T₀: its offset from the centre at T₀ (r_s, rain axes, on the slice), dx/dT (c), and the attitude.
pub type MovedPoint = (Vec3, Vec3, Quat);

/// Where a point of a body (model's unit, body axes) is `s` r_s/c after T₀. Twin of `local_motion_at` in shaders/instances/recorded.wgsl.
pub fn local_motion_at(instance: &Instance, nodes: &[MotionNode], body: Vec3, s: f32) -> MovedPoint {
    let xyz = |row: [f32; 4]| Vec3::new(row[0], row[1], row[2]);
    let scale = instance.scale;
    if scale == 0.0 {
        let [x, y, z] = [instance.shape_x, instance.shape_y, instance.shape_z].map(Vec3::from_array);
        return (x * body.x + y * body.y + z * body.z, Vec3::ZERO, Quat::from_xyzw(0.0, 0.0, 0.0, 0.0));
    }
    let (first, per_time, last) = (instance.first_node, instance.nodes_per_time, instance.node_intervals);
    let at = (s - first) * per_time;
    let x = at.clamp(0.0, last);
    let index = x.floor().min(last - 1.0);
    let (share, inside) = (x - index, if at == x { 1.0 } else { 0.0 });
    let [[turn_a, aside_a, pushed_a], [turn_b, aside_b, pushed_b]] = [nodes[index as usize], nodes[index as usize + 1]];
    let [turn_a, turn_b] = [turn_a, turn_b].map(Vec4::from_array);
    let (mean, change) = (turn_a.lerp(turn_b, share), turn_b - turn_a);
    let q = Quat::from_vec4(mean.normalize());
    let rest = q * (body * scale);
    let rate = change.truncate() * mean.w - mean.truncate() * change.w - change.truncate().cross(mean.truncate());
    let turning = (rate * (2.0 / mean.length_squared())).cross(rest) * (per_time * inside);
    let strays = if instance.flags & STRAYS_FLAG != 0 { 1.0 } else { 0.0 };
    let mut moved = carried(instance, rest, turning, s, xyz(pushed_a).lerp(xyz(pushed_b), share) * strays);
    if strays > 0.0 {
        let [a, b] = [aside_a, aside_b].map(xyz);
        moved.0 += a.lerp(b, share);
        moved.1 += (b - a) * (per_time * inside);
    }
    (moved.0, moved.1, q)
}

/// Twin of `carried` in shaders/instances/local_motion.wgsl: offset and velocity.
fn carried(instance: &Instance, rest: Vec3, turning: Vec3, s: f32, pushed: Vec3) -> (Vec3, Vec3) {
    let [velocity, acceleration, jerk, snap, contraction, force] =
        [instance.velocity, instance.acceleration, instance.jerk, instance.snap, instance.contraction, instance.force]
            .map(Vec3::from_array);
    let way = (velocity + (acceleration + (jerk + snap * (0.25 * s)) * (s / 3.0)) * (0.5 * s)) * s;
    let velocity = velocity + (acceleration + (jerk + snap * (s / 3.0)) * (0.5 * s)) * s;
    let p = contraction + force * s + pushed;
    let gamma = (1.0 + p.length_squared()).sqrt();
    let contracted = |v: Vec3| v - p * (p.dot(v) / (gamma * (1.0 + gamma)));
    (way + contracted(rest), velocity + contracted(turning))
}

/// Has a body go straight on from a sample of its history without turning: one whose own motion has no numbers.
pub fn at_rest(attitude: DQuat, nodes: &mut Vec<MotionNode>) {
    nodes.clear();
    nodes.extend([[attitude.as_quat().to_array(), [0.0; 4], [0.0; 4]]; 2]);
}
