#define_import_path lensrunner::disk::arcs::place

// Projection of a point of the disk, and its light.

#import lensrunner::disk::arcs::bindings::{Bend, circles, disk_counters, table_bend}
#import lensrunner::disk::motion::{disk_frequency, disk_slant, LEAST_COSINE}
#import lensrunner::disk::sigma::Bearing
#import lensrunner::disk::types::{coverage, disk, DiskVertex, mixed_gas, own_share}
#import lensrunner::geometry::clip::finite_vector
#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::FLAG_DOPPLER
#import lensrunner::lensing::closed_form::{angle, HALF_TURN, sine_cosine}
#import lensrunner::lensing::lookup::{lens_lookup_at, LensRay}

/// Thin images are drawn this many pixels wider on either side than their coverage reaches, so that the rasteriser cuts nothing off.
const SOFT: f32 = 0.25;

/// Widths, in pixels, between which a gap between two rings opens. A narrower gap is closed from both sides: rows of pixels that hit or
/// miss it would show moiré.
const SEEN_GAP: vec2<f32> = vec2<f32>(2.0, 4.0);
/// A ring between gaps is drawn this many pixels wide at least: what is narrower than a pixel would be dashes.
const LEAST_RING: f32 = 1.5;
/// The step, in rad at the hole, by which the direction of a circle on the screen is found.
const ALONG_STEP: f32 = 0.01;

/// Number of circles over which the mean gas of a thin image is taken, for each of so many azimuths; as in src/render/disk/view.rs.
const THIN_SAMPLES: u32 = 8u;
const THIN_AZIMUTHS: u32 = 12u;
/// The first of these azimuths, and what is left from the last to half a turn: π(½/12)² and π(1 − (11½/12)²), in rad.
const FIRST_AZIMUTH: f32 = 0.0054541539;
const FROM_LAST_AZIMUTH: f32 = 0.25634524;

/// hc/λk at 550 nm, in K: light goes as exp(−this/T) by Wien's law.
const GREEN: f32 = 26160.0;

/// Least transmission of the second image that is assumed: the correction below is at most one over it.
const LEAST_PASSED: f32 = 0.1;

/// The variance of the pattern and its finest octaves: 1 and 0.35².
const VARIANCE: f32 = 1.1225;

/// ln of the mean light of gas at GREEN/T = `x` with streaks that give ln T the variance `v`: the normal distribution of ln T, weighted by
/// light exp(x(1 − e^{−y})), is approximated by one moved to `brightest`.
fn mean_light(x: f32, v: f32) -> f32 {
    return 0.5 * v * (x * x - x) / (1.0 + v * x) - x;
}

/// The inverse: x of gas whose mean light has the logarithm `light`.
fn mean_light_of(light: f32, v: f32) -> f32 {
    let b = 1.0 + v * (0.5 + light);
    return -2.0 * light / (b + sqrt(b * b - 2.0 * v * light));
}

/// How far ln T is above that of mean gas where streaks make most of the light.
fn brightest(x: f32, v: f32) -> f32 {
    return v * x / (1.0 + v * x);
}

/// The variance of ln T by streaks.
fn streak_variance() -> f32 {
    return VARIANCE * 0.0625 * disk.contrast * disk.contrast;
}

/// Gas as it is seen.
struct SeenGas {
    /// ln of the seen temperature in K.
    ln_temperature: f32,
    /// Optical depth.
    depth: f32,
    ln_g: f32,
}

/// A mix of the mean gas of a thin image (without streaks) and a circle's own gas, of which the share is `share`; depths are along the ray.
/// Light and the stopped share are mixed: mixing logarithms loses up to 40 % of the light of an image one to two pixels wide.
fn between(mean: SeenGas, own: SeenGas, share: f32) -> SeenGas {
    let v = streak_variance();
    let stops = 1.0 - exp(-vec2<f32>(mean.depth, own.depth));
    let x = min(GREEN / exp(vec2<f32>(mean.ln_temperature, own.ln_temperature)), vec2<f32>(80.0));
    let light = stops * exp(vec2<f32>(-x.x, mean_light(x.y, v)));
    let stopped = mix(stops.x, stops.y, share);
    // Streaks that give ln T the variance share·v are laid over it.
    let all = mean_light_of(log(clamp(mix(light.x, light.y, share) / max(stopped, 1e-6), 1e-37, 0.999)), share * v);
    return SeenGas(log(GREEN / max(all, 1e-3)), -log(1.0 - min(stopped, 0.999)), mix(mean.ln_g, own.ln_g, share));
}

