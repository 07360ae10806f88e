// The formulas of the lookup, written once and compiled for both precisions by `mod.rs` (`type Real`): in f64 for the bake, in
// f32 as the twin of shaders/lensing/closed_form.wgsl, function for function under the same names. What is needed at the camera and at the
// point alike is done in two lanes of one register.
//
// Symbols: a = 1/L, c = 1/r, Φ the angle swept, w = du/dΦ at the camera, w_e the same at the point, e = 1/b with
// e² = w² + a² − a³ = w_e² + c² − c³; T is Painlevé–Gullstrand time. Lengths in r_s, times in r_s/c, angles in radians.
//
// The closed form of the slope is the boundary value problem u″ = −u + 3/2 u², u(0) = a, u(Φ) = c solved to second order around
// the camera: exact to third order in the distance, right to second order in the deflection where the field is weak (so it opens
// the Einstein ring), and going over into the ray that winds around the photon sphere for a camera near the hole.
//
// Where no source is given a number was chosen by hand, for residuals that are small and smooth between nodes of the table; `score`
// measures what that leaves. None of them makes an answer right or wrong: the bake takes whatever the closed form leaves, and
// `table::VERSION` changes with them.

/// Beyond this angle swept, in radians, the closed forms see less and less of Φ: they only need to stay smooth there. Just beyond π, where
/// the Einstein ring is; by hand.
pub const BEND_START: Real = 3.4;
/// The width of what they still go beyond it, in radians: they reach 0.57 of it, the most of x/(1 + x⁴). By hand.
pub const BEND_RANGE: Real = 1.4;
/// The length of the second axis before it is scaled to 1: the most that it is at Φ = 3π.
pub const SWEEP_LENGTH: Real = 17.0;
/// The smallest angle swept, in radians: a point exactly on the axis is looked up as if this far off it.
pub const SMALLEST_SWEEP: Real = 1e-9;
/// Half the turn, in radians.
pub const HALF_TURN: Real = std::f64::consts::PI as Real;
/// The largest angle swept in the table, in radians: 3π.
pub const LARGEST_SWEEP: Real = (3.0 * std::f64::consts::PI) as Real;
/// The table's range of 1/r, in 1/r_s: r from 1.000001 to 10,526. The second is 1 − 2⁻²⁰, the same in both precisions.
pub const POINT_RANGE: [Real; 2] = [0.95e-4, 0.999_999_046_325_683_6];

/// a, in 1/r_s, at which the terms of weak fields have faded to 1/e: at the photon sphere, a = 2/3, a ninth is left. By hand.
const FADE: f64 = 0.45;
/// n of strong fields is this times a²/(a + 1/3): 1 at the photon sphere, where what is off it grows as e^Φ (u″ linearised there). How it
/// goes elsewhere is by hand.
const STRONG_BEND: f64 = 2.25;
/// The softening of the axis of points over a, for a camera far outside: where c is small beside it, from some 3 L on, the axis is linear
/// in c. By hand.
const SOFTENING: f64 = 0.3;
/// Width, in ln L, over which the lapse at the camera ceases to count as it goes inside. By hand.
const EVEN: f64 = 0.45;
/// The slope at the point is measured against c + a/(1 + 4a): however near the hole the camera is, by no more than a quarter. By hand.
const REACH: f64 = 4.0;
/// The least `lift`, that of a camera at L = 10. By hand.
const LEAST_LIFT: f64 = 1e-4;
/// Nodes of the sweep crowd within this part of a radian of the axis, its inverse here. By hand.
const AXIS_STRETCH: Real = 10.0;
/// Weight of the Einstein ring, by ln(h/2), in the axis of the sweep. By hand.
const RING_STRETCH: Real = 0.3;
/// Weight of √(1 − 1/r), whose slope opens the horizon, in the axis of points. By hand.
const HORIZON_STRETCH: Real = 2.0;
/// The least square under the root of the slope's quadratic equation, over b² and over q: there it has no solution, and the guess only has
/// to stay smooth. By hand.
const LEAST_ROOT: [Real; 2] = [0.05, 1e-4];
/// The least sine of a corrected slope's angle, over u: keeps the quotient finite where a ray is turned until it is radial.
const LEAST_SINE: Real = 1e-6;
/// Nearer than this part of L to the camera's radius, ln(r/L)/(r − L) is its limit a: what is left is rounding.
const SAME_RADIUS: Real = 1e-6;
/// Added to c in the delay's factor, which is 1 near the camera and far away all the same: it keeps c⁸ from becoming a number too small for
/// f32's usual ones, which are slow.
const LEAST_NEAR: Real = 0.01;

