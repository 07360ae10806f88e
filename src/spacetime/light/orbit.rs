//! u(Φ) in closed form.
//!
//! With u = 4q every ray obeys q′² = 4q³ − q² + e²/16, an elliptic curve whose addition theorem carries a ray from the camera to
//! any Φ without a case for turning points. The curve's own point at Φ = 0 is the singularity, so the only transcendental
//! function needed is the *pole orbit* q(Φ): the ray that leaves r = 0 at Φ = 0 (Weierstrass' ℘ = q − 1/12 with g₂ = 1/12,
//! g₃ = 1/216 − e²/16). It is evaluated by its Laurent series at Φ/2ⁿ and n duplications.
//!
//! All is written in p = q − 1/6 and d = (e² − 4/27)/16: p′² = p²(4p + 1) + d. Both vanish for the ray that winds around the
//! photon sphere, so nothing cancels there.
//! Sources: Whittaker & Watson, Modern Analysis, 20.2–20.6; Abramowitz & Stegun 18.5 (series), 18.4 (duplication).

/// e² of the ray that winds for ever around r = 3/2, in 1/r_s²: 1/b_c².
pub(super) const CRITICAL_ENERGY_SQUARED: f64 = 4.0 / 27.0;

/// u of the photon sphere.
pub(super) const PHOTON_SPHERE: f64 = 2.0 / 3.0;

/// p beyond which the pole orbit counts as back in the singularity: r = 2.5e-11, while 1e-6 is the smallest radius in use.
const NEXT_SINGULARITY: f64 = 1e10;

/// The pole orbit at one Φ: p and p′, and their derivatives by d.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pole {
    pub p: f64,
    pub y: f64,
    pub p_d: f64,
    pub y_d: f64,
}

/// The pole orbit at `phi` > 0 for the parameter d; None past its full period (it has come back to the singularity, and no ray
/// with this d is still on its way). p′ < 0 up to the half period, p′ ≥ 0 from there on.
pub(super) fn pole_orbit(phi: f64, d: f64) -> Option<Pole> {
    // The nearest pole lies farther than 4.5 min(1, e^{-1/3}); at a ninth of that the first term left out is below 1e-18.
    let energy_squared = (CRITICAL_ENERGY_SQUARED + 16.0 * d).max(1.0);
    let mut t = phi * phi;
    let mut z = phi;
    let mut doublings = 0;
    while t * t * t * energy_squared > 0.015_625 {
        t *= 0.25;
        z *= 0.5;
        doublings += 1;
    }
    let mut pole = laurent(z, t, d);
    for _ in 0..doublings {
        if pole.y >= 0.0 {
            return None;
        }
        pole = double(&pole, d)?;
    }
    Some(pole)
}

/// The Laurent series of the pole orbit at small z; t = z².
fn laurent(z: f64, t: f64, d: f64) -> Pole {
    const C2: f64 = 1.0 / 240.0;
    const C4: f64 = C2 * C2 / 3.0;
    const C3_D: f64 = -1.0 / 28.0;
    let c3 = (-1.0 / 216.0 - d) / 28.0;
    let c5 = 3.0 / 11.0 * C2 * c3;
    let c6 = (2.0 * C2 * C2 * C2 + 3.0 * c3 * c3) / 39.0;
    let c7 = 2.0 / 33.0 * C2 * C2 * c3;
    let c8 = 5.0 / 7293.0 * C2 * (11.0 * C2 * C2 * C2 + 36.0 * c3 * c3);
    let c9 = c3 * (29.0 * C2 * C2 * C2 + 11.0 * c3 * c3) / 2717.0;
    // Derivatives by c3.
    const C5_3: f64 = 3.0 / 11.0 * C2;
    const C7_3: f64 = 2.0 / 33.0 * C2 * C2;
    let c6_3 = 6.0 / 39.0 * c3;
    let c8_3 = 360.0 / 7293.0 * C2 * c3;
    let c9_3 = (29.0 * C2 * C2 * C2 + 33.0 * c3 * c3) / 2717.0;

    let series = |c: [f64; 8]| c.iter().rev().fold(0.0, |sum, c| sum * t + c);
    let inverse = 1.0 / t;
    let value = series([C2, c3, C4, c5, c6, c7, c8, c9]);
    let slope = series([2.0 * C2, 4.0 * c3, 6.0 * C4, 8.0 * c5, 10.0 * c6, 12.0 * c7, 14.0 * c8, 16.0 * c9]);
    let value_3 = series([0.0, 1.0, 0.0, C5_3, c6_3, C7_3, c8_3, c9_3]);
    let slope_3 = series([0.0, 4.0, 0.0, 8.0 * C5_3, 10.0 * c6_3, 12.0 * C7_3, 14.0 * c8_3, 16.0 * c9_3]);
    Pole { p: inverse - 1.0 / 12.0 + t * value, y: -2.0 * inverse / z + z * slope, p_d: t * value_3 * C3_D, y_d: z * slope_3 * C3_D }
}

