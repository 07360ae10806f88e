//! Rays found vertex by vertex in f32, without a table: the twins of shaders/functions/shooting.wgsl, exact.wgsl, integrate.wgsl and
//! refine.wgsl, line by line. What the GPU's methods "exact", "rk4-16", "rk4-64" and "newton" do.
//!
//! A shot is fired from the camera with a slope; Newton's method in a bracket finds the slope that meets the point. It starts from the
//! table's closed form.

use super::lookup::inside::INSIDE_NODES;
use super::lookup::source_point::SourcePoint;
use super::lookup::{LEAST_LAPSE2, LensRay, NOTHING, finite, ray_of};
use super::orbit::{CRITICAL_SQUARE, FELL, LEFT, MET, PHOTON_SPHERE, carry, critical_excess, pole_orbit, shoot};
use super::single::{HALF_TURN, LensCamera, SMALLEST_SWEEP, bent_sweep, energy, slope_guess};

/// A shot from the camera: its fate, u − a and du/dΦ at the end, ∂u/∂x there and the time it took.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)]
pub struct Fired {
    pub fate: u32,
    pub rise: f32,
    pub slope: f32,
    pub rate: f32,
    pub time: f32,
}

/// The ray found: w, e, w_e and the last shot's time; `found` is false where none was.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)]
pub struct Joined {
    pub slope: f32,
    pub energy: f32,
    pub emission_slope: f32,
    pub time: f32,
    pub found: bool,
}

/// Shots after which the best so far is taken.
pub const MOST_SHOTS: u32 = 30;
/// What counts as beyond every slope.
pub const BEYOND: f32 = 3e38;

/// Rays of a camera are numbered by x, which grows with the slope: w outside; inside w + s ≤ 0, from which e has its digits.
pub fn fan_shift(cam: &LensCamera) -> f32 {
    if cam.lapse2 < 0.0 { cam.a * (-cam.lapse2).max(0.0).sqrt() } else { 0.0 }
}

/// w, d and ∂d/∂x of the ray x.
pub fn fan_start(cam: &LensCamera, x: f32) -> [f32; 3] {
    let s = fan_shift(cam);
    let w = x - s;
    let d = if cam.lapse2 < 0.0 { (x * (x - 2.0 * s) - CRITICAL_SQUARE) / 16.0 } else { critical_excess(cam.a, w) };
    [w, d, 0.125 * w]
}

/// e of the ray x.
pub fn fan_energy(cam: &LensCamera, x: f32) -> f32 {
    if cam.lapse2 < 0.0 {
        return (x * (x - 2.0 * fan_shift(cam))).max(0.0).sqrt();
    }
    energy(x, cam.a, cam.lapse2)
}

/// The step in x that should undo `miss` in u, on (u + 1)^{-1/2}: u has a double pole where the ray falls in, and is straight in x far out.
pub fn newton_change(a: f32, c: f32, miss: f32, rise: f32, rate: f32) -> f32 {
    let here = (a + rise).max(-0.5) + 1.0;
    let there = c + 1.0;
    miss / rate * 2.0 * here / ((here * there).sqrt() + there)
}

/// Halfway in the angle at which the camera sees the rays x = −a cot θ.
pub fn middle_ray(a: f32, low: f32, high: f32) -> f32 {
    let first = if low <= -BEYOND { 0.0 } else { a.atan2(-low) };
    let last = if high >= BEYOND { HALF_TURN } else { a.atan2(-high) };
    let theta = 0.5 * (first + last);
    -a * theta.cos() / theta.sin().max(1e-12)
}

/// The ray that sweeps `phi` from u = a to u = c = a + `rise`, by shots of `fire(x)`.
pub fn shot_ray(cam: &LensCamera, c: f32, rise: f32, phi: f32, fire: impl Fn(f32) -> Fired) -> Joined {
    let mut x = slope_guess(cam, rise, bent_sweep(phi)).0 + fan_shift(cam);
    let mut low = -BEYOND;
    let mut high = if cam.lapse2 < 0.0 { 0.0 } else { BEYOND };
    let mut last = BEYOND;
    let mut result = Joined { slope: 0.0, energy: 0.0, emission_slope: 0.0, time: 0.0, found: false };
    for _ in 0..MOST_SHOTS {
        if !(x > low && x < high) {
            x = middle_ray(cam.a, low, high);
        }
        let fired = fire(x);
        if fired.fate != MET {
            *if fired.fate == LEFT { &mut low } else { &mut high } = x;
            x = BEYOND;
            continue;
        }
        let miss = rise - fired.rise;
        *if miss > 0.0 { &mut low } else { &mut high } = x;
        result =
            Joined { slope: fan_start(cam, x)[0], energy: fan_energy(cam, x), emission_slope: fired.slope, time: fired.time, found: true };
        let step = newton_change(cam.a, c, miss, fired.rise, fired.rate);
        let size = step.abs();
        let scale = x.abs() + 1e-3 * cam.a;
        // Rounding ends the descent: the steps then no longer shrink. NaN ends it too.
        let goes_on = size > 3e-7 * scale;
        if !goes_on || (size < 1e-3 * scale && size > 0.5 * last) {
            break;
        }
        last = size;
        x += step;
    }
    result
}