/// The constants of one camera radius, which the processor computes once a frame in f64.
#[derive(Clone, Copy, Debug)]
pub struct LensCamera {
    /// L.
    pub l: Real,
    /// 1 − 1/L, free of cancellation.
    pub lapse2: Real,
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
    /// How much the lapse squared at the camera counts beside that at the point: a half, less and less the further inside the camera is.
    pub even: Real,
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
    /// a⁴/(1 + a⁴), at least 1e-4.
    pub lift: Real,
}

/// The constants of the camera at radius `l`.
pub fn camera(l: f64) -> LensCamera {
    let a = 1.0 / l;
    let m = (-(a / FADE).powi(2)).exp();
    // −1 far away, where u″ = −u.
    let n = -m + (1.0 - m) * STRONG_BEND * a * a / (a + 1.0 / 3.0);
    let soft = SOFTENING * a / (1.0 + a * a).sqrt();
    let raw = |c: f64| (c + soft).ln() - HORIZON_STRETCH as f64 * (1.0 - c).sqrt();
    let (first, last) = (raw(POINT_RANGE[0] as f64), raw(POINT_RANGE[1] as f64));
    LensCamera {
        l: l as Real,
        lapse2: ((l - 1.0) / l) as Real,
        a: a as Real,
        beta: a.sqrt() as Real,
        fade: m as Real,
        bend: n as Real,
        rate: n.abs().sqrt() as Real,
        even: (0.5 * (-(l.min(1.0).ln() / EVEN).powi(2)).exp()) as Real,
        soft: soft as Real,
        start: first as Real,
        scale: (1.0 / (last - first)) as Real,
        share: (a / (1.0 + a)) as Real,
        reach: (a / (1.0 + REACH * a)) as Real,
        lift: (a.powi(4) / (1.0 + a.powi(4))).max(LEAST_LIFT) as Real,
    }
}

/// Φ as the closed forms see it: itself up to `BEND_START`, then somewhat beyond and back toward it, three times differentiable.
#[inline]
pub fn bent_sweep(sweep: Real) -> Real {
    if sweep <= BEND_START {
        return sweep;
    }
    let off = sweep - BEND_START;
    let x = off * (1.0 / BEND_RANGE);
    let x4 = x * x * (x * x);
    BEND_START + off / (1.0 + x4)
}

/// What the delay's closed form and the table share of the sweep: K = 1 − cos Φ, h and q, for Stumpff's functions of Φ²/4.
///
/// h is half the chord's fall, cos(Φ/2), doubled and kept positive beyond π: (y + √(y² + s²))/2 with y = 2 cos(Φ/2) and the width s of the
/// Einstein ring; q is the square of the chord between two unit vectors less what the lens takes.
#[inline]
pub fn lens_equation(cam: &LensCamera, c: Real, bent: Real, (sine, cosine): (Real, Real)) -> [Real; 3] {
    let x = bent * sine;
    let square = x * x;
    let k = 0.5 * square;
    let y = 2.0 * cosine;
    let quarter = 0.5 * (cam.share + c) * k * k;
    let large = 0.5 * y.abs() + (0.25 * y * y + quarter).sqrt();
    // x² − excess (h + y), where excess h is a quarter of the softening. Which of the two is h depends on the order: a branch that is
    // foreseen.
    if y > 0.0 { [k, large, square - quarter - quarter / large * y] } else { [k, quarter / large, square - quarter - large * y] }
}

