//! The walks: from electrons to luminous points on the screen.
//!
//! Collisions are dealt out evenly: with one random number u for each electron, the collisions above a level are ⌊n·spent + u⌋. Their mean
//! is exactly n·spent at every level, and the sum is n to within one collision, so no energy is lost or made.

use glam::Vec3;

use super::eye::Eye;
use super::lattice::Lattice;
use super::sheet::{Falls, LEVELS, Streak, TOP, field_direction, row_reach};
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

/// The collisions of an electron at one level.
#[derive(Clone, Copy, Debug, Default)]
struct Step {
    level: u32,
    count: f32,
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

/// Two numbers in [−1, 1) for the way astray at a level.
fn astray(key: u32, level: u32) -> [f32; 2] {
    let bits = hash(key.wrapping_add(level + 1));
    [bits >> 16, bits & 65_535].map(|half| half as f32 * (1.0 / 32_768.0) - 1.0)
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
    pub fn walk(&self, method: Method, streaks: &[Streak], out: &mut Vec<Point>) {
        let mut steps = [Step::default(); LEVELS];
        for streak in streaks {
            // The electron's own key, and the random number that deals out its collisions.
            let key = hash(streak.id.wrapping_add(hash(self.seed)));
            let u = (key >> 8) as f32 / 16_777_216.0;
            match method {
                Method::Particles => self.particles(streak, key, u, out),
                Method::Tabled => self.tabled(streak, key, self.deal(streak, u, &mut steps), out),
                Method::Linear => self.linear(streak, key, self.deal(streak, u, &mut steps), out),
                Method::Exact => self.exact(streak, key, self.deal(streak, u, &mut steps), out),
            }
        }
    }

    /// The levels at which an electron collides, from the top down, by the table of falls.
    fn deal<'s>(&self, streak: &Streak, u: f32, steps: &'s mut [Step; LEVELS]) -> &'s [Step] {
        let row = streak.row as usize;
        let (mut length, mut above) = (0, 0);
        for (level, spent) in self.falls.spent[row][1..=self.falls.stops[row]].iter().enumerate() {
            let below = (spent * streak.collisions + u) as i32;
            // Every level is written, and one without collisions written over: which have some cannot be foretold.
            steps[length] = Step { level: level as u32, count: (below - above) as f32 };
            length += usize::from(below > above);
            above = below;
        }
        &steps[..length]
    }

    /// A luminous point at an apparent place, unless it is nearer than the nearest depth or not a number.
    fn luminous(&self, seen: Vec3, Step { level, count }: Step, out: &mut Vec<Point>) {
        let eye = self.eye;
        if let Some([x, y]) = eye.screen(seen) {
            out.push(Point { x, y, scale: eye.focal * eye.scale() / -seen.z, count, level });
        }
    }

    /// Where an electron is at a level, km: along its field line, and astray.
    fn place(&self, streak: &Streak, along: Vec3, [e1, e2]: [Vec3; 2], key: u32, level: u32) -> Vec3 {
        let [a, b] = astray(key, level);
        let (height, sway) = (self.falls.heights[level as usize], self.falls.sway[level as usize]);
        streak.top + along * (TOP as f32 - height) + (e1 * a + e2 * b) * sway
    }

    /// The 3-D particle method: the position steps along the field and astray, the energy left follows from the air there, and each
    /// luminous point is projected.
    fn particles(&self, streak: &Streak, key: u32, u: f32, out: &mut Vec<Point>) {
        let along = (streak.end - streak.top) / (TOP as f32 - streak.end_height);
        let across = across();
        let reach = row_reach(streak.row as usize);
        let mut above = 0;
        for level in 0..LEVELS as u32 {
            let left = fall::share_left(self.falls.overheads[level as usize], reach);
            let below = ((1.0 - left) as f32 * streak.collisions + u) as i32;
            if below > above {
                let place = self.place(streak, along, across, key, level);
                self.luminous(self.eye.apparent(place), Step { level, count: (below - above) as f32 }, out);
                above = below;
            }
            if left <= 0.0 {
                break;
            }
        }
    }

    /// The particle method at the steps that a table deals out.
    fn tabled(&self, streak: &Streak, key: u32, steps: &[Step], out: &mut Vec<Point>) {
        let along = (streak.end - streak.top) / (TOP as f32 - streak.end_height);
        let across = across();
        for step in steps {
            self.luminous(self.eye.apparent(self.place(streak, along, across, key, step.level)), *step, out);
        }
    }

    /// Equations 3 to 5 of Sekiguchi et al.: equal parts of the fall are equal parts of the screen distance; radius and depth likewise.
    fn linear(&self, streak: &Streak, key: u32, steps: &[Step], out: &mut Vec<Point>) {
        let eye = self.eye;
        let (a, b) = (eye.apparent(streak.top), eye.apparent(streak.end));
        let (Some(p), Some(q)) = (eye.screen(a), eye.screen(b)) else { return };
        let (scale_a, scale_b) = (eye.focal * eye.scale() / -a.z, eye.focal * eye.scale() / -b.z);
        let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
        let per_km = 1.0 / (TOP as f32 - streak.end_height);
        // The way astray is measured by the streak's length on the screen, as in equation 4, so it is not foreshortened.
        let pixels_per_km = dx.hypot(dy) * per_km;
        out.extend(steps.iter().map(|&Step { level, count }| {
            let [a, b] = astray(key, level);
            let s = (TOP as f32 - self.falls.heights[level as usize]) * per_km;
            let away = self.falls.sway[level as usize] * pixels_per_km;
            Point { x: p[0] + dx * s + a * away, y: p[1] + dy * s + b * away, scale: scale_a + (scale_b - scale_a) * s, count, level }
        }));
    }

    /// Between two projected ends the homogeneous coordinates are linear in height: one reciprocal a step. In flat space that is the
    /// projection itself; where light is bent, the lattice has chords enough.
    fn exact(&self, streak: &Streak, key: u32, steps: &[Step], out: &mut Vec<Point>) {
        let high = TOP as f32;
        let Some(lattice) = self.lattice.filter(|_| self.eye.bent.is_some()) else {
            let ends = [self.eye.apparent(streak.top), self.eye.apparent(streak.end)];
            self.chord(key, steps, ends, [high, streak.end_height], out);
            return;
        };
        let length = (high - lattice.foot()) / lattice.chords() as f32;
        let mut rest = steps;
        let mut start = lattice.end(streak.top.truncate(), 0);
        for k in 0..lattice.chords() {
            if rest.is_empty() {
                break;
            }
            let stop = lattice.end(streak.top.truncate(), k + 1);
            let ends = [high - length * k as f32, high - length * (k + 1) as f32];
            // Steps fall: those of this chord come first, and the last chord takes the rest.
            let above = |step: &Step| self.falls.heights[step.level as usize] >= ends[1];
            let count = if k + 1 == lattice.chords() { rest.len() } else { rest.partition_point(above) };
            self.chord(key, &rest[..count], [start, stop], ends, out);
            rest = &rest[count..];
            start = stop;
        }
    }

    /// The steps between two projected ends, at the heights `ends`, km.
    fn chord(&self, key: u32, steps: &[Step], [start, stop]: [Vec3; 2], ends: [f32; 2], out: &mut Vec<Point>) {
        let [e1, e2] = self.across;
        let down = (stop - start) / (ends[0] - ends[1]);
        for step in steps {
            let [a, b] = astray(key, step.level);
            let (height, sway) = (self.falls.heights[step.level as usize], self.falls.sway[step.level as usize]);
            self.luminous(start + down * (ends[0] - height) + (e1 * a + e2 * b) * sway, *step, out);
        }
    }
}
