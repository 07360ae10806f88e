//! The motion of the curtains in the plane across the field: charge → potential → electric field → drift (paper 3, 2.4).
//!
//! The electrons that come down charge the sheet negatively. The charges are laid on a grid (cloud in cell), −∇²V = ρ/ε₀ is solved with V = 0 on
//! the edge of the square ([`Poisson`]), E = −∇V by central differences, and every node drifts with E × B/B², which is what the Lorentz force
//! leaves of a charge's motion once its gyration (a microsecond for electrons) is averaged away. A charged sheet in this drift is a vortex
//! sheet: it folds and curls by itself, in the north counterclockwise as seen from the ground (Hallinan and Davis 1970). New electrons keep arriving
//! where the curve was, so nodes are drawn back to it within the renewal time, and no fold winds up without end.

use glam::DVec2;

use super::curve::Curve;
use super::poisson::Poisson;
use super::random::uniform;

/// Inner points along the side of the grid.
pub const GRID: usize = 95;
/// Time between two steps, s. A node at the greatest speed moves a fraction of a cell in it.
pub const STEP: f64 = 0.5;
/// Strength of the field at the reference height, T (the Earth's at 67° N).
pub const FIELD: f64 = 5e-5;
/// No node drifts faster, km s⁻¹: the fastest seen in the ionosphere are near 4.
pub const TOP_SPEED: f64 = 4.0;

/// What moves, and how strongly.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The curves at rest.
    pub curves: Vec<Curve>,
    /// Nodes of all curves together; shared out by length.
    pub nodes: usize,
    /// Electric field toward a long straight curtain beside it, mV/m: the sheet's charge is −2 ε₀ of it.
    pub field: f64,
    /// Time in which new electrons take the place of old, s.
    pub renewal: f64,
    /// Contrast of the brightness that travels along the curtains, 0 to 1.
    pub contrast: f64,
    /// Which aurora.
    pub seed: u32,
}

/// A node of a curtain at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Place in the plane across the field, km.
    pub place: DVec2,
    /// Energy flux over its mean.
    pub flux: f64,
}

/// All curtains, stepping at a fixed rate.
#[derive(Clone, Debug)]
pub struct Motion {
    plan: Plan,
    /// Curve and place along it of each node.
    rest: Vec<(usize, f64)>,
    /// First node of each curve, and their number after the last.
    starts: Vec<usize>,
    /// Whether a curve goes on in another before its start and after its end.
    joined: Vec<[bool; 2]>,
    nodes: Vec<Node>,
    /// Speeds of the last step, for Adams and Bashforth's second-order step.
    speeds: Vec<DVec2>,
    time: f64,
    centre: DVec2,
    side: f64,
    poisson: Poisson,
    grid: Vec<f64>,
    caught: u64,
}

impl Motion {
    /// The curtains at rest at `time` (s).
    pub fn new(plan: Plan, time: f64) -> Self {
        let lengths: Vec<f64> = plan.curves.iter().map(length).collect();
        let total: f64 = lengths.iter().sum::<f64>().max(1e-6);
        let mut rest = Vec::new();
        let mut starts = vec![0];
        for (index, part) in lengths.iter().enumerate() {
            // At least a few, so that every curve can bend.
            let count = ((plan.nodes as f64 * part / total).round() as usize).max(8);
            rest.extend((0..count).map(|k| (index, k as f64 / (count - 1) as f64)));
            starts.push(rest.len());
        }
        let points: Vec<DVec2> = rest.iter().map(|&(curve, t)| plan.curves[curve].point(t)).collect();
        let low = points.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = points.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        // Twice as wide as the charges: the grounded frame is then far.
        let side = 2.0 * (high - low).max_element().max(10.0);
        let nodes: Vec<Node> = points.iter().map(|&place| Node { place, flux: 1.0 }).collect();
        let mut motion = Motion {
            speeds: vec![DVec2::ZERO; nodes.len()],
            rest,
            starts,
            joined: joints(&plan.curves),
            nodes,
            time,
            centre: 0.5 * (low + high),
            side,
            poisson: Poisson::new(GRID, side / (GRID + 1) as f64),
            grid: vec![0.0; GRID * GRID],
            caught: 0,
            plan,
        };
        motion.shine();
        motion
    }

    /// Time goes by (s) and brightness travels on, but nothing moves: an aurora that nobody has watched begins so, with a past.
    pub fn pass(&mut self, seconds: f64) {
        self.time += seconds;
        self.shine();
    }

    /// Strength of the field, renewal time and contrast as in [`Plan`], from now on.
    pub fn change(&mut self, field: f64, renewal: f64, contrast: f64) {
        (self.plan.field, self.plan.renewal, self.plan.contrast) = (field, renewal, contrast);
    }

    /// The time reached, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The nodes, curve after curve.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// First node of each curve, and after the last their number.
    pub fn starts(&self) -> &[usize] {
        &self.starts
    }

    /// Length of a curve at rest, km.
    pub fn rest_length(&self, curve: &Curve) -> f64 {
        length(curve)
    }

    /// Nodes whose speed was not finite, and that were put back to where they rest, so far.
    pub fn caught(&self) -> u64 {
        self.caught
    }

