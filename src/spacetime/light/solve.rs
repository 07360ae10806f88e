//! The ray that meets a point: Newton's method on the closed form, kept inside a bracket.
//!
//! At fixed Φ and camera, u(Φ) increases strictly with the slope w (neighbouring rays of one camera meet nowhere in the plane),
//! from the ray that just escapes to the ray that just falls in, so there is at most one ray and a bracket always holds it.

use super::orbit::{CRITICAL_ENERGY_SQUARED, Carried, Continued, PHOTON_SPHERE, SweepEnd, critical_excess, follow, shoot};
use super::{Branch, Ray};
use std::f64::consts::PI;

/// The rays of one camera, numbered by one increasing parameter x.
#[derive(Clone, Copy)]
enum Fan {
    /// Camera at u < 1: x = w, any number.
    Outside { u: f64 },
    /// Camera at u ≥ 1: x = w + s ≤ 0 with s = √(u³ − u²). Backwards in time nothing stays inside, so w ≤ −s; e² = x(x − 2s) has
    /// its relative accuracy also where e is small.
    Inside { u: f64, s: f64 },
}

/// One ray of a fan.
struct Start {
    slope: f64,
    d: f64,
    /// ∂d/∂x (∂w/∂x = 1).
    d_x: f64,
}

impl Fan {
    fn new(u: f64) -> Fan {
        if u < 1.0 { Fan::Outside { u } } else { Fan::Inside { u, s: u * (u - 1.0).sqrt() } }
    }

    fn u(self) -> f64 {
        match self {
            Fan::Outside { u } | Fan::Inside { u, .. } => u,
        }
    }

    fn top(self) -> f64 {
        match self {
            Fan::Outside { .. } => f64::INFINITY,
            Fan::Inside { .. } => 0.0,
        }
    }

    fn of_slope(self, w: f64) -> f64 {
        match self {
            Fan::Outside { .. } => w,
            Fan::Inside { s, .. } => w + s,
        }
    }

    fn start(self, x: f64) -> Start {
        match self {
            Fan::Outside { u } => Start { slope: x, d: critical_excess(u, x), d_x: x / 8.0 },
            Fan::Inside { s, .. } => Start { slope: x - s, d: (x * (x - 2.0 * s) - CRITICAL_ENERGY_SQUARED) / 16.0, d_x: (x - s) / 8.0 },
        }
    }

    /// |e|.
    fn energy(self, x: f64) -> f64 {
        match self {
            Fan::Outside { u } => (x * x + u * u * (1.0 - u)).sqrt(),
            Fan::Inside { s, .. } => (x * (x - 2.0 * s)).sqrt(),
        }
    }
}

/// The exact ray that joins the point at `u_point` (0 is the sky) to the camera at `u_camera` over the angle `swept`; arguments,
/// and the cases of None, as in [`super::connect`].
pub fn join(u_point: f64, swept: f64, u_camera: f64, branch: Branch) -> Option<Ray> {
    join_near(u_point, swept, u_camera, branch, None)
}

/// As [`join`], starting from a guess of the slope at the camera (1/r_s), for instance a neighbour's; the result is the same
/// whatever the guess, only faster with a good one.
pub fn join_near(u_point: f64, swept: f64, u_camera: f64, branch: Branch, guess: Option<f64>) -> Option<Ray> {
    if !exists(u_point, swept, u_camera, branch) {
        return None;
    }
    let fan = Fan::new(u_camera);
    let x = match guess.filter(|w| w.is_finite()) {
        Some(w) => fan.of_slope(w),
        None => first_guess(fan, u_point, swept),
    };
    let (x, emission_slope) = solve(fan, u_point, swept, x)?;
    let energy = fan.energy(x);
    Some(Ray { slope: fan.start(x).slope, emission_slope, energy: if branch == Branch::Minus { -energy } else { energy } })
}

/// The step in x that should undo `miss` in u at the point, by Newton's method on (u + c)^{-1/2}: u has a double pole where the ray falls
/// in, and is straight in x far out.
fn newton(u: f64, u_point: f64, miss: f64, carried: &Carried, start: &Start) -> f64 {
    let rate = carried.by_slope + carried.by_d * start.d_x;
    let c = 1.0;
    let here = (u + carried.rise).max(-0.5) + c;
    let there = u_point + c;
    miss / rate * 2.0 * here / ((here * there).sqrt() + there)
}

/// Φ in radians up to which rays are joined: beyond, neighbouring numbers w are rays that part before they get there.
const MOST_SWEPT: f64 = 30.0;

