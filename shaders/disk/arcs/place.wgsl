#define_import_path lensrunner::disk::arcs::place

// Projection of a point of the disk, and its light.

#import lensrunner::disk::arcs::bindings::{bends, circles, disk_counters}
#import lensrunner::disk::motion::{disk_frequency, disk_slant, LEAST_COSINE}
#import lensrunner::disk::sigma::Bearing
#import lensrunner::disk::types::{coverage, disk, DiskVertex, own_share}
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
    return VARIANCE * 0.0625 * disk.gas.x * disk.gas.x;
}

/// A mix of the mean gas of a thin image (x: ln of the seen temperature, y: optical depth along the ray; without streaks) and a circle's
/// own gas, of which the share is `share`. Light and the stopped share are mixed: mixing logarithms lost up to 40 % of the light of an
/// image one to two pixels wide.
fn between(mean: vec2<f32>, own: vec2<f32>, share: f32) -> vec2<f32> {
    let v = streak_variance();
    let stops = 1.0 - exp(-vec2<f32>(mean.y, own.y));
    let x = min(GREEN / exp(vec2<f32>(mean.x, own.x)), vec2<f32>(80.0));
    let light = stops * exp(vec2<f32>(-x.x, mean_light(x.y, v)));
    let stopped = mix(stops.x, stops.y, share);
    // Streaks that give ln T the variance share·v are laid over it.
    let all = mean_light_of(log(clamp(mix(light.x, light.y, share) / max(stopped, 1e-6), 1e-37, 0.999)), share * v);
    return vec2<f32>(log(GREEN / max(all, 1e-3)), -log(1.0 - min(stopped, 0.999)));
}

/// Between which of THIN_AZIMUTHS azimuths an azimuth (rad from the camera's) lies: the one before (x), and the share of the way to the
/// next (y). They are closest together where the disk comes closest to the camera.
fn among_azimuths(azimuth: f32) -> vec2<f32> {
    let place = clamp(f32(THIN_AZIMUTHS) * sqrt(azimuth / HALF_TURN) - 0.5, 0.0, f32(THIN_AZIMUTHS) - 1.0);
    let before = min(floor(place), f32(THIN_AZIMUTHS - 2u));
    return vec2<f32>(before, place - before);
}

/// The mean gas of a thin image, whose width is seen by one ray: gas without streaks that is as bright as the image in the mean over its
/// width and over streaks. Returns x: ln of the seen temperature in K; y: optical depth along the ray; z: ln g. `arriving` is the light's
/// rain-frame momentum at the camera, `frequency` its frequency there, `observed` that in the camera's frame. The image has the circles
/// from `first` on, for all azimuths; of those at `azimuth` (rad from the camera's) `count` are used. The transmission of the second image
/// as it is drawn (`before`, see [`second_before`]) is corrected to the exact one.
fn mean_gas(first: u32, count: u32, azimuth: f32, arriving: vec3<f32>, frequency: f32, observed: f32, share: f32, before: vec2<f32>) -> vec3<f32> {
    let n = frame.radial.xyz;
    let energy = frequency - frame.side_b.w * dot(n, arriving);
    let angular = cross(n * frame.radial.w, arriving);
    let shifts = (frame.switches.x & FLAG_DOPPLER) != 0u;
    let v = streak_variance();
    var light = 0.0;
    var stopped = 0.0;
    var shifted = 0.0;
    let place = among_azimuths(azimuth);
    let here = first + THIN_SAMPLES * u32(place.x);
    let t = vec4<f32>(place.y);
    for (var k = here; k < min(here + count, arrayLength(&circles) - THIN_SAMPLES); k++) {
        var there = circles[k];
        let next = circles[k + THIN_SAMPLES];
        there.gas = mix(there.gas, next.gas, t);
        there.motion = mix(there.motion, next.motion, t);
        there.place = mix(there.place, next.place, t);
        // Light of these orders has been round the hole: it left inward from outside the photon sphere and outward from inside.
        let found = disk_frequency(energy, angular, there.gas.x, there.gas.x < 1.5, there.motion.xy);
        let ratio = clamp(observed / found.x, 1e-3, 1e3);
        let temperature = exp(there.gas.z) * select(1.0, ratio, shifts);
        let depth = there.gas.w / max(found.y, LEAST_COSINE);
        let x = GREEN / temperature;
        // Density is the fourth power of the temperature.
        let nearer = there.place;
        let slanted = disk_frequency(energy, angular, nearer.w, nearer.w < 1.5, nearer.yz).y;
        let through = nearer.x / max(slanted, LEAST_COSINE);
        // The mean over streaks, by three points of a normal distribution.
        let denser = exp(4.0 * sqrt(3.0 * v));
        // In the second image gas has `share` of the area.
        let passed = 1.0 - share * (1.0 - (4.0 * exp(-through) + exp(-through * denser) + exp(-through / denser)) / 6.0);
        let drawn = 1.0 - before.x - before.y * (1.0 - passed);
        let shown = (1.0 - exp(-depth * exp(4.0 * brightest(x, v)))) * exp(mean_light(x, v)) * (max(passed, LEAST_PASSED) / max(drawn, LEAST_PASSED));
        light += shown;
        shifted += shown * log(ratio);
        stopped += 1.0 - exp(-depth);
    }
    let own = max(stopped, 1e-6);
    let x = -log(clamp(light / own, 1e-37, 0.999));
    return vec3<f32>(log(GREEN / max(x, 1e-3)), -log(1.0 - min(own / f32(THIN_SAMPLES), 0.999)), shifted / max(light, 1e-37));
}

