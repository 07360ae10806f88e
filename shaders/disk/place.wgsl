// Where a point of the disk is seen, and what its light becomes.

/// Thin images are drawn this many pixels wider on either side than their coverage reaches, so that the rasteriser cuts nothing off.
const SOFT: f32 = 0.25;

/// Half widths in pixels between which a thin image goes over from the mean of all its gas to gas from each of its circles, and is no longer drawn wider.
/// What is thinner is drawn wider than it is, and a pixel would show whichever circle its centre falls on: a row of dots. A wide image needs that no more, as
/// the gas thins out towards its edges, and it would move the gas aside.
const MEAN: vec2<f32> = vec2<f32>(0.25, 1.0);

/// Circles whose mean a thin image shows; as in src/render/disk/view.rs.
const THIN_SAMPLES: u32 = 8u;

/// hc/λk at 550 nm, in K: light goes as exp(−this/T) by Wien's law.
const GREEN: f32 = 26160.0;

/// The variance of the pattern and its finest octaves: 1 and 0.35².
const VARIANCE: f32 = 1.1225;

/// ln of the light of gas at GREEN/T = `x` in the mean over streaks by which ln T has the variance `v`: what gas_colour makes of it.
fn mean_light(x: f32, v: f32) -> f32 {
    return 0.5 * v * (x * x - x) / (1.0 + v * x) - x;
}

/// The inverse: x of gas whose light has the logarithm `light` in the mean.
fn mean_light_of(light: f32, v: f32) -> f32 {
    let b = 1.0 + v * (0.5 + light);
    return -2.0 * light / (b + sqrt(b * b - 2.0 * v * light));
}

/// The gas that is as bright as an image is in the mean over its width, where that is thin: all of it is seen by the same ray. x: ln of the temperature
/// that is seen, in K; y: optical depth along the ray. `arriving` is the light's rain-frame momentum at the camera, `observed` its frequency there.
fn mean_gas(first: u32, arriving: vec3<f32>, frequency: f32, observed: f32) -> vec2<f32> {
    let n = frame.radial.xyz;
    let energy = frequency - frame.side_b.w * dot(n, arriving);
    let angular = cross(n * frame.radial.w, arriving);
    let shifts = (frame.switches.x & FLAG_DOPPLER) != 0u;
    // Streaks brighten cold gas more than warm gas: the mean is that of light with them.
    let v = VARIANCE * 0.0625 * disk.gas.x * disk.gas.x;
    var light = 0.0;
    var stopped = 0.0;
    for (var k = first; k < min(first + THIN_SAMPLES, arrayLength(&circles)); k++) {
        let there = circles[k];
        // Light of these orders has been round the hole: it left inward from outside the photon sphere and outward from within.
        let found = disk_frequency(energy, angular, there.gas.x, there.gas.x < 1.5, there.motion.xy);
        let temperature = exp(there.gas.z) * select(1.0, clamp(observed / found.x, 1e-3, 1e3), shifts);
        let stops = 1.0 - exp(-there.gas.w / max(found.y, LEAST_COSINE));
        light += stops * exp(mean_light(GREEN / temperature, v));
        stopped += stops;
    }
    let own = max(stopped, 1e-6);
    let x = mean_light_of(log(clamp(light / own, 1e-37, 0.999)), v);
    return vec2<f32>(log(GREEN / max(x, 1e-3)), -log(1.0 - min(own / f32(THIN_SAMPLES), 0.999)));
}

/// The vertex of `row` at θ.
fn disk_vertex(row: u32, theta: f32) -> DiskVertex {
    let circle = circles[row];
    let order = circle.rows.x;
    let n = frame.radial.xyz;
    let s = sin(theta);
    let c = cos(theta);
    let half_sine = sin(0.5 * theta);
    let turn = select(1.0, -1.0, order == 2u);

    // The same for all radii: the half plane, bounded by the axis, that holds the ray.
    let up = -disk.towards.w * c;
    let reach = sqrt(up * up + s * s);
    let side = (disk.upwards.xyz * up + disk.sideways.xyz * s) / max(reach, 1e-12);

    var ray: LensRay;
    var psi = vec3<f32>(0.0);
    var valid = true;
    // Orders 2 and 3 may be thin: they need to know where the whole disk begins and ends here. The lookup is called from this one place.
    for (var k = 0u; k < select(3u, 1u, order == 1u); k++) {
        let which = select(select(circle.rows.z, circle.rows.y, k == 1u), row, k == 0u);
        let there = circles[which];
        let r = there.gas.x;
        let along = there.place.x - 2.0 * r * disk.sideways.w * half_sine * half_sine;
        let found = lens_lookup_at(along, r * reach, r * c * disk.sideways.w, order);
        valid = valid && found.valid && found.delay > 0.0;
        let angle_seen = atan2(found.sin_psi, found.cos_psi);
        if k == 0u {
            ray = found;
            psi.x = angle_seen;
        } else if k == 1u {
            psi.y = angle_seen;
        } else {
            psi.z = angle_seen;
        }
    }

    var seen_at = n * ray.cos_psi + side * (turn * ray.sin_psi);
    var thin = vec2<f32>(0.0, 1e6);
    if order > 1u {
        // Pixels by the size of one at this place of the picture.
        let pixel = frame.size.z * camera_doppler_of(seen_at);
        let half = 0.5 * abs(psi.z - psi.y) / pixel;
        let middle = 0.5 * (psi.y + psi.z);
        let drawn = half + (disk.gas.w + SOFT) * (1.0 - smoothstep(MEAN.x, MEAN.y, half));
        let d = clamp((psi.x - middle) / (pixel * max(half, 1e-4)), -1.0, 1.0) * drawn;
        thin = vec2<f32>(d, half);
        let moved = middle + d * pixel;
        seen_at = n * cos(moved) + side * (turn * sin(moved));
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
    let m = frame.camera_from_rain;
    let arriving = -seen_at * ray.frequency;
    let observed = m[0].w * arriving.x + m[1].w * arriving.y + m[2].w * arriving.z + m[3].w * ray.frequency;
    let g = clamp(observed / emitted, 1e-3, 1e3);
    let cosine = abs(dot(leaving, disk_normal())) / emitted;

    let ln_g = log(g);
    let turns = (theta + cuts_origin() - circle.gas.y) / (2.0 * HALF_TURN);
    let slant = disk_slant(cosine, ray.delay, circle.motion.z);
    var shown = vec2<f32>(circle.gas.z + ln_g, circle.gas.w);
    if order > 1u && thin.y < MEAN.y {
        let shifts = (frame.switches.x & FLAG_DOPPLER) != 0u;
        let mean = mean_gas(circle.rows.w, arriving, ray.frequency, observed);
        shown = mix(vec2<f32>(mean.x + select(ln_g, 0.0, shifts), mean.y / max(slant, 1e-6)), shown, smoothstep(MEAN.x, MEAN.y, thin.y));
    }
    // Close by, the slant is worked out in each pixel.
    vertex.gas = vec4<f32>(turns, circle.motion.w, shown.x, shown.y * select(slant, 1.0, order <= disk.room.y));
    vertex.more = vec4<f32>(ln_g, cosine, thin);
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
    return 1.0 / max(m[3].w - (m[0].w * look.x + m[1].w * look.y + m[2].w * look.z), 1e-6);
}