/// e to the arsinh(10 Φ).
#[inline]
pub fn near_axis(sweep: Real) -> Real {
    AXIS_STRETCH * sweep + (1.0 + AXIS_STRETCH * AXIS_STRETCH * sweep * sweep).sqrt()
}

/// The table's first two coordinates, each in 0..=1, from the logarithms of c + `soft`, of [`near_axis`] and of h/2.
///
/// The first runs over `POINT_RANGE`: c = 1/r, resolved around the camera and toward the horizon, where `lapse` = √(1 − 1/r). The
/// second runs over Φ from 0 to 3π and somewhat beyond: Φ + arsinh(10 Φ) − 0.3 ln(h/2), stretched near 0 and around π by the width of the
/// Einstein ring.
#[inline]
pub fn axes(cam: &LensCamera, lapse: Real, sweep: Real, [point, near, lens]: [Real; 3]) -> (Real, Real) {
    ((point - HORIZON_STRETCH * lapse - cam.start) * cam.scale, (sweep + near - RING_STRETCH * lens) * (1.0 / SWEEP_LENGTH))
}

/// (S, K) with K′ = S, S′ = 1 + nK: sine and 1 − cosine, or their hyperbolic kin, from [`half_angle`] and Stumpff's functions of it.
#[inline]
pub fn basis(cam: &LensCamera, sweep: Real, x: Real, (sine, cosine): (Real, Real)) -> (Real, Real) {
    let square = sweep * sweep;
    if x < -1.0 {
        let up = (cam.rate * sweep).exp();
        let down = 1.0 / up;
        return (0.5 * (up - down) / cam.rate, (0.5 * (up + down) - 1.0) / (cam.rate * cam.rate));
    }
    (sweep * sine * cosine, 0.5 * square * sine * sine)
}

/// The square of half the angle that [`basis`] is taken of, negative where it is hyperbolic.
#[inline]
pub fn half_angle(cam: &LensCamera, sweep: Real) -> Real {
    -0.25 * cam.bend * sweep * sweep
}

/// The closed form of (w, w_e) for `rise` = c − a and the bent sweep.
pub fn slope_guess(cam: &LensCamera, rise: Real, bent: Real) -> (Real, Real) {
    let x = half_angle(cam, bent);
    slopes(cam, rise, basis(cam, bent, x, stumpff(x)))
}

/// The same from [`basis`].
#[inline]
pub fn slopes(cam: &LensCamera, rise: Real, (s, k): (Real, Real)) -> (Real, Real) {
    // What is right only in weak fields, held down where K grows.
    let m = cam.fade / (1.0 + cam.a * cam.a * k * k);
    let am = cam.a * m;
    // u″ at the camera.
    let f = cam.a * (1.5 * cam.a - 1.0);
    let b = s * (1.0 + am * k);
    let c = rise - f * k - 0.5 * am * f * k * k;
    let q = m * k * k;
    let root = (b * b + 2.0 * q * c).max(LEAST_ROOT[0] * b * b + LEAST_ROOT[1] * q).sqrt();
    let w = above(b, 2.0 * c, root - b) / above(b, b + root, q);
    let turn = 1.0 + cam.bend * k;
    if cam.bend > 0.0 {
        // The same derivative with the growing terms that cancel taken out by the equation for w.
        let rest = (1.5 + 0.5 * cam.bend * k) * k * k * (am * f + m * w * w);
        return (w, (turn * rise + f * k + rest) * (1.0 / s) + w * am * s * s);
    }
    (w, w * (turn * (1.0 + am * k) + am * s * s) + s * (f + am * f * k + m * k * w * w))
}

/// e ≥ 0 of a ray with slope w at u, `lapse2` = 1 − u.
#[inline]
pub fn energy(w: Real, u: Real, lapse2: Real) -> Real {
    (w * w + u * u * lapse2).max(0.0).sqrt()
}

