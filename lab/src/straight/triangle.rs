//! One ray and one triangle, watertight (Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection", JCGT 2, 1).
//!
//! The three corners are sheared so that the ray becomes the z axis. A corner shared by several triangles is sheared to the same two
//! numbers in all of them, and the sign of each edge function is exact (in f64 where f32 gives 0), so the projected triangles of a closed
//! mesh leave no gap, neither at edges nor at corners. Edges and corners belong to all triangles that touch them.

use super::ray::{Hit, Ray};

/// A ray made ready for triangles.
#[derive(Clone, Copy, Debug)]
pub struct Shear {
    /// The ray's origin.
    pub origin: [f32; 3],
    /// The axis along which the ray moves fastest; the next two, cyclically, are x and y of the shear.
    pub axis: usize,
    /// Direction along x, y over that along z, and 1 over that along z.
    pub slopes: [f32; 3],
}

/// The axis along which a direction moves fastest; the first of equals.
#[inline]
pub fn fastest(direction: [f32; 3]) -> usize {
    let [x, y, z] = direction.map(f32::abs);
    if x >= y && x >= z {
        0
    } else if y >= z {
        1
    } else {
        2
    }
}

impl Shear {
    /// Makes a ray ready.
    #[inline]
    pub fn new(ray: &Ray) -> Shear {
        let axis = fastest(ray.direction);
        let [x, y, z] = permuted(ray.direction, axis);
        Shear { origin: ray.origin, axis, slopes: [x / z, y / z, 1.0 / z] }
    }

    /// The t at which the ray's line meets the triangle; not a number or anything where it does not. Compare with `>= 0` and `<= until`.
    #[inline]
    pub fn meet(&self, corners: &[[f32; 3]; 3]) -> Option<f32> {
        let [a, b, c] = corners.map(|v| {
            let [x, y, z] = permuted(std::array::from_fn(|i| v[i] - self.origin[i]), self.axis);
            [x - self.slopes[0] * z, y - self.slopes[1] * z, self.slopes[2] * z]
        });
        let [u, v, w] = edges(a, b, c);
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let whole = u + v + w;
        if whole == 0.0 {
            return None;
        }
        Some((u * a[2] + v * b[2] + w * c[2]) / whole)
    }

    /// Tests a triangle and keeps the better of the two hits.
    #[inline]
    pub fn update(&self, corners: &[[f32; 3]; 3], triangle: u32, until: f32, best: &mut Hit) {
        if let Some(t) = self.meet(corners) {
            let hit = Hit { t, triangle };
            if t >= 0.0 && t <= until && hit.before(best) {
                *best = hit;
            }
        }
    }
}

/// Twice the areas of the three triangles between the axis and the edges, signed alike inside.
#[inline]
fn edges(a: [f32; 3], b: [f32; 3], c: [f32; 3]) -> [f32; 3] {
    // No fused multiply-add: rounding both products alike is what makes the sign right, and the opposite of the neighbour's.
    let quick = [c[0] * b[1] - c[1] * b[0], a[0] * c[1] - a[1] * c[0], b[0] * a[1] - b[1] * a[0]];
    if quick.iter().all(|&e| e != 0.0) {
        return quick;
    }
    // Products of two f32 are exact in f64. A sign must survive the way back to f32.
    let exact = |p: [f32; 3], q: [f32; 3]| {
        let [px, py, qx, qy] = [p[0], p[1], q[0], q[1]].map(f64::from);
        let edge = px * qy - py * qx;
        if edge == 0.0 { 0.0 } else { (edge.abs().max(f64::from(f32::MIN_POSITIVE)).copysign(edge)) as f32 }
    };
    [exact(c, b), exact(a, c), exact(b, a)]
}

/// (x, y, z) of the shear: the two axes after `axis`, and `axis`.
#[inline]
fn permuted(v: [f32; 3], axis: usize) -> [f32; 3] {
    match axis {
        0 => [v[1], v[2], v[0]],
        1 => [v[2], v[0], v[1]],
        _ => v,
    }
}
