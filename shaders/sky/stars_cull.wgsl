// Which clusters of stars may be on the screen, in which orders: one thread per cluster. In doubt a cluster is kept.

#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::{STAR_CLUSTERS, STAR_ORDERS, StarCluster}
#import lensrunner::lensing::closed_form::{angle, sine_cosine}
#import lensrunner::sky::star_clusters::{star_cluster, star_clusters}
#import lensrunner::sky::table::{PI, sky_seen}

/// Those that are kept: STAR_ORDERS times the cluster's number, and one less than the order.
@group(1) @binding(1) var<storage, read_write> listed_clusters: array<u32>;
@group(1) @binding(2) var<storage, read_write> star_groups: StarGroups;

/// Arguments of the dispatch that projects, and how many clusters are listed for it.
struct StarGroups {
    groups_x: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    clusters: atomic<u32>,
}

/// What roundings may take from an angle, in rad.
const SLACK: f32 = 1e-3;

/// Whether the image of this order may be on the screen, by a cone of directions that holds it.
fn may_be_seen(cluster: StarCluster, order: u32) -> bool {
    let n = frame.outward;
    let along = dot(cluster.middle, n);
    let across = cluster.middle - n * along;
    let sin_phi = length(across);
    let phi = angle(sin_phi, along, 1.0);
    let low = phi - cluster.spread;
    let high = phi + cluster.spread;
    let turn = select(1.0, -1.0, order == 2u);
    let base = select(0.0, 2.0 * PI, order == 2u);
    let a = frame.shadow_edge * (1.0 - exp(-sky_seen(base + turn * max(low, 0.0)).x));
    let b = frame.shadow_edge * (1.0 - exp(-sky_seen(base + turn * min(high, PI)).x));
    let psi = 0.5 * (a + b);
    let half = 0.5 * abs(a - b);
    // Half of what the cluster covers of the circle round the axis: its own sine over that of its place.
    let round = min(cluster.sine / max(sin_phi, 1e-9), 1.0);
    let round_angle = angle(round, sqrt(1.0 - round * round), 1.0);
    // From the middle along the axis, then round it where that is longest.
    let widest = max(sine_cosine(min(psi + half, 0.5 * PI)).x, sine_cosine(psi - half).x);
    let radius = half + round_angle * widest + SLACK;
    // Round the axis itself the image is a disc or a ring.
    if (low <= 0.0) | (high >= PI) | (radius >= 0.5 * PI) {
        return true;
    }
    let centre = sine_cosine(psi);
    let cone = sine_cosine(radius);
    let look = n * centre.y + across * (turn * centre.x / sin_phi);
    // Light from l is in the cone where l · look − cos(radius) ≥ 0: the product of two four-vectors, the same for every observer. Seen by
    // the camera the cone is about c, c · l ≥ k, and its sine is as much smaller as c is longer.
    let seen = frame.camera_from_rain * vec4<f32>(look, -cone.y);
    let c = seen.xyz;
    let k = -seen.w;
    let slack = SLACK * length(c) + 1e-6 * frame.camera_from_rain[3].w;
    // Of the corners of the screen, with the margin of stars_project.wgsl.
    let tangents = (1.0 + 4.0 / frame.size) / frame.focal;
    let reach = cone.x + slack;
    let corner = dot(tangents, tangents);
    // Farther from the screen's middle than a corner.
    let away = -c.z * sqrt(1.0 + corner) < k - (cone.x * sqrt(corner) + slack * sqrt(1.0 + corner));
    // Wholly beyond a plane of the view's pyramid.
    let beyond = abs(c.xy) + c.z * tangents > reach * sqrt(1.0 + tangents * tangents);
    return (k <= 0.0) | !(away | any(beyond));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(star_clusters);
    if 2u * id.x >= size.x * size.y {
        return;
    }
    // Where the table has room for more, their count is 0.
    let cluster = star_cluster(id.x);
    for (var order = 1u; order <= STAR_ORDERS; order++) {
        if (cluster.count > 0.0) & may_be_seen(cluster, order) {
            let slot = atomicAdd(&star_groups.clusters, 1u);
            listed_clusters[slot] = STAR_ORDERS * id.x + order - 1u;
            atomicMax(&star_groups.groups_x, slot / STAR_CLUSTERS + 1u);
        }
    }
}
