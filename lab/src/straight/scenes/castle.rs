//! A castle of exactly as many triangles as that of Sei 2008, which was never published: long thin walls, tiny merlons and large pieces of
//! ground side by side, which is what makes it hard for packets of a fixed size.

use std::f64::consts::TAU;

use glam::DVec3;

use super::{SceneView, Triangle, rounded};

/// From a hill in front of the gate.
pub const VIEW: SceneView = SceneView::new([26.0, 15.0, 12.0], [0.0, 0.0, 2.5]);

/// Distance of the towers from the keep.
const RING: f64 = 10.0;
const TOWERS: usize = 8;

/// 33,276 triangles, about 40 units wide.
pub fn castle() -> Vec<Triangle> {
    let mut triangles = Vec::new();
    ground(&mut triangles);
    let corner = |i: usize| {
        let angle = TAU * (i as f64 + 0.5) / TOWERS as f64;
        DVec3::new(RING * angle.cos(), RING * angle.sin(), 0.0)
    };
    for i in 0..TOWERS {
        tower(&mut triangles, corner(i));
        wall(&mut triangles, corner(i), corner((i + 1) % TOWERS));
    }
    shaft(&mut triangles, DVec3::ZERO, 3.0, 9.0, 64, 20);
    spire(&mut triangles, DVec3::new(0.0, 0.0, 9.0), 3.3, 4.0, 60);
    triangles
}

/// A grid of 64 × 64 quads with low hills.
fn ground(triangles: &mut Vec<Triangle>) {
    const CELLS: usize = 64;
    let point = |i: usize, j: usize| {
        let [x, y] = [i, j].map(|k| 40.0 * (k as f64 / CELLS as f64 - 0.5));
        // Flat under the walls.
        let hills = ((x.hypot(y) - 13.0) / 6.0).clamp(0.0, 1.0);
        DVec3::new(x, y, hills * (0.8 * (0.7 * x).sin() * (0.9 * y).cos() + 0.3 * (2.3 * x + 1.7 * y).sin()) - 0.05)
    };
    for i in 0..CELLS {
        for j in 0..CELLS {
            quad(triangles, [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]);
        }
    }
}

fn quad(triangles: &mut Vec<Triangle>, [a, b, c, d]: [DVec3; 4]) {
    triangles.push(rounded([a, b, c]));
    triangles.push(rounded([c, d, a]));
}

/// A point of a circle around a vertical axis.
fn rim(centre: DVec3, radius: f64, k: usize, sides: usize) -> DVec3 {
    let angle = TAU * (k % sides) as f64 / sides as f64;
    centre + DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.0)
}

fn shaft(triangles: &mut Vec<Triangle>, foot: DVec3, radius: f64, height: f64, sides: usize, rings: usize) {
    let level = |ring: usize| foot + DVec3::Z * (height * ring as f64 / rings as f64);
    for ring in 0..rings {
        for k in 0..sides {
            let (low, high) = (level(ring), level(ring + 1));
            let at = |centre, k| rim(centre, radius, k, sides);
            quad(triangles, [at(low, k), at(low, k + 1), at(high, k + 1), at(high, k)]);
        }
    }
}

fn spire(triangles: &mut Vec<Triangle>, foot: DVec3, radius: f64, height: f64, sides: usize) {
    for k in 0..sides {
        triangles.push(rounded([rim(foot, radius, k, sides), rim(foot, radius, k + 1, sides), foot + DVec3::Z * height]));
    }
}

fn tower(triangles: &mut Vec<Triangle>, foot: DVec3) {
    let top = foot + DVec3::Z * 5.0;
    shaft(triangles, foot, 1.2, 5.0, 48, 24);
    spire(triangles, top, 1.0, 1.5, 48);
    for k in 0..24 {
        let middle = rim(top, 1.2, k, 24);
        let out = (middle - top).normalize();
        slab(triangles, middle, out * 0.08, DVec3::Z.cross(out) * 0.08, 0.3);
    }
}

/// A curtain wall with 13 merlons.
fn wall(triangles: &mut Vec<Triangle>, from: DVec3, to: DVec3) {
    let along = to - from;
    let across = DVec3::Z.cross(along).normalize();
    slab(triangles, 0.5 * (from + to), 0.5 * along, 0.3 * across, 3.0);
    for k in 0..13 {
        let middle = from + along * ((k as f64 + 0.5) / 13.0) + DVec3::Z * 3.0;
        slab(triangles, middle, along.normalize() * 0.15, 0.3 * across, 0.4);
    }
}

/// A box on its foot: 12 triangles.
fn slab(triangles: &mut Vec<Triangle>, foot: DVec3, along: DVec3, across: DVec3, height: f64) {
    let low = [foot - along - across, foot + along - across, foot + along + across, foot - along + across];
    let high = low.map(|p| p + DVec3::Z * height);
    quad(triangles, low);
    quad(triangles, high);
    for k in 0..4 {
        let next = (k + 1) % 4;
        quad(triangles, [low[k], low[next], high[next], high[k]]);
    }
}
