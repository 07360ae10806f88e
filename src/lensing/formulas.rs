// The formulas of the lookup, written once and compiled for both precisions by `mod.rs` (`type Real`): in f64 for the bake, in
// f32 as the twin of shaders/functions/lensing.wgsl, function for function under the same names.
//
// Symbols: a = 1/L, c = 1/r, Φ the angle swept, w = du/dΦ at the camera, w_e the same at the point, e = 1/b with
// e² = w² + a² − a³ = w_e² + c² − c³; T is Painlevé–Gullstrand time. Lengths in r_s, times in r_s/c, angles in radians.
//
// The closed form of the slope is the boundary value problem u″ = −u + 3/2 u², u(0) = a, u(Φ) = c solved to second order around
// the camera: exact to third order in the distance, right to second order in the deflection where the field is weak (so it opens
// the Einstein ring), and going over into the ray that winds around the photon sphere for a camera near the hole.

/// Beyond this angle swept, in radians, the closed forms see less and less of Φ: they only need to stay smooth there.
pub const BEND_START: Real = 3.6;
/// How far they still go beyond it, in radians.
pub const BEND_RANGE: Real = 0.5;
/// The smallest angle swept, in radians: a point exactly on the axis is looked up as if this far off it.
pub const SMALLEST_SWEEP: Real = 1e-9;
/// Half the turn, in radians.
pub const HALF_TURN: Real = std::f64::consts::PI as Real;
/// The largest angle swept in the table, in radians: 3π.
pub const LARGEST_SWEEP: Real = (3.0 * std::f64::consts::PI) as Real;
/// The table's range of 1/r, in 1/r_s: r from 1.00035 to 10,526.
pub const POINT_RANGE: [Real; 2] = [0.95e-4, 0.999_65];

/// The constants of one camera radius, which the processor computes once a frame in f64.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// L.
    pub l: Real,
    /// 1 − 1/L, free of cancellation.
    pub room: Real,
    /// a = 1/L.
    pub a: Real,
    /// β = √a, the river's speed.
    pub beta: Real,
    /// How much of the weak-field terms is kept: 1 far away, 0 near the hole.
    pub fade: Real,
    /// The coefficient n of K″ = 1 + n K.
    pub bend: Real,
    /// √|n|.
    pub rate: Real,
    /// u″ at the camera: 3/2 a² − a.
    pub force: Real,
    /// The softening of the axis of points.
    pub soft: Real,
    /// Where the axis of points begins.
    pub start: Real,
    /// One over its length.
    pub scale: Real,
}

/// The constants of the camera at radius `l`.
pub fn camera(l: f64) -> Camera {
    let a = 1.0 / l;
    let m = (-(a / 0.45f64).powi(2)).exp();
    let n = -m + (1.0 - m) * 2.25 * a * a / (a + 1.0 / 3.0);
    let soft = 0.3 * a / (1.0 + a * a).sqrt();
    let raw = |c: f64| (c + soft).ln() - 2.0 * (1.0 - c).sqrt();
    let (first, last) = (raw(POINT_RANGE[0] as f64), raw(POINT_RANGE[1] as f64));
    Camera {
        l: l as Real,
        room: ((l - 1.0) / l) as Real,
        a: a as Real,
        beta: a.sqrt() as Real,
        fade: m as Real,
        bend: n as Real,
        rate: n.abs().sqrt() as Real,
        force: (1.5 * a * a - a) as Real,
        soft: soft as Real,
        start: first as Real,
        scale: (1.0 / (last - first)) as Real,
    }
}

/// ln(1 + x), accurate for small x.
pub fn log1p(x: Real) -> Real {
    let z = x / (2.0 + x);
    if z.abs() < 0.1 {
        let y = z * z;
        return 2.0 * z * (1.0 + y * (1.0 / 3.0 + y * (0.2 + y * (1.0 / 7.0 + y * (1.0 / 9.0)))));
    }
    (1.0 + x).ln()
}

/// The table's first coordinate, 0 to 1 over `POINT_RANGE`: c = 1/r, resolved around the camera and toward the horizon, where
/// `room` = 1 − 1/r.
pub fn point_axis(cam: &Camera, c: Real, room: Real) -> Real {
    ((c + cam.soft).ln() - 2.0 * room.max(0.0).sqrt() - cam.start) * cam.scale
}