/// Between which of THIN_AZIMUTHS azimuths an azimuth (rad from the camera's) lies: the one before (x), and the share of the way to the
/// next (y). They are closest together where the disk comes closest to the camera.
fn among_azimuths(azimuth: f32) -> vec2<f32> {
    let place = clamp(f32(THIN_AZIMUTHS) * sqrt(azimuth / HALF_TURN) - 0.5, 0.0, f32(THIN_AZIMUTHS) - 1.0);
    let before = min(floor(place), f32(THIN_AZIMUTHS - 2u));
    return vec2<f32>(before, place - before);
}

/// The mean gas of a thin image, whose width is seen by one ray: gas without streaks that is as bright as the image in the mean over its
/// width and over streaks; its depth is along the ray. `arriving` is the light's rain-frame momentum at the camera, `frequency` its
/// frequency there, `observed` that in the camera's frame. The image has the circles from `first` on, for all azimuths; of those at
/// `azimuth` (rad from the camera's) `count` are used. The transmission of the second image as it is drawn (`before`) is corrected to the
/// exact one.
fn mean_gas(first: u32, count: u32, azimuth: f32, arriving: vec3<f32>, frequency: f32, observed: f32, share: f32,
    before: Before) -> SeenGas {
    let n = frame.outward;
    let energy = frequency - frame.river_speed * dot(n, arriving);
    let angular = cross(n * frame.camera_radius, arriving);
    let shifts = (frame.flags & FLAG_DOPPLER) != 0u;
    let v = streak_variance();
    var light = 0.0;
    var stopped = 0.0;
    var shifted = 0.0;
    let place = among_azimuths(azimuth);
    let here = first + THIN_SAMPLES * u32(place.x);
    let t = place.y;
    for (var k = here; k < min(here + count, arrayLength(&circles) - THIN_SAMPLES); k++) {
        let a = circles[k];
        let b = circles[k + THIN_SAMPLES];
        let gas = mixed_gas(a.gas, b.gas, t);
        // Light of these orders has been round the hole: it left inward from outside the photon sphere and outward from inside.
        let found = disk_frequency(energy, angular, gas.radius, gas.radius < 1.5, vec2<f32>(gas.outward, gas.along));
        let ratio = clamp(observed / found.x, 1e-3, 1e3);
        let temperature = exp(gas.ln_temperature) * select(1.0, ratio, shifts);
        let depth = gas.depth / max(found.y, LEAST_COSINE);
        let x = GREEN / temperature;
        // Density is the fourth power of the temperature.
        let radius = mix(a.nearer_radius, b.nearer_radius, t);
        let motion = mix(vec2<f32>(a.nearer_outward, a.nearer_along), vec2<f32>(b.nearer_outward, b.nearer_along), vec2<f32>(t));
        let slanted = disk_frequency(energy, angular, radius, radius < 1.5, motion).y;
        let through = mix(a.nearer_depth, b.nearer_depth, t) / max(slanted, LEAST_COSINE);
        // The mean over streaks, by three points of a normal distribution.
        let denser = exp(4.0 * sqrt(3.0 * v));
        // In the second image gas has `share` of the area.
        let passed = 1.0 - share * (1.0 - (4.0 * exp(-through) + exp(-through * denser) + exp(-through / denser)) / 6.0);
        let drawn = 1.0 - before.all - before.own * (1.0 - passed);
        let shown = (1.0 - exp(-depth * exp(4.0 * brightest(x, v)))) * exp(mean_light(x, v))
            * (max(passed, LEAST_PASSED) / max(drawn, LEAST_PASSED));
        light += shown;
        shifted += shown * log(ratio);
        stopped += 1.0 - exp(-depth);
    }
    let own = max(stopped, 1e-6);
    let x = -log(clamp(light / own, 1e-37, 0.999));
    return SeenGas(log(GREEN / max(x, 1e-3)), -log(1.0 - min(own / f32(THIN_SAMPLES), 0.999)), shifted / max(light, 1e-37));
}