    /// One step of [`STEP`] seconds.
    pub fn step(&mut self) {
        self.charge();
        self.poisson.solve(&mut self.grid);
        self.time += STEP;
        for k in 0..self.nodes.len() {
            let (curve, t) = self.rest[k];
            let home = self.plan.curves[curve].point(t);
            let place = self.nodes[k].place;
            let field = self.field_at(place);
            // mV/m over T is mm/s·1000: 1e-3/B m/s, 1e-6/B km/s. The field points down, so E × B turns E to the left seen from above.
            let drift = (field.perp() * (1e-6 / FIELD)).clamp_length_max(TOP_SPEED);
            let speed = drift + (home - place) / self.plan.renewal.max(STEP);
            let next = place + (1.5 * speed - 0.5 * self.speeds[k]) * STEP;
            if next.is_finite() {
                self.nodes[k].place = next;
                self.speeds[k] = speed;
            } else {
                self.nodes[k].place = home;
                self.speeds[k] = DVec2::ZERO;
                self.caught += 1;
            }
        }
        self.shine();
    }

    /// The potential on the grid after the last step, V (mV/m times km), row by row from low x and y: for tests and charts.
    pub fn potential(&self) -> &[f64] {
        &self.grid
    }

    /// The field at a place after the last step, mV/m.
    pub fn field_at(&self, place: DVec2) -> DVec2 {
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
        let at = |i: i64, j: i64| {
            -DVec2::new(potential(i + 1, j) - potential(i - 1, j), potential(i, j + 1) - potential(i, j - 1)) / (2.0 * spacing)
        };
        at(i, j).lerp(at(i + 1, j), s.x).lerp(at(i, j + 1).lerp(at(i + 1, j + 1), s.x), s.y)
    }

    fn spacing(&self) -> f64 {
        self.side / (GRID + 1) as f64
    }

    /// Lays the charges on the grid: ρ/ε₀ in mV/m per km.
    fn charge(&mut self) {
        self.grid.fill(0.0);
        let spacing = self.spacing();
        for (curve, window) in self.starts.windows(2).enumerate() {
            let count = window[1] - window[0];
            // Each node carries the charge of its share of the curve at rest; stretching thins it out.
            // Electrons: it is negative.
            let charge = -2.0 * self.plan.field * length(&self.plan.curves[curve]) / count as f64 / (spacing * spacing);
            for node in &self.nodes[window[0]..window[1]] {
                let p = (node.place - self.centre + 0.5 * self.side) / spacing - 1.0;
                let (i, j) = (p.x.floor(), p.y.floor());
                let s = p - DVec2::new(i, j);
                for (di, dj, weight) in
                    [(0, 0, (1.0 - s.x) * (1.0 - s.y)), (1, 0, s.x * (1.0 - s.y)), (0, 1, (1.0 - s.x) * s.y), (1, 1, s.x * s.y)]
                {
                    let (i, j) = (i as i64 + di, j as i64 + dj);
                    if (0..GRID as i64).contains(&i) && (0..GRID as i64).contains(&j) {
                        self.grid[j as usize * GRID + i as usize] += charge * node.flux * weight;
                    }
                }
            }
        }
    }

    /// Brightness that travels along the curtains: two octaves of smooth noise, going at different speeds.
    fn shine(&mut self) {
        for k in 0..self.nodes.len() {
            let (curve, t) = self.rest[k];
            // A curtain that ends fades out over the last tenth of it.
            let end = |joined: bool, t: f64| if joined { 1.0 } else { smooth((t / 0.12).min(1.0)) };
            let fade = end(self.joined[curve][0], t) * end(self.joined[curve][1], 1.0 - t);
            let along = (k - self.starts[curve]) as f64;
            let channel = self.plan.seed.wrapping_mul(7919).wrapping_add(curve as u32 * 2);
            // Patterns a few dozen nodes long, passing a node in ten seconds or so.
            let wave = 0.65 * smooth_noise(channel, along / 41.0 - self.time / 23.0)
                + 0.35 * smooth_noise(channel + 1, along / 13.0 + self.time / 9.0);
            self.nodes[k].flux = fade * (1.0 + self.plan.contrast.clamp(0.0, 1.0) * (2.0 * wave - 1.0));
        }
    }
}

/// Noise in [0, 1], smooth, one value per unit of `x`.
fn smooth_noise(channel: u32, x: f64) -> f64 {
    let cell = x.floor();
    let s = x - cell;
    let at = |k: f64| f64::from(uniform(channel, k as i64 as u32, 77));
    at(cell) + (at(cell + 1.0) - at(cell)) * smooth(s)
}

/// From 0 to 1 with level ends.
fn smooth(s: f64) -> f64 {
    s * s * (3.0 - 2.0 * s)
}

/// For each curve whether another begins or ends where it starts, and where it ends.
fn joints(curves: &[Curve]) -> Vec<[bool; 2]> {
    let meets = |own: usize, place: DVec2| {
        let mut others = curves.iter().enumerate().filter(|(index, _)| *index != own);
        others.any(|(_, curve)| [0.0, 1.0].iter().any(|&t| curve.point(t).distance(place) < 1.0))
    };
    curves.iter().enumerate().map(|(index, curve)| [0.0, 1.0].map(|t| meets(index, curve.point(t)))).collect()
}

/// Length of a curve, km, by 256 chords.
fn length(curve: &Curve) -> f64 {
    (0..256).map(|k| curve.point(f64::from(k) / 256.0).distance(curve.point(f64::from(k + 1) / 256.0))).sum()
}
