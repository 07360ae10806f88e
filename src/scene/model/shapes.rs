//! Procedural shapes of unit extent: sphere (diameter 1) and square (edge 1), by their number of triangles.

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};

use super::{Material, Model, Vertex};

/// Where the origin of a [`square`] lies in its grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Anchor {
    /// At the centre of the square, wherever that falls.
    #[default]
    Centre,
    /// At the centroid of a triangle.
    Inside,
    /// At the middle of an edge.
    Edge,
    /// On a vertex.
    Vertex,
}

/// A sphere of diameter 1 from parallels and meridians, the pole along y, with texture coordinates (u along the equator,
/// v from the north pole). It has 4m(m − 1) triangles, m ≥ 2 being chosen so that this is nearest to `triangles`.
/// Closed: vertices on the seam and at the poles are doubled for the texture, but agree bit by bit in position.
pub fn uv_sphere(triangles: u32, material: Material) -> Model {
    let stacks = (((1.0 + (1.0 + f64::from(triangles)).sqrt()) / 2.0).round() as u32).max(2);
    let slices = 2 * stacks;
    let mut model = Model { materials: vec![material], ..Model::default() };
    for stack in 0..=stacks {
        // The poles have no azimuth of their own; sin(π) is not zero in floating point.
        let (sine, cosine) = match stack {
            0 => (0.0, 1.0),
            last if last == stacks => (0.0, -1.0),
            _ => (PI * f64::from(stack) / f64::from(stacks)).sin_cos(),
        };
        for slice in 0..=slices {
            let azimuth = TAU * f64::from(slice % slices) / f64::from(slices);
            let normal = DVec3::new(sine * azimuth.sin(), cosine, sine * azimuth.cos()).as_vec3();
            // At a pole each triangle has its own vertex, half a slice on.
            let shift = if stack == 0 || stack == stacks { 0.5 } else { 0.0 };
            let u = (slice as f32 + shift) / slices as f32;
            model.vertices.push(sphere_vertex(normal, [u, stack as f32 / stacks as f32]));
        }
    }
    let row = slices + 1;
    for stack in 0..stacks {
        for slice in 0..slices {
            let (a, b) = (stack * row + slice, (stack + 1) * row + slice);
            if stack > 0 {
                model.triangles.push([a, b, a + 1]);
            }
            if stack + 1 < stacks {
                model.triangles.push([a + 1, b, b + 1]);
            }
        }
    }
    // The last row's triangles end in the pole vertex of their own slice.
    model.triangle_materials = vec![0; model.triangles.len()];
    model
}

/// A ring in the plane z = 0: its middle line is a circle of diameter 1, its tube has the diameter `thickness`. `around` × `across` × 2
/// triangles, closed.
pub fn torus(around: u32, across: u32, thickness: f64, material: Material) -> Model {
    let mut model = Model { materials: vec![material], ..Model::default() };
    for step in 0..around {
        let (sine, cosine) = (TAU * f64::from(step) / f64::from(around)).sin_cos();
        let outward = DVec3::new(cosine, sine, 0.0);
        for turn in 0..across {
            let (rise, reach) = (TAU * f64::from(turn) / f64::from(across)).sin_cos();
            let normal = outward * reach + DVec3::Z * rise;
            let position = (outward * 0.5 + normal * (0.5 * thickness)).as_vec3();
            let uv = [step as f32 / around as f32, turn as f32 / across as f32];
            model.vertices.push(Vertex { position: position.to_array(), normal: normal.as_vec3().to_array(), uv });
        }
    }
    for step in 0..around {
        for turn in 0..across {
            let [here, next] = [step, (step + 1) % around].map(|step| step * across);
            let over = (turn + 1) % across;
            model.triangles.push([here + turn, next + turn, next + over]);
            model.triangles.push([here + turn, next + over, here + over]);
        }
    }
    model.triangle_materials = vec![0; model.triangles.len()];
    model
}

fn sphere_vertex(normal: Vec3, uv: [f32; 2]) -> Vertex {
    Vertex { position: (0.5 * normal).to_array(), normal: normal.to_array(), uv }
}

/// How many triangles [`icosphere`] makes when at least this many are asked for.
pub fn icosphere_triangles(least: u32) -> u32 {
    let mut triangles = 20;
    while triangles < least {
        triangles *= 4;
    }
    triangles
}

