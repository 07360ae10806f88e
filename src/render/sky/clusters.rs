//! Which stars may be on the screen: the catalogue in clusters, told by where each is seen. Plain data of the processor.

use std::cmp::Reverse;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use crate::render::gpu::types::Star;
use crate::render::instances::visibility::may_be_seen;
use crate::render::sky::table::sky_seen;
use crate::spacetime::Observer;

/// Orders in which stars are projected: the third is within a ten-thousandth of the shadow's edge and carries as little of the light.
pub const ORDERS: u32 = 2;
/// Most stars of a cluster.
const CLUSTER: usize = 64;
/// Clusters per workgroup of the projection, with eight threads for each.
pub const CLUSTERS: u32 = 8;

/// Stars that are near each other on the sky, the brightest first.
#[derive(Clone, Copy, Debug)]
struct Cluster {
    first: u32,
    count: u32,
    /// Middle, and the angle of the farthest star from it in radians.
    middle: DVec3,
    spread: f64,
}

/// Neighbouring clusters: those of four cells.
#[derive(Clone, Debug)]
struct Region {
    /// All of their stars.
    all: Cluster,
    /// Their numbers.
    clusters: Range<usize>,
}

/// The clusters of a catalogue.
#[derive(Clone, Debug)]
pub struct StarClusters {
    clusters: Vec<Cluster>,
    /// Few, so that most clusters need not be looked at one by one.
    regions: Vec<Region>,
}

impl StarClusters {
    /// Of a catalogue, and its stars in the order of their clusters, these in that of their regions.
    pub fn of(stars: &[Star]) -> (StarClusters, Vec<Star>) {
        // Cells of a cube's faces, 16 × 16 each: about 75 stars a cell. The last two bits count the cells of a region.
        let cell = |star: &Star| {
            let d = star.direction;
            let axis = (0..3).max_by(|&a, &b| d[a].abs().total_cmp(&d[b].abs())).unwrap_or(0);
            let face = |k: usize| ((d[(axis + k) % 3] / d[axis].abs().max(1e-9) * 8.0 + 8.0) as u32).min(15);
            let (x, y) = (face(1), face(2));
            (axis as u32 * 2 + u32::from(d[axis] < 0.0)) << 8 | (x >> 1) << 5 | (y >> 1) << 2 | (x & 1) << 1 | (y & 1)
        };
        let mut sorted = stars.to_vec();
        // Fluxes are positive, and the bits of such numbers are in their order.
        sorted.sort_by_cached_key(|star| (cell(star), Reverse(star.flux.max(0.0).to_bits())));
        let mut clusters = Vec::new();
        let mut regions = Vec::new();
        let mut first = 0;
        let cluster = |first: u32, part: &[Star]| {
            let direction = |star: &Star| DVec3::from_array(star.direction.map(f64::from)).normalize_or(DVec3::Z);
            let middle = part.iter().map(direction).sum::<DVec3>().normalize_or(DVec3::Z);
            let spread = part.iter().map(|star| middle.angle_between(direction(star))).fold(0.0, f64::max);
            Cluster { first, count: part.len() as u32, middle, spread }
        };
        for region in sorted.chunk_by(|a, b| cell(a) >> 2 == cell(b) >> 2) {
            let begin = clusters.len();
            let all = cluster(first, region);
            for part in region.chunk_by(|a, b| cell(a) == cell(b)).flat_map(|same_cell| same_cell.chunks(CLUSTER)) {
                clusters.push(cluster(first, part));
                first += part.len() as u32;
            }
            regions.push(Region { all, clusters: begin..clusters.len() });
        }
        (StarClusters { clusters, regions }, sorted)
    }

    /// Clusters that may be on the screen of this camera, in a picture of `size` pixels: first star, how many, order. `table` is the sky's
    /// for the camera's radius; `edge` the angle of the shadow's edge in radians.
    pub fn listed(&self, camera: &Observer, table: &[[f32; 4]], edge: f64, size: [u32; 2]) -> Vec<[u32; 4]> {
        let aspect = f64::from(size[1]) / f64::from(size[0]);
        let mut listed: Vec<[u32; 4]> = (1..=ORDERS)
            .into_par_iter()
            .flat_map(|order| self.regions.par_iter().map(move |region| (order, region)))
            .filter(|(order, region)| cluster_may_be_seen(&region.all, *order, camera, table, edge, aspect))
            .flat_map_iter(|(order, region)| self.clusters[region.clusters.clone()].iter().map(move |cluster| (order, cluster)))
            .filter(|(order, cluster)| cluster_may_be_seen(cluster, *order, camera, table, edge, aspect))
            .map(|(order, cluster)| [cluster.first, cluster.count, order, 0])
            .collect();
        // The last workgroup is filled up with empty clusters.
        listed.resize(listed.len().next_multiple_of(CLUSTERS as usize), [0; 4]);
        listed
    }
}

