//! Which side of a triangle is outside. A closed body hides those of its own triangles that are turned away.

use std::collections::HashMap;

use crate::scene::model::Model;

/// No side is outside: the triangle is part of an open sheet, and both its sides are seen.
pub const OPEN: u32 = 0;
/// The cross product of the sides 0–1 and 0–2 points outward; as in shaders/gpu/types.wgsl.
pub const ALONG: u32 = 1;
/// It points inward; as in shaders/gpu/types.wgsl.
pub const AGAINST: u32 = 2;

/// Added if the whole model is one closed body. Bodies that make up a model may abut, and where their edges are divided differently their
/// backs fill the crack: only the backs of a single body may be left out.
pub const LONE: u32 = 4;

/// For each triangle of the model: whether the cross product of its sides, in the order of its corners, points out of its body. A body is a
/// set of triangles connected by edges; it is closed if each of its edges is passed equally often both ways.
pub fn sides(model: &Model) -> Vec<u32> {
    // Vertices at one place are one corner of the body, whatever their normals.
    let mut places: HashMap<[u32; 3], usize> = HashMap::new();
    let corners: Vec<[usize; 3]> = model
        .triangles
        .iter()
        .map(|triangle| {
            triangle.map(|vertex| {
                let next = places.len();
                *places.entry(model.vertices[vertex as usize].position.map(|x| (x + 0.0).to_bits())).or_insert(next)
            })
        })
        .collect();
    let edges = |c: [usize; 3]| [[c[0], c[1]], [c[1], c[2]], [c[2], c[0]]];
    let whole = |c: &[usize; 3]| c[0] != c[1] && c[1] != c[2] && c[2] != c[0];

    let mut bodies: Vec<usize> = (0..places.len()).collect();
    let mut passes: HashMap<[usize; 2], i64> = HashMap::new();
    for &c in corners.iter().filter(|c| whole(c)) {
        for [a, b] in edges(c) {
            let (a_body, b_body) = (root(&mut bodies, a), root(&mut bodies, b));
            bodies[a_body] = b_body;
            *passes.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
        }
    }
    let mut open = vec![false; places.len()];
    for (&[a, _], &pass) in &passes {
        if pass != 0 {
            let body = root(&mut bodies, a);
            open[body] = true;
        }
    }
    // Six times the volume that a body's triangles enclose, positive if they are wound outward.
    let mut volumes = vec![0.0; places.len()];
    for (c, triangle) in corners.iter().zip(&model.triangles).filter(|(c, _)| whole(c)) {
        let [p, q, r] = triangle.map(|vertex| glam::Vec3::from(model.vertices[vertex as usize].position).as_dvec3());
        volumes[root(&mut bodies, c[0])] += p.dot(q.cross(r));
    }
    let first = corners.iter().find(|c| whole(c)).map(|c| root(&mut bodies, c[0]));
    let lone = corners.iter().filter(|c| whole(c)).all(|c| Some(root(&mut bodies, c[0])) == first);
    let lone = if lone { LONE } else { 0 };
    corners
        .iter()
        .map(|c| {
            let body = root(&mut bodies, c[0]);
            match (whole(c) && !open[body], volumes[body]) {
                (true, volume) if volume > 0.0 => ALONG | lone,
                (true, volume) if volume < 0.0 => AGAINST | lone,
                _ => OPEN,
            }
        })
        .collect()
}

/// The representative corner of the body of a corner, with path compression.
fn root(bodies: &mut [usize], mut corner: usize) -> usize {
    while bodies[corner] != corner {
        bodies[corner] = bodies[bodies[corner]];
        corner = bodies[corner];
    }
    corner
}
