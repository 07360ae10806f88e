// Stars, projected forward: one workgroup per cluster and order, one thread per star. Power goes as the black body at gT over the one at T, times the exact ratio of
// solid angles in the camera's frame, held below that of a star of finite size.

@group(1) @binding(0) var<storage, read> stars: array<Star>;
@group(1) @binding(1) var<storage, read_write> seen_stars: array<SeenStar>;
@group(1) @binding(2) var<storage, read_write> star_draw: StarDraw;

/// Clusters of stars that may be on the screen: first star, how many, image order.
@group(1) @binding(3) var<storage, read> star_clusters: array<vec4<u32>>;

struct StarDraw {
    vertices: atomic<u32>,
    instances: u32,
    first_vertex: u32,
    first_instance: u32,
}

/// Least sine of the angle from the axis: a star's disc is finite, so its ring is never infinitely bright. 1e-6 rad is a giant at 10 pc;
/// it holds the magnification of a ring below about a million.
const STAR_DISC: f32 = 1e-6;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let cluster = star_clusters[group.x];
    let order = cluster.z;
    if lane >= cluster.y {
        return;
    }
    let star = stars[cluster.x + lane];
    if star.direction.w < frame.sky_z.w {
        return;
    }
    let n = frame.radial.xyz;
    let cos_phi = clamp(dot(star.direction.xyz, n), -1.0, 1.0);
    let across = star.direction.xyz - n * cos_phi;
    let sin_phi = length(across);
    let phi = atan2(sin_phi, cos_phi);
    var swept = phi;
    var turn = 1.0;
    if order == 2u {
        swept = 2.0 * PI - phi;
        turn = -1.0;
    } else if order == 3u {
        swept = 2.0 * PI + phi;
    }
    let s = sky_seen(swept);
    let gap = frame.exposure.w * exp(-s.x);
    let psi = frame.exposure.w - gap;
    let look = n * cos(psi) + across * (turn * sin(psi) / max(sin_phi, 1e-9));
    let camera = (frame.camera_from_rain * vec4<f32>(look, -1.0)).xyz;
    if camera.z >= 0.0 {
        return;
    }
    let ndc = camera.xy * frame.projection.xy / -camera.z;
    // Two pixels of margin for the spot.
    let margin = 1.0 + 4.0 / frame.size.xy;
    if any(abs(ndc) > margin) {
        return;
    }
    let doppler = camera_doppler(look);
    // dΩ_camera/dΩ_sky = (sinψ dψ)/(sinΦ dΦ) / D²; dψ/dΦ = gap · ds/dΦ.
    let magnification = sin(psi) * gap * s.y / max(sin_phi, STAR_DISC) / (doppler * doppler);
    let flux = star.direction.w * magnification * frame.light.y;
    // Too faint to change a pixel of the developed picture: the peak of a spot is a third of its light, so this is under one step of 8 bits.
    let g = sky_ratio(cos(psi), doppler);
    if flux * max(g * g * g * g, 1.0) * adaptation.x < 1e-2 {
        return;
    }
    let flags = frame.switches.x;
    let rest = blackbody_rgb(star.colour.x);
    var light = blackbody_rgb(star.colour.x * select(1.0, g, (flags & FLAG_DOPPLER) != 0u));
    // The catalogue gives light as seen: a black body at T of that luminance. At gT it is as much brighter as the black body is.
    light /= max(luminance(select(light, rest, (flags & FLAG_BEAMING) != 0u)), 1e-30);
    let colour = light * flux;
    // Three vertices a star, and one instance: software drivers pay for each instance.
    let slot = atomicAdd(&star_draw.vertices, 3u) / 3u;
    if slot >= arrayLength(&seen_stars) {
        atomicSub(&star_draw.vertices, 3u);
        return;
    }
    seen_stars[slot] = SeenStar(vec4<f32>(ndc, frame.sky_y.w * select(3.6, 2.2, luminance(colour) * adaptation.x < 0.1), 0.0), vec4<f32>(min(colour, vec3<f32>(6e4)), 1.0));
}