/// Whether the image of this order of a cluster may be on the screen, by a cone that holds the image. In doubt the answer is yes.
fn cluster_may_be_seen(cluster: &Cluster, order: u32, camera: &Observer, table: &[[f32; 4]], edge: f64, aspect: f64) -> bool {
    let n = camera.axis_frame()[0];
    let phi = cluster.middle.angle_between(n);
    let (low, high) = ((phi - cluster.spread).max(0.0), (phi + cluster.spread).min(PI));
    let swept = |phi: f64| match order {
        1 => phi,
        2 => TAU - phi,
        _ => TAU + phi,
    };
    let seen = |phi: f64| edge * -(-f64::from(sky_seen(table, swept(phi) as f32)[0])).exp_m1();
    let (a, b) = (seen(low), seen(high));
    let (psi, half) = (0.5 * (a + b), 0.5 * (a - b).abs());
    // The cluster's extent round the axis.
    if phi - cluster.spread <= 0.0 || phi + cluster.spread >= PI {
        return true;
    }
    let round = (cluster.spread.sin() / phi.sin()).min(1.0).asin();
    let radius = half + round * (psi + half).min(FRAC_PI_2).sin().max((psi - half).sin());
    let side = (cluster.middle - n * cluster.middle.dot(n)).normalize_or_zero() * if order == 2 { -1.0 } else { 1.0 };
    let look = n * psi.cos() + side * psi.sin();
    // The size of a spot is a few pixels more.
    may_be_seen(camera, look, radius, 0.02, aspect)
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;
    use crate::render::sky::table::sky_table;
    use crate::spacetime::light;

    /// Every star that lands on the screen, by the exact solution, is in a cluster that was kept.
    #[test]
    fn no_star_on_the_screen_is_left_out() {
        let mut stars = Vec::new();
        for k in 0..20_000 {
            // A spiral over the sphere.
            let z = 1.0 - 2.0 * (f64::from(k) + 0.5) / 20_000.0;
            let azimuth = f64::from(k) * 2.399_963;
            let d = DVec3::new((1.0 - z * z).sqrt() * azimuth.cos(), (1.0 - z * z).sqrt() * azimuth.sin(), z);
            stars.push(Star { direction: d.as_vec3().to_array(), flux: 1.0, temperature: 5000.0, luminance: 0.0, unused: [0.0; 2] });
        }
        let (StarClusters { clusters, regions }, sorted) = StarClusters::of(&stars);
        let mut on_screen = 0;
        let mut kept = 0;
        for (position, momentum, angle) in [
            (DVec3::new(9.0, 2.0, 1.0), DVec3::ZERO, 0.3),
            (DVec3::new(9.0, 2.0, 1.0), DVec3::new(-0.8, 0.9, 0.2), 2.6),
            (DVec3::new(0.2, 1.05, 0.3), DVec3::new(1.5, 2.0, -1.0), 1.2),
            (DVec3::new(0.5, 0.1, 0.3), DVec3::new(-0.4, 0.0, 0.7), 4.4),
        ] {
            let attitude = DQuat::from_rotation_y(angle) * DQuat::from_rotation_x(0.4);
            let camera = Observer { position, momentum, attitude, field_of_view: 1.05 };
            let (l, size) = (camera.radius(), [640, 360]);
            let (table, edge) = (sky_table(l), light::shadow_angle(1.0 / l));
            let n = camera.axis_frame()[0];
            let may_be_seen = |cluster: &Cluster, order| cluster_may_be_seen(cluster, order, &camera, &table, edge, 360.0 / 640.0);
            for order in 1..=ORDERS {
                let of_regions =
                    regions.iter().flat_map(|region| clusters[region.clusters.clone()].iter().map(move |cluster| (region, cluster)));
                for (region, cluster) in of_regions {
                    let keep = may_be_seen(&region.all, order) && may_be_seen(cluster, order);
                    kept += u32::from(keep);
                    for star in &sorted[cluster.first as usize..(cluster.first + cluster.count) as usize] {
                        let d = DVec3::from_array(star.direction.map(f64::from)).normalize();
                        let phi = d.angle_between(n);
                        let side = (d - n * d.dot(n)).normalize_or_zero();
                        let (swept, turn) = if order == 1 { (phi, 1.0) } else { (TAU - phi, -1.0) };
                        let Some(slope) = light::sky_slope(swept, 1.0 / l) else { continue };
                        let u = 1.0 / l;
                        let energy = (slope * slope + u * u - u * u * u).max(0.0).sqrt();
                        let psi = light::rain_angle(slope, energy, u);
                        let seen = camera.seen_direction(n * psi.cos() + side * (turn * psi.sin()));
                        let Some([x, y]) = camera.pixel(seen, size) else { continue };
                        if (0.0..640.0).contains(&x) && (0.0..360.0).contains(&y) {
                            on_screen += 1;
                            assert!(keep, "a star at pixel {x}, {y} in order {order} was left out, camera at {position}");
                        }
                    }
                }
            }
        }
        // The test saw something, and the clusters are not all kept.
        assert!(on_screen > 3000, "{on_screen}");
        assert!(f64::from(kept) < 0.5 * (8 * clusters.len()) as f64, "{kept} of {}", 8 * clusters.len());
    }
}
