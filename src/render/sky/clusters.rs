//! The catalogue in clusters of stars that are near each other, so that most need not be looked at in a frame.

use std::cmp::Reverse;

use glam::DVec3;

use crate::render::gpu::types::{Star, StarCluster};

/// Most stars of a cluster.
const CLUSTER: usize = 64;

/// The clusters of a catalogue, and its stars in their order.
pub(super) fn clusters(stars: &[Star]) -> (Vec<StarCluster>, Vec<Star>) {
    // Cells of a cube's faces, 16 × 16 each: about 75 stars a cell.
    let cell = |star: &Star| {
        let d = star.direction;
        let axis = (0..3).max_by(|&a, &b| d[a].abs().total_cmp(&d[b].abs())).unwrap_or(0);
        let face = |k: usize| ((d[(axis + k) % 3] / d[axis].abs().max(1e-9) * 8.0 + 8.0) as u32).min(15);
        (axis as u32 * 2 + u32::from(d[axis] < 0.0)) << 8 | face(1) << 4 | face(2)
    };
    let mut sorted = stars.to_vec();
    // Fluxes are positive, and the bits of such numbers are in their order.
    sorted.sort_by_cached_key(|star| (cell(star), Reverse(star.flux.max(0.0).to_bits())));
    let mut first = 0;
    let clusters = sorted.chunk_by(|a, b| cell(a) == cell(b)).flat_map(|same_cell| same_cell.chunks(CLUSTER)).map(|part| {
        let direction = |star: &Star| DVec3::from_array(star.direction.map(f64::from)).normalize_or(DVec3::Z);
        let middle = part.iter().map(direction).sum::<DVec3>().normalize_or(DVec3::Z);
        let spread = part.iter().map(|star| middle.angle_between(direction(star))).fold(0.0, f64::max);
        first += part.len();
        StarCluster {
            middle: middle.as_vec3().to_array(),
            spread: spread as f32,
            sine: spread.sin() as f32,
            // Whole numbers up to 2²⁴ are exact.
            first: (first - part.len()) as f32,
            count: part.len() as f32,
            unused: 0.0,
        }
    });
    (clusters.collect(), sorted)
}
