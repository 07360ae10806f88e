//! The walks: from electrons to luminous points on the screen.
//!
//! Collisions are dealt out evenly: with one random number u for each electron, the collisions above a level are ⌊n·spent + u⌋. Their mean is
//! exactly n·spent at every level, and the sum is n to within one collision, so no energy is lost or made.

use glam::{Vec2, Vec3};

use super::collisions::Collisions;
use super::eye::Eye;
use super::lattice::Lattice;
use super::sheet::{Falls, LEVELS, Streak, TOP, field_direction, row_reach};
use crate::scene::aurora::fall;
use crate::scene::aurora::random::hash;

/// How luminous points are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Every collision happens in space and is projected from there: the method of Kojima and others (2012) that the paper compares with.
    Particles,
    /// The paper's walk: end points are projected, everything between is linear on the screen.
    Linear,
    /// Ends of chords are projected; the parameter in space is walked, homogeneous coordinates are interpolated.
    Exact,
}

impl Method {
    /// All of them, and their names.
    pub const ALL: [(Method, &'static str); 3] = [(Method::Particles, "particles"), (Method::Linear, "linear"), (Method::Exact, "exact")];
}

/// A luminous point on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Pixels from the upper left corner.
    pub x: f32,
    /// Downwards.
    pub y: f32,
    /// Pixels per km there.
    pub scale: f32,
    /// Collisions.
    pub count: f32,
    /// Level of height.
    pub level: u32,
}

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
#[target_feature(enable = "avx2,bmi1")]
fn walk_avx(walker: &Walker, method: Method, streaks: &[Streak], out: &mut Vec<Point>) {
    walker.walk_all(method, streaks, out);
}

/// Two unit vectors across the field.
fn across() -> [Vec3; 2] {
    let up = field_direction().as_vec3();
    [Vec3::X, up.cross(Vec3::X)]
}

impl<'a> Walker<'a> {
    /// Walks by `eye`; `lattice` has the chords of the exact walk where light is bent (without it each streak has one, of its own); `seed` says
    /// which random numbers.
    pub fn new(eye: &'a Eye, falls: &'a Falls, lattice: Option<&'a Lattice>, seed: u32) -> Self {
        Walker { eye, falls, lattice, seed, across: across().map(|e| eye.direction(e)) }
    }

    /// Adds the luminous points of the electrons, by the method; points before the camera only.
    pub fn walk(&self, method: Method, streaks: &[Streak], out: &mut Vec<Point>) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("bmi1") {
            #[allow(unsafe_code)]
            // SAFETY: the instructions were detected. They make the walks half as long; the results are the same bits.
            return unsafe { walk_avx(self, method, streaks, out) };
        }
        self.walk_all(method, streaks, out);
    }

    #[inline(always)]
    fn walk_all(&self, method: Method, streaks: &[Streak], out: &mut Vec<Point>) {
        let mut steps = Collisions::default();
        let mut screen = Screen { x: [0.0; LEVELS], y: [0.0; LEVELS], scale: [0.0; LEVELS], depth: [0.0; LEVELS] };
        match method {
            Method::Particles => streaks.iter().for_each(|streak| self.particles(streak, out)),
            Method::Linear => streaks.iter().for_each(|streak| self.linear(streak, &mut steps, out)),
            Method::Exact => streaks.iter().for_each(|streak| self.exact(streak, &mut steps, &mut screen, out)),
        }
    }