/// Half the width that a thin image is drawn with, in pixels.
fn drawn_half(half: f32) -> f32 {
    return half + (disk.least_width + SOFT) * (1.0 - own_share(half));
}

/// What the second image, where it is drawn thin, stops of light that comes through the gas of its circles.
struct Before {
    /// Of all light.
    all: f32,
    /// Of the light that this gas itself stops.
    own: f32,
}

/// Light of the third image crosses the second at one point, near the photon sphere; but a pixel shows the mean of the second's gas, and
/// covers what is beside the image as well. The third image is so thin that all of it is `d` pixels from the middle of the second, which
/// has the half width `half`, under a tent, whose gas has the mean optical depth `depth`, and which has gas on the share `share` of its
/// area.
fn second_before(d: f32, half: f32, depth: f32, share: f32) -> Before {
    // Over the tent by three points with its variance, 1/6.
    let aside = 0.57735027 * disk.least_width;
    let covered = 0.5 * coverage(d, half) + 0.25 * (coverage(d - aside, half) + coverage(d + aside, half));
    let own = own_share(half);
    return Before(covered * ((1.0 - own) * (1.0 - exp(-depth))) * share, covered * own);
}

/// A ray between two rays that are so close that everything is linear.
fn between_rays(a: LensRay, b: LensRay, t: f32) -> LensRay {
    var ray = b;
    ray.cos_psi = mix(a.cos_psi, b.cos_psi, t);
    ray.sin_psi = mix(a.sin_psi, b.sin_psi, t);
    ray.delay = mix(a.delay, b.delay, t);
    ray.frequency = mix(a.frequency, b.frequency, t);
    ray.emission_radial = mix(a.emission_radial, b.emission_radial, t);
    ray.emission_tangential = mix(a.emission_tangential, b.emission_tangential, t);
    ray.emission_frequency = mix(a.emission_frequency, b.emission_frequency, t);
    return ray;
}

/// The half plane, bounded by the axis, that contains all rays to a bearing: the same for all radii.
struct HalfPlane {
    /// Across the axis, a unit vector; and by how much the bearing's unit vector reaches along it.
    side: vec3<f32>,
    reach: f32,
    /// sin² and cos² of θ/2, free of cancellation.
    sine_squared: f32,
    cosine_squared: f32,
}

fn half_plane_of(at: Bearing) -> HalfPlane {
    let s = at.sine;
    let c = at.cosine;
    let halves = select(vec2<f32>(0.5 - 0.5 * c, 0.5 * s * s / (1.0 - c)), vec2<f32>(0.5 * s * s / (1.0 + c), 0.5 + 0.5 * c), c > 0.0);
    let up = -disk.camera_sine * c;
    let reach = sqrt(up * up + s * s);
    return HalfPlane((disk.upwards * up + disk.sideways * s) / max(reach, 1e-12), reach, halves.x, halves.y);
}

/// The rays that a vertex needs.
struct Rays {
    /// That of its circle; and that of the circle if the gap beside it is closed.
    ray: LensRay,
    in_gap: LensRay,
    /// Viewing angles: of the circle;
    circle: f32,
    /// in order 1 across its gap, and a little aside;
    gap: f32,
    aside: f32,
    /// else where the whole disk begins and ends,
    begin: f32,
    end: f32,
    /// and where the second image does beside the third: the same ray crosses the plane on the other side of the hole.
    second_begin: f32,
    second_end: f32,
    valid: bool,
    /// Whether the third image is behind the second.
    behind_second: bool,
}

/// The step aside, away from the axis, where the circle is near it.
fn step_aside(at: Bearing) -> f32 {
    return select(-ALONG_STEP, ALONG_STEP, at.cosine > 0.0);
}

