//! Curves and triangles: which of them are sure to miss each other, and where in a triangle a point is.

use glam::DVec3;

/// Barycentric weights down to minus this count as inside: rounding must not open a gap between neighbours.
const SLACK: f64 = 1e-11;

/// Whether a curve within `grow` (r_s) of the chord between two points is sure to miss a triangle.
///
/// Where the curve is in the triangle's plane, its chord is within `grow` of the plane. So that point of the chord is within `grow` times
/// the chord's length over its rise of where the chord crosses the plane, and the curve within `grow` more. A barycentric weight changes
/// per length by at most the longest edge over twice the area.
pub(super) fn passes_beside(corners: [DVec3; 3], normal: DVec3, [from, to]: [DVec3; 2], grow: f64) -> bool {
    let chord = to - from;
    let rise = normal.dot(chord);
    let through = from + chord * (normal.dot(corners[0] - from) / rise);
    let area = normal.length_squared();
    let edges = [corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]];
    let longest = edges.map(DVec3::length_squared).into_iter().fold(0.0, f64::max);
    let away = grow * (1.0 + chord.length() * area.sqrt() / rise.abs());
    let slack = SLACK + away * (longest / area).sqrt();
    // NaN if the chord is parallel to the plane: then nothing is sure.
    (0..3).any(|k| edges[k].cross(through - corners[k]).dot(normal) < -slack * area)
}

/// Barycentric weights of a point of the triangle's plane that is known to `rounding` (r_s), or None outside.
pub(super) fn weights(corners: [DVec3; 3], normal: DVec3, point: DVec3, rounding: f64) -> Option<[f64; 3]> {
    let area = normal.length_squared();
    let [a, b, c] = corners.map(|v| v - point);
    let weights = [b.cross(c), c.cross(a), a.cross(b)].map(|part| part.dot(normal) / area);
    // Rounding weighs the more the lower the triangle is: its least height is twice the area over the longest edge.
    if weights.iter().any(|&w| w < -SLACK) {
        let longest = (corners[1] - corners[0]).length().max((corners[2] - corners[1]).length()).max((corners[0] - corners[2]).length());
        let slack = rounding * longest / area.sqrt();
        return weights.iter().all(|&w| w >= -slack).then_some(weights);
    }
    Some(weights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::picture::roots::{Bend, roots};

    #[test]
    fn a_curve_that_meets_a_triangle_does_not_pass_beside_it() {
        let corners = [DVec3::new(-0.3, -0.2, 0.0), DVec3::new(0.4, -0.1, 0.1), DVec3::new(0.0, 0.5, -0.1)];
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        // Evenly spread numbers.
        let spread = |i: u32, k: i32| (f64::from(i) * 0.8566748838545029f64.powi(k)).fract() - 0.5;
        let (mut met, mut let_go) = (0, 0);
        for i in 1..20_000 {
            let [from, way, off] = [1, 4, 7].map(|k| DVec3::new(spread(i, k), spread(i, k + 1), spread(i, k + 2)));
            let grow = 0.2 * f64::from(i % 11) / 11.0;
            let curve = |t: f64| from + way * (2.0 * t) + off.normalize() * (grow * 4.0 * t * (1.0 - t));
            let ends = [curve(0.0), curve(1.0)];
            let height = |t: f64| normal.dot(curve(t) - corners[0]);
            let hit = (0..64).any(|k| {
                let [a, b] = [f64::from(k) / 64.0, f64::from(k + 1) / 64.0];
                let least = &Bend { curve: 0.0, kink: 0.0 };
                roots(&height, (a, height(a)), (b, height(b)), least, 0.0, &mut |t| weights(corners, normal, curve(t), 1e-15).is_some())
            });
            let beside = passes_beside(corners, normal, ends, grow);
            assert!(!hit || !beside, "{i}");
            met += u32::from(hit);
            let_go += u32::from(beside);
        }
        assert!(met > 1000 && let_go > 5000, "{met} {let_go}");
    }
}
