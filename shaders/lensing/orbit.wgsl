#define_import_path lensrunner::lensing::orbit

// u(Φ) in closed form in single precision: the addition theorem of src/spacetime/light/orbit.rs. The pole orbit of the curve p′² = p²(4p +
// 1) + d at Φ, by its Laurent series at Φ/2ⁿ and n duplications, then carried to the camera's ray (Whittaker & Watson 20.2 to 20.6). u =
// 1/r, w = du/dΦ, d = (e² − 4/27)/16. Lengths in r_s, angles in radians.

/// e² of the ray that winds around the photon sphere, 1/r_s².
const CRITICAL_SQUARE: f32 = 4.0 / 27.0;
/// u of the photon sphere.
const PHOTON_SPHERE: f32 = 2.0 / 3.0;

/// How a ray ended: at the angle asked for,
const MET: u32 = 0u;
/// in the sky before,
const LEFT: u32 = 1u;
/// or in the singularity.
const FELL: u32 = 2u;

/// The pole orbit at one Φ: p and p′, their derivatives by d, and whether it is still on its way.
struct Pole {
    p: f32,
    y: f32,
    p_d: f32,
    y_d: f32,
    flies: bool,
}

const C2: f32 = 0.00416666666666667;

/// The Laurent series at small `z`; `t` = z².
fn laurent(z: f32, t: f32, d: f32) -> Pole {
    let c3 = (-1.0 / 216.0 - d) / 28.0;
    let c4 = C2 * C2 / 3.0;
    let c5 = 3.0 / 11.0 * C2 * c3;
    let c6 = (2.0 * C2 * C2 * C2 + 3.0 * c3 * c3) / 39.0;
    let c7 = 2.0 / 33.0 * C2 * C2 * c3;
    let c8 = 5.0 / 7293.0 * C2 * (11.0 * C2 * C2 * C2 + 36.0 * c3 * c3);
    let c9 = c3 * (29.0 * C2 * C2 * C2 + 11.0 * c3 * c3) / 2717.0;
    // Derivatives by c3, which falls with d by 1/28.
    let c5_3 = 3.0 / 11.0 * C2;
    let c6_3 = 6.0 / 39.0 * c3;
    let c7_3 = 2.0 / 33.0 * C2 * C2;
    let c8_3 = 360.0 / 7293.0 * C2 * c3;
    let c9_3 = (29.0 * C2 * C2 * C2 + 33.0 * c3 * c3) / 2717.0;
    let value = C2 + t * (c3 + t * (c4 + t * (c5 + t * (c6 + t * (c7 + t * (c8 + t * c9))))));
    let slope = 2.0 * C2 + t * (4.0 * c3 + t * (6.0 * c4
        + t * (8.0 * c5 + t * (10.0 * c6 + t * (12.0 * c7 + t * (14.0 * c8 + t * 16.0 * c9))))));
    let value_3 = t * (1.0 + t * t * (c5_3 + t * (c6_3 + t * (c7_3 + t * (c8_3 + t * c9_3)))));
    let slope_3 = t * (4.0 + t * t * (8.0 * c5_3 + t * (10.0 * c6_3 + t * (12.0 * c7_3 + t * (14.0 * c8_3 + t * 16.0 * c9_3)))));
    let inverse = 1.0 / t;
    return Pole(inverse - 1.0 / 12.0 + t * value, -2.0 * inverse / z + z * slope, -t * value_3 / 28.0, -z * slope_3 / 28.0, true);
}

/// From Φ to 2Φ.
fn doubled(pole: Pole, d: f32) -> Pole {
    let p = pole.p;
    let y = pole.y;
    let p_d = pole.p_d;
    let y_d = pole.y_d;
    let p2 = p * p;
    let square = p2 * (4.0 * p + 1.0) + d;
    if !(pole.flies && y < 0.0 && square > 0.0) {
        return Pole(p, y, p_d, y_d, false);
    }
    let square_d = (12.0 * p2 + 2.0 * p) * p_d + 1.0;
    let over_square = 1.0 / square;
    let new_p = (p2 * p2 - d * (2.0 * p + 0.25)) * over_square;
    let top_d = (4.0 * p2 * p - 2.0 * d) * p_d - (2.0 * p + 0.25);
    let p3 = p2 * p;
    let inner = 20.0 * p3 + 5.0 * p2 + 0.5 * p;
    let slope_top = p3 * p2 * (4.0 * p + 2.0) + d * (inner - 2.0 * d);
    let slope_top_d = (p2 * p2 * (24.0 * p + 10.0) + d * (60.0 * p2 + 10.0 * p + 0.5)) * p_d + inner - 4.0 * d;
    let over_y = 1.0 / y;
    let new_y = 0.5 * slope_top * over_y * over_square;
    return Pole(new_p, new_y, (top_d - new_p * square_d) * over_square,
        0.5 * slope_top_d * over_y * over_square - new_y * (y_d * over_y + square_d * over_square), !(new_p > p && new_p > 1e6));
}