/// e to the arsinh x: sums of arsinh go under one logarithm.
pub fn opened(x: Real) -> Real {
    let root = (1.0 + x * x).sqrt();
    if x < 0.0 { 1.0 / (root - x) } else { root + x }
}

/// arsinh(10 Φ) at the end of the table, Φ = 3π.
pub const SWEEP_END: Real = 5.239_102_591_656_62;

/// The table's second coordinate, 0 to 1 over Φ from 0 to 3π: Φ + 0.3 arsinh((Φ − π)/s) + arsinh(10 Φ), stretched around π by the
/// width `s` of the Einstein ring and near 0, less what it is at 0 and over its length.
pub fn sweep_axis(cam: &Camera, c: Real, sweep: Real) -> Real {
    let over = 1.0 / (2.8 * (cam.a / (1.0 + cam.a) + c).sqrt());
    let first = opened(HALF_TURN * over);
    let here = first * opened((sweep - HALF_TURN) * over);
    let length = LARGEST_SWEEP + SWEEP_END + 0.3 * (first * opened(2.0 * HALF_TURN * over)).ln();
    (sweep + 0.3 * here.ln() + opened(10.0 * sweep).ln()) / length
}

/// Φ as the closed forms see it: itself up to `BEND_START`, then levelling off, four times differentiable.
pub fn bent_sweep(sweep: Real) -> Real {
    if sweep <= BEND_START {
        return sweep;
    }
    let x = (sweep - BEND_START) / BEND_RANGE;
    let x2 = x * x;
    BEND_START + (sweep - BEND_START) / (1.0 + x2 * x2).sqrt().sqrt()
}

/// (S, K) with K′ = S, S′ = 1 + nK: sine and 1 − cosine, or their hyperbolic kin.
pub fn basis(cam: &Camera, sweep: Real) -> [Real; 2] {
    let x = cam.rate * sweep;
    if x < 0.3 {
        let y = cam.bend * sweep * sweep;
        let s = sweep * (1.0 + y * (1.0 / 6.0) * (1.0 + y * (1.0 / 20.0) * (1.0 + y * (1.0 / 42.0))));
        let k = 0.5 * sweep * sweep * (1.0 + y * (1.0 / 12.0) * (1.0 + y * (1.0 / 30.0) * (1.0 + y * (1.0 / 56.0))));
        return [s, k];
    }
    if cam.bend < 0.0 {
        let (sine, cosine) = (0.5 * x).sin_cos();
        let h = sine / cam.rate;
        return [2.0 * h * cosine, 2.0 * h * h];
    }
    let up = x.exp();
    let down = 1.0 / up;
    [
        0.5 * (up - down) / cam.rate,
        (0.5 * (up + down) - 1.0) / (cam.rate * cam.rate),
    ]
}

/// The closed form of (w, w_e) for `rise` = c − a and the bent sweep.
pub fn slope_guess(cam: &Camera, rise: Real, bent: Real) -> [Real; 2] {
    let [s, k] = basis(cam, bent);
    // What is right only in weak fields, held down where K grows.
    let m = cam.fade / (1.0 + cam.a * cam.a * k * k);
    let am = cam.a * m;
    let f = cam.force;
    let b = s * (1.0 + am * k);
    let c = rise - f * k - 0.5 * am * f * k * k;
    let q = m * k * k;
    let root = (b * b + 2.0 * q * c).max(0.05 * b * b + 1e-4 * q).sqrt();
    let w = if b > 0.0 {
        2.0 * c / (b + root)
    } else {
        (root - b) / q
    };
    let turn = 1.0 + cam.bend * k;
    if cam.bend > 0.0 {
        // The same derivative with the growing terms that cancel taken out by the equation for w.
        let rest = (1.5 + 0.5 * cam.bend * k) * k * k * (am * f + m * w * w);
        return [w, (turn * rise + f * k + rest) / s + w * am * s * s];
    }
    [
        w,
        w * (turn * (1.0 + am * k) + am * s * s) + f * s + am * f * k * s + m * k * s * w * w,
    ]
}

/// e ≥ 0 of a ray with slope w at u, `room` = 1 − u.
pub fn energy(w: Real, u: Real, room: Real) -> Real {
    (w * w + u * u * room).max(0.0).sqrt()
}

