//! The walks: from electrons to luminous points on the screen.
//!
//! Collisions are dealt out evenly: with one random number u for each electron, the collisions above a level are ⌊n·spent + u⌋. Their mean
//! is exactly n·spent at every level, and the sum is n to within one collision, so no energy is lost or made.

use glam::{Vec2, Vec3};

use super::collisions::Collisions;
use super::lattice::Lattice;
use super::points::{Eight, LANES, Point, Points};
use crate::aurora::eye::Eye;
use crate::aurora::sheet::{Falls, LEVELS, Streak, TOP, field_direction, row_reach};
use lensrunner::scene::aurora::fall;
use lensrunner::scene::aurora::random::hash;

/// How luminous points are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Every collision happens in space and is projected from there: the method of Kojima et al. 2012 that Sekiguchi et al. compare with.
    Particles,
    /// The same with the fall tabulated, as the walks on the screen have it: what is left between the two is the walk's own share.
    Tabled,
    /// The walk of Sekiguchi et al.: end points are projected, everything between is linear on the screen.
    Linear,
    /// Ends of chords are projected; the parameter in space is walked, homogeneous coordinates are interpolated.
    Exact,
}

impl Method {
    /// All of them, and their names.
    pub const ALL: [(Method, &'static str); 4] =
        [(Method::Particles, "particles"), (Method::Tabled, "particles-tabled"), (Method::Linear, "linear"), (Method::Exact, "exact")];
}

/// Electrons whose collisions are dealt before the first of them is walked: numbers just stored one by one cannot be read together at once.
const TOGETHER: usize = 4;

/// What all walks of a frame share.
#[derive(Clone, Copy, Debug)]
pub struct Walker<'a> {
    eye: &'a Eye,
    falls: &'a Falls,
    lattice: Option<&'a Lattice>,
    seed: u32,
    /// Unit vectors across the field as the camera sees them.
    across: [Vec3; 2],
}

/// The electron's own key, and the random number that deals out its collisions.
fn key(streak: &Streak, seed: u32) -> (u32, f32) {
    let key = hash(streak.id.wrapping_add(hash(seed)));
    (key, (key >> 8) as f32 / 16_777_216.0)
}

/// Two numbers in [−1, 1) for the way astray at a level.
#[inline(always)]
fn astray(key: u32, level: u32) -> [f32; 2] {
    let bits = hash(key.wrapping_add(level + 1));
    // Through i32, for which processors have an instruction.
    [bits >> 16, bits & 65_535].map(|half| half as i32 as f32 * (1.0 / 32_768.0) - 1.0)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,popcnt")]
fn walk_avx(walker: &Walker, method: Method, streaks: &[Streak], out: &mut Points) {
    walker.walk_all::<true>(method, streaks, out);
}

/// Two unit vectors across the field.
pub fn across() -> [Vec3; 2] {
    let up = field_direction().as_vec3();
    [Vec3::X, up.cross(Vec3::X)]
}

impl<'a> Walker<'a> {
    /// Walks by `eye`; `lattice` has the chords of the exact walk where light is bent (without it each streak has one, of its own); `seed`
    /// says which random numbers.
    pub fn new(eye: &'a Eye, falls: &'a Falls, lattice: Option<&'a Lattice>, seed: u32) -> Self {
        Walker { eye, falls, lattice, seed, across: across().map(|e| eye.direction(e)) }
    }

    /// Adds the luminous points of the electrons, by the method; points before the camera only.
    pub fn walk(&self, method: Method, streaks: &[Streak], out: &mut Points) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("popcnt") {
            #[allow(unsafe_code)]
            // SAFETY: the instructions were detected.
            return unsafe { walk_avx(self, method, streaks, out) };
        }
        self.walk_plainly(method, streaks, out);
    }

    /// The same without instructions that only some processors have: the same bits.
    pub fn walk_plainly(&self, method: Method, streaks: &[Streak], out: &mut Points) {
        self.walk_all::<false>(method, streaks, out);
    }

    /// `AVX` may be said only where the processor has AVX2.
    // Plain loops: what is handed to an iterator as a closure is not always compiled into `walk_avx`, and then it lacks its instructions.
    #[inline(always)]
    fn walk_all<const AVX: bool>(&self, method: Method, streaks: &[Streak], out: &mut Points) {
        let mut steps: [Collisions; TOGETHER] = Default::default();
        for streaks in streaks.chunks(TOGETHER) {
            out.reserve(TOGETHER * LEVELS);
            if method != Method::Particles {
                for (streak, steps) in streaks.iter().zip(&mut steps) {
                    let (_, u) = key(streak, self.seed);
                    steps.deal::<AVX>(self.falls, streak.row as usize, streak.collisions, u);
                }
            }
            for (streak, steps) in streaks.iter().zip(&steps) {
                match method {
                    Method::Particles => self.particles(streak, out),
                    Method::Tabled => self.tabled(streak, steps, out),
                    Method::Linear => self.linear(streak, steps, out),
                    Method::Exact => self.exact(streak, steps, out),
                }
            }
        }
    }

    /// The 3-D particle method: the position steps along the field and astray, the energy left follows from the air there, and each
    /// luminous point is projected.
    #[inline(always)]
    fn particles(&self, streak: &Streak, out: &mut Points) {
        let falls = self.falls;
        let along = (streak.end - streak.top) / (TOP as f32 - streak.end_height);
        let [e1, e2] = across();
        let reach = row_reach(streak.row as usize);
        let (key, u) = key(streak, self.seed);
        let mut before = u as i32;
        for level in 0..LEVELS {
            let left = fall::share_left(falls.overheads[level], reach);
            let now = ((1.0 - left) as f32 * streak.collisions + u) as i32;
            if now > before {
                let [a, b] = astray(key, level as u32);
                let sway = falls.sway[level];
                let position = streak.top + along * (TOP as f32 - falls.heights[level]) + (e1 * a + e2 * b) * sway;
                self.luminous(position, (now - before) as f32, level as u32, out);
                before = now;
            }
            if left <= 0.0 {
                break;
            }
        }
    }

    /// A luminous point in space, projected.
    #[inline(always)]
    fn luminous(&self, position: Vec3, count: f32, level: u32, out: &mut Points) {
        let apparent = self.eye.apparent(position);
        if let Some([x, y]) = self.eye.screen(apparent) {
            let scale = self.eye.focal * self.eye.scale() / -apparent.z;
            out.push(Point { x, y, scale, count, level });
        }
    }

    /// The particle method at the steps that a table deals out.
    #[inline(always)]
    fn tabled(&self, streak: &Streak, steps: &Collisions, out: &mut Points) {
        let along = (streak.end - streak.top) / (TOP as f32 - streak.end_height);
        let [e1, e2] = across();
        let (key, _) = key(streak, self.seed);
        for (k, (level, count)) in steps.level[..steps.length].iter().zip(&steps.count).enumerate() {
            let [a, b] = astray(key, *level);
            let (height, sway) = (steps.height[k], steps.sway[k]);
            self.luminous(streak.top + along * (TOP as f32 - height) + (e1 * a + e2 * b) * sway, *count, *level, out);
        }
    }

    /// Equations 3 to 5 of Sekiguchi et al.: equal parts of the fall are equal parts of the screen distance; radius and depth likewise.
    #[inline(always)]
    fn linear(&self, streak: &Streak, steps: &Collisions, out: &mut Points) {
        let eye = self.eye;
        let (a, b) = (eye.apparent(streak.top), eye.apparent(streak.end));
        let (Some(p), Some(q)) = (eye.screen(a), eye.screen(b)) else { return };
        let (scale_a, scale_b) = (eye.focal * eye.scale() / -a.z, eye.focal * eye.scale() / -b.z);
        let step = [q[0] - p[0], q[1] - p[1]];
        let per_km = 1.0 / (TOP as f32 - streak.end_height);
        // The way astray is measured by the streak's length on the screen, as in equation 4, so it is not foreshortened.
        let sway = step[0].hypot(step[1]) * per_km;
        let (key, _) = key(streak, self.seed);
        for first in (0..steps.length).step_by(LANES) {
            let mut points = Eight { count: steps.count_of(first), level: steps.level_of(first), ..Eight::default() };
            let [heights, sways] = steps.places_of(first);
            for k in 0..LANES {
                let [ja, jb] = astray(key, points.level[k]);
                let (s, away) = ((TOP as f32 - heights[k]) * per_km, sways[k] * sway);
                points.x[k] = p[0] + step[0] * s + ja * away;
                points.y[k] = p[1] + step[1] * s + jb * away;
                points.scale[k] = scale_a + (scale_b - scale_a) * s;
            }
            out.push_eight(&points, LANES.min(steps.length - first));
        }
    }

    /// Between two projected ends the homogeneous coordinates are linear in height: one reciprocal a step. In flat space that is the
    /// projection itself; where light is bent, the lattice has chords enough.
    #[inline(always)]
    fn exact(&self, streak: &Streak, steps: &Collisions, out: &mut Points) {
        let (key, _) = key(streak, self.seed);
        let high = TOP as f32;
        let Some(lattice) = self.lattice.filter(|_| self.eye.bent.is_some()) else {
            let chord = (self.eye.apparent(streak.top), self.eye.apparent(streak.end));
            self.chord(key, steps, 0..steps.length, chord, [high, streak.end_height], out);
            return;
        };
        let top = Vec2::new(streak.top.x, streak.top.y);
        let length = (high - lattice.foot()) / lattice.chords() as f32;
        let mut first = 0;
        let mut start = lattice.end(top, 0);
        for k in 0..lattice.chords() {
            if first == steps.length {
                break;
            }
            let stop = lattice.end(top, k + 1);
            let ends = [high - length * k as f32, high - length * (k + 1) as f32];
            // Steps fall: those of this chord follow one another, and the last chord takes the rest.
            let rest = &steps.height[first..steps.length];
            let above = |height: &f32| *height >= ends[1];
            let count = if k + 1 == lattice.chords() { rest.len() } else { rest.partition_point(above) };
            self.chord(key, steps, first..first + count, (start, stop), ends, out);
            first += count;
            start = stop;
        }
    }

    /// The steps `range` between two projected ends, at the heights `ends`. Points before the nearest depth are left out, and what is not a
    /// number.
    #[inline(always)]
    fn chord(
        &self,
        key: u32,
        steps: &Collisions,
        range: std::ops::Range<usize>,
        (start, stop): (Vec3, Vec3),
        ends: [f32; 2],
        out: &mut Points,
    ) {
        let eye = self.eye;
        let [e1, e2] = self.across;
        let (half, focal, scale, near) = (eye.size.map(|side| 0.5 * side as f32), eye.focal, eye.focal * eye.scale(), eye.near());
        let down = (stop - start) / (ends[0] - ends[1]);
        for first in range.clone().step_by(LANES) {
            let mut points = Eight { count: steps.count_of(first), level: steps.level_of(first), ..Eight::default() };
            let [heights, sways] = steps.places_of(first);
            let mut depths = [0.0; LANES];
            // Columns of numbers without a branch, so that the compiler takes eight together.
            for k in 0..LANES {
                let [a, b] = astray(key, points.level[k]);
                let (a, b, t) = (a * sways[k], b * sways[k], ends[0] - heights[k]);
                let depth = -(start.z + down.z * t + e1.z * a + e2.z * b);
                let inverse = 1.0 / depth;
                depths[k] = depth;
                points.x[k] = half[0] + (start.x + down.x * t + e1.x * a + e2.x * b) * (focal * inverse);
                points.y[k] = half[1] - (start.y + down.y * t + e1.y * a + e2.y * b) * (focal * inverse);
                points.scale[k] = scale * inverse;
            }
            let count = LANES.min(range.end - first);
            // Mostly all are before the camera, those beyond the last too. The test is false for what is not a number.
            let mut all = true;
            for depth in depths {
                all &= depth > near;
            }
            if all {
                out.push_eight(&points, count);
            } else {
                for k in (0..count).filter(|&k| depths[k] > near) {
                    let (x, y, scale, count) = (points.x[k], points.y[k], points.scale[k], points.count[k]);
                    out.push(Point { x, y, scale, count, level: points.level[k] });
                }
            }
        }
    }
}