/// Orders 2 and 3 may be thin: they need to know where the whole disk begins and ends here. A gap has another side, and its slant must be
/// known: the third point is a little aside. The lookup is called from this one place.
fn rays_of(row: u32, at: Bearing, plane: HalfPlane) -> Rays {
    let circle = circles[row];
    let order = circle.order;
    let reach = plane.reach;
    let step = step_aside(at);
    var rays: Rays;
    rays.valid = true;
    rays.behind_second = order == 3u;
    for (var k = 0u; k < select(select(3u, select(1u, 3u, circle.gap > 0.0), order == 1u), 5u, order == 3u); k++) {
        let beside = k == 1u && order == 1u;
        let aside = select(0.0, step, k == 2u && order == 1u);
        let which = select(select(circle.last_row, circle.first_row, k == 1u || k == 3u), row, k == 0u || order == 1u);
        let opposite = k > 2u;
        let there = circles[which];
        let r = select(there.gas.radius, there.gap_radius, beside);
        let ahead = select(at.cosine, -at.cosine, opposite) * disk.camera_cosine;
        let along = there.beyond + (r - there.gas.radius) * disk.camera_cosine - 2.0 * r * disk.camera_cosine
            * select(plane.sine_squared, plane.cosine_squared, opposite);
        let found = lens_lookup_at(along - r * aside * reach, r * (reach + aside * ahead), r * (ahead - aside * reach),
            select(order, 2u, opposite));
        let seen = found.valid && found.delay > 0.0;
        rays.valid = rays.valid && (seen || opposite);
        rays.behind_second = rays.behind_second && (seen || !opposite);
        let angle_seen = angle(found.sin_psi, found.cos_psi, 1.0);
        if k == 0u {
            rays.ray = found;
            rays.circle = angle_seen;
        } else if beside {
            rays.in_gap = found;
            rays.gap = angle_seen;
        } else if k == 1u {
            rays.begin = angle_seen;
        } else if order == 1u {
            rays.aside = angle_seen;
        } else if k == 2u {
            rays.end = angle_seen;
        } else if k == 3u {
            rays.second_begin = angle_seen;
        } else {
            rays.second_end = angle_seen;
        }
    }
    return rays;
}

/// How far a gap beside a circle of order 1 is open, 0 to 1.
fn open_gap(row: u32, at: Bearing, plane: HalfPlane, rays: Rays) -> f32 {
    let circle = circles[row];
    let gap = circle.gap;
    let n = frame.outward;
    let ray = rays.ray;
    let pixel = frame.pixel * pixel_of(n * ray.cos_psi + plane.side * ray.sin_psi, plane.side * ray.cos_psi - n * ray.sin_psi);
    // Across the circle, from its direction on the screen: towards the axis and round it per radian of θ.
    let across = (rays.aside - rays.circle) / step_aside(at) * disk.camera_cosine * at.sine / max(plane.reach, 1e-12);
    let way = vec2<f32>(across, ray.sin_psi * disk.steepness / max(plane.reach * plane.reach, 1e-12));
    let dark = circle.gap_sides * abs(rays.circle - rays.gap) * abs(way.y) / max(length(way), 1e-12) / pixel;
    let ring = dark * (1.0 - gap) / gap;
    return min(smoothstep(SEEN_GAP.x, SEEN_GAP.y, dark), 1.0 - clamp((LEAST_RING - ring) / max(dark, 1e-6), 0.0, 1.0));
}

/// Where a vertex is seen.
struct Apparition {
    /// The direction of the vertex, and that where all of a thin image is seen.
    at: vec3<f32>,
    all_at: vec3<f32>,
    /// The distance from the image's middle and half its width, in pixels; of order 1, which is wide, 0 and a great number.
    from_middle: f32,
    half_width: f32,
    /// For the third image: distance of its middle from that of the second image, and half the width of the second, in pixels.
    from_second: f32,
    second_half_width: f32,
}

