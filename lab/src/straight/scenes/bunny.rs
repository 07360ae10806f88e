//! The Stanford bunny from a file, or a blob of as many triangles in its place.

use std::path::Path;

use glam::{DVec3, Vec3};

use super::{SceneView, Triangle, rounded};

/// The bunny stands in a cube of edge 1 around the origin.
pub const VIEW: SceneView = SceneView::new([0.3, -1.6, 0.4], [0.0; 3]);

/// What a file must be.
const FORMAT: &str = "binary_little_endian 1.0, vertices of float x, y, z and faces of uchar int vertex_indices";

/// Reads a binary little-endian PLY of triangles and fits it into a cube of edge 1 around the origin, axes kept. An error says what is
/// wrong with which file.
pub fn read(path: &Path) -> Result<Vec<Triangle>, String> {
    let named = |what: String| format!("{}: {what}", path.display());
    let bytes = std::fs::read(path).map_err(|error| named(error.to_string()))?;
    Ok(normalised(parse(&bytes).map_err(|what| named(format!("{what}; expected {FORMAT}")))?))
}

fn parse(bytes: &[u8]) -> Result<Vec<[DVec3; 3]>, String> {
    const END: &[u8] = b"end_header\n";
    let end = bytes.windows(END.len()).position(|w| w == END).ok_or("no line end_header")? + END.len();
    let header = std::str::from_utf8(&bytes[..end]).map_err(|_| "the header is not text")?;
    let mut lines = header.lines().filter(|line| !line.starts_with("comment"));
    let mut expect = |start: &str| -> Result<usize, String> {
        let line = lines.next().unwrap_or("");
        let rest = line.strip_prefix(start).ok_or(format!("{line:?} where {start:?} was expected"))?.trim();
        if rest.is_empty() { Ok(0) } else { rest.parse().map_err(|_| format!("{line:?}: not a number")) }
    };
    expect("ply")?;
    expect("format binary_little_endian 1.0")?;
    let vertices = expect("element vertex")?;
    for axis in ["x", "y", "z"] {
        expect(&format!("property float {axis}"))?;
    }
    let faces = expect("element face")?;
    expect("property list uchar int vertex_indices")?;
    expect("end_header")?;
    let body = &bytes[end..];
    let split = vertices.checked_mul(12).filter(|&n| n <= body.len()).ok_or(format!("cut short in its {vertices} vertices"))?;
    let (points, corners) = body.split_at(split);
    let number = |at: &[u8]| f64::from(f32::from_le_bytes([at[0], at[1], at[2], at[3]]));
    let points: Vec<DVec3> = points.chunks_exact(12).map(|p| DVec3::new(number(p), number(&p[4..]), number(&p[8..]))).collect();
    let rows = corners.get(..faces.saturating_mul(13)).ok_or(format!("cut short in its {faces} faces"))?;
    let mut triangles = Vec::with_capacity(faces);
    for (face, row) in rows.chunks_exact(13).enumerate() {
        if row[0] != 3 {
            return Err(format!("face {face} has {} corners, not 3", row[0]));
        }
        let mut triangle = [DVec3::ZERO; 3];
        for (corner, index) in triangle.iter_mut().zip(row[1..].chunks_exact(4)) {
            let index = i32::from_le_bytes([index[0], index[1], index[2], index[3]]);
            *corner = *usize::try_from(index)
                .ok()
                .and_then(|i| points.get(i))
                .ok_or(format!("face {face} names vertex {index} of {vertices}"))?;
        }
        triangles.push(triangle);
    }
    Ok(triangles)
}

fn normalised(triangles: Vec<[DVec3; 3]>) -> Vec<Triangle> {
    let corners = || triangles.iter().flatten();
    let low = corners().fold(DVec3::INFINITY, |a, &b| a.min(b));
    let high = corners().fold(DVec3::NEG_INFINITY, |a, &b| a.max(b));
    let (centre, size) = (0.5 * (low + high), (high - low).max_element());
    triangles.iter().map(|t| rounded(t.map(|c| (c - centre) / size))).collect()
}

/// An icosahedron, each face cut into 59², blown up to a sphere and roughened: 69,620 triangles.
pub fn stand_in() -> Vec<Triangle> {
    normalised(geodesic(59).into_iter().map(|t| t.map(|p| p * (1.0 + rough(p)))).collect())
}

/// A few octaves of waves in odd directions.
fn rough(p: DVec3) -> f64 {
    (0..6)
        .map(|octave| {
            let (phase, scale) = (f64::from(octave), 2f64.powi(octave));
            let q = p * (2.0 * scale) + DVec3::new(1.3, 2.1, 0.7) * phase;
            0.25 / scale * (q.x + 0.6 * q.y).sin() * (q.y - 0.8 * q.z).sin() * (q.z + 0.4 * q.x).cos()
        })
        .sum()
}

/// The geodesic sphere: 20 f² triangles whose shared corners are the same bits.
pub fn geodesic(frequency: usize) -> Vec<[DVec3; 3]> {
    let g = 0.5 * (1.0 + 5f64.sqrt());
    let corners: Vec<DVec3> = (0..3)
        .flat_map(|axis| [(1.0, g), (1.0, -g), (-1.0, g), (-1.0, -g)].map(|(a, b)| rotate_axes(DVec3::new(0.0, a, b), axis)))
        .collect();
    let mut triangles = Vec::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                // The edges of this icosahedron are 2 long, its next distance is 2g.
                let near = |a: usize, b: usize| corners[a].distance(corners[b]) < 2.5;
                if near(i, j) && near(j, k) && near(k, i) {
                    face(&mut triangles, [corners[i], corners[j], corners[k]], frequency);
                }
            }
        }
    }
    triangles
}

/// The same of this centre and radius: a closed mesh with many triangles at each corner.
pub fn ball(frequency: usize, centre: Vec3, radius: f32) -> Vec<Triangle> {
    geodesic(frequency).into_iter().map(|t| t.map(|p| (centre + p.as_vec3() * radius).to_array())).collect()
}

fn rotate_axes(p: DVec3, by: usize) -> DVec3 {
    let p = p.to_array();
    DVec3::from_array(std::array::from_fn(|i| p[(i + by) % 3]))
}

fn face(triangles: &mut Vec<[DVec3; 3]>, [a, b, c]: [DVec3; 3], frequency: usize) {
    // Outward, so that all faces turn the same way.
    let (b, c) = if (b - a).cross(c - a).dot(a) > 0.0 { (b, c) } else { (c, b) };
    let point = |i: usize, j: usize| {
        // Terms in the order of the corners' coordinates, so that two faces compute the same point of a shared edge alike.
        let mut terms = [(a, frequency - i - j), (b, i), (c, j)];
        terms.sort_by(|(p, _), (q, _)| p.to_array().partial_cmp(&q.to_array()).expect("finite corners"));
        terms.iter().map(|&(p, n)| p * n as f64).sum::<DVec3>().normalize()
    };
    for i in 0..frequency {
        for j in 0..frequency - i {
            triangles.push([point(i, j), point(i + 1, j), point(i, j + 1)]);
            if i + j + 1 < frequency {
                triangles.push([point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]);
            }
        }
    }
}
