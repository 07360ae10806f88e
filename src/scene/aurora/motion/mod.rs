//! The motion of the curtains in the plane across the field: charge → potential → electric field → drift (Sekiguchi et al., 2.4).
//!
//! The electrons that come down charge the sheet negatively. Each node carries the charge of its share of the curve, as a Gaussian as thick
//! as the sheet.
//!
//! - Far field: charges are laid on a grid cloud in cell, −∇²V = ρ/ε₀ is solved with V = 0 on the edge of the square ([`Poisson`]), and E =
//!   −∇V by central differences.
//! - Near field, finer than the grid: summed over pairs of nodes ([`Near`]).
//! - Every node drifts with E × B/B², the Lorentz motion averaged over its gyration (a microsecond for electrons).
//!
//! A charged sheet in this drift is a vortex sheet: its waves grow, fold and curl by themselves, in the north counterclockwise as seen from
//! the ground (Hallinan & Davis 1970). With d the sheet's thickness and U the jump of the drift across it, a wave of wavenumber k that is
//! long against d grows at kU/2; waves of length 2πd grow fastest, at 0.22 U/d, and those shorter than 3 d hardly.
//!
//! New electrons keep arriving where the curve was at rest. They come in surges that run along the curtain. Between two surges it folds
//! freely; in a surge its nodes go back to their rest. If nodes were drawn back all the time, those of a curl would fall into its middle,
//! because the turning averages out the direction in which they are drawn, and their charge would gather in growing knots.

pub mod chain;
pub mod near;
pub mod poisson;

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::DVec2;

use super::curve::Curve;
use super::random::uniform;
use chain::{Link, links};
use near::{Charge, Near};
use poisson::Poisson;

/// Inner points along the side of the grid.
pub const GRID: usize = 95;
/// Time between two steps, in s. In it a node at the greatest speed moves a fraction of a cell.
pub const STEP: f64 = 0.5;
/// Nodes that are moved in one part of a step.
const NODES_AT_ONCE: usize = 512;
/// Strength of the field at the reference height, T (the Earth's at 67° N).
pub const FIELD: f64 = 5e-5;
/// No node drifts faster, km s⁻¹: the fastest seen in the ionosphere are near 4.
pub const TOP_SPEED: f64 = 4.0;
/// Standard deviation, in cells, of the Gaussian that stands for each charge on the grid: the least at which modes between its points
/// vanish (to 1 %).
const SIGMA: f64 = 1.0;
/// Least thickness of a curtain's charge, in km (one standard deviation): with it curls are about 40 km apart; folds in the sky are 10 to
/// 50 km wide.
const THICKNESS: f64 = 6.0;
/// Share of a renewal time that a surge takes; below, by which power of e a surge brings nodes nearer to their rest.
const SURGE: f64 = 0.4;
const SURGES_TO: f64 = 3.0;
/// Longest time between two surges, in d/U: later, curls would have wound up more than twice.
const WOUND_UP: f64 = 24.0;
/// Length, in km, of the noise by which surges come earlier or later along a curtain; below, by how many renewal times.
const SURGE_LENGTH: f64 = 250.0;
const SURGE_SPREAD: f64 = 1.5;
/// Waves of brightness that travel along the curtains: length in km, and the time in s in which one passes a node.
const WAVES: [(f64, f64); 2] = [(95.0, 23.0), (30.0, -9.0)];
/// Weights of those waves, and 1 beside them: their mean is no change.
const WAVE_WEIGHTS: [f64; 2] = [1.3, 0.7];
/// Share of its last curve over which an open end of a curtain fades out.
const FADE_OUT: f64 = 0.12;
/// From one chain of curves to the next, km along the pattern of rays: each has other rays.
const OTHER_RAYS: f64 = 613.0;
/// Round a closed chain [`Node::along`] grows by a multiple of this, in km: the period of the rays' noise in shaders/aurora/ends.wgsl, 512
/// values at 0.3 per km.
pub const RAYS_LENGTH: f64 = 512.0 / 0.3;

