// Stars, projected forward: eight threads per cluster and order, which go through its stars from the brightest on until they are too faint.
// Power goes as the black body at gT over the one at T, times the exact ratio of solid angles in the camera's frame, held below that of a
// star of finite size.

#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::colour::{blackbody_rgb, luminance}
#import lensrunner::gpu::types::{FLAG_BEAMING, FLAG_DOPPLER, SeenStar, STAR_CLUSTERS, STAR_ORDERS, Star}
#import lensrunner::sky::star_clusters::star_cluster
#import lensrunner::sky::star_spot::{BRIGHT_RADIUS, DIM, DIM_FOR_ONE, DIM_RADIUS}
#import lensrunner::sky::table::{camera_doppler, PI, sky_ratio, sky_seen}

/// Clusters that may be on the screen, and how many, as stars_cull.wgsl leaves them.
@group(1) @binding(1) var<storage, read> listed_clusters: array<u32>;
@group(1) @binding(2) var<storage, read> star_groups: StarGroups;
@group(1) @binding(3) var<storage, read> stars: array<Star>;
@group(1) @binding(4) var<storage, read_write> seen_stars: array<SeenStar>;
@group(1) @binding(5) var<storage, read_write> star_draw: StarDraw;

struct StarDraw {
    vertices: atomic<u32>,
    instances: u32,
    first_vertex: u32,
    first_instance: u32,
}

struct StarGroups {
    groups_x: u32,
    groups_y: u32,
    groups_z: u32,
    clusters: u32,
}

/// Least sine of the angle from the axis: a star's disc is finite, so its ring is never infinitely bright. 1e-6 rad is a giant at 10 pc;
/// it holds the magnification of a ring below about a million.
const STAR_DISC: f32 = 1e-6;

/// Threads of a cluster.
const LANES: u32 = 64u / STAR_CLUSTERS;
/// A star that is this much too faint ends its cluster, where magnification changes by less: at more than NEAR_AXIS from the axis.
const SURE: f32 = 8.0;
/// Sine of the angle from the axis.
const NEAR_AXIS: f32 = 0.3;
/// Widest angle between two stars of a cluster, in rad: the diagonal of a cell.
const CLUSTER_WIDTH: f32 = 0.18;
/// The least light of a star that is drawn, exposed: the peak of a spot is a third of it, so this is under one step of 8 bits.
const LEAST: f32 = 1e-2;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let place = id.x / LANES;
    let listed = listed_clusters[place];
    let cluster = star_cluster(listed / STAR_ORDERS);
    let order = 1u + listed % STAR_ORDERS;
    // The last workgroup has more room than clusters.
    let count = select(0u, u32(cluster.count), place < star_groups.clusters);
    let n = frame.outward;
    let flags = frame.flags;
    let exposure = frame.last_exposure;
    // Speed makes more of one star than of another: over an angle θ the Doppler factor 1/(γ(1 − β cos)) changes by e^{βγθ} at most, and the
    // light by its square.
    let gamma = frame.camera_from_rain[3].w;
    let sure = SURE * exp(2.0 * CLUSTER_WIDTH * sqrt(max(gamma * gamma - 1.0, 0.0)));
    // Two pixels of margin for the spot.
    let margin = 1.0 + 4.0 / frame.size;
    // A loop that ends is all that software drivers skip work by: a branch is run through by all.
    for (var i = id.x % LANES; i < count; i += LANES) {
        let star = stars[u32(cluster.first) + i];
        if star.flux < frame.faintest_star {
            break;
        }
        let cos_phi = clamp(dot(star.direction, n), -1.0, 1.0);
        let across = star.direction - n * cos_phi;
        let sin_phi = length(across);
        let phi = atan2(sin_phi, cos_phi);
        let turn = select(1.0, -1.0, order == 2u);
        let s = sky_seen(select(0.0, 2.0 * PI, order != 1u) + turn * phi);
        let gap = frame.shadow_edge * exp(-s.x);
        let psi = frame.shadow_edge - gap;
        let cos_psi = cos(psi);
        let sin_psi = sin(psi);
        let look = n * cos_psi + across * (turn * sin_psi / max(sin_phi, 1e-9));
        let doppler = camera_doppler(look);
        // dΩ_camera/dΩ_sky = (sinψ dψ)/(sinΦ dΦ) / D²; dψ/dΦ = gap · ds/dΦ.
        let magnification = sin_psi * gap * s.y / max(sin_phi, STAR_DISC) / (doppler * doppler);
        let flux = star.flux * magnification * frame.star_brightness;
        let g = sky_ratio(cos_psi, doppler);
        let exposed = flux * max(g * g * g * g, 1.0) * exposure;
        if (exposed * sure < LEAST) & (sin_phi > NEAR_AXIS) {
            break;
        }
        let camera = (frame.camera_from_rain * vec4<f32>(look, -1.0)).xyz;
        let ndc = camera.xy * frame.focal / -camera.z;
        if (exposed < LEAST) | (camera.z >= 0.0) | any(abs(ndc) > margin) {
            continue;
        }
        let light = blackbody_rgb(star.temperature * select(1.0, g, (flags & FLAG_DOPPLER) != 0u));
        // The catalogue gives light as seen: a black body at T of that luminance. At gT it is as much brighter as the black body is.
        let colour = light * flux / max(select(luminance(light), star.luminance, (flags & FLAG_BEAMING) != 0u), 1e-30);
        // Three vertices a star, and one instance: software drivers pay for each instance.
        let slot = atomicAdd(&star_draw.vertices, 3u) / 3u;
        if slot >= arrayLength(&seen_stars) {
            atomicSub(&star_draw.vertices, 3u);
            break;
        }
        let is_dim = luminance(colour) * exposure < DIM;
        let is_left_out = is_dim & ((u32(cluster.first) + i) % DIM_FOR_ONE != 0u);
        let radius = frame.star_sigma * select(BRIGHT_RADIUS, DIM_RADIUS, is_dim);
        seen_stars[slot] = SeenStar(ndc, select(radius, -radius, is_left_out), min(colour, vec3<f32>(6e4)));
    }
}
