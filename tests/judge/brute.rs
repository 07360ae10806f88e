//! What a pixel shows: the dense ray against triangles, the curve itself intersected. Brute force over triangles at rest, their planes
//! looked for by dense samples: what `judge::picture` is held against.

use glam::{DVec2, DVec3};
use lensrunner::judge::geodesic::Segment;
use lensrunner::judge::ray::{End, RaySample, Stop, TracedRay, sky_radius};
use lensrunner::judge::trace::Hit;

/// A set of triangles at rest in Painlevé–Gullstrand coordinates.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Vertices in r_s from the hole.
    pub vertices: Vec<DVec3>,
    /// Three indices a triangle.
    pub triangles: Vec<[u32; 3]>,
}

/// What is seen in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Seen {
    /// The shadow.
    Captured,
    /// The sky in this direction from the hole, unit vector.
    Sky(DVec3),
    /// A triangle.
    Hit(Hit),
}

/// Follows the light seen from `position` in direction `look` (rain frame) back to the first thing it meets.
pub fn trace(meshes: &[Mesh], position: DVec3, look: DVec3, tolerance: f64) -> Seen {
    let radius = meshes.iter().flat_map(|m| &m.vertices).map(|v| v.length()).fold(sky_radius(position.length()), f64::max);
    let ray = TracedRay::trace(position, look, tolerance, &Stop { radius, ..Stop::default() });
    if let Some(hit) = first_hit(meshes, &ray) {
        return Seen::Hit(hit);
    }
    match ray.sky_swept() {
        Some(swept) if ray.end == End::Escaped => Seen::Sky(ray.embed(DVec2::from_angle(swept))),
        _ => Seen::Captured,
    }
}

/// The first triangle that a ray, followed backwards, meets.
pub fn first_hit(meshes: &[Mesh], ray: &TracedRay) -> Option<Hit> {
    let normal = ray.axes[0].cross(ray.axes[1]);
    let mut first: Option<Hit> = None;
    for (object, mesh) in meshes.iter().enumerate() {
        let height: Vec<f64> = mesh.vertices.iter().map(|v| normal.dot(*v)).collect();
        for (triangle, indices) in mesh.triangles.iter().enumerate() {
            // A ray stays in its plane, so a triangle on one side of that plane cannot be met.
            let side = indices.map(|i| height[i as usize]);
            if side.iter().all(|&s| s > 0.0) || side.iter().all(|&s| s < 0.0) {
                continue;
            }
            let corners = indices.map(|i| mesh.vertices[i as usize]);
            let until = first.map_or(f64::INFINITY, |hit| hit.delay);
            if let Some((sample, barycentrics)) = meet(ray, corners, until) {
                let order = (sample.swept / std::f64::consts::PI) as u32 + 1;
                let RaySample { position, momentum, swept, delay } = sample;
                first = Some(Hit { object, triangle, barycentrics, order, swept, delay, position, momentum });
            }
        }
    }
    first
}

/// The first crossing of the ray with one triangle before the delay `until`.
fn meet(ray: &TracedRay, corners: [DVec3; 3], until: f64) -> Option<(RaySample, [f64; 3])> {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    // The triangle's plane cuts the ray's plane in the line a·x = c.
    let a = DVec2::new(normal.dot(ray.axes[0]), normal.dot(ray.axes[1]));
    let c = normal.dot(corners[0]);
    let centre = (corners[0] + corners[1] + corners[2]) / 3.0;
    let centre_in_plane = DVec2::new(centre.dot(ray.axes[0]), centre.dot(ray.axes[1]));
    let size = corners.iter().map(|v| v.distance(centre)).fold(0.0, f64::max);
    for (i, segment) in ray.segments.iter().enumerate().take_while(|(_, s)| s.start < until) {
        if segment.position(0.0).distance(centre_in_plane) > size + segment.reach() {
            continue;
        }
        for elapsed in crossings(segment, a, c) {
            let sample = ray.sample(i, elapsed);
            if sample.delay >= until {
                return None;
            }
            if let Some(barycentrics) = inside(corners, normal, sample.position) {
                return Some((sample, barycentrics));
            }
        }
    }
    None
}

/// Where a segment crosses the line a·x = c, in order: by its height above the line at many points, so that no case is left out by
/// reasoning.
fn crossings(segment: &Segment, a: DVec2, c: f64) -> Vec<f64> {
    const SAMPLES: usize = 48;
    let height = |s: f64| a.dot(segment.position(s)) - c;
    let mut samples: Vec<(f64, f64)> = (0..=SAMPLES).map(|k| segment.length * k as f64 / SAMPLES as f64).map(|s| (s, height(s))).collect();
    if samples.iter().all(|sample| sample.1 == 0.0) {
        // The ray runs in the plane of the triangle: it sees no surface.
        return Vec::new();
    }
    // Where the height is least between two samples it may dip below the line: one more sample there.
    let dips: Vec<f64> = samples
        .windows(3)
        .filter(|w| w[1].1.abs() <= w[0].1.abs() && w[1].1.abs() <= w[2].1.abs() && w[0].1 * w[2].1 > 0.0)
        .map(|w| least(w[0].0, w[2].0, |s| height(s) * w[0].1.signum()))
        .collect();
    samples.extend(dips.into_iter().map(|s| (s, height(s))));
    samples.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut found: Vec<f64> = samples.iter().filter(|sample| sample.1 == 0.0).map(|sample| sample.0).collect();
    found.extend(samples.windows(2).filter(|w| w[0].1 * w[1].1 < 0.0).map(|w| segment.cross_line(a, c, w[0].0, w[1].0)));
    found.sort_by(f64::total_cmp);
    found
}

/// Where f is least between a and b, by thirds, well enough to tell its sign.
fn least(mut a: f64, mut b: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..60 {
        let (left, right) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
        if f(left) < f(right) {
            b = right;
        } else {
            a = left;
        }
    }
    0.5 * (a + b)
}

/// The weights of the corners at a point of the triangle's plane, or None outside.
fn inside(corners: [DVec3; 3], normal: DVec3, point: DVec3) -> Option<[f64; 3]> {
    let area = normal.length_squared();
    let [a, b, c] = corners.map(|v| v - point);
    let weights = [b.cross(c), c.cross(a), a.cross(b)].map(|part| part.dot(normal) / area);
    // Rounding of the crossing must not open a gap between neighbours; a point on a shared edge may belong to both.
    const SLACK: f64 = 1e-12;
    weights.iter().all(|&w| w >= -SLACK).then_some(weights)
}