/// The curtains and the strength of their motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The curves at rest.
    pub curves: Vec<Curve>,
    /// Nodes of all curves together, distributed by length.
    pub nodes: usize,
    /// Electric field towards a long straight curtain, beside it, in mV/m: the sheet's charge is −2 ε₀ times it.
    pub field: f64,
    /// Time between two surges, in which new electrons replace old ones, in s; infinite for none.
    pub renewal: f64,
    /// Contrast of the brightness that travels along the curtains, 0 to 1.
    pub contrast: f64,
    /// Seed: which aurora.
    pub seed: u32,
}

/// A node of a curtain at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Place in the plane across the field, km.
    pub place: DVec2,
    /// Energy flux over its mean.
    pub flux: f64,
    /// Position along its curtain at rest, in km, for the pattern of rays. Round a closed chain it is stretched a little, to a whole number
    /// of [`RAYS_LENGTH`].
    pub along: f64,
}

/// Which nodes each curve has; it stays as the nodes move.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodeLayout {
    /// First node of each curve, and after the last their number.
    pub starts: Vec<usize>,
    /// Length of each curve at rest, km.
    pub lengths: Vec<f64>,
}

/// All curtains, stepping at a fixed rate.
#[derive(Clone, Debug)]
pub struct AuroraMotion {
    plan: Plan,
    /// Each node at rest: its curve, its parameter along it, its position in km.
    rest: Vec<(usize, f64, DVec2)>,
    /// For each node, by how many renewal times surges come earlier.
    early: Vec<f64>,
    layout: Arc<NodeLayout>,
    /// How the curves join.
    links: Vec<Link>,
    nodes: Vec<Node>,
    /// Velocities of the last step, for the second-order step of Adams and Bashforth.
    speeds: Vec<DVec2>,
    time: f64,
    centre: DVec2,
    side: f64,
    poisson: Poisson,
    grid: Vec<f64>,
    near: Near,
    /// Nodes that the step which has begun has moved.
    moved: usize,
    caught: u64,
}

impl AuroraMotion {
    /// The curtains at rest at `time` (s).
    pub fn new(plan: Plan, time: f64) -> Self {
        let lengths: Vec<f64> = plan.curves.iter().map(length).collect();
        let total: f64 = lengths.iter().sum::<f64>().max(1e-6);
        let mut rest = Vec::new();
        let mut starts = vec![0];
        for (index, part) in lengths.iter().enumerate() {
            // At least a few, so that every curve can bend.
            let count = ((plan.nodes as f64 * part / total).round() as usize).max(8);
            let at = |k: usize| k as f64 / (count - 1) as f64;
            rest.extend((0..count).map(|k| (index, at(k), plan.curves[index].point(at(k)))));
            starts.push(rest.len());
        }
        let low = rest.iter().map(|rest| rest.2).fold(DVec2::INFINITY, DVec2::min);
        let high = rest.iter().map(|rest| rest.2).fold(DVec2::NEG_INFINITY, DVec2::max);
        // Twice as wide as the charges, so that the grounded edge is far.
        let side = 2.0 * (high - low).max_element().max(10.0);
        let centre = 0.5 * (low + high);
        let spacing = side / (GRID + 1) as f64;
        let links = links(&plan.curves, &lengths);
        let along = |curve: usize, t: f64| {
            let link = links[curve];
            let stretch = if link.closed { (link.total / RAYS_LENGTH).round().max(1.0) * RAYS_LENGTH / link.total.max(1e-6) } else { 1.0 };
            (link.start + t * lengths[curve]) * stretch + OTHER_RAYS * link.chain as f64
        };
        let nodes: Vec<Node> = rest.iter().map(|&(curve, t, place)| Node { place, flux: 1.0, along: along(curve, t) }).collect();
        let mut motion = AuroraMotion {
            speeds: vec![DVec2::ZERO; nodes.len()],
            near: Near::new(1.0, SIGMA * spacing, centre, side),
            poisson: Poisson::of_clouds(GRID, spacing, SIGMA * spacing),
            grid: vec![0.0; GRID * GRID],
            rest,
            early: Vec::new(),
            layout: Arc::new(NodeLayout { starts, lengths }),
            links,
            moved: nodes.len(),
            nodes,
            time,
            centre,
            side,
            caught: 0,
            plan,
        };
        motion.near.thicken(motion.thickness());
        let early = |&(curve, t, _): &(usize, f64, DVec2)| SURGE_SPREAD * motion.noise_along(curve, t, SURGE_LENGTH, 0.0, 900);
        motion.early = motion.rest.iter().map(early).collect();
        for k in 0..motion.nodes.len() {
            motion.nodes[k].flux = motion.flux(k);
        }
        motion
    }