    /// The 3-D particle method: the position steps along the field and astray, the energy left follows from the air there, and each luminous
    /// point is projected.
    #[inline(always)]
    fn particles(&self, streak: &Streak, out: &mut Vec<Point>) {
        let Walker { eye, falls, .. } = *self;
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
                let apparent = eye.apparent(position);
                if let Some([x, y]) = eye.screen(apparent) {
                    let scale = eye.focal * eye.scale() / -apparent.z;
                    out.push(Point { x, y, scale, count: (now - before) as f32, level: level as u32 });
                }
                before = now;
            }
            if left <= 0.0 {
                break;
            }
        }
    }

    /// Equations 3 to 5 of the paper: equal parts of the fall are equal parts of the screen distance; radius and depth likewise.
    #[inline(always)]
    fn linear(&self, streak: &Streak, steps: &mut Collisions, out: &mut Vec<Point>) {
        let eye = self.eye;
        let (a, b) = (eye.apparent(streak.top), eye.apparent(streak.end));
        let (Some(p), Some(q)) = (eye.screen(a), eye.screen(b)) else { return };
        let (scale_a, scale_b) = (eye.focal * eye.scale() / -a.z, eye.focal * eye.scale() / -b.z);
        let step = [q[0] - p[0], q[1] - p[1]];
        let per_km = 1.0 / (TOP as f32 - streak.end_height);
        // The way astray is measured by the streak's length on the screen, as in equation 4, so it is not foreshortened.
        let sway = step[0].hypot(step[1]) * per_km;
        let (key, u) = key(streak, self.seed);
        steps.deal(self.falls, streak.row as usize, streak.collisions, u);
        out.extend((0..steps.length).map(|k| {
            let level = steps.level[k];
            let [ja, jb] = astray(key, level);
            let s = (TOP as f32 - steps.height[k]) * per_km;
            let away = steps.sway[k] * sway;
            let (x, y) = (p[0] + step[0] * s + ja * away, p[1] + step[1] * s + jb * away);
            Point { x, y, scale: scale_a + (scale_b - scale_a) * s, count: steps.count[k], level }
        }));
    }

    /// Between two projected ends the homogeneous coordinates are linear in height: one reciprocal a step. In flat space that is the projection
    /// itself; where light is bent, the lattice has chords enough.
    #[inline(always)]
    fn exact(&self, streak: &Streak, steps: &mut Collisions, screen: &mut Screen, out: &mut Vec<Point>) {
        let (key, u) = key(streak, self.seed);
        steps.deal(self.falls, streak.row as usize, streak.collisions, u);
        let high = TOP as f32;
        let Some(lattice) = self.lattice.filter(|_| self.eye.bent.is_some()) else {
            let chord = (self.eye.apparent(streak.top), self.eye.apparent(streak.end));
            self.chord(key, steps, 0..steps.length, chord, [high, streak.end_height], screen, out);
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
            let count = if k + 1 == lattice.chords() { rest.len() } else { rest.partition_point(|height| *height >= ends[1]) };
            self.chord(key, steps, first..first + count, (start, stop), ends, screen, out);
            first += count;
            start = stop;
        }
    }

    /// The steps `range` between two projected ends, at the heights `ends`. Points before the nearest depth are left out, and what is not a number.
    #[inline(always)]
    #[allow(clippy::too_many_arguments, reason = "a chord, what is walked along it, and where the points go")]
    fn chord(
        &self,
        key: u32,
        steps: &Collisions,
        range: std::ops::Range<usize>,
        (start, stop): (Vec3, Vec3),
        ends: [f32; 2],
        screen: &mut Screen,
        out: &mut Vec<Point>,
    ) {
        let eye = self.eye;
        let [e1, e2] = self.across;
        let (half, focal, scale) = (eye.size.map(|side| 0.5 * side as f32), eye.focal, eye.focal * eye.scale());
        let down = (stop - start) / (ends[0] - ends[1]);
        let count = range.len();
        let (level, height, sway) = (&steps.level[range.clone()], &steps.height[range.clone()], &steps.sway[range.clone()]);
        // Columns of numbers without a branch, so that the compiler can take several together.
        for k in 0..count {
            let [a, b] = astray(key, level[k]);
            let (a, b, t) = (a * sway[k], b * sway[k], ends[0] - height[k]);
            let depth = -(start.z + down.z * t + e1.z * a + e2.z * b);
            let inverse = 1.0 / depth;
            screen.depth[k] = depth;
            screen.x[k] = half[0] + (start.x + down.x * t + e1.x * a + e2.x * b) * (focal * inverse);
            screen.y[k] = half[1] - (start.y + down.y * t + e1.y * a + e2.y * b) * (focal * inverse);
            screen.scale[k] = scale * inverse;
        }
        let near = eye.near();
        let counts = &steps.count[range];
        let Screen { x, y, scale, depth } = screen;
        let (x, y, scale, depth) = (&x[..count], &y[..count], &scale[..count], &depth[..count]);
        let point = |k: usize| Point { x: x[k], y: y[k], scale: scale[k], count: counts[k], level: level[k] };
        // Mostly all are before the camera, and a known number of points is added faster than one by one. The test is false for what is not a
        // number, too.
        if depth.iter().fold(true, |all, depth| all & (*depth > near)) {
            out.extend((0..count).map(point));
        } else {
            out.extend((0..count).filter(|&k| depth[k] > near).map(point));
        }
    }
}

/// Where the steps of a chord fall on the screen.
struct Screen {
    x: [f32; LEVELS],
    y: [f32; LEVELS],
    scale: [f32; LEVELS],
    depth: [f32; LEVELS],
}