/// `turn` is −1 where the image is on the other side of the axis.
fn apparition_of(order: u32, plane: HalfPlane, rays: Rays, turn: f32) -> Apparition {
    let n = frame.outward;
    let ray = rays.ray;
    let side = plane.side;
    let seen_at = n * ray.cos_psi + side * (turn * ray.sin_psi);
    if order == 1u {
        return Apparition(seen_at, seen_at, 0.0, 1e6, 0.0, 1e6);
    }
    // Pixels by the size of one at this place of the picture.
    let pixel = frame.pixel * pixel_of(seen_at, side * (turn * ray.cos_psi) - n * ray.sin_psi);
    let half = 0.5 * abs(rays.end - rays.begin) / pixel;
    let middle = 0.5 * (rays.begin + rays.end);
    let d = clamp((rays.circle - middle) / (pixel * max(half, 1e-4)), -1.0, 1.0) * drawn_half(half);
    let moved = middle + d * pixel;
    let seen_turn = sine_cosine(moved);
    let all_turn = sine_cosine(middle);
    return Apparition(n * seen_turn.y + side * (turn * seen_turn.x), n * all_turn.y + side * (turn * all_turn.x), d, half,
        (middle - 0.5 * (rays.second_begin + rays.second_end)) / pixel, 0.5 * abs(rays.second_end - rays.second_begin) / pixel);
}

/// Mixes the gas of a circle, `own`, with the mean gas of its image where that is thin; depths are along the disk's axis. `azimuth` is that
/// from the camera's, `slant` the way through the disk along the ray over that along its axis.
fn seen_gas(row: u32, own: SeenGas, slant: f32, azimuth: f32, rays: Rays, seen: Apparition, share: f32) -> SeenGas {
    let circle = circles[row];
    let own_part = own_share(seen.half_width);
    let shifts = (frame.flags & FLAG_DOPPLER) != 0u;
    let coming = -seen.all_at * rays.ray.frequency;
    let seen_as = camera_doppler_of(seen.all_at) * rays.ray.frequency;
    // Software drivers skip a loop without steps, but run through every branch.
    let is_behind = rays.behind_second && own_share(seen.second_half_width) < 1.0;
    let second_first = circle.first_sample - select(0u, THIN_SAMPLES * THIN_AZIMUTHS, circle.order == 3u);
    let hiding = mean_gas(second_first, select(0u, THIN_SAMPLES, is_behind), HALF_TURN - azimuth, coming, rays.ray.frequency, seen_as,
        share, Before(0.0, 1.0)).depth;
    var before = Before(0.0, 1.0);
    if is_behind {
        before = second_before(seen.from_second, seen.second_half_width, hiding, share);
    }
    let mean = mean_gas(circle.first_sample, select(THIN_SAMPLES, 0u, own_part == 1.0), azimuth, coming, rays.ray.frequency, seen_as, share,
        before);
    var gas = own;
    if own_part < 1.0 {
        let shown = SeenGas(mean.ln_temperature + select(mean.ln_g, 0.0, shifts), mean.depth, mean.ln_g);
        gas = between(shown, SeenGas(own.ln_temperature, own.depth * slant, own.ln_g), own_part);
        gas.depth /= max(slant, 1e-6);
    }
    return gas;
}

/// The light of a ring's bend on one side or the other.
fn bend_light(bend: Bend, at: Bearing, azimuth: f32) -> f32 {
    // Where θ changes its sign both sides have the same light: they meet before the first azimuth and beyond the last.
    let apart = min(min(azimuth / FIRST_AZIMUTH, (HALF_TURN - azimuth) / FROM_LAST_AZIMUTH), 1.0);
    return 0.5 * (bend.light + bend.other_light) + select(0.5, -0.5, at.sine < 0.0) * apart * (bend.light - bend.other_light);
}