    /// Sets the strength of the field, renewal time and contrast, as in [`Plan`].
    pub fn change(&mut self, field: f64, renewal: f64, contrast: f64) {
        (self.plan.field, self.plan.renewal, self.plan.contrast) = (field, renewal, contrast);
        self.near.thicken(self.thickness());
    }

    /// Thickness d of the sheet, in km: the standard deviation of each node's charge. It is at least the distance of nodes at rest, so that
    /// a sheet stretched to twice its length is still even to 2 %. It is at least the drift in a step, so that waves grow by an eighth in a
    /// step at most.
    pub fn thickness(&self) -> f64 {
        let spacing = self.layout.lengths.iter().sum::<f64>() / (self.nodes.len() - self.layout.lengths.len()).max(1) as f64;
        THICKNESS.max(spacing).max(jump(self.plan.field).abs() * STEP)
    }

    /// The time reached, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The nodes, curve after curve.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Which nodes each curve has.
    pub fn layout(&self) -> &Arc<NodeLayout> {
        &self.layout
    }

    /// The nodes as they are drawn: each curve has one more before its first and one more after its last, which give its ends their
    /// direction ([`super::curve::between_nodes`]). Where curves join these are nodes of the neighbour; else the end's own neighbour is
    /// mirrored at the end.
    pub fn row(&self) -> impl Iterator<Item = Node> {
        let at = |curve: usize, from_start: bool, number: usize| {
            let (first, last) = (self.layout.starts[curve], self.layout.starts[curve + 1] - 1);
            self.nodes[if from_start { first + number } else { last - number }]
        };
        self.links.iter().enumerate().flat_map(move |(curve, link)| {
            let beyond = |start: bool| {
                let (end, inner) = (at(curve, start, 0), at(curve, start, 1));
                let place = match link.joined[usize::from(!start)] {
                    Some(other) => at(other, !start, 1).place,
                    None => 2.0 * end.place - inner.place,
                };
                Node { place, ..end }
            };
            let own = self.layout.starts[curve]..self.layout.starts[curve + 1];
            [beyond(true)].into_iter().chain(self.nodes[own].iter().copied()).chain([beyond(false)])
        })
    }

    /// How many nodes had a velocity that was not finite and were put back to rest, so far.
    pub fn caught(&self) -> u64 {
        self.caught
    }

    /// One step of [`STEP`] seconds.
    pub fn step(&mut self) {
        while !self.part_of_step() {}
    }

    /// The next part of a step: its field, or the way of `NODES_AT_ONCE` nodes. True once the step is done; until then some nodes are
    /// ahead of the others.
    pub fn part_of_step(&mut self) -> bool {
        if self.moved == self.nodes.len() {
            let charges: Vec<Charge> = self.charge().collect();
            self.lay_out(&charges);
            self.poisson.solve(&mut self.grid);
            self.near.sort(charges, &self.layout.starts);
            self.time += STEP;
            self.moved = 0;
            return self.nodes.is_empty();
        }
        let (period, last) = (self.period(), (self.moved + NODES_AT_ONCE).min(self.nodes.len()));
        for k in self.moved..last {
            self.drift(k, period);
            self.nodes[k].flux = self.flux(k);
        }
        self.moved = last;
        last == self.nodes.len()
    }

    /// Number of parts of a step.
    pub fn parts_of_step(&self) -> usize {
        1 + self.nodes.len().div_ceil(NODES_AT_ONCE)
    }

