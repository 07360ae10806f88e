//! `balls` and `tree` of the Standard Procedural Databases (Haines 1987; recipes of the release in CC0/MIT), tessellated at its
//! resolution 3.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

use glam::{DMat3, DVec3};

use super::{SceneView, Triangle, rounded};

/// Cells along the edge of one of a sphere's six faces, and quads of a cone in a quarter turn (OUTPUT_RESOLUTION).
const RESOLUTION: usize = 3;

/// balls4A of Sei 2008; B stands half as far, C four times as far.
pub const BALLS_VIEW: SceneView = SceneView::new([2.1, 1.3, 1.7], [0.0; 3]);

/// The view of `tree`.
pub const TREE_VIEW: SceneView = SceneView::new([4.5, 0.4, 2.0], [0.0, 0.0, 1.5]);

impl SceneView {
    /// The same view from `factor` times as far.
    pub fn from_distance(&self, factor: f64) -> SceneView {
        let eye = std::array::from_fn(|i| self.target[i] + factor * (self.eye[i] - self.target[i]));
        SceneView { eye, ..*self }
    }
}

/// The sphereflake: nine spheres of a third of the radius on each sphere, `size` times over, on a floor. 108 · Σ 9ⁿ + 2 triangles.
pub fn balls(size: u32) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    quad(&mut triangles, 12.0, -0.5);
    let unit = unit_sphere();
    let directions = children();
    let mut stack = vec![(DVec3::ZERO, 0.5, DVec3::Z, size)];
    while let Some((centre, radius, direction, left)) = stack.pop() {
        sphere(&mut triangles, &unit, centre, radius);
        if left > 0 {
            let turn = turn_z_to(direction);
            stack.extend(directions.map(|d| {
                let d = turn * d;
                (centre + d * (radius + radius / 3.0), radius / 3.0, d, left - 1)
            }));
        }
    }
    triangles
}

/// Where the nine children sit on a sphere whose own parent lies at −Z: three above, six on the equator.
fn children() -> [DVec3; 9] {
    let d = std::f64::consts::FRAC_1_SQRT_2;
    let trio = [DVec3::new(d, d, 0.0), DVec3::new(d, 0.0, -d), DVec3::new(0.0, d, -d)];
    let tilt = DMat3::from_axis_angle(DVec3::new(d, -d, 0.0), (2.0 / 6f64.sqrt()).asin());
    std::array::from_fn(|i| DMat3::from_rotation_z((i / 3) as f64 * TAU / 3.0) * (tilt * trio[i % 3]))
}

/// Turns +Z into a unit vector, about the axis at right angles to both.
fn turn_z_to(direction: DVec3) -> DMat3 {
    let axis = DVec3::Z.cross(direction);
    if axis.length() < 1e-9 {
        // Along ±Z the axis is free.
        return if direction.z > 0.0 { DMat3::IDENTITY } else { DMat3::from_rotation_x(std::f64::consts::PI) };
    }
    DMat3::from_axis_angle(axis.normalize(), direction.z.clamp(-1.0, 1.0).acos())
}

/// A tree that forks `size` times, every branch a cone with a ball on its end, on a field. 132 · (2^(size + 1) − 1) + 2 triangles.
pub fn tree(size: u32) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    quad(&mut triangles, 50.0, 0.0);
    let unit = unit_sphere();
    // Angle, divergence (degrees), contraction of the two branches. Row vectors in the source; transposed here.
    let forks = [(40f64, 90f64, 0.65), (25.0, 230.0, 0.70)].map(|(angle, divergence, contraction)| {
        let turn = DMat3::from_rotation_z(divergence.to_radians()) * DMat3::from_rotation_x(angle.to_radians());
        turn * contraction
    });
    let mut stack = vec![(DMat3::IDENTITY, DVec3::ZERO, 1.0, size)];
    while let Some((turn, base, scale, left)) = stack.pop() {
        let apex = base + turn * DVec3::Z;
        let radius = 0.15 * scale;
        cone(&mut triangles, base, apex, radius, 0.67 * radius);
        sphere(&mut triangles, &unit, apex, 0.67 * radius);
        if left > 0 {
            stack.extend(forks.map(|fork| (turn * fork, apex, 0.67 * scale, left - 1)));
        }
    }
    triangles
}

/// A square floor of half width `half` at height `z`.
fn quad(triangles: &mut Vec<Triangle>, half: f64, z: f64) {
    let [a, b, c, d] = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec3::new(half * x, half * y, z));
    triangles.push(rounded([a, b, c]));
    triangles.push(rounded([c, d, a]));
}

/// The six faces of a cube blown up to the unit sphere, each cell cut in two: 12 R² triangles.
fn unit_sphere() -> Vec<[DVec3; 3]> {
    let angle = |i: usize| FRAC_PI_4 * (2.0 * i as f64 / RESOLUTION as f64 - 1.0);
    let mut grid: Vec<Vec<DVec3>> = (0..=RESOLUTION)
        .map(|i| {
            let x = DVec3::new(angle(i).cos(), 0.0, -angle(i).sin());
            (0..=RESOLUTION).map(|j| x.cross(DVec3::new(0.0, angle(j).cos(), angle(j).sin())).normalize()).collect()
        })
        .collect();
    let mut triangles = Vec::new();
    for face in 0..6 {
        for p in grid.iter_mut().flatten() {
            *p = match (face + 2) % 3 {
                0 => DVec3::new(-p.y, p.x, p.z),
                1 => DVec3::new(p.x, -p.z, p.y),
                _ => DVec3::new(-p.z, p.y, p.x),
            };
        }
        for i in 0..RESOLUTION {
            for j in 0..RESOLUTION {
                triangles.push([grid[i][j], grid[i][j + 1], grid[i + 1][j + 1]]);
                triangles.push([grid[i + 1][j + 1], grid[i + 1][j], grid[i][j]]);
            }
        }
    }
    triangles
}

fn sphere(triangles: &mut Vec<Triangle>, unit: &[[DVec3; 3]], centre: DVec3, radius: f64) {
    triangles.extend(unit.iter().map(|corners| rounded(corners.map(|c| centre + radius * c))));
}

/// The side of a frustum between two circles: 8 R triangles, no caps.
fn cone(triangles: &mut Vec<Triangle>, base: DVec3, apex: DVec3, base_radius: f64, apex_radius: f64) {
    let axis = (apex - base).normalize();
    let across = axis.cross(DVec3::Z);
    let start = if across.length() < 1e-9 { axis.cross(DVec3::X) } else { across }.normalize();
    let number = 4 * RESOLUTION;
    let spokes: Vec<DVec3> = (0..number).map(|k| DMat3::from_axis_angle(axis, FRAC_PI_2 * k as f64 / RESOLUTION as f64) * start).collect();
    for k in 0..number {
        let (here, next) = (spokes[k], spokes[(k + 1) % number]);
        let [a, b, c, d] = [base + base_radius * next, apex + apex_radius * next, apex + apex_radius * here, base + base_radius * here];
        triangles.push(rounded([a, b, c]));
        triangles.push(rounded([c, d, a]));
    }
}
