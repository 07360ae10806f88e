//! Chords for all electrons at once: apparent places on a lattice around the aurora, halved until everything between is right.
//!
//! Only the lattice's nodes go through the lookup; a streak takes the ends of its chords from it by bilinear interpolation of the
//! homogeneous coordinates. In flat space that interpolation is the projection itself, so one cell is enough.

use glam::{Vec2, Vec3};

use super::eye::Eye;
use super::sheet::{Streak, TOP, field_direction};

/// Most halvings along each axis.
const MOST_HALVINGS: [u32; 3] = [7, 6, 3];
/// The lattice follows the field down to this height, km.
const FOOT: f32 = 80.0;

/// Apparent places over (x, y) at the top and along the field downwards.
#[derive(Clone, Debug)]
pub struct Lattice {
    low: Vec2,
    /// Cells per km.
    per_km: Vec2,
    cells: [usize; 3],
    nodes: Vec<Vec3>,
}

impl Lattice {
    /// Around the streaks, with an error of at most about `tolerance` pixels at the middles of its cells.
    pub fn around(eye: &Eye, streaks: &[Streak], tolerance: f32) -> Lattice {
        let tops = || streaks.iter().map(|streak| streak.top.truncate()).filter(|top| top.is_finite() && top.length() < 1e5);
        let low = tops().fold(Vec2::INFINITY, Vec2::min);
        let high = tops().fold(Vec2::NEG_INFINITY, Vec2::max);
        let (low, high) = if low.is_finite() { (low - 0.1, high + 0.1) } else { (Vec2::ZERO, Vec2::ONE) };
        let mut halvings = [0u32; 3];
        if eye.bent.is_some() {
            let at = |s: Vec3| eye.apparent(point(low, high, s));
            // Along each axis the bend between two neighbours, in the worst of a few rows, falls as the square of the spacing.
            for (axis, most) in MOST_HALVINGS.into_iter().enumerate() {
                let mut worst = 0.0f32;
                for row in 0..9 {
                    for part in 0..4 {
                        let place = |s: f32| {
                            let (a, b) = ((row % 3) as f32 * 0.5, (row / 3) as f32 * 0.5);
                            let mut p = Vec3::splat(a);
                            p[(axis + 1) % 3] = a;
                            p[(axis + 2) % 3] = b;
                            p[axis] = (part as f32 + s) * 0.25;
                            p
                        };
                        worst = worst.max(bend(eye, at(place(0.0)), at(place(0.5)), at(place(1.0))));
                    }
                }
                // A quarter of the axis bends by `worst`; three axes share the tolerance.
                let mut error = 16.0 * worst;
                while error > tolerance / 3.0 && halvings[axis] < most {
                    error *= 0.25;
                    halvings[axis] += 1;
                }
            }
        }
        let cells = halvings.map(|halvings| 1usize << halvings);
        let [nx, ny, nz] = cells;
        let mut nodes = Vec::with_capacity((nx + 1) * (ny + 1) * (nz + 1));
        for k in 0..=nz {
            for j in 0..=ny {
                for i in 0..=nx {
                    let s = Vec3::new(i as f32 / nx as f32, j as f32 / ny as f32, k as f32 / nz as f32);
                    nodes.push(eye.apparent(point(low, high, s)));
                }
            }
        }
        Lattice { low, per_km: Vec2::new(nx as f32, ny as f32) / (high - low), cells, nodes }
    }

    /// Chords along a streak.
    pub fn chords(&self) -> usize {
        self.cells[2]
    }

    /// Height of the lower end of the last chord, km.
    pub fn foot(&self) -> f32 {
        FOOT
    }

    /// Apparent place of the streak whose top is at `top`, at the upper end of chord `k`.
    pub fn end(&self, top: Vec2, k: usize) -> Vec3 {
        let [nx, ny, _] = self.cells;
        let p = (top - self.low) * self.per_km;
        // A streak outside the lattice (not finite, or absurdly far) is extrapolated and then found to be out of the picture.
        let i = (p.x as usize).min(nx - 1);
        let j = (p.y as usize).min(ny - 1);
        let (s, t) = (p.x - i as f32, p.y - j as f32);
        let row = (k * (ny + 1) + j) * (nx + 1) + i;
        let node = |n: usize| self.nodes[n];
        let low = node(row) + (node(row + 1) - node(row)) * s;
        let high = node(row + nx + 1) + (node(row + nx + 2) - node(row + nx + 1)) * s;
        low + (high - low) * t
    }
}

/// The point at shares `s` of the lattice's box, which leans with the field.
fn point(low: Vec2, high: Vec2, s: Vec3) -> Vec3 {
    let up = field_direction().as_vec3();
    let top = low + (high - low) * s.truncate();
    top.extend(TOP as f32) - up * ((TOP as f32 - FOOT) * s.z / up.z)
}

/// Distance on the screen, pixels, between the middle as projected and as interpolated. An angle times the focal length, so that it holds
/// behind the camera too; 0 for what is not a number, of which nothing will be drawn.
fn bend(eye: &Eye, a: Vec3, middle: Vec3, b: Vec3) -> f32 {
    let guess = 0.5 * (a + b);
    let cross = guess.cross(middle).length();
    let bend = eye.focal * cross / (guess.length() * middle.length()).max(1e-20);
    if bend.is_finite() { bend } else { 0.0 }
}