    /// Lets a node drift for a step, and go back to its rest as far as new electrons replace old ones.
    fn drift(&mut self, k: usize, period: f64) {
        let home = self.rest[k].2;
        let place = self.nodes[k].place;
        let drift = drift(self.field_at(place)).clamp_length_max(TOP_SPEED);
        let next = place + (1.5 * drift - 0.5 * self.speeds[k]) * STEP;
        if next.is_finite() {
            self.nodes[k].place = home + (next - home) * (-self.renewed(k, period)).exp();
            self.speeds[k] = drift;
        } else {
            self.nodes[k].place = home;
            self.speeds[k] = DVec2::ZERO;
            self.caught += 1;
        }
    }

    /// Time from one surge of new electrons to the next, s.
    fn period(&self) -> f64 {
        if self.plan.renewal == f64::INFINITY {
            return f64::INFINITY;
        }
        self.plan.renewal.max(STEP).min(WOUND_UP * self.thickness() / jump(self.plan.field).abs().max(1e-6))
    }

    /// By which power of e new electrons replaced old ones at a node in the last step. A surge, 1 − cos over its time, is integrated in
    /// closed form, so that its sum does not depend on how short it is relative to a step.
    fn renewed(&self, k: usize, period: f64) -> f64 {
        let come = |time: f64| {
            let periods = time / period + self.early[k];
            let phase = (periods.rem_euclid(1.0) / SURGE).min(1.0);
            periods.floor() + phase - (TAU * phase).sin() / TAU
        };
        SURGES_TO * (come(self.time) - come(self.time - STEP))
    }

    /// Smooth noise in [0, 1] along the curtains, one value every `long` km, without a seam round a closed chain, shifted by `gone` values.
    fn noise_along(&self, curve: usize, t: f64, long: f64, gone: f64, channel: u32) -> f64 {
        let link = self.links[curve];
        let round = (link.total / long).round().max(1.0);
        let (values, round) = if link.closed { (round / link.total.max(1e-6), round) } else { (1.0 / long, f64::INFINITY) };
        let channel = self.plan.seed.wrapping_mul(7919).wrapping_add(link.chain as u32 * 2 + channel);
        smooth_noise(channel, (link.start + t * self.layout.lengths[curve]) * values - gone, round)
    }

    /// The potential on the grid after the last step, V (mV/m times km), row by row from low x and y: for tests and charts.
    pub fn potential(&self) -> &[f64] {
        &self.grid
    }

    /// The field at a point, in mV/m, by the charges as they were before the last step.
    pub fn field_at(&self, place: DVec2) -> DVec2 {
        self.far_at(place) + self.near.field_at(place)
    }

    /// The charges as they were before the last step.
    pub fn charges(&self) -> &[Charge] {
        self.near.charges()
    }

    /// The middle of the grounded square and its side, km.
    pub fn square(&self) -> (DVec2, f64) {
        (self.centre, self.side)
    }

    /// The field of the grid: of all charges as Gaussians of a cell's width.
    fn far_at(&self, place: DVec2) -> DVec2 {
        let spacing = self.spacing();
        let p = (place - self.centre + 0.5 * self.side) / spacing - 1.0;
        if !p.is_finite() {
            return DVec2::ZERO;
        }
        let potential = |i: i64, j: i64| {
            let inside = |k: i64| (0..GRID as i64).contains(&k);
            if inside(i) && inside(j) { self.grid[j as usize * GRID + i as usize] } else { 0.0 }
        };
        let (i, j) = (p.x.floor() as i64, p.y.floor() as i64);
        let s = p - DVec2::new(i as f64, j as f64);
        // Central differences of fourth order: those of second order are too small by a twelfth where the pairs take over from the grid.
        let at = |i: i64, j: i64| {
            let near = DVec2::new(potential(i + 1, j) - potential(i - 1, j), potential(i, j + 1) - potential(i, j - 1));
            let far = DVec2::new(potential(i + 2, j) - potential(i - 2, j), potential(i, j + 2) - potential(i, j - 2));
            -(8.0 * near - far) / (12.0 * spacing)
        };
        at(i, j).lerp(at(i + 1, j), s.x).lerp(at(i, j + 1).lerp(at(i + 1, j + 1), s.x), s.y)
    }