/// A sphere of diameter 1 from a subdivided icosahedron: 20·4^k triangles, the smallest such number that is at least
/// `triangles`. Its texture coordinates are longitude and latitude, with a seam.
pub fn icosphere(triangles: u32, material: Material) -> Model {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let mut corners: Vec<DVec3> = Vec::new();
    for (one, phi) in [(1.0, golden), (1.0, -golden), (-1.0, golden), (-1.0, -golden)] {
        corners.extend([DVec3::new(0.0, one, phi), DVec3::new(one, phi, 0.0), DVec3::new(phi, 0.0, one)]);
    }
    corners.iter_mut().for_each(|corner| *corner = corner.normalize());
    let mut faces = convex_faces(&corners);
    while (faces.len() as u32) < triangles {
        faces = subdivide(&mut corners, &faces);
    }
    let vertices = corners
        .iter()
        .map(|corner| {
            let u = (corner.x.atan2(corner.z) / TAU).rem_euclid(1.0);
            sphere_vertex(corner.as_vec3(), [u as f32, (corner.y.clamp(-1.0, 1.0).acos() / PI) as f32])
        })
        .collect();
    Model { vertices, triangle_materials: vec![0; faces.len()], triangles: faces, materials: vec![material] }
}

/// The faces of the icosahedron: triples of corners at the edge's distance from one another, counter-clockwise from outside.
fn convex_faces(corners: &[DVec3]) -> Vec<[u32; 3]> {
    // The edge of an icosahedron with circumradius 1 is 1.0515, the next distance between corners 1.7013.
    let near = |a: usize, b: usize| corners[a].distance(corners[b]) < 1.3;
    let mut faces = Vec::new();
    for a in 0..corners.len() {
        for b in a + 1..corners.len() {
            for c in b + 1..corners.len() {
                if near(a, b) && near(b, c) && near(c, a) {
                    let outward = (corners[b] - corners[a]).cross(corners[c] - corners[a]).dot(corners[a]) > 0.0;
                    let (second, third) = if outward { (b, c) } else { (c, b) };
                    faces.push([a as u32, second as u32, third as u32]);
                }
            }
        }
    }
    faces
}

fn subdivide(corners: &mut Vec<DVec3>, faces: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            corners.push(((corners[a as usize] + corners[b as usize]) / 2.0).normalize());
            corners.len() as u32 - 1
        })
    };
    let mut finer = Vec::with_capacity(4 * faces.len());
    for &[a, b, c] in faces {
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    finer
}

/// A square of edge 1 in the plane z = 0, facing +z, as a grid of two triangles a cell; u to +x, v to −y. An even number of
/// `triangles` is met exactly if that many make cells no longer than twice their width (2,000 is 25 × 40 cells); else there are a few less
/// (746: 19 × 19 cells), since needles beside the axis of hole and camera are drawn out round the whole ring. `anchor` shifts the whole
/// square by less than a cell so that its origin lies inside a triangle, on an edge, on a vertex.
pub fn square(triangles: u32, anchor: Anchor, material: Material) -> Model {
    let cells = triangles.div_ceil(2).max(1);
    let side = cells.isqrt();
    let columns = (1 + side / 2..=side).rev().find(|columns| cells.is_multiple_of(*columns)).unwrap_or(side);
    let rows = cells / columns;
    // The origin in units of cells from the lower left corner; coordinates are (index − origin)·step, so a vertex there is exactly 0.
    let (half_x, half_y) = (f64::from(columns / 2), f64::from(rows / 2));
    let origin = match anchor {
        Anchor::Centre => (0.5 * f64::from(columns), 0.5 * f64::from(rows)),
        Anchor::Inside => (half_x + 2.0 / 3.0, half_y + 1.0 / 3.0),
        Anchor::Edge => (half_x + 0.5, half_y),
        Anchor::Vertex => (half_x, half_y),
    };
    let mut model = Model { materials: vec![material], ..Model::default() };
    for row in 0..=rows {
        for column in 0..=columns {
            let x = (f64::from(column) - origin.0) / f64::from(columns);
            let y = (f64::from(row) - origin.1) / f64::from(rows);
            let uv = [column as f32 / columns as f32, 1.0 - row as f32 / rows as f32];
            model.vertices.push(Vertex { position: [x as f32, y as f32, 0.0], normal: [0.0, 0.0, 1.0], uv });
        }
    }
    let line = columns + 1;
    for row in 0..rows {
        for column in 0..columns {
            let a = row * line + column;
            model.triangles.extend([[a, a + 1, a + line + 1], [a, a + line + 1, a + line]]);
        }
    }
    model.triangle_materials = vec![0; model.triangles.len()];
    model
}
