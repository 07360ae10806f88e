//! The travel time of light in Painlevé–Gullstrand time.
//!
//! Along the ray dt/dΦ = e/(u²(1 − u)) in Schwarzschild's t. With t̂ = t + ln|1 − 1/r|, regular on the horizon like T,
//!
//! dt̂/dΦ = e/u² + e/u + K,  K = u²/(e − w) = (e + w)/(1 − u),   T = t̂ + 2√r − 2 ln(1 + 1/√r).
//!
//! Three identities, each following from w² = e² − u² + u³ and w′ = −u + 3/2 u², take all that grows without bound (far away, or
//! at the past horizon) in closed form, and what is left to quadrature is analytic in Φ:
//!
//! e/u² = [u/2 − (w/u)′]/e,  e/u = [ln((e − w)/u)]′ + K/2,
//! K = u²/(e + w) − 2 [ln|1 − u|]′ = 2e/u + 2 [ln u − ln(e − w)]′.

use super::Ray;
use super::orbit::{CRITICAL_ENERGY_SQUARED, PHOTON_SPHERE, Pole, carry, critical_excess, pole_orbit};

/// Gauss–Legendre of ten points on [0, 1]: abscissae and weights (Abramowitz & Stegun 25.4.30).
const NODES: [(f64, f64); 10] = {
    const HALF: [(f64, f64); 5] = [
        (0.148_874_338_981_631_22, 0.295_524_224_714_752_87),
        (0.433_395_394_129_247_2, 0.269_266_719_309_996_35),
        (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
        (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
        (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
    ];
    let mut all = [(0.0, 0.0); 10];
    let mut i = 0;
    while i < 5 {
        all[2 * i] = (0.5 - 0.5 * HALF[i].0, 0.5 * HALF[i].1);
        all[2 * i + 1] = (0.5 + 0.5 * HALF[i].0, 0.5 * HALF[i].1);
        i += 1;
    }
    all
};

/// The longest panel, in radians: the poles of u(Φ) near the real axis are 2π apart at the photon sphere, and ten nodes then
/// leave less than 1e-12.
const LONGEST_PANEL: f64 = 1.0;

/// T_arrival − T_emission in r_s/c along `ray`, which joins the point at `u_point` to the camera at `u_camera` (1/r_s) over the
/// angle `swept`. Infinite for the sky; infinite or negative infinite only there and on the horizon.
pub fn delay(ray: &Ray, u_point: f64, swept: f64, u_camera: f64) -> f64 {
    if u_point <= 0.0 {
        return f64::INFINITY;
    }
    let Ray { slope, emission_slope, energy: e } = *ray;
    let d = if u_camera < 1.0 { critical_excess(u_camera, slope) } else { (e * e - CRITICAL_ENERGY_SQUARED) / 16.0 };
    let scattered = d < 0.0 && u_camera <= PHOTON_SPHERE;
    let trapped = d < 0.0 && !scattered;
    let near = swept < 0.5 && u_point < 2.0 * u_camera && u_camera < 2.0 * u_point;
    let path = QuadratureRay { slope, u_point, emission_slope, d, swept, u_camera, energy: e };

    let time = if trapped || near {
        let closed = |w: f64, u: f64| 2.0 * libm::log(u / ahead(e, w, u));
        closed(emission_slope, u_point) - closed(slope, u_camera) + path.integral(|u, _| e * (1.0 + 3.0 * u) / (u * u))
    } else if scattered {
        let closed = |w: f64, u: f64| libm::log(ahead(e, w, u) / u) - w / (u * e);
        closed(emission_slope, u_point) - closed(slope, u_camera) + path.integral(|u, w| u / (2.0 * e) + 1.5 * (e + w) / (1.0 - u))
    } else {
        // No turning point. Light that left the past horizon has e and w of one sign.
        let outgoing = e * slope > 0.0;
        let closed = |w: f64, u: f64| {
            let rest = libm::log((e.abs() + w.abs()) / u);
            (if outgoing { -rest } else { rest }) - w / (u * e)
        };
        let horizon = if outgoing { -2.0 * libm::log((1.0 - u_point) / (1.0 - u_camera)) } else { 0.0 };
        closed(emission_slope, u_point) - closed(slope, u_camera)
            + horizon
            + path.integral(|u, w| u / (2.0 * e) + (1.5 * u * u / (e.abs() + w.abs())).copysign(e))
    };
    time + to_rain_time(u_camera) - to_rain_time(u_point)
}

/// The delay in r_s/c of the ray of zero energy between two places inside the horizon, u > 1: E > 0 and E < 0 meet there. It is the mean of
/// the delays of the two, whatever the angle swept: light that left longer ago has E < 0. With t = √r it is 2 [artanh t − t].
pub fn zero_energy_delay(u_point: f64, u_camera: f64) -> f64 {
    let part = |u: f64| {
        let t = 1.0 / u.sqrt();
        2.0 * (libm::atanh(t) - t)
    };
    part(u_point) - part(u_camera)
}

/// e − w without cancellation.
fn ahead(e: f64, w: f64, u: f64) -> f64 {
    if e * w > 0.0 { u * u * (1.0 - u) / (e + w) } else { e - w }
}

/// T − t̂.
fn to_rain_time(u: f64) -> f64 {
    let beta = u.sqrt();
    2.0 / beta - 2.0 * libm::log1p(beta)
}

/// A ray as the quadrature sees it.
struct QuadratureRay {
    slope: f64,
    u_point: f64,
    emission_slope: f64,
    d: f64,
    swept: f64,
    u_camera: f64,
    energy: f64,
}

impl QuadratureRay {
    /// ∫ f(u, w) dΦ along the ray.
    fn integral(&self, f: impl Fn(f64, f64) -> f64) -> f64 {
        let narrow = LONGEST_PANEL / libm::cbrt(self.energy.abs().max(1.0));
        if self.u_camera < 1.0 { self.integral_of_halves(narrow, f) } else { self.integral_inwards(narrow, f) }
    }

    /// Camera outside: equal panels, half of them reached from either end, for errors grow like exp Φ near the photon sphere.
    fn integral_of_halves(&self, narrow: f64, f: impl Fn(f64, f64) -> f64) -> f64 {
        let count = (self.swept / narrow - 1e-9).ceil().max(1.0);
        // A ray of the vacuum needs a dozen.
        if count.is_nan() || count > 1e4 {
            return f64::NAN;
        }
        let Some(panel) = PhasePanel::new(self.swept / count, self.d) else {
            return f64::NAN;
        };
        let from_camera = (0.5 * count) as usize;
        let (mut u, mut w) = (self.u_camera, self.slope);
        let mut sum = 0.0;
        for _ in 0..from_camera {
            sum += panel.integral(u, w, &f);
            (u, w) = ahead_by(u, w, &panel.whole);
        }
        // The same path seen from the point has the opposite slope.
        let f = |u: f64, w: f64| f(u, -w);
        (u, w) = (self.u_point, -self.emission_slope);
        for _ in from_camera..count as usize {
            sum += panel.integral(u, w, f);
            (u, w) = ahead_by(u, w, &panel.whole);
        }
        sum
    }

    /// Camera inside: panels from the point on, shorter towards the singularity that lies 2/√u behind the camera. Along the way
    /// w² − u³ loses the e² that decides about the rest, so in the camera's half every panel starts anew from the camera, with the
    /// d that has not lost it.
    fn integral_inwards(&self, narrow: f64, f: impl Fn(f64, f64) -> f64) -> f64 {
        let beyond = 2.0 / self.u_camera.sqrt();
        let f = |u: f64, w: f64| f(u, -w);
        let (mut u, mut w) = (self.u_point, -self.emission_slope);
        let mut left = self.swept;
        let mut sum = 0.0;
        loop {
            let longest = narrow.min(0.4 * (left + beyond));
            let last = left <= longest;
            let step = if last { left } else { longest };
            let Some(panel) = PhasePanel::new(step, self.d) else {
                return f64::NAN;
            };
            sum += panel.integral(u, w, f);
            if last {
                return sum;
            }
            left -= step;
            if left > 0.5 * self.swept {
                (u, w) = ahead_by(u, w, &panel.whole);
            } else {
                let Some(pole) = pole_orbit(left, self.d) else {
                    return f64::NAN;
                };
                let (there, slope) = ahead_by(self.u_camera, self.slope, &pole);
                (u, w) = (there, -slope);
            }
        }
    }
}

/// The ray (u, w) one step farther.
fn ahead_by(u: f64, w: f64, pole: &Pole) -> (f64, f64) {
    let carried = carry(u, w, pole);
    (u + carried.rise, carried.chord * carried.rise - w)
}

/// A panel of Φ: its length, and the pole orbit at its nodes and at its end.
struct PhasePanel {
    step: f64,
    nodes: [Pole; 10],
    whole: Pole,
}

impl PhasePanel {
    fn new(step: f64, d: f64) -> Option<PhasePanel> {
        let whole = pole_orbit(step, d)?;
        let mut nodes = [whole; 10];
        for (node, (x, _)) in nodes.iter_mut().zip(NODES) {
            *node = pole_orbit(step * x, d)?;
        }
        Some(PhasePanel { step, nodes, whole })
    }

    /// ∫ f(u, w) dΦ over the panel that starts at (u, w).
    fn integral(&self, u: f64, w: f64, f: impl Fn(f64, f64) -> f64) -> f64 {
        let sum: f64 = self
            .nodes
            .iter()
            .zip(NODES)
            .map(|(pole, (_, weight))| {
                let (u, w) = ahead_by(u, w, pole);
                weight * f(u, w)
            })
            .sum();
        sum * self.step
    }
}