/// Half the width that a thin image is drawn with, in pixels.
fn drawn_half(half: f32) -> f32 {
    return half + (disk.gas.w + SOFT) * (1.0 - own_share(half));
}

/// What the second image, where it is drawn thin, stops of light that comes through the gas of its circles: x of all light, y of the light
/// that this gas itself stops. Light of the third image crosses the second at one point, near the photon sphere; but a pixel shows the mean
/// of the second's gas, and covers what is beside the image as well. The third image is so thin that all of it is `d` pixels from the
/// middle of the second, which has the half width `half`, under a tent, and whose gas has the mean optical depth `depth`.
fn second_before(d: f32, half: f32, depth: f32) -> vec2<f32> {
    // Over the tent by three points with its variance, 1/6.
    let aside = 0.57735027 * disk.gas.w;
    let covered = 0.5 * coverage(d, half) + 0.25 * (coverage(d - aside, half) + coverage(d + aside, half));
    let own = own_share(half);
    return covered * vec2<f32>((1.0 - own) * (1.0 - exp(-depth)), own);
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

/// The vertex of `row` there.
fn disk_vertex(row: u32, at: Bearing) -> DiskVertex {
    let circle = circles[row];
    let order = circle.rows.x;
    let n = frame.radial.xyz;
    let s = at.sine;
    let c = at.cosine;
    // sin² and cos² of θ/2, free of cancellation.
    let halves = select(vec2<f32>(0.5 - 0.5 * c, 0.5 * s * s / (1.0 - c)), vec2<f32>(0.5 * s * s / (1.0 + c), 0.5 + 0.5 * c), c > 0.0);
    let turn = select(1.0, -1.0, order == 2u);

    // The same for all radii: the half plane, bounded by the axis, that contains the ray.
    let up = -disk.towards.w * c;
    let reach = sqrt(up * up + s * s);
    let side = (disk.upwards.xyz * up + disk.sideways.xyz * s) / max(reach, 1e-12);

    var ray: LensRay;
    // The ray of this circle if the gap beside it is closed.
    var in_gap: LensRay;
    let gap = circle.place.z;
    var psi = vec3<f32>(0.0);
    var valid = true;
    // Where the second image begins and ends beside the third: the same ray crosses the plane on the other side of the hole.
    var second = vec2<f32>(0.0);
    var behind_second = order == 3u;
    // Away from the axis, where the circle is near it.
    let step = select(-ALONG_STEP, ALONG_STEP, c > 0.0);
    // Orders 2 and 3 may be thin: they need to know where the whole disk begins and ends here. A gap has another side, and its slant must
    // be known: the third point is a little aside. The lookup is called from this one place.
    for (var k = 0u; k < select(select(3u, select(1u, 3u, gap > 0.0), order == 1u), 5u, order == 3u); k++) {
        let beside = k == 1u && order == 1u;
        let aside = select(0.0, step, k == 2u && order == 1u);
        let which = select(select(circle.rows.z, circle.rows.y, k == 1u || k == 3u), row, k == 0u || order == 1u);
        let opposite = k > 2u;
        let there = circles[which];
        let r = select(there.gas.x, there.place.y, beside);
        let ahead = select(c, -c, opposite) * disk.sideways.w;
        let along = there.place.x + (r - there.gas.x) * disk.sideways.w - 2.0 * r * disk.sideways.w * select(halves.x, halves.y, opposite);
        let found = lens_lookup_at(along - r * aside * reach, r * (reach + aside * ahead), r * (ahead - aside * reach), select(order, 2u, opposite));
        let seen = found.valid && found.delay > 0.0;
        valid = valid && (seen || opposite);
        behind_second = behind_second && (seen || !opposite);
        let angle_seen = angle(found.sin_psi, found.cos_psi, 1.0);
        if k == 0u {
            ray = found;
            psi.x = angle_seen;
        } else if k == 1u {
            in_gap = found;
            psi.y = angle_seen;
        } else if k == 2u {
            psi.z = angle_seen;
        } else if k == 3u {
            second.x = angle_seen;
        } else {
            second.y = angle_seen;
        }
    }

    // Share of the ring's area that has gas: less, by as much as it has grown over its gaps.
    var share = 1.0 - gap;
    if gap > 0.0 && order == 1u {
        let pixel = frame.size.z * pixel_of(n * ray.cos_psi + side * ray.sin_psi, side * ray.cos_psi - n * ray.sin_psi);
        // Across the circle, from its direction on the screen: towards the axis and round it per radian of θ.
        let way = vec2<f32>((psi.z - psi.x) / step * disk.sideways.w * s / max(reach, 1e-12), ray.sin_psi * disk.upwards.w / max(reach * reach, 1e-12));
        let dark = circle.place.w * abs(psi.x - psi.y) * abs(way.y) / max(length(way), 1e-12) / pixel;
        let ring = dark * share / gap;
        let open = min(smoothstep(SEEN_GAP.x, SEEN_GAP.y, dark), 1.0 - clamp((LEAST_RING - ring) / max(dark, 1e-6), 0.0, 1.0));
        share /= 1.0 - open * gap;
        ray = between_rays(in_gap, ray, open);
    }

    var seen_at = n * ray.cos_psi + side * (turn * ray.sin_psi);
    // For order 1, which is wide, the share of the area with gas; in the others, whose gaps are closed, it is the same everywhere.
    var thin = vec2<f32>(share, 1e6);
    // Where all of a thin image is seen.
    var all_at = seen_at;
    // For the third image: distance of its middle from that of the second image, and half the width of the second, in pixels.
    var nearer = vec2<f32>(0.0, 1e6);
    if order > 1u {
        // Pixels by the size of one at this place of the picture.
        let pixel = frame.size.z * pixel_of(seen_at, side * (turn * ray.cos_psi) - n * ray.sin_psi);
        let half = 0.5 * abs(psi.z - psi.y) / pixel;
        let middle = 0.5 * (psi.y + psi.z);
        let d = clamp((psi.x - middle) / (pixel * max(half, 1e-4)), -1.0, 1.0) * drawn_half(half);
        thin = vec2<f32>(d, half);
        nearer = vec2<f32>(middle - 0.5 * (second.x + second.y), 0.5 * abs(second.y - second.x)) / pixel;
        let moved = middle + d * pixel;
        let seen_turn = sine_cosine(moved);
        let all_turn = sine_cosine(middle);
        seen_at = n * seen_turn.y + side * (turn * seen_turn.x);
        all_at = n * all_turn.y + side * (turn * all_turn.x);
    }

    var vertex: DiskVertex;
    let apparent = (frame.camera_from_rain * vec4<f32>(seen_at * ray.delay, -ray.delay)).xyz;
    if !valid || !finite_vector(apparent) {
        if valid {
            atomicAdd(&disk_counters.caught, 1u);
        }
        vertex.apparent = vec4<f32>(0.0);
        return vertex;
    }
    vertex.apparent = vec4<f32>(apparent, ray.delay);

    // The photon and the gas at the point, rain axes.
    let outward = disk.towards.xyz * c + disk.sideways.xyz * s;
    let along_orbit = disk.sideways.xyz * c - disk.towards.xyz * s;
    let tangent = (side * (c * disk.sideways.w) - n * reach) * turn;
    let leaving = outward * ray.emission_radial - tangent * ray.emission_tangential;
    let momentum = outward * circle.motion.x + along_orbit * circle.motion.y;
    let gamma = sqrt(1.0 + dot(momentum, momentum));
    let emitted = max(gamma * ray.emission_frequency - dot(momentum, leaving), 1e-9);
    let arriving = -seen_at * ray.frequency;
    let observed = camera_doppler_of(seen_at) * ray.frequency;
    let g = clamp(observed / emitted, 1e-3, 1e3);
    let cosine = abs(dot(leaving, disk_normal())) / emitted;

    var ln_g = log(g);
    let turns = (at.theta + cuts_origin() - circle.gas.y) / (2.0 * HALF_TURN);
    let slant = disk_slant(cosine, ray.delay, circle.motion.z);
    var shown = vec2<f32>(circle.gas.z + ln_g, circle.gas.w);
    let own = own_share(thin.y);
    let shifts = (frame.switches.x & FLAG_DOPPLER) != 0u;
    let azimuth = angle(abs(s), c, 1.0);
    let coming = -all_at * ray.frequency;
    let seen_as = camera_doppler_of(all_at) * ray.frequency;
    // Software drivers skip a loop without steps, but run through every branch.
    let is_behind = behind_second && own_share(nearer.y) < 1.0;
    let second_first = circle.rows.w - select(0u, THIN_SAMPLES * THIN_AZIMUTHS, order == 3u);
    let hiding = mean_gas(second_first, select(0u, THIN_SAMPLES, is_behind), HALF_TURN - azimuth, coming, ray.frequency, seen_as, share, vec2<f32>(0.0, 1.0)).y;
    let before = select(vec2<f32>(0.0, 1.0), second_before(nearer.x, nearer.y, hiding) * vec2<f32>(share, 1.0), is_behind);
    let mean = mean_gas(circle.rows.w, select(THIN_SAMPLES, 0u, own == 1.0), azimuth, coming, ray.frequency, seen_as, share, before);
    if own < 1.0 {
        let along = between(vec2<f32>(mean.x + select(mean.z, 0.0, shifts), mean.y), vec2<f32>(shown.x, shown.y * slant), own);
        shown = vec2<f32>(along.x, along.y / max(slant, 1e-6));
        ln_g = mix(mean.z, ln_g, own);
    }
    // From near, the slant is computed in each pixel.
    let along_ray = select(slant, 1.0, order <= disk.room.y);
    vertex.gas = vec4<f32>(turns, circle.motion.w, shown.x, shown.y * along_ray);
    vertex.more = vec4<f32>(ln_g, cosine, thin);
    let place = among_azimuths(azimuth);
    let first_bend = row * THIN_AZIMUTHS + u32(place.x);
    // What a thin image shows of all of its gas is the same everywhere in it.
    let bend = mix(bends[first_bend], bends[first_bend + 1u], vec4<f32>(place.y));
    // Where θ changes its sign both sides have the same light: they meet before the first azimuth and beyond the last.
    let apart = min(min(azimuth / FIRST_AZIMUTH, (HALF_TURN - azimuth) / FROM_LAST_AZIMUTH), 1.0);
    let brighter = 0.5 * (bend.y + bend.w) + select(0.5, -0.5, s < 0.0) * apart * (bend.y - bend.w);
    vertex.bend = vec4<f32>(bend.x, own * brighter, own * bend.z, f32((row - circle.rows.y) & 1u));
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
