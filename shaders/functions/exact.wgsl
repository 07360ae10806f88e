// The closed form solved for each vertex: the twin of src/lensing/shooting.rs.

fn fire(cam: LensCamera, x: f32, phi: f32) -> Fired {
    let start = fan_start(cam, x);
    let shot = shoot(cam.a, start.x, start.y, phi);
    let carried = shot.carried;
    return Fired(shot.fate, carried.rise, carried.chord * carried.rise - start.x, carried.by_slope + carried.by_d * start.z, 0.0);
}

/// e − w without cancellation, e > 0.
fn ahead(e: f32, w: f32, u: f32, lapse2: f32) -> f32 {
    return select(e - w, u * u * lapse2 / (e + w), w > 0.0);
}

/// T − t̂: Painlevé–Gullstrand time less that which is regular on the horizon.
fn to_rain_time(u: f32) -> f32 {
    let beta = sqrt(u);
    return 2.0 / beta - 2.0 * log(1.0 + beta);
}

/// The travel time of light along the ray (w, e, w_e) from u = `c` to the camera over `phi`: by parts in closed form, the rest by Gauss's
/// rule of twelve on panels of up to two radians, each half of the way reached from its own end.
fn exact_delay(cam: LensCamera, c: f32, lapse2: f32, phi: f32, ray: Joined) -> f32 {
    let a = cam.a;
    let e = ray.energy;
    let w = ray.slope;
    let w_e = ray.emission_slope;
    let d = select(critical_excess(a, w), (e * e - CRITICAL_SQUARE) / 16.0, cam.lapse2 < 0.0);
    let scattered = d < 0.0 && a <= PHOTON_SPHERE;
    let near = (d < 0.0 && !scattered) || (phi < 0.5 && c < 2.0 * a && a < 2.0 * c);
    let outgoing = w > 0.0;
    var closed = 0.0;
    if near {
        closed = 2.0 * log(c * ahead(e, w, a, cam.lapse2) / (a * ahead(e, w_e, c, lapse2)));
    } else if scattered {
        closed = log(ahead(e, w_e, c, lapse2) * a / (c * ahead(e, w, a, cam.lapse2))) + (w / a - w_e / c) / e;
    } else {
        let rest = log((e + abs(w_e)) * a / (c * (e + abs(w))));
        closed = select(rest, -rest, outgoing) + (w / a - w_e / c) / e;
        if outgoing {
            closed -= 2.0 * log(lapse2 / cam.lapse2);
        }
    }
    let panels = max(ceil(0.5 * phi), 1.0);
    let half = 0.5 * phi / panels;
    var rule = INSIDE_NODES;
    var sum = 0.0;
    let count = 12u * u32(panels);
    for (var k = 0u; k < count; k++) {
        let node = rule[k % 6u];
        let at = half * (2.0 * f32(k / 12u) + 1.0 + select(-node.x, node.x, k % 12u < 6u));
        let from_camera = at < 0.5 * phi;
        let u0 = select(c, a, from_camera);
        let w0 = select(-w_e, w, from_camera);
        let carried = carry(u0, w0, pole_orbit(select(phi - at, at, from_camera), d));
        let u = u0 + carried.rise;
        let slope = (carried.chord * carried.rise - w0) * select(-1.0, 1.0, from_camera);
        if near {
            sum += node.y * e * (1.0 + 3.0 * u) / (u * u);
        } else if scattered {
            sum += node.y * (0.5 * u / e + 1.5 * (e + slope) / (1.0 - u));
        } else {
            sum += node.y * (0.5 * u / e + 1.5 * u * u / (e + abs(slope)));
        }
    }
    return closed + half * sum + to_rain_time(a) - to_rain_time(c);
}

/// The ray of a point outside.
fn exact_ray(cam: LensCamera, at: SourcePoint, sweep: f32) -> LensRay {
    if !(finite(at.r) && finite(at.dr) && at.r > 1e-3 && at.lapse2 > 0.0) {
        return no_ray();
    }
    let phi = max(sweep, SMALLEST_SWEEP);
    let c = 1.0 / at.r;
    let lapse2 = max(at.lapse2, 1e-4);
    let ray = shot_ray(cam, c, -at.dr * c * cam.a, phi);
    if !ray.found {
        return no_ray();
    }
    return ray_of(cam, c, lapse2, ray.slope, ray.energy, ray.emission_slope, exact_delay(cam, c, lapse2, phi, ray));
}
