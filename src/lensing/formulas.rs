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
    /// a/(1 + a).
    pub share: Real,
    /// a/(1 + 4a).
    pub reach: Real,
    /// a⁴/(1 + a⁴).
    pub lift: Real,
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
        share: (a / (1.0 + a)) as Real,
        reach: (a / (1.0 + 4.0 * a)) as Real,
        lift: (a.powi(4) / (1.0 + a.powi(4))) as Real,
    }
}

/// arsinh(10 Φ) at the end of the table, Φ = 3π.
pub const SWEEP_END: Real = 5.239_102_591_656_62;

/// The table's first two coordinates, each in 0..=1.
///
/// The first runs over `POINT_RANGE`: c = 1/r, resolved around the camera and toward the horizon, where `room` = 1 − 1/r. The second runs over Φ
/// from 0 to 3π: Φ + 0.3 arsinh((Φ − π)/s) + arsinh(10 Φ), stretched around π by the width `s` of the Einstein ring and near 0, less what it
/// is at 0 and over its length.
#[inline]
pub fn axes(cam: &Camera, c: Real, room: Real, sweep: Real) -> [Real; 2] {
    // e to the arsinh(x/s) is (x + √(x² + s²))/s, so that sums of arsinh go under one logarithm; for x < 0 its inverse loses nothing.
    let s2 = 7.84 * (cam.share + c);
    let off = sweep - HALF_TURN;
    let first = HALF_TURN + (HALF_TURN * HALF_TURN + s2).sqrt();
    let last = 2.0 * HALF_TURN + (4.0 * HALF_TURN * HALF_TURN + s2).sqrt();
    let root = (off * off + s2).sqrt();
    let (up, down) = (above(-off, first, first * (root + off)), above(-off, root - off, s2));
    let near = 10.0 * sweep + (1.0 + 100.0 * sweep * sweep).sqrt();
    let [point, here, length, near] = ln4([c + cam.soft, up / down, first * last / s2, near]);
    [
        (point - 2.0 * room.max(0.0).sqrt() - cam.start) * cam.scale,
        (sweep + 0.3 * here + near) / (LARGEST_SWEEP + SWEEP_END + 0.3 * length),
    ]
}

/// Φ as the closed forms see it: itself up to `BEND_START`, then levelling off, four times differentiable.
#[inline]
pub fn bent_sweep(sweep: Real) -> Real {
    if sweep <= BEND_START {
        return sweep;
    }
    let x = (sweep - BEND_START) / BEND_RANGE;
    let x2 = x * x;
    BEND_START + (sweep - BEND_START) / (1.0 + x2 * x2).sqrt().sqrt()
}

/// (S, K) with K′ = S, S′ = 1 + nK: sine and 1 − cosine, or their hyperbolic kin.
#[inline]
pub fn basis(cam: &Camera, sweep: Real) -> [Real; 2] {
    let square = sweep * sweep;
    let x = -0.25 * cam.bend * square;
    if x < -1.0 {
        let up = (cam.rate * sweep).exp();
        let down = 1.0 / up;
        return [0.5 * (up - down) / cam.rate, (0.5 * (up + down) - 1.0) / (cam.rate * cam.rate)];
    }
    // By the half angle.
    let [sine, cosine] = stumpff(x);
    [sweep * sine * cosine, 0.5 * square * sine * sine]
}

/// The closed form of (w, w_e) for `rise` = c − a and the bent sweep.
#[inline]
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
    let w = above(b, 2.0 * c, root - b) / above(b, b + root, q);
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
#[inline]
pub fn energy(w: Real, u: Real, room: Real) -> Real {
    (w * w + u * u * room).max(0.0).sqrt()
}

/// The photon's outward rain-frame momentum per angular momentum at u, for slope w and energy e, `room` = 1 − u; the one against the
/// sweep is u. Regular through the horizon for w ≤ 0 ≤ e; e < 0 exists only inside.
#[inline]
pub fn radial_momentum(w: Real, e: Real, u: Real, beta: Real, room: Real) -> Real {
    let along = beta * e;
    above(w.max(-e), w + along, u * u - e * e) / above(w.max(-e), room, along - w)
}

/// The slope whose angle atan2(u, −slope) is that of `guess` turned by `turn` (at most 2 radians either way): how the table corrects a
/// closed form.
#[inline]
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
#[inline]
pub fn emission_scale(cam: &Camera, c: Real) -> Real {
    c + cam.reach
}

/// The parts of the delay T = p₀ + p₂ (p₁ + table): what is singular at the horizon and what falls with the rain; the chord and
/// Shapiro's logarithm, both regular across the Einstein ring; a factor that goes to zero with e at the horizon.
/// `room` = 1 − 1/r, `dr` = r − L; w, e, w_e are those of the ray.
#[inline]
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
    let root_c = c.sqrt();
    let [sine, cosine] = stumpff(0.25 * bent * bent);
    let x = bent * sine;
    let k = 0.5 * x * x;
    // Half the chord's fall: 2 cos(Φ/2), kept positive beyond π as in the lens equation.
    let y = 2.0 * cosine;
    let soft = 2.0 * (a + c) / (1.0 + a + c) * k * k;
    let large = 0.5 * (y.abs() + (y * y + soft).sqrt());
    let small = 0.25 * soft / large;
    let (h, excess) = (above(y, large, small), above(y, small, large));
    // x² − excess (h + y), where excess h = soft/4.
    let q = x * x - 0.25 * soft - excess * y;
    let fall = dr / (r * root_c + l * cam.beta);
    // 1 + 3 ln(r/L)/(r − L): exact along Φ = 0.
    let log = log1p(dr * a);
    let mean = 1.0 + 3.0 * above(dr.abs() - 1e-6 * l, log / dr, a);
    let direct = dr + 3.0 * log;
    let across = mean * (1.0 + 3.0 * c) * (room + k * c * c * cam.share) * r * l * q;
    let chord = (direct * direct + across).sqrt();
    // The ray at the point, at the camera, and of the fall with the rain what is not 2 (√r − √L).
    let (out, out_over) = (above(w_e, w_e + e, c), above(w_e, room * c, e - w_e));
    let (back, back_over) = (above(w, a * cam.room, e - w), above(w, e + w, a));
    let doppler = out * back * (1.0 + root_c) / (out_over * back_over * (1.0 + cam.beta));
    let c4 = c * c * c * c;
    let factor = e / (e * e + 0.5 * k * c4 * c4 * cam.lift).sqrt();
    [2.0 * (ln(doppler) - fall), chord - 2.0 * ln(0.5 * h), factor]
}