/// A shot by the closed form.
pub fn fire_exactly(cam: &LensCamera, x: f32, phi: f32) -> Fired {
    let [w, d, d_x] = fan_start(cam, x);
    let shot = shoot(cam.a, w, d, phi);
    let carried = shot.carried;
    Fired {
        fate: shot.fate,
        rise: carried.rise,
        slope: carried.chord * carried.rise - w,
        rate: carried.by_slope + carried.by_d * d_x,
        time: 0.0,
    }
}

/// e − w without cancellation, e > 0.
pub fn ahead(e: f32, w: f32, u: f32, lapse2: f32) -> f32 {
    if w > 0.0 { u * u * lapse2 / (e + w) } else { e - w }
}

/// T − t̂: Painlevé–Gullstrand time less that which is regular on the horizon.
pub fn to_rain_time(u: f32) -> f32 {
    let beta = u.sqrt();
    2.0 / beta - 2.0 * (1.0 + beta).ln()
}

/// The travel time of light along the ray (w, e, w_e) from u = `c` to the camera over `phi`: by parts in closed form (see
/// `spacetime::light`), the rest by Gauss's rule of twelve on panels of up to two radians, each half of the way reached from its own end.
pub fn exact_delay(cam: &LensCamera, c: f32, lapse2: f32, phi: f32, ray: &Joined) -> f32 {
    let a = cam.a;
    let (e, w, w_e) = (ray.energy, ray.slope, ray.emission_slope);
    let d = if cam.lapse2 < 0.0 { (e * e - CRITICAL_SQUARE) / 16.0 } else { critical_excess(a, w) };
    let scattered = d < 0.0 && a <= PHOTON_SPHERE;
    let near = (d < 0.0 && !scattered) || (phi < 0.5 && c < 2.0 * a && a < 2.0 * c);
    let outgoing = w > 0.0;
    let closed = if near {
        2.0 * (c * ahead(e, w, a, cam.lapse2) / (a * ahead(e, w_e, c, lapse2))).ln()
    } else if scattered {
        (ahead(e, w_e, c, lapse2) * a / (c * ahead(e, w, a, cam.lapse2))).ln() + (w / a - w_e / c) / e
    } else {
        let rest = ((e + w_e.abs()) * a / (c * (e + w.abs()))).ln();
        let parts = if outgoing { -rest } else { rest } + (w / a - w_e / c) / e;
        if outgoing { parts - 2.0 * (lapse2 / cam.lapse2).ln() } else { parts }
    };
    let panels = (0.5 * phi).ceil().max(1.0);
    let half = 0.5 * phi / panels;
    let mut sum = 0.0;
    let count = 12 * panels as u32;
    for k in 0..count {
        let [place, weight] = INSIDE_NODES[k as usize % 6];
        let at = half * (2.0 * (k / 12) as f32 + 1.0 + if k % 12 < 6 { place } else { -place });
        let from_camera = at < 0.5 * phi;
        let (u0, w0, way) = if from_camera { (a, w, at) } else { (c, -w_e, phi - at) };
        let carried = carry(u0, w0, pole_orbit(way, d));
        let u = u0 + carried.rise;
        let slope = (carried.chord * carried.rise - w0) * if from_camera { 1.0 } else { -1.0 };
        sum += weight
            * if near {
                e * (1.0 + 3.0 * u) / (u * u)
            } else if scattered {
                0.5 * u / e + 1.5 * (e + slope) / (1.0 - u)
            } else {
                0.5 * u / e + 1.5 * u * u / (e + slope.abs())
            };
    }
    closed + half * sum + to_rain_time(a) - to_rain_time(c)
}

/// The ray of a point outside by the closed form.
pub fn exact_ray(cam: &LensCamera, at: SourcePoint, sweep: f32) -> LensRay {
    if !(finite(at.r) && finite(at.dr) && at.r > 1e-3 && at.lapse2 > 0.0) {
        return NOTHING;
    }
    let phi = sweep.max(SMALLEST_SWEEP);
    let c = 1.0 / at.r;
    let lapse2 = at.lapse2.max(1e-4);
    let ray = shot_ray(cam, c, -at.dr * c * cam.a, phi, |x| fire_exactly(cam, x, phi));
    if !ray.found {
        return NOTHING;
    }
    ray_of(cam, c, lapse2, [ray.slope, ray.energy, ray.emission_slope, exact_delay(cam, c, lapse2, phi, &ray)])
}

