//! The walks: from electrons to luminous points on the screen.

use glam::Vec3;

use super::eye::Eye;
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
    /// End points are projected; the parameter in space is walked, homogeneous coordinates are interpolated.
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

/// Sidewards speed over speed along the field that collisions give, at most: a fall is off by a kilometre or so at its end.
const JITTER: f32 = 0.01;

/// Random numbers of one level of one electron: for the collisions, and two for going astray in [−1, 1).
fn randoms(key: u32, level: usize) -> [f32; 3] {
    let bits = hash(key.wrapping_add(level as u32));
    let unit = 1.0 / 65_536.0;
    // Sixteen bits for the collisions, eight for each direction of what is a small displacement.
    [(bits >> 16) as f32 * unit, ((bits >> 8) & 255) as f32 * (2.0 / 256.0) - 1.0, (bits & 255) as f32 * (2.0 / 256.0) - 1.0]
}

/// The luminous points of one electron, by the method; points before the camera only. `tolerance` in pixels is the error allowed to the chords
/// of the exact walk where light is bent.
pub fn walk(method: Method, eye: &Eye, falls: &Falls, streak: &Streak, seed: u32, tolerance: f32, out: &mut Vec<Point>) {
    match method {
        Method::Particles => particles(eye, falls, streak, seed, out),
        Method::Linear => linear(eye, falls, streak, seed, out),
        Method::Exact => exact(eye, falls, streak, seed, tolerance, out),
    }
}

/// Two unit vectors across the field.
fn across() -> [Vec3; 2] {
    let up = field_direction().as_vec3();
    let east = Vec3::X;
    [east, up.cross(east)]
}

/// The 3-D particle method: the position steps along the field and astray, the air there is looked up, and each luminous point is projected.
fn particles(eye: &Eye, falls: &Falls, streak: &Streak, seed: u32, out: &mut Vec<Point>) {
    let along = (streak.end - streak.top) / (TOP as f32 - streak.end_height);
    let [e1, e2] = across();
    let reach = row_reach(streak.row as usize);
    let key = hash(streak.id.wrapping_add(hash(seed)));
    let (mut height, mut position) = (TOP as f32, streak.top);
    let mut left = 1.0;
    for level in 0..LEVELS {
        let step = height - falls.heights[level];
        height = falls.heights[level];
        let [u, a, b] = randoms(key, level);
        position += along * step + (e1 * a + e2 * b) * (JITTER * step);
        // What is left by the air overhead at this place.
        let after = fall::share_left(falls.overheads[level], reach);
        let count = ((left - after) as f32 * streak.collisions + u).floor();
        left = after;
        if count > 0.0 {
            let apparent = eye.apparent(position);
            if let Some([x, y]) = eye.screen(apparent) {
                out.push(Point { x, y, scale: eye.focal * eye.scale() / -apparent.z, count, level: level as u32 });
            }
        }
        if after <= 0.0 {
            break;
        }
    }
}

/// Equations 3 to 5 of the paper: equal parts of the fall are equal parts of the screen distance; radius and depth likewise.
fn linear(eye: &Eye, falls: &Falls, streak: &Streak, seed: u32, out: &mut Vec<Point>) {
    let (a, b) = (eye.apparent(streak.top), eye.apparent(streak.end));
    let (Some(p), Some(q)) = (eye.screen(a), eye.screen(b)) else { return };
    let (scale_a, scale_b) = (eye.focal * eye.scale() / -a.z, eye.focal * eye.scale() / -b.z);
    let step = [q[0] - p[0], q[1] - p[1]];
    let length = step[0].hypot(step[1]);
    let key = hash(streak.id.wrapping_add(hash(seed)));
    let per_km = 1.0 / (TOP as f32 - streak.end_height);
    let losses = &falls.losses[streak.row as usize];
    let (mut height, mut astray) = (TOP as f32, [0.0f32; 2]);
    for (level, (&below, &loss)) in falls.heights.iter().zip(losses).enumerate() {
        let part = (height - below) * per_km;
        height = below;
        let [u, ja, jb] = randoms(key, level);
        astray[0] += ja * JITTER * part * length;
        astray[1] += jb * JITTER * part * length;
        let count = (loss * streak.collisions + u).floor();
        if count > 0.0 {
            let s = (TOP as f32 - height) * per_km;
            let scale = scale_a + (scale_b - scale_a) * s;
            out.push(Point { x: p[0] + step[0] * s + astray[0], y: p[1] + step[1] * s + astray[1], scale, count, level: level as u32 });
        }
    }
}