/// The vertex of `row` there.
fn disk_vertex(row: u32, at: Bearing) -> DiskVertex {
    let circle = circles[row];
    let order = circle.order;
    let n = frame.outward;
    let s = at.sine;
    let c = at.cosine;
    let turn = select(1.0, -1.0, order == 2u);
    let plane = half_plane_of(at);
    var rays = rays_of(row, at, plane);

    // Share of the ring's area that has gas: less, by as much as it has grown over its gaps.
    let gap = circle.gap;
    var share = 1.0 - gap;
    if gap > 0.0 && order == 1u {
        let open = open_gap(row, at, plane, rays);
        share /= 1.0 - open * gap;
        rays.ray = between_rays(rays.in_gap, rays.ray, open);
    }
    let ray = rays.ray;
    let seen = apparition_of(order, plane, rays, turn);

    var vertex: DiskVertex;
    let apparent = (frame.camera_from_rain * vec4<f32>(seen.at * ray.delay, -ray.delay)).xyz;
    if !rays.valid || !finite_vector(apparent) {
        if rays.valid {
            atomicAdd(&disk_counters.caught, 1u);
        }
        return vertex;
    }
    vertex.apparent = apparent;
    vertex.path = ray.delay;

    // The photon and the gas at the point, rain axes.
    let outward = disk.towards * c + disk.sideways * s;
    let along_orbit = disk.sideways * c - disk.towards * s;
    let tangent = (plane.side * (c * disk.camera_cosine) - n * plane.reach) * turn;
    let leaving = outward * ray.emission_radial - tangent * ray.emission_tangential;
    let momentum = outward * circle.gas.outward + along_orbit * circle.gas.along;
    let gamma = sqrt(1.0 + dot(momentum, momentum));
    let emitted = max(gamma * ray.emission_frequency - dot(momentum, leaving), 1e-9);
    let observed = camera_doppler_of(seen.at) * ray.frequency;
    let g = clamp(observed / emitted, 1e-3, 1e3);
    let cosine = abs(dot(leaving, disk_normal())) / emitted;

    let slant = disk_slant(cosine, ray.delay, circle.gas.half_height);
    let azimuth = angle(abs(s), c, 1.0);
    let own = SeenGas(circle.gas.ln_temperature + log(g), circle.gas.depth, log(g));
    let gas = seen_gas(row, own, slant, azimuth, rays, seen, share);
    // From near, the slant is computed in each pixel.
    let along_ray = select(slant, 1.0, order <= disk.near_orders);
    vertex.turns = (at.theta + cuts_origin() - circle.gas.lead) / (2.0 * HALF_TURN);
    vertex.pattern_height = circle.gas.pattern_height;
    vertex.ln_temperature = gas.ln_temperature;
    vertex.depth = gas.depth * along_ray;
    vertex.ln_g = gas.ln_g;
    vertex.cosine = cosine;
    vertex.filled = share;
    vertex.from_middle = seen.from_middle;
    vertex.half_width = seen.half_width;
    let place = among_azimuths(azimuth);
    let bend = table_bend(row * THIN_AZIMUTHS + u32(place.x), place.y);
    // What a thin image shows of all of its gas is the same everywhere in it.
    let own_part = own_share(seen.half_width);
    vertex.bend_height = bend.height;
    vertex.bend_light = own_part * bend_light(bend, at, azimuth);
    vertex.bend_depth = own_part * bend.depth;
    vertex.side = f32((row - circle.first_row) & 1u);
    return vertex;
}

/// The disk's axis.
fn disk_normal() -> vec3<f32> {
    return vec3<f32>(0.0, 0.0, 1.0);
}

/// The camera's azimuth, which turns θ into the disk's own.
fn cuts_origin() -> f32 {
    return atan2(disk.towards.y, disk.towards.x);
}

/// Frequency in the camera's frame over that in the rain frame, of light from `look`: angles there are smaller by it.
fn camera_doppler_of(look: vec3<f32>) -> f32 {
    let m = frame.camera_from_rain;
    return max(m[3].w - (m[0].w * look.x + m[1].w * look.y + m[2].w * look.z), 1e-6);
}

/// Least cosine of the angle from the camera's axis for the size of a pixel: beyond it, where no picture reaches, pixels stay as large as
/// there.
const LEAST_AHEAD: f32 = 0.1;

/// The rain frame's angle that is one pixel of the middle of a picture long, at `look` in the direction `along` (rain axes) across it: by
/// aberration, and by the perspective, which draws out what is aside.
fn pixel_of(look: vec3<f32>, along: vec3<f32>) -> f32 {
    let m = frame.camera_from_rain;
    let seen = (m * vec4<f32>(look, -1.0)).xyz;
    let moves = (m * vec4<f32>(along, 0.0)).xyz;
    let ahead = max(-seen.z, LEAST_AHEAD * length(seen));
    return ahead * ahead / max(length(moves.xy * ahead + seen.xy * moves.z), 1e-9 * ahead * ahead);
}
