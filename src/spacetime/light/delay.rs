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
use super::orbit::{
    CRITICAL_ENERGY_SQUARED, PHOTON_SPHERE, Pole, carry, critical_excess, pole_orbit,
};

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
    let Ray {
        slope,
        emission_slope,
        energy: e,
    } = *ray;
    let d = if u_camera < 1.0 {
        critical_excess(u_camera, slope)
    } else {
        (e * e - CRITICAL_ENERGY_SQUARED) / 16.0
    };
    let scattered = d < 0.0 && u_camera <= PHOTON_SPHERE;
    let trapped = d < 0.0 && !scattered;
    let near = swept < 0.5 && u_point < 2.0 * u_camera && u_camera < 2.0 * u_point;
    let path = Path {
        u_point,
        emission_slope,
        d,
        swept,
        u_camera,
        energy: e,
    };

    let time = if trapped || near {
        let closed = |w: f64, u: f64| 2.0 * (u / ahead(e, w, u)).ln();
        closed(emission_slope, u_point) - closed(slope, u_camera)
            + path.integral(|u, _| e * (1.0 + 3.0 * u) / (u * u))
    } else if scattered {
        let closed = |w: f64, u: f64| (ahead(e, w, u) / u).ln() - w / (u * e);
        closed(emission_slope, u_point) - closed(slope, u_camera)
            + path.integral(|u, w| u / (2.0 * e) + 1.5 * (e + w) / (1.0 - u))
    } else {
        // No turning point. Light that left the past horizon has e and w of one sign.
        let outgoing = e * slope > 0.0;
        let closed = |w: f64, u: f64| {
            let rest = ((e.abs() + w.abs()) / u).ln();
            (if outgoing { -rest } else { rest }) - w / (u * e)
        };
        let horizon = if outgoing {
            -2.0 * ((1.0 - u_point) / (1.0 - u_camera)).ln()
        } else {
            0.0
        };
        closed(emission_slope, u_point) - closed(slope, u_camera)
            + horizon
            + path.integral(|u, w| u / (2.0 * e) + (1.5 * u * u / (e.abs() + w.abs())).copysign(e))
    };
    time + to_rain_time(u_camera) - to_rain_time(u_point)
}

/// e − w without cancellation.
fn ahead(e: f64, w: f64, u: f64) -> f64 {
    if e * w > 0.0 {
        u * u * (1.0 - u) / (e + w)
    } else {
        e - w
    }
}

/// T − t̂.
fn to_rain_time(u: f64) -> f64 {
    let beta = u.sqrt();
    2.0 / beta - 2.0 * beta.ln_1p()
}

/// A ray as the quadrature sees it.
struct Path {
    u_point: f64,
    emission_slope: f64,
    d: f64,
    swept: f64,
    u_camera: f64,
    energy: f64,
}

impl Path {
    /// ∫ f(u, w) dΦ along the ray, in panels from the point to the camera: that way a ray that ends deep inside stays accurate,
    /// for there w² − u³ of the camera's end would have lost the e² that decides about the rest.
    fn integral(&self, f: impl Fn(f64, f64) -> f64) -> f64 {
        let (mut u, mut w) = (self.u_point, self.emission_slope);
        let mut left = self.swept;
        let mut sum = 0.0;
        let narrow = LONGEST_PANEL / self.energy.abs().max(1.0).cbrt();
        let beyond = 2.0 / self.u_camera.sqrt();
        let mut cached: Option<(f64, [Pole; 10], Pole)> = None;
        loop {
            // Inside, the singularity lies 2/√u behind the camera.
            let panels = (left / narrow.min(0.4 * (left + beyond)) - 1e-9)
                .ceil()
                .max(1.0);
            let step = left / panels;
            let fitting = cached.filter(|(length, ..)| (step / length - 1.0).abs() < 1e-12);
            let Some((step, nodes, whole)) = fitting.or_else(|| poles_over(step, self.d)) else {
                return f64::NAN;
            };
            cached = Some((step, nodes, whole));
            let mut panel = 0.0;
            for (pole, (_, weight)) in nodes.iter().zip(NODES) {
                let (u, w) = back(u, w, pole);
                panel += weight * f(u, w);
            }
            sum += panel * step;
            if panels <= 1.0 {
                return sum;
            }
            (u, w) = back(u, w, &whole);
            left -= step;
        }
    }
}

/// The ray (u, w) carried towards the camera.
fn back(u: f64, w: f64, pole: &Pole) -> (f64, f64) {
    let carried = carry(u, -w, pole);
    (u + carried.rise, -(carried.chord * carried.rise + w))
}

/// The length of a panel, and the pole orbit at its nodes and at its end.
fn poles_over(step: f64, d: f64) -> Option<(f64, [Pole; 10], Pole)> {
    let whole = pole_orbit(step, d)?;
    let mut nodes = [whole; 10];
    for (node, (x, _)) in nodes.iter_mut().zip(NODES) {
        *node = pole_orbit(step * x, d)?;
    }
    Some((step, nodes, whole))
}