/// The pole orbit at `phi` > 0 for the parameter `d`.
fn pole_orbit(phi: f32, d: f32) -> Pole {
    // The nearest pole lies farther than 4.5 min(1, e^{-1/3}); at a third of that the first term left out is below 1e-9.
    let square = max(CRITICAL_SQUARE + 16.0 * d, 1.0);
    var t = phi * phi;
    var z = phi;
    var doublings = 0u;
    while t * t * t * square > 11.0 && doublings < 24u {
        t *= 0.25;
        z *= 0.5;
        doublings += 1u;
    }
    var pole = laurent(z, t, d);
    for (var i = 0u; i < doublings; i++) {
        pole = doubled(pole, d);
    }
    return pole;
}

/// A ray carried over one angle: u(Φ) − u(0), the slope λ of the curve's chord (u′ = −w + λ rise), ∂u/∂w and ∂u/∂d.
struct Carried {
    rise: f32,
    chord: f32,
    by_slope: f32,
    by_d: f32,
}

/// The ray (`u`, `w`) carried over the Φ of `pole`.
fn carry(u: f32, w: f32, pole: Pole) -> Carried {
    let p = pole.p;
    let y = pole.y;
    let p_d = pole.p_d;
    let y_d = pole.y_d;
    let quarter = 0.25 * u;
    let gap = p + 1.0 / 6.0 - quarter;
    if w < 0.0 && y < 0.0 && gap < quarter {
        // Here `gap` may vanish on the way of a healthy ray, and numerator and denominator of the form below with it.
        let q = p + 1.0 / 6.0;
        let over = 1.0 / (-0.25 * w - y);
        let chord = (4.0 * (quarter * quarter + quarter * q + q * q) - quarter - q) * over;
        let chord_d = (4.0 * (quarter + 2.0 * q) - 1.0) * p_d * over + chord * over * y_d;
        return Carried(chord * chord + 1.0 - 2.0 * u - 4.0 * q, chord, 0.5 * chord * chord * over, 2.0 * chord * chord_d - 4.0 * p_d);
    }
    let over = 1.0 / gap;
    let half_force = 0.5 * u * (3.0 * u - 2.0);
    let scale = 0.5 * over * over;
    let rise = (w * (0.25 * w - y) + half_force * gap) * scale;
    return Carried(rise, (0.25 * w - y) * over, (0.5 * w - y) * scale, (half_force * p_d - w * y_d) * scale - 2.0 * rise * p_d * over);
}

/// d of the ray (`u`, `w`), without cancellation near the critical ray.
fn critical_excess(u: f32, w: f32) -> f32 {
    let critical = (PHOTON_SPHERE - u) * sqrt(u + 1.0 / 3.0);
    return (w - critical) * (w + critical) / 16.0;
}

/// Where a ray is after some angle: [`MET`], [`LEFT`] or [`FELL`], and how it got there.
struct Shot {
    fate: u32,
    carried: Carried,
}

/// The ray (`u`, `w`) with the parameter `d` after it swept `phi`.
fn shoot(u: f32, w: f32, d: f32, phi: f32) -> Shot {
    let trapped = d < 0.0 && u > PHOTON_SPHERE;
    let scattered = d < 0.0 && !trapped;
    let pole = pole_orbit(phi, d);
    let carried = carry(u, w, pole);
    if !pole.flies {
        return Shot(select(LEFT, FELL, trapped || (w >= 0.0 && !scattered)), carried);
    }
    let past_half = pole.y >= 0.0;
    let gap = pole.p + 1.0 / 6.0 - 0.25 * u;
    let slope = carried.chord * carried.rise - w;
    // Comes back up, which it does only beyond the sky; rounding can turn the slope of a ray near the photon sphere.
    let returns = slope >= 1e-4 || (slope >= 0.0 && u + carried.rise < 0.5);
    var fate = MET;
    if scattered {
        if (w >= 0.0 && past_half && slope > 0.0) || (w < 0.0 && (past_half || returns)) {
            fate = LEFT;
        }
    } else if w >= 0.0 {
        if past_half || gap <= 0.0 {
            fate = FELL;
        }
    } else if trapped {
        if past_half && gap >= 0.0 {
            fate = FELL;
        }
    } else if past_half || returns {
        fate = LEFT;
    }
    return Shot(fate, carried);
}