/// From Φ to 2Φ. None at the full period.
fn double(pole: &Pole, d: f64) -> Option<Pole> {
    let Pole { p, y, p_d, y_d } = *pole;
    let p2 = p * p;
    let square = p2 * (4.0 * p + 1.0) + d;
    if square <= 0.0 {
        return None;
    }
    let square_d = (12.0 * p2 + 2.0 * p) * p_d + 1.0;
    let over_square = 1.0 / square;
    let top = p2 * p2 - d * (2.0 * p + 0.25);
    let top_d = (4.0 * p2 * p - 2.0 * d) * p_d - (2.0 * p + 0.25);
    let new_p = top * over_square;
    // So near the full period rounding decides what is seen; the singularity is nearer than any u in use.
    if new_p > p && new_p > NEXT_SINGULARITY {
        return None;
    }

    let p3 = p2 * p;
    let inner = 20.0 * p3 + 5.0 * p2 + 0.5 * p;
    let slope_top = p3 * p2 * (4.0 * p + 2.0) + d * (inner - 2.0 * d);
    let slope_top_d = (p2 * p2 * (24.0 * p + 10.0) + d * (60.0 * p2 + 10.0 * p + 0.5)) * p_d + inner - 4.0 * d;
    let over_y = 1.0 / y;
    let new_y = 0.5 * slope_top * over_y * over_square;
    Some(Pole {
        p: new_p,
        y: new_y,
        p_d: (top_d - new_p * square_d) * over_square,
        y_d: 0.5 * slope_top_d * over_y * over_square - new_y * (y_d * over_y + square_d * over_square),
    })
}

/// A ray carried over one angle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Carried {
    /// u(Φ) − u(0), accurate also where it is small.
    pub rise: f64,
    /// The slope λ of the curve's chord: u′(Φ) = −w + λ rise.
    pub chord: f64,
    /// ∂u/∂w and ∂u/∂d at fixed Φ.
    pub by_slope: f64,
    /// See `by_slope`.
    pub by_d: f64,
}

/// The addition theorem: the ray (u, w) with the parameter d of `pole` carried over the Φ of `pole`.
pub(super) fn carry(u: f64, w: f64, pole: &Pole) -> Carried {
    let Pole { p, y, p_d, y_d } = *pole;
    let quarter = 0.25 * u;
    let gap = p + 1.0 / 6.0 - quarter;
    if w < 0.0 && y < 0.0 && gap < quarter {
        // Here `gap` may vanish on the way of a healthy ray, and numerator and denominator of the form below with it.
        let q = p + 1.0 / 6.0;
        let over = 1.0 / (-0.25 * w - y);
        let chord = (4.0 * (quarter * quarter + quarter * q + q * q) - quarter - q) * over;
        let chord_d = (4.0 * (quarter + 2.0 * q) - 1.0) * p_d * over + chord * over * y_d;
        Carried {
            rise: chord * chord + 1.0 - 2.0 * u - 4.0 * q,
            chord,
            by_slope: 2.0 * chord * chord * 0.25 * over,
            by_d: 2.0 * chord * chord_d - 4.0 * p_d,
        }
    } else {
        let over = 1.0 / gap;
        let half_force = 0.5 * u * (3.0 * u - 2.0);
        let top = w * (0.25 * w - y) + half_force * gap;
        let scale = 0.5 * over * over;
        let rise = top * scale;
        Carried {
            rise,
            chord: (0.25 * w - y) * over,
            by_slope: (0.5 * w - y) * scale,
            by_d: (half_force * p_d - w * y_d) * scale - 2.0 * rise * p_d * over,
        }
    }
}

