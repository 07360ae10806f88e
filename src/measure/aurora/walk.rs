//! The walks: from electrons to luminous points on the screen.
//!
//! Collisions are dealt out evenly: with one random number u for each electron, the collisions above a level are ⌊n·spent + u⌋. Their mean is
//! exactly n·spent at every level, and the sum is n to within one collision, so no energy is lost or made.

use glam::{Vec2, Vec3};

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
    /// The camera.
    pub eye: &'a Eye,
    /// The fall.
    pub falls: &'a Falls,
    /// Chords, for the exact walks; without it each streak has one, of its own.
    pub lattice: Option<&'a Lattice>,
    /// Which random numbers.
    pub seed: u32,
}

/// The electron's own key, and the random number that deals out its collisions.
fn key(streak: &Streak, seed: u32) -> (u32, f32) {
    let key = hash(streak.id.wrapping_add(hash(seed)));
    (key, (key >> 8) as f32 / 16_777_216.0)
}

/// Two numbers in [−1, 1) for the way astray at a level.
fn astray(key: u32, level: usize) -> [f32; 2] {
    let bits = hash(key.wrapping_add(level as u32 + 1));
    [(bits >> 16) as f32 / 32_768.0 - 1.0, (bits & 65_535) as f32 / 32_768.0 - 1.0]
}

/// Two unit vectors across the field.
fn across() -> [Vec3; 2] {
    let up = field_direction().as_vec3();
    [Vec3::X, up.cross(Vec3::X)]
}

impl Walker<'_> {
    /// Adds the luminous points of one electron, by the method; points before the camera only.
    pub fn walk(&self, method: Method, streak: &Streak, out: &mut Vec<Point>) {
        match method {
            Method::Particles => self.particles(streak, out),
            Method::Linear => self.linear(streak, out),
            Method::Exact => self.exact(streak, out),
        }
    }

    /// The 3-D particle method: the position steps along the field and astray, the energy left follows from the air there, and each luminous
    /// point is projected.
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
                let [a, b] = astray(key, level);
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
    fn linear(&self, streak: &Streak, out: &mut Vec<Point>) {
        let eye = self.eye;
        let (a, b) = (eye.apparent(streak.top), eye.apparent(streak.end));
        let (Some(p), Some(q)) = (eye.screen(a), eye.screen(b)) else { return };
        let (scale_a, scale_b) = (eye.focal * eye.scale() / -a.z, eye.focal * eye.scale() / -b.z);
        let step = [q[0] - p[0], q[1] - p[1]];
        let per_km = 1.0 / (TOP as f32 - streak.end_height);
        // The way astray is measured by the streak's length on the screen, as in equation 4, so it is not foreshortened.
        let sway = step[0].hypot(step[1]) * per_km;
        self.collide(streak, |key, level, height, count| {
            let [ja, jb] = astray(key, level);
            let s = (TOP as f32 - height) * per_km;
            let away = self.falls.sway[level] * sway;
            let (x, y) = (p[0] + step[0] * s + ja * away, p[1] + step[1] * s + jb * away);
            out.push(Point { x, y, scale: scale_a + (scale_b - scale_a) * s, count, level: level as u32 });
        });
    }

    /// Between two projected ends the homogeneous coordinates are linear in height: one reciprocal a step. In flat space that is the projection
    /// itself; where light is bent, the lattice has chords enough.
    fn exact(&self, streak: &Streak, out: &mut Vec<Point>) {
        let mut project = self.projector(streak);
        self.collide(streak, |key, level, height, count| {
            if let Some([x, y, scale]) = project(key, level, height) {
                out.push(Point { x, y, scale, count, level: level as u32 });
            }
        });
    }

    /// From height to (x, y, pixels per km), for levels in falling order; None before the nearest depth and for what is not a number.
    fn projector(&self, streak: &Streak) -> impl FnMut(u32, usize, f32) -> Option<[f32; 3]> + use<'_> {
        let Walker { eye, lattice, falls, .. } = *self;
        let [e1, e2] = across().map(|e| eye.direction(e));
        let (half, focal, scale, near) = (eye.size.map(|side| 0.5 * side as f32), eye.focal, eye.scale(), eye.near());
        let top = Vec2::new(streak.top.x, streak.top.y);
        let lattice = lattice.filter(|_| eye.bent.is_some());
        let chord_length =
            lattice.map_or(TOP as f32 - streak.end_height, |lattice| (TOP as f32 - lattice.foot()) / lattice.chords() as f32);
        let (mut start, mut stop) = match lattice {
            Some(lattice) => (lattice.end(top, 0), lattice.end(top, 1)),
            None => (eye.apparent(streak.top), eye.apparent(streak.end)),
        };
        let sway = &falls.sway;
        let mut chord = 0;
        let mut high = TOP as f32;
        move |key, level, height| {
            while high - height > chord_length && lattice.is_some_and(|lattice| chord + 2 <= lattice.chords()) {
                chord += 1;
                high -= chord_length;
                (start, stop) = (stop, lattice.map_or(stop, |lattice| lattice.end(top, chord + 1)));
            }
            let [a, b] = astray(key, level);
            let c = start + (stop - start) * ((high - height) / chord_length) + (e1 * a + e2 * b) * sway[level];
            let depth = -c.z;
            // Also false for what is not a number.
            (depth > near).then(|| {
                let f = focal / depth;
                [half[0] + f * c.x, half[1] - f * c.y, f * scale]
            })
        }
    }

    /// Calls `at` with key, level, height and number of collisions for each level that has any.
    fn collide(&self, streak: &Streak, mut at: impl FnMut(u32, usize, f32, f32)) {
        let (key, u) = key(streak, self.seed);
        let spent = &self.falls.spent[streak.row as usize];
        // All levels at once, so that the compiler can take several together.
        let mut sums = [0i32; LEVELS];
        for (sum, &spent) in sums.iter_mut().zip(spent) {
            *sum = (spent * streak.collisions + u) as i32;
        }
        // Which levels have any, without a branch that could be guessed wrong.
        let mut found = [0u16; LEVELS + 1];
        let (mut length, mut before) = (0, u as i32);
        for (level, &now) in sums.iter().enumerate() {
            found[length] = level as u16;
            length += usize::from(now > before);
            before = now;
        }
        let mut before = u as i32;
        for &level in &found[..length] {
            let level = usize::from(level);
            at(key, level, self.falls.heights[level], (sums[level] - before) as f32);
            before = sums[level];
        }
    }
}