/// Along a shot: the rates of u − a, w, ∂u/∂w, ∂w/∂w₀.
pub fn shot_rates(a: f32, state: [f32; 4]) -> [f32; 4] {
    let u = a + state[0];
    [state[1], u * (1.5 * u - 1.0), state[3], (3.0 * u - 1.0) * state[2]]
}

/// dT/dΦ of the photon, which runs against Φ: ingoing, then outgoing light.
pub fn shot_time(u: f32, w: f32) -> f32 {
    let e = energy(w, u, 1.0 - u);
    let beta = u.max(0.0).sqrt();
    if w <= 0.0 { (w * w + u * u) / (u * u * (e - beta * w)) } else { (e + beta * w) / (u * u * (1.0 - u)) }
}

/// A shot by `steps` steps of Runge and Kutta's fourth-order rule.
pub fn fire_in_steps(cam: &LensCamera, x: f32, phi: f32, steps: u32) -> Fired {
    let a = cam.a;
    let h = phi / steps as f32;
    let ahead = |s: [f32; 4], k: [f32; 4], h: f32| [0, 1, 2, 3].map(|i| s[i] + h * k[i]);
    let astray = |fate| Fired { fate, rise: 0.0, slope: 0.0, rate: 1.0, time: 0.0 };
    let mut state = [0.0, fan_start(cam, x)[0], 0.0, 1.0];
    let mut time = 0.0;
    for _ in 0..steps {
        let k1 = shot_rates(a, state);
        let s2 = ahead(state, k1, 0.5 * h);
        let k2 = shot_rates(a, s2);
        let s3 = ahead(state, k2, 0.5 * h);
        let k3 = shot_rates(a, s3);
        let s4 = ahead(state, k3, h);
        let k4 = shot_rates(a, s4);
        let middle = shot_time(a + s2[0], s2[1]) + shot_time(a + s3[0], s3[1]);
        time += h / 6.0 * (shot_time(a + state[0], state[1]) + 2.0 * middle + shot_time(a + s4[0], s4[1]));
        state = [0, 1, 2, 3].map(|i| state[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        let u = a + state[0];
        if u.is_nan() || u >= (2.0 * a).max(100.0) {
            return astray(FELL);
        }
        // Past the sky the equation leads back to false points.
        if u < -0.5 || (u < 0.0 && state[1] > 0.0) {
            return astray(LEFT);
        }
    }
    Fired { fate: MET, rise: state[0], slope: state[1], rate: state[2], time }
}

/// The ray of a point outside by integration in `steps` steps.
pub fn integrated_ray(cam: &LensCamera, at: SourcePoint, sweep: f32, steps: u32) -> LensRay {
    if !(finite(at.r) && finite(at.dr) && at.r > 1e-3 && at.lapse2 > 0.0) {
        return NOTHING;
    }
    let c = 1.0 / at.r;
    let phi = sweep.max(SMALLEST_SWEEP);
    let ray = shot_ray(cam, c, -at.dr * c * cam.a, phi, |x| fire_in_steps(cam, x, phi, steps));
    if !ray.found {
        return NOTHING;
    }
    ray_of(cam, c, at.lapse2.max(1e-4), [ray.slope, ray.energy, ray.emission_slope, ray.time])
}

/// The largest turn of a slope that is believed, radians: more than the table is ever off, and less than half a pixel. Beyond it, what
/// speaks is the rounding of the closed form.
pub const MOST_REFINED: f32 = 5e-5;

/// `ray` with the slopes that one Newton step on the closed form gives; its delay stays.
pub fn refined_ray(cam: &LensCamera, at: SourcePoint, sweep: f32, ray: LensRay) -> LensRay {
    if !ray.valid || at.lapse2 <= 0.0 {
        return ray;
    }
    let c = 1.0 / at.r;
    let phi = sweep.max(SMALLEST_SWEEP);
    let s = fan_shift(cam);
    let e = ray.energy;
    let x = if cam.lapse2 < 0.0 { -e * e / (s + (s * s + e * e).sqrt()) } else { ray.slope };
    let fired = fire_exactly(cam, x, phi);
    let rise = -at.dr * c * cam.a;
    let moved = x + newton_change(cam.a, c, rise - fired.rise, fired.rise, fired.rate);
    let w = moved - s;
    // Both turns as sines: (a, −w) against (a, −slope).
    let a = cam.a;
    let turn = (a * (w - ray.slope)).abs() / ((a * a + w * w) * (a * a + ray.slope * ray.slope)).sqrt();
    let believed = turn < MOST_REFINED;
    if fired.fate != MET || !believed || (cam.lapse2 < 0.0 && moved >= 0.0) {
        return ray;
    }
    ray_of(cam, c, at.lapse2.max(LEAST_LAPSE2), [w, fan_energy(cam, moved), ray.emission_slope, ray.delay])
}