/// The photon's rain-frame momentum per angular momentum at two points, [camera, point], at u with the river's speed `beta` and `lapse2` =
/// 1 − u, for slopes w and the energy e: frequency plus outward momentum at both, then frequency less it. Their product is u², the square
/// of the momentum against the sweep. Regular through the horizon for w ≤ 0 ≤ e; e < 0 exists only inside.
#[inline]
pub fn light_cones(w: (Real, Real), e: Real, u: (Real, Real), beta: (Real, Real), lapse2: (Real, Real)) -> [Real; 4] {
    let pair = |(a, b): (Real, Real)| Four::from([a, b, a, b]);
    let (w, u, e) = (pair(w), pair(u), Four::splat(e));
    let rising = w.simd_gt(Four::ZERO) | Four::ZERO.simd_gt(e);
    let square = u * u;
    let over = (rising.select(e + w, square) * (pair(beta) + 1.0)).to_array();
    let under = rising.select(pair(lapse2), e - w);
    let back = (square * under).to_array();
    let under = under.to_array();
    (Four::from([over[0], over[1], back[0], back[1]]) / Four::from([under[0], under[1], over[0], over[1]])).to_array()
}

/// The slopes whose angles atan2(u, −slope) are those of the guesses turned by twice the angles whose tangents are `turns`: how the table
/// corrects the closed forms.
#[inline]
pub fn turned_slopes(guesses: (Real, Real), u: (Real, Real), turns: (Real, Real)) -> (Real, Real) {
    let pair = |(a, b): (Real, Real)| Four::from([a, b, a, b]);
    let (guess, u, turn) = (pair(guesses), pair(u), pair(turns));
    // Cosine and sine of the turn, both times 1 + turn², which cancels.
    let (ct, st) = (Four::ONE - turn * turn, turn + turn);
    let sine = (u * ct - guess * st).fast_max(u * LEAST_SINE);
    let [w, w_e, ..] = (u * (guess * ct + u * st) / sine).to_array();
    (w, w_e)
}

/// The slope against which the angle of w_e is measured: of the size of slopes near the point, and never small beside e.
#[inline]
pub fn emission_scale(cam: &LensCamera, c: Real) -> Real {
    c + cam.reach
}

/// The part of the delay that is regular across the Einstein ring: the chord and Shapiro's logarithm. `logs` are ln(r/L) and ln(h/2).
///
/// Exact along Φ = 0 and, for a camera outside, to second order in the distance: the mean of 1 + 3/r over the way times the root of the
/// squares of the radial distance and of the chord, the latter by the mean of the lapse squared at both ends. Next to the horizon it is
/// exact at any distance that is small beside 1: there four times ((ε₁ − ε₂)² + (ε₁ + ε₂) φ²/2 + φ⁴/16)^½ with ε = r − 1 is light between
/// two falling observers in flat space.
#[inline]
pub fn delay_across(cam: &LensCamera, r: Real, c: Real, lapse2: Real, dr: Real, [k, _, q]: [Real; 3], logs: (Real, Real)) -> Real {
    let mean = 1.0 + 3.0 * if dr.abs() > SAME_RADIUS * cam.l { logs.0 / dr } else { cam.a };
    let both = lapse2 + cam.even * (cam.lapse2 - lapse2) + k * c * c * (cam.share - 1.5 * cam.share * cam.even);
    let across = (1.0 + 1.5 * (cam.a + c)) * both * r * cam.l * q;
    (mean * (mean * dr * dr + across)).sqrt() - 2.0 * logs.1
}

/// The factor of [`delay_across`] and the table's delay, which goes to zero with e at the horizon.
#[inline]
pub fn delay_factor(cam: &LensCamera, c: Real, k: Real, e: Real) -> Real {
    let near = c + LEAST_NEAR;
    let c4 = near * near * near * near;
    e / (e * e + 0.25 * k * k * c4 * c4 * cam.lift).sqrt()
}

/// The rest of the delay: what is singular at the horizon and what falls with the rain, from the photon's [`light_cones`].
#[inline]
pub fn delay_along(cam: &LensCamera, r: Real, c: Real, dr: Real, cones: [Real; 4]) -> Real {
    // The river's fall is 2 (√r − √L).
    2.0 * (ln(cones[1] * cones[2] * (r * cam.l)) - dr / (r * c.sqrt() + cam.l * cam.beta))
}
