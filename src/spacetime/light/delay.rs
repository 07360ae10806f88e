//! The travel time of light in Painlevé–Gullstrand time.
//!
//! Along the ray dt/dΦ = e/(u²(1 − u)) in Schwarzschild's t. With t̂ = t + ln|1 − 1/r|, regular on the horizon like T,
//!
//! dt̂/dΦ = e/u² + e/u + u²/(e − w),   T = t̂ + 2√r − 2 ln(1 + 1/√r),
//!
//! and along every ray  e/u² = [u/2 − (w/u)′]/e,  e/u = [ln((e − w)/u)]′ + ½ u²/(e − w),
//! u²/(e − w) = u²/(e + w) − 2 [ln|1 − u|]′,
//! so that all that grows without bound (far away, or at the past horizon) is taken in closed form, and what is left to
//! quadrature is analytic in Φ. (Each identity follows from w² = e² − u² + u³ and w′ = −u + 3/2 u².)

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
    let trapped = d < 0.0 && u_camera > PHOTON_SPHERE;
    let near = swept < 0.5 && u_point < 2.0 * u_camera && u_camera < 2.0 * u_point;
    let form = if e < 0.0 || trapped || near { Form::Direct } else { Form::Far };

    let mut time = quadrature(form, e, d, u_camera, slope, u_point, emission_slope, swept);
    if form == Form::Far {
        let ratio = (ahead(e, emission_slope, u_point) / u_point) / (ahead(e, slope, u_camera) / u_camera);
        time += ratio.ln() - (emission_slope / u_point - slope / u_camera) / e;
    }
    time + to_rain_time(u_camera) - to_rain_time(u_point)
}

/// How e/u² + e/u is integrated.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    /// As it stands: near the camera, inside, and where e may vanish.
    Direct,
    /// Less its closed-form part: far away.
    Far,
}

/// e − w for e > 0, without cancellation.
fn ahead(e: f64, w: f64, u: f64) -> f64 {
    if w > 0.0 { u * u * (1.0 - u) / (e + w) } else { e - w }
}

/// T − t̂.
fn to_rain_time(u: f64) -> f64 {
    let beta = u.sqrt();
    2.0 / beta - 2.0 * beta.ln_1p()
}

#[expect(clippy::too_many_arguments, reason = "the two ends of one ray")]
fn quadrature(form: Form, e: f64, d: f64, u0: f64, w0: f64, u_end: f64, w_end: f64, swept: f64) -> f64 {
    let (mut u, mut w) = (u0, w0);
    let mut left = swept;
    let mut sum = 0.0;
    let mut step = 0.0;
    let mut poles: Option<([Pole; 10], Pole)> = None;
    loop {
        // Inside, the singularity behind the camera is 2/√u away and recedes; outside all panels are equal.
        let longest = LONGEST_PANEL.min(0.8 / u.max(1.0).sqrt()).min(1.0 / e.abs().max(1.0).cbrt());
        let panels = (left / longest * (1.0 - 1e-12)).ceil().max(1.0);
        if panels <= 1.0 || (step / (left / panels) - 1.0).abs() > 1e-9 {
            if panels > 1.0 || (step / left - 1.0).abs() > 1e-9 {
                step = left / panels;
                poles = None;
            }
        }
        let (nodes, whole) = match poles {
            Some(ref cached) => cached,
            None => {
                let Some(fresh) = poles_over(step, d) else { return f64::NAN };
                poles.insert(fresh)
            }
        };
        let last = panels <= 1.0;
        let (u_next, w_next) = if last {
            (u_end, w_end)
        } else {
            let carried = carry(u, w, whole);
            (u + carried.rise, carried.chord * carried.rise - w)
        };
        // Leaving the past horizon behind: e and w of one sign, so e + w is safe and e − w is not.
        let outgoing = e * (w + w_next) > 0.0;
        let mut panel = 0.0;
        for (pole, (_, weight)) in nodes.iter().zip(NODES) {
            let carried = carry(u, w, pole);
            let un = u + carried.rise;
            let wn = carried.chord * carried.rise - w;
            let k = un * un / if outgoing { e + wn } else { e - wn };
            panel += weight
                * match form {
                    Form::Direct => e * (1.0 + un) / (un * un) + k,
                    Form::Far => un / (2.0 * e) + 1.5 * k,
                };
        }
        sum += panel * step;
        if outgoing {
            let factor = if form == Form::Far { -3.0 } else { -2.0 };
            sum += factor * ((1.0 - u_next) / (1.0 - u)).ln();
        }
        if last {
            return sum;
        }
        left -= step;
        (u, w) = (u_next, w_next);
    }
}

/// The pole orbit at the nodes of a panel and at its end.
fn poles_over(step: f64, d: f64) -> Option<([Pole; 10], Pole)> {
    let whole = pole_orbit(step, d)?;
    let mut nodes = [whole; 10];
    for (node, (x, _)) in nodes.iter_mut().zip(NODES) {
        *node = pole_orbit(step * x, d)?;
    }
    Some((nodes, whole))
}
