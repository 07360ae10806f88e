#define_import_path lensrunner::lensing::exact

// The closed form of the ray solved for each vertex in single precision, as src/spacetime/light/ does it in double precision: the ray that
// meets a point by Newton's method in a bracket, and its travel time.

#import lensrunner::lensing::closed_form
#import lensrunner::lensing::closed_form::{bent_sweep, finite, HALF_TURN, LensCamera, slope_guess, SMALLEST_SWEEP, SourcePoint}
#import lensrunner::lensing::inside::INSIDE_NODES
#import lensrunner::lensing::lookup::{LensRay, no_ray, ray_of}
#import lensrunner::lensing::orbit::{carry, critical_excess, CRITICAL_SQUARE, LEFT, MET, PHOTON_SPHERE, pole_orbit, shoot}

/// A shot from the camera: its fate, u − a and du/dΦ at the end, ∂u/∂x there.
struct Fired {
    fate: u32,
    rise: f32,
    slope: f32,
    rate: f32,
}

/// The ray found: w, e, w_e; `found` is false where none was.
struct Joined {
    slope: f32,
    energy: f32,
    emission_slope: f32,
    found: bool,
}

/// Shots after which the best so far is taken.
const MOST_SHOTS: u32 = 30u;
/// What counts as beyond every slope.
const BEYOND: f32 = 3e38;

/// Rays of a camera are numbered by x, which grows with the slope: w outside; inside w + s ≤ 0, from which e has its digits.
fn fan_shift(cam: LensCamera) -> f32 {
    return select(0.0, cam.a * sqrt(max(-cam.lapse_squared, 0.0)), cam.lapse_squared < 0.0);
}

/// w, d and ∂d/∂x of the ray x.
fn fan_start(cam: LensCamera, x: f32) -> vec3<f32> {
    let s = fan_shift(cam);
    let w = x - s;
    let d = select(critical_excess(cam.a, w), (x * (x - 2.0 * s) - CRITICAL_SQUARE) / 16.0, cam.lapse_squared < 0.0);
    return vec3<f32>(w, d, 0.125 * w);
}

fn fan_energy(cam: LensCamera, x: f32) -> f32 {
    if cam.lapse_squared < 0.0 {
        return sqrt(max(x * (x - 2.0 * fan_shift(cam)), 0.0));
    }
    return closed_form::energy(x, cam.a, cam.lapse_squared);
}

/// A shot by the closed form.
fn fire(cam: LensCamera, x: f32, phi: f32) -> Fired {
    let start = fan_start(cam, x);
    let shot = shoot(cam.a, start.x, start.y, phi);
    let carried = shot.carried;
    return Fired(shot.fate, carried.rise, carried.chord * carried.rise - start.x, carried.by_slope + carried.by_d * start.z);
}

/// The step in x that should undo `miss` in u, on (u + 1)^{-1/2}: u has a double pole where the ray falls in, and is straight in x far out.
fn newton_change(a: f32, c: f32, miss: f32, rise: f32, rate: f32) -> f32 {
    let here = max(a + rise, -0.5) + 1.0;
    let there = c + 1.0;
    return miss / rate * 2.0 * here / (sqrt(here * there) + there);
}

/// Halfway in the angle at which the camera sees the rays x = −a cot θ.
fn middle_ray(a: f32, low: f32, high: f32) -> f32 {
    let first = select(atan2(a, -low), 0.0, low <= -BEYOND);
    let last = select(atan2(a, -high), HALF_TURN, high >= BEYOND);
    let theta = 0.5 * (first + last);
    return -a * cos(theta) / max(sin(theta), 1e-12);
}

/// The ray that sweeps `phi` from u = a to u = c = a + `rise`.
fn shot_ray(cam: LensCamera, c: f32, rise: f32, phi: f32) -> Joined {
    var x = slope_guess(cam, rise, bent_sweep(phi)).x + fan_shift(cam);
    var low = -BEYOND;
    var high = select(BEYOND, 0.0, cam.lapse_squared < 0.0);
    var last = BEYOND;
    var result = Joined(0.0, 0.0, 0.0, false);
    for (var i = 0u; i < MOST_SHOTS; i++) {
        if !(x > low && x < high) {
            x = middle_ray(cam.a, low, high);
        }
        let fired = fire(cam, x, phi);
        if fired.fate != MET {
            if fired.fate == LEFT {
                low = x;
            } else {
                high = x;
            }
            x = BEYOND;
            continue;
        }
        let miss = rise - fired.rise;
        if miss > 0.0 {
            low = x;
        } else {
            high = x;
        }
        result = Joined(fan_start(cam, x).x, fan_energy(cam, x), fired.slope, true);
        let step = newton_change(cam.a, c, miss, fired.rise, fired.rate);
        let size = abs(step);
        let scale = abs(x) + 1e-3 * cam.a;
        // Rounding ends the descent: the steps then no longer shrink.
        if !(size > 3e-7 * scale) || (size < 1e-3 * scale && size > 0.5 * last) {
            break;
        }
        last = size;
        x += step;
    }
    return result;
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
    let d = select(critical_excess(a, w), (e * e - CRITICAL_SQUARE) / 16.0, cam.lapse_squared < 0.0);
    let scattered = d < 0.0 && a <= PHOTON_SPHERE;
    let near = (d < 0.0 && !scattered) || (phi < 0.5 && c < 2.0 * a && a < 2.0 * c);
    let outgoing = w > 0.0;
    var closed = 0.0;
    if near {
        closed = 2.0 * log(c * ahead(e, w, a, cam.lapse_squared) / (a * ahead(e, w_e, c, lapse2)));
    } else if scattered {
        closed = log(ahead(e, w_e, c, lapse2) * a / (c * ahead(e, w, a, cam.lapse_squared))) + (w / a - w_e / c) / e;
    } else {
        let rest = log((e + abs(w_e)) * a / (c * (e + abs(w))));
        closed = select(rest, -rest, outgoing) + (w / a - w_e / c) / e;
        if outgoing {
            closed -= 2.0 * log(lapse2 / cam.lapse_squared);
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
    if !(finite(at.r) && finite(at.dr) && at.r > 1e-3 && at.lapse_squared > 0.0) {
        return no_ray();
    }
    let phi = max(sweep, SMALLEST_SWEEP);
    let c = 1.0 / at.r;
    let lapse2 = max(at.lapse_squared, 1e-4);
    let ray = shot_ray(cam, c, -at.dr * c * cam.a, phi);
    if !ray.found {
        return no_ray();
    }
    return ray_of(cam, c, lapse2, ray.slope, ray.energy, ray.emission_slope, exact_delay(cam, c, lapse2, phi, ray));
}