/// The parameter d = (e² − 4/27)/16 of the ray (u, w), without cancellation near the critical ray.
pub(super) fn critical_excess(u: f64, w: f64) -> f64 {
    let critical = (PHOTON_SPHERE - u) * (u + 1.0 / 3.0).sqrt();
    (w - critical) * (w + critical) / 16.0
}

/// Where a ray has come to after sweeping some angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SweepEnd {
    /// It is there.
    At {
        /// u = 1/r, in 1/r_s.
        u: f64,
        /// du/dΦ, in 1/r_s.
        slope: f64,
    },
    /// It left for the sky before.
    Escaped,
    /// It ended in the singularity before.
    Plunged,
}

/// The ray with slope `w` at `u` > 0 after it swept `phi` > 0 (backwards in time, as everywhere here), whatever lies between;
/// its energy may have either sign, which makes no difference to the path.
pub fn follow(u: f64, w: f64, phi: f64) -> SweepEnd {
    match shoot(u, w, critical_excess(u, w), phi) {
        Continued::At(carried) if u + carried.rise >= 0.0 => SweepEnd::At { u: u + carried.rise, slope: carried.chord * carried.rise - w },
        Continued::At(_) | Continued::Escaped => SweepEnd::Escaped,
        Continued::Plunged => SweepEnd::Plunged,
    }
}

/// As `SweepEnd`; `At` may have u slightly below 0, a smooth continuation past the sky.
pub(super) enum Continued {
    At(Carried),
    Escaped,
    Plunged,
}

/// As `follow`, with d given.
///
/// The pole orbit tells how far along Φ is: its half period ω is passed where p′ changes sign, its period 2ω ends every ray.
pub(super) fn shoot(u: f64, w: f64, d: f64, phi: f64) -> Continued {
    let trapped = d < 0.0 && u > PHOTON_SPHERE;
    let scattered = d < 0.0 && !trapped;
    let Some(pole) = pole_orbit(phi, d) else {
        return if trapped || (w >= 0.0 && !scattered) { Continued::Plunged } else { Continued::Escaped };
    };
    let past_half = pole.y >= 0.0;
    let gap = pole.p + 1.0 / 6.0 - 0.25 * u;
    if scattered {
        // Rises to its apsis, falls, leaves; what comes up again after more than ω is not light any more.
        let carried = carry(u, w, &pole);
        let left = if w >= 0.0 { past_half && carried.chord * carried.rise > w } else { past_half || returning(u, w, &carried) };
        return if left { Continued::Escaped } else { Continued::At(carried) };
    }
    if w >= 0.0 {
        // Straight to the singularity, where gap = 0.
        return if past_half || gap <= 0.0 { Continued::Plunged } else { Continued::At(carry(u, w, &pole)) };
    }
    if trapped {
        // Up to its apsis and back to the singularity, where gap = 0 for the second time.
        return if past_half && gap >= 0.0 { Continued::Plunged } else { Continued::At(carry(u, w, &pole)) };
    }
    let carried = carry(u, w, &pole);
    if past_half || returning(u, w, &carried) { Continued::Escaped } else { Continued::At(carried) }
}

/// Whether a ray that set out outward comes back up, which it does only beyond the sky. Rounding can turn the slope of the ray
/// that winds down to the photon sphere; a true return to there takes more than 20 radians to be as flat.
fn returning(u: f64, w: f64, carried: &Carried) -> bool {
    const FLAT: f64 = 1e-9;
    let slope = carried.chord * carried.rise - w;
    slope >= FLAT || (slope >= 0.0 && u + carried.rise < 0.5)
}