/// Whether u (1/r_s) is one that light can be computed for: below r = 1e-6 the rounding of u at the camera is felt as far out as
/// the horizon.
pub(super) fn in_range(u: f64) -> bool {
    (1e-30..=1e6).contains(&u)
}

/// Whether such a ray exists.
fn exists(u_point: f64, swept: f64, u_camera: f64, branch: Branch) -> bool {
    let sound = (u_point == 0.0 || in_range(u_point)) && in_range(u_camera) && (1e-30..=MOST_SWEPT).contains(&swept);
    if !sound || (branch == Branch::Minus && (u_point <= 1.0 || u_camera <= 1.0)) {
        return false;
    }
    if u_point < 1.0 {
        return true;
    }
    // Inside: the ray of zero energy, r = (1 − cos η)/2 with η growing like Φ, reaches farthest.
    u_camera > u_point && swept < libm::acos(1.0 - 2.0 / u_point) - libm::acos(1.0 - 2.0 / u_camera)
}

/// x of the straight line of flat space where it makes sense, else of the ray that winds around the photon sphere.
fn first_guess(fan: Fan, u_point: f64, swept: f64) -> f64 {
    let straight = fan.of_slope((u_point - fan.u() * libm::cos(swept)) / libm::sin(swept));
    if swept < 2.5 && straight < fan.top() {
        return straight;
    }
    match fan {
        Fan::Outside { u } => (PHOTON_SPHERE - u) * (u + 1.0 / 3.0).sqrt(),
        Fan::Inside { s, .. } => -CRITICAL_ENERGY_SQUARED / (s + libm::hypot(s, CRITICAL_ENERGY_SQUARED.sqrt())),
    }
}

/// x and the slope at the point.
fn solve(fan: Fan, u_point: f64, swept: f64, guess: f64) -> Option<(f64, f64)> {
    /// More than enough: bisection alone needs about 60 steps.
    const MOST_STEPS: usize = 200;
    let u = fan.u();
    let rise_wanted = u_point - u;
    let (mut low, mut high) = (f64::NEG_INFINITY, fan.top());
    let mut x = guess;
    let mut last_step = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        if !(x > low && x < high) {
            x = middle(low, high, u);
            if !(x > low && x < high) {
                // Two neighbouring numbers hold the ray between them.
                let w = fan.start(if low.is_finite() { low } else { high }).slope;
                return match follow(u, w, swept) {
                    SweepEnd::At { slope, .. } => Some((fan.of_slope(w), slope)),
                    _ => None,
                };
            }
        }
        let start = fan.start(x);
        let carried = match shoot(u, start.slope, start.d, swept) {
            Continued::At(carried) => carried,
            Continued::Escaped => {
                low = x;
                x = f64::NAN;
                continue;
            }
            Continued::Plunged => {
                high = x;
                x = f64::NAN;
                continue;
            }
        };
        let miss = rise_wanted - carried.rise;
        if miss > 0.0 {
            low = x;
        } else {
            high = x;
        }
        let step = newton(u, u_point, miss, &carried, &start);
        // Rounding in u(Φ) ends the descent; the steps then no longer shrink.
        let scale = match fan {
            Fan::Outside { .. } => x.abs() + 1e-3 * u,
            Fan::Inside { .. } => x.abs(),
        };
        let size = step.abs();
        let at_the_floor = size < 1e-7 * scale && size > 0.25 * last_step;
        if miss == 0.0 || size <= 4.0 * f64::EPSILON * scale || at_the_floor {
            return Some((x, carried.chord * rise_wanted - start.slope));
        }
        last_step = size;
        x += step;
    }
    None
}

/// A parameter between two: their geometric mean where both are known and far apart, else halfway in the angle θ of x = −u cot θ, as
/// seen from the camera, else a step towards the ray of zero energy.
fn middle(low: f64, high: f64, u: f64) -> f64 {
    if low * high > 0.0 && low.is_finite() && high.is_finite() && !(0.1..10.0).contains(&(low / high)) {
        return (low * high).sqrt().copysign(low);
    }
    if high == 0.0 && low > -0.1 * u {
        return 0.1 * low;
    }
    let angle = |x: f64| {
        if x == f64::NEG_INFINITY {
            0.0
        } else if x == f64::INFINITY {
            PI
        } else {
            libm::atan2(u, -x)
        }
    };
    let theta = 0.5 * (angle(low) + angle(high));
    -u / libm::tan(theta)
}