/// Most chords of one streak.
const MOST_CHORDS: usize = 8;

/// Between two projected ends the homogeneous coordinates are linear in height: one reciprocal a step. In flat space that is the projection
/// itself; where light is bent, the streak is halved into chords until the middle of each is within the tolerance.
fn exact(eye: &Eye, falls: &Falls, streak: &Streak, seed: u32, tolerance: f32, out: &mut Vec<Point>) {
    let mut ends = [(0.0f32, Vec3::ZERO); MOST_CHORDS + 1];
    let count = chords(eye, streak, tolerance, &mut ends);
    // Apparent places that are not finite are not drawn: the lookup has no ray there.
    let key = hash(streak.id.wrapping_add(hash(seed)));
    let losses = &falls.losses[streak.row as usize];
    let [e1, e2] = across().map(|e| eye.direction(e));
    let per_km = 1.0 / (TOP as f32 - streak.end_height);
    let (half, focal, scale, near) = (eye.size.map(|side| 0.5 * side as f32), eye.focal, eye.scale(), eye.near());
    // How far astray by level, in km, before anything is projected: sums of the same numbers that the particle method adds up.
    let mut place = [[0.0f32; 4]; LEVELS];
    let (mut height, mut astray) = (TOP as f32, [0.0f32; 2]);
    let mut last = 0;
    for (level, (&below, &loss)) in falls.heights.iter().zip(losses).enumerate() {
        let step = (height - below) * JITTER;
        height = below;
        let [u, ja, jb] = randoms(key, level);
        astray = [astray[0] + ja * step, astray[1] + jb * step];
        place[level] = [astray[0], astray[1], (loss * streak.collisions + u).floor(), (TOP as f32 - height) * per_km];
        // Nothing is left below where the electron stops.
        last = level + 1;
        if height <= streak.end_height {
            break;
        }
    }
    let mut chord = 0;
    for (level, &[a, b, hits, s]) in place[..last].iter().enumerate() {
        if hits <= 0.0 {
            continue;
        }
        while chord + 2 < count && s > ends[chord + 1].0 {
            chord += 1;
        }
        let (s0, c0) = ends[chord];
        let (s1, c1) = ends[chord + 1];
        let c = c0 + (c1 - c0) * ((s - s0) / (s1 - s0)) + e1 * a + e2 * b;
        let depth = -c.z;
        // Also false for what is not a number.
        if depth > near {
            let f = focal / depth;
            out.push(Point { x: half[0] + f * c.x, y: half[1] - f * c.y, scale: f * scale, count: hits, level: level as u32 });
        }
    }
}

/// The ends of the chords, (share of the way from top to end, apparent place), and how many there are.
fn chords(eye: &Eye, streak: &Streak, tolerance: f32, ends: &mut [(f32, Vec3); MOST_CHORDS + 1]) -> usize {
    let at = |s: f32| eye.apparent(streak.top + (streak.end - streak.top) * s);
    ends[0] = (0.0, at(0.0));
    if eye.bent.is_none() {
        ends[1] = (1.0, at(1.0));
        return 2;
    }
    // The middle is projected in any case: it is the measure of the error, and an end of two chords where the error is too large.
    let (a, middle, b) = (ends[0].1, at(0.5), at(1.0));
    let mut pieces = 1;
    let mut error = bend(eye, a, middle, b);
    while pieces < MOST_CHORDS && !(error <= tolerance) {
        pieces *= 2;
        // A smooth curve's error falls as the square of the chord.
        error *= 0.25;
    }
    for k in 1..=pieces {
        let s = k as f32 / pieces as f32;
        ends[k] = (
            s,
            if k == pieces {
                b
            } else if 2 * k == pieces {
                middle
            } else {
                at(s)
            },
        );
    }
    pieces + 1
}

/// Distance on the screen, pixels, between the middle as projected and as interpolated. An angle times the focal length, so that it holds
/// behind the camera too.
fn bend(eye: &Eye, a: Vec3, middle: Vec3, b: Vec3) -> f32 {
    let guess = 0.5 * (a + b);
    let cross = guess.cross(middle).length();
    eye.focal * cross / (guess.length() * middle.length()).max(1e-20)
}