    fn spacing(&self) -> f64 {
        self.side / (GRID + 1) as f64
    }

    /// The charge of each node: that of its share of the curve at rest, half as much at the ends. Stretching thins it out. It is negative,
    /// as of electrons.
    fn charge(&self) -> impl Iterator<Item = Charge> {
        self.layout.starts.windows(2).enumerate().flat_map(move |(curve, window)| {
            let share = -2.0 * self.plan.field * self.layout.lengths[curve] / (window[1] - window[0] - 1) as f64;
            (window[0]..window[1]).map(move |k| {
                let part = if k == window[0] || k + 1 == window[1] { 0.5 } else { 1.0 };
                Charge { place: self.nodes[k].place, amount: share * part * self.nodes[k].flux }
            })
        })
    }

    /// Lays the charges on the grid, cloud in cell: ρ/ε₀ in mV/m per km.
    fn lay_out(&mut self, charges: &[Charge]) {
        self.grid.fill(0.0);
        let spacing = self.spacing();
        for charge in charges {
            let p = (charge.place - self.centre + 0.5 * self.side) / spacing - 1.0;
            let (i, j) = (p.x.floor(), p.y.floor());
            let s = p - DVec2::new(i, j);
            for (di, dj, weight) in
                [(0, 0, (1.0 - s.x) * (1.0 - s.y)), (1, 0, s.x * (1.0 - s.y)), (0, 1, (1.0 - s.x) * s.y), (1, 1, s.x * s.y)]
            {
                let (i, j) = (i as i64 + di, j as i64 + dj);
                if (0..GRID as i64).contains(&i) && (0..GRID as i64).contains(&j) {
                    self.grid[j as usize * GRID + i as usize] += charge.amount * weight / (spacing * spacing);
                }
            }
        }
    }

    /// Brightness that travels along the curtains, at a node: two octaves of smooth noise at different speeds, without a seam round a closed
    /// chain.
    fn flux(&self, k: usize) -> f64 {
        let (curve, t, _) = self.rest[k];
        let link = self.links[curve];
        let end = |joined: Option<usize>, t: f64| if joined.is_some() { 1.0 } else { smooth((t / FADE_OUT).min(1.0)) };
        let fade = end(link.joined[0], t) * end(link.joined[1], 1.0 - t);
        let wave = [0, 1].map(|octave: usize| {
            let (long, passing) = WAVES[octave];
            self.noise_along(curve, t, long, self.time / passing, octave as u32)
        });
        fade * (1.0 + self.plan.contrast.clamp(0.0, 1.0) * (WAVE_WEIGHTS[0] * wave[0] + WAVE_WEIGHTS[1] * wave[1] - 1.0))
    }
}

/// The drift E × B/B² in a field (mV/m), in km s⁻¹. B points down, so the drift is E turned to the left as seen from above. 1 mV/m over 1 T
/// is 1e-6 km/s.
fn drift(field: DVec2) -> DVec2 {
    field.perp() * (1e-6 / FIELD)
}

/// The jump U of the drift across a long straight curtain, in km s⁻¹, with a field (mV/m) towards it on both sides.
pub fn jump(field: f64) -> f64 {
    2.0 * field * (1e-6 / FIELD)
}

/// Smooth noise in [0, 1], one value per unit of `x`, with period `round`.
fn smooth_noise(channel: u32, x: f64, round: f64) -> f64 {
    let cell = x.floor();
    let s = x - cell;
    let at = |k: f64| f64::from(uniform(channel, (if round.is_finite() { k.rem_euclid(round) } else { k }) as i64 as u32, 77));
    at(cell) + (at(cell + 1.0) - at(cell)) * smooth(s)
}

/// From 0 to 1 with slope 0 at both ends.
fn smooth(s: f64) -> f64 {
    s * s * (3.0 - 2.0 * s)
}

/// Length of a curve, km, by 256 chords.
pub fn length(curve: &Curve) -> f64 {
    (0..256).map(|k| curve.point(f64::from(k) / 256.0).distance(curve.point(f64::from(k + 1) / 256.0))).sum()
}
