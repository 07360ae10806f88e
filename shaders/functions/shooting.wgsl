// The ray that meets a point, by Newton's method in a bracket: the twin of src/lensing/shooting.rs. The method that includes this file
// supplies fn fire(cam: LensCamera, x: f32, phi: f32) -> Fired

/// A shot from the camera: its fate, u − a and du/dΦ at the end, ∂u/∂x there and the time it took.
struct Fired {
    fate: u32,
    rise: f32,
    slope: f32,
    rate: f32,
    time: f32,
}

/// The ray found: w, e, w_e and the last shot's time; `found` is false where none was.
struct Joined {
    slope: f32,
    energy: f32,
    emission_slope: f32,
    time: f32,
    found: bool,
}

/// Shots after which the best so far is taken.
const MOST_SHOTS: u32 = 30u;
/// What counts as beyond every slope.
const BEYOND: f32 = 3e38;

/// Rays of a camera are numbered by x, which grows with the slope: w outside; inside w + s ≤ 0, from which e has its digits.
fn fan_shift(cam: LensCamera) -> f32 {
    return select(0.0, cam.a * sqrt(max(-cam.lapse2, 0.0)), cam.lapse2 < 0.0);
}

/// w, d and ∂d/∂x of the ray x.
fn fan_start(cam: LensCamera, x: f32) -> vec3<f32> {
    let s = fan_shift(cam);
    let w = x - s;
    let d = select(critical_excess(cam.a, w), (x * (x - 2.0 * s) - CRITICAL_SQUARE) / 16.0, cam.lapse2 < 0.0);
    return vec3<f32>(w, d, 0.125 * w);
}

fn fan_energy(cam: LensCamera, x: f32) -> f32 {
    if cam.lapse2 < 0.0 {
        return sqrt(max(x * (x - 2.0 * fan_shift(cam)), 0.0));
    }
    return energy(x, cam.a, cam.lapse2);
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
    var high = select(BEYOND, 0.0, cam.lapse2 < 0.0);
    var last = BEYOND;
    var result = Joined(0.0, 0.0, 0.0, 0.0, false);
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
        result = Joined(fan_start(cam, x).x, fan_energy(cam, x), fired.slope, fired.time, true);
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