/// The photon's outward rain-frame momentum per angular momentum at u, for slope w and energy e, `room` = 1 − u; the one against the
/// sweep is u. Regular through the horizon for w ≤ 0 ≤ e; e < 0 exists only inside.
pub fn radial_momentum(w: Real, e: Real, u: Real, beta: Real, room: Real) -> Real {
    if w > 0.0 || e < 0.0 {
        return (w + beta * e) / room;
    }
    (u * u - e * e) / (beta * e - w)
}

/// The slope whose angle atan2(u, −slope) is that of `guess` turned by `turn` (at most 2 radians either way): how the table corrects a
/// closed form.
pub fn turned_slope(guess: Real, u: Real, turn: Real) -> Real {
    // tan(turn/2) = p/q by Padé's approximant of order 5 over 4: off by 1e-7 at the largest turn, and no sine is called.
    let x = 0.5 * turn;
    let y = x * x;
    let p = x * (945.0 - y * (105.0 - y));
    let q = 945.0 - y * (420.0 - 15.0 * y);
    // Cosine and sine of the turn, both times p² + q², which cancels.
    let (ct, st) = (q * q - p * p, 2.0 * p * q);
    let sine = (u * ct - guess * st).max(1e-6 * u);
    u * (guess * ct + u * st) / sine
}

/// The slope against which the angle of w_e is measured: of the size of slopes near the point, and never small beside e.
pub fn emission_scale(cam: &Camera, c: Real) -> Real {
    c + cam.a / (1.0 + 4.0 * cam.a)
}

/// The parts of the delay T = p₀ + p₂ (p₁ + table): what is singular at the horizon and what falls with the rain; the chord and
/// Shapiro's logarithm, both regular across the Einstein ring; a factor that goes to zero with e at the horizon.
/// `room` = 1 − 1/r, `dr` = r − L; w, e, w_e are those of the ray.
pub fn delay_parts(
    cam: &Camera,
    r: Real,
    room: Real,
    dr: Real,
    bent: Real,
    w: Real,
    e: Real,
    w_e: Real,
) -> [Real; 3] {
    let (l, a) = (cam.l, cam.a);
    let c = 1.0 / r;
    let (root_r, root_l) = (r.sqrt(), l.sqrt());
    let (sine, cosine) = (0.5 * bent).sin_cos();
    let x = 2.0 * sine;
    let k = 0.5 * x * x;
    // Half the chord's fall: 2 cos(Φ/2), kept positive beyond π as in the lens equation.
    let y = 2.0 * cosine;
    let soft = 2.0 * (a + c) / (1.0 + a + c) * k * k;
    let reach = (y * y + soft).sqrt();
    let h = if y > 0.0 {
        0.5 * (y + reach)
    } else {
        0.5 * soft / (reach - y)
    };
    let excess = if y > 0.0 {
        0.5 * soft / (reach + y)
    } else {
        0.5 * (reach - y)
    };
    let q = x * x - excess * (h + y);
    let fall = dr / (root_r + root_l);
    // 1 + 3 ln(r/L)/(r − L): exact along Φ = 0.
    let mean = if dr.abs() > 1e-6 * l { 1.0 + 3.0 * log1p(dr / l) / dr } else { 1.0 + 3.0 / l };
    // Of the fall with the rain, what is not a logarithm is 2 (√r − √L).
    let rain = root_l * (1.0 + root_r) / (root_r * (1.0 + root_l));
    let across = mean * (1.0 + 3.0 * c) * (room + k * c * c * a / (1.0 + a)) * r * l * q;
    let chord = (mean * mean * dr * dr + across).sqrt();
    let out = if w_e > 0.0 {
        (w_e + e) / (room * c)
    } else {
        c / (e - w_e)
    };
    let back = if w > 0.0 {
        a * cam.room / (e + w)
    } else {
        (e - w) / a
    };
    let a4 = a * a * a * a;
    let c4 = c * c * c * c;
    let factor = e / (e * e + 0.5 * k * c4 * c4 * a4 / (1.0 + a4)).sqrt();
    [
        2.0 * ((out * back * rain).ln() - fall),
        chord - 2.0 * (0.5 * h).ln(),
        factor,
    ]
}
