#define_import_path lensrunner::lensing::closed_form

// What is right near the camera in closed form: the slopes of a ray at both its ends, and its travel time.
//
// Glossary (r_s = c = 1, radians; docs/glossary.md)
//   a = 1/L, c = 1/r       inverse radii of camera and point         lapse2     1 − 1/r (or 1 − 1/L), free of cancellation,
//                                                                             lapse_squared in structs
//   sweep, Φ               the angle the ray sweeps: φ, 2π − φ, 2π + φ
//   w, w_e                 du/dΦ at the camera and at the point      e        1/b: e² = w² + a² − a³ = w_e² + c² − c³
//   ψ                      the look direction in the rain frame from the outward radial
//   T                      Painlevé–Gullstrand time
//   beta                   √a, the river's speed                     bent     Φ as the closed forms see it
//
// The twin of src/lensing/closed_form/formulas.rs, function for function.

const BEND_START: f32 = 3.4;
const BEND_RANGE: f32 = 1.4;
const SMALLEST_SWEEP: f32 = 1e-9;
const HALF_TURN: f32 = 3.14159265358979;
const LARGEST_SWEEP: f32 = 9.42477796076938;

struct LensCamera {
    l: f32,      // L
    lapse_squared: f32, // 1 − 1/L
    a: f32,      // 1/L
    beta: f32,   // √a
    fade: f32,   // share of the weak-field terms
    bend: f32,   // n of K″ = 1 + nK
    rate: f32,   // √|n|
    even: f32,   // how much the lapse squared at the camera counts beside that at the point
    soft: f32,   // softening, start and 1/length of the axis of points
    start: f32,
    scale: f32,
    nx: u32,     // nodes along r and Φ; two more coefficients than nodes each way
    ny: u32,
    share: f32,  // a/(1 + a)
    reach: f32,  // a/(1 + 4a)
    lift: f32,   // a⁴/(1 + a⁴), at least 1e-4
}

struct SourcePoint {
    r: f32,
    lapse_squared: f32,
    dr: f32,
    phi: f32,
}

fn log1p(x: f32) -> f32 {
    let z = x / (2.0 + x);
    if abs(z) < 0.1 {
        let y = z * z;
        return 2.0 * z * (1.0 + y * (1.0 / 3.0 + y * (0.2 + y * (1.0 / 7.0 + y * (1.0 / 9.0)))));
    }
    return log(1.0 + x);
}

/// arctan t for |t| ≤ tan(π/8). Drivers' own differ by far more than the last place, and with them the direction near the fold of an image.
fn short_arctan(t: f32) -> f32 {
    let y = t * t;
    let y2 = y * y;
    let p = -0.33333315497 + y * 0.19998488890;
    return t + t * y * (p + y2 * ((-0.14243837705 + y * 0.10595915130) - y2 * 0.06083223004));
}

/// Stumpff's functions (sin √x / √x, cos √x), hyperbolic for x < 0, of both, for −1 ≤ x ≤ 4.5.
fn stumpffs(pair: vec2<f32>) -> vec4<f32> {
    let x = pair.xxyy;
    let square = x * x;
    let low = 1.0 + x * vec2<f32>(-0.16666667004543, -0.49999999998826).xyxy;
    let middle = vec2<f32>(0.00833333768415, 0.0416666673983).xyxy + x * vec2<f32>(-0.00019840930941, -0.00138888919447).xyxy;
    let high = vec2<f32>(2.75098584e-6, 2.48009826069e-5).xyxy + x * vec2<f32>(-2.34998e-8, -2.75080533053e-7).xyxy;
    let last = square * vec2<f32>(0.0, 1.95904e-9).xyxy;
    return low + square * (middle + square * (high + last));
}

/// Those of one.
fn stumpff(x: f32) -> vec2<f32> {
    return stumpffs(vec2<f32>(x, x)).xy;
}

/// Sine and cosine of an angle up to 4.2 rad, by those of half of it. Drivers' own may be off by 2⁻¹¹, half a pixel.
fn sine_cosine(x: f32) -> vec2<f32> {
    let half = stumpff(0.25 * x * x);
    let s = 0.5 * x * half.x;
    return vec2<f32>(2.0 * s * half.y, 1.0 - 2.0 * s * s);
}

const SWEEP_LENGTH: f32 = 17.0;

fn bent_sweep(sweep: f32) -> f32 {
    if sweep <= BEND_START {
        return sweep;
    }
    let off = sweep - BEND_START;
    let x = off * (1.0 / BEND_RANGE);
    let x4 = x * x * (x * x);
    return BEND_START + off / (1.0 + x4);
}

/// (K, h, q) for Stumpff's functions of Φ²/4: 1 − cos Φ; twice cos(Φ/2), kept positive beyond π by the width of the Einstein ring; the
/// square of the chord between two unit vectors less what the lens takes.
fn lens_equation(cam: LensCamera, c: f32, bent: f32, half: vec2<f32>) -> vec3<f32> {
    let x = bent * half.x;
    let square = x * x;
    let k = 0.5 * square;
    let y = 2.0 * half.y;
    let quarter = 0.5 * (cam.share + c) * k * k;
    let large = 0.5 * abs(y) + sqrt(0.25 * y * y + quarter);
    if y > 0.0 {
        return vec3<f32>(k, large, square - quarter - quarter / large * y);
    }
    return vec3<f32>(k, quarter / large, square - quarter - large * y);
}

/// e to the arsinh(10 Φ).
fn near_axis(sweep: f32) -> f32 {
    return 10.0 * sweep + sqrt(1.0 + 100.0 * sweep * sweep);
}

/// The table's first two coordinates, from the logarithms of c + `soft`, of `near_axis` and of h/2.
fn axes(cam: LensCamera, lapse: f32, sweep: f32, logs: vec3<f32>) -> vec2<f32> {
    return vec2<f32>((logs.x - 2.0 * lapse - cam.start) * cam.scale, (sweep + logs.y - 0.3 * logs.z) * (1.0 / SWEEP_LENGTH));
}

fn half_angle(cam: LensCamera, sweep: f32) -> f32 {
    return -0.25 * cam.bend * sweep * sweep;
}

fn basis(cam: LensCamera, sweep: f32, x: f32, half: vec2<f32>) -> vec2<f32> {
    if x < -1.0 {
        let up = exp(cam.rate * sweep);
        let down = 1.0 / up;
        return vec2<f32>(0.5 * (up - down) / cam.rate, (0.5 * (up + down) - 1.0) / (cam.rate * cam.rate));
    }
    return vec2<f32>(sweep * half.x * half.y, 0.5 * sweep * sweep * half.x * half.x);
}

fn slope_guess(cam: LensCamera, rise: f32, bent: f32) -> vec2<f32> {
    let x = half_angle(cam, bent);
    return slopes(cam, rise, basis(cam, bent, x, stumpff(x)));
}

fn slopes(cam: LensCamera, rise: f32, sk: vec2<f32>) -> vec2<f32> {
    let s = sk.x;
    let k = sk.y;
    // What is right only in weak fields, held down where K grows.
    let m = cam.fade / (1.0 + cam.a * cam.a * k * k);
    let am = cam.a * m;
    // u″ at the camera.
    let f = cam.a * (1.5 * cam.a - 1.0);
    let b = s * (1.0 + am * k);
    let c = rise - f * k - 0.5 * am * f * k * k;
    let q = m * k * k;
    let root = sqrt(max(b * b + 2.0 * q * c, 0.05 * b * b + 1e-4 * q));
    let w = select(root - b, 2.0 * c, b > 0.0) / select(q, b + root, b > 0.0);
    let turn = 1.0 + cam.bend * k;
    if cam.bend > 0.0 {
        // The same derivative with the growing terms that cancel taken out by the equation for w.
        let rest = (1.5 + 0.5 * cam.bend * k) * k * k * (am * f + m * w * w);
        return vec2<f32>(w, (turn * rise + f * k + rest) * (1.0 / s) + w * am * s * s);
    }
    return vec2<f32>(w, w * (turn * (1.0 + am * k) + am * s * s) + s * (f + am * f * k + m * k * w * w));
}

fn energy(w: f32, u: f32, lapse2: f32) -> f32 {
    return sqrt(max(w * w + u * u * lapse2, 0.0));
}

/// Frequency plus outward momentum at the camera and at the point, then frequency less it.
fn light_cones(w: vec2<f32>, e: f32, u: vec2<f32>, beta: vec2<f32>, lapse2: vec2<f32>) -> vec4<f32> {
    let rising = max(w, vec2<f32>(-e)) > vec2<f32>(0.0);
    let square = u * u;
    let over = select(square, e + w, rising) * (beta + 1.0);
    let under = select(e - w, lapse2, rising);
    return vec4<f32>(over, square * under) / vec4<f32>(under, over);
}

/// The slopes whose angles are those of the guesses turned by twice the angles whose tangents are `turns`.
fn turned_slopes(guess: vec2<f32>, u: vec2<f32>, turn: vec2<f32>) -> vec2<f32> {
    // Cosine and sine of the turn, both times 1 + turn², which cancels.
    let ct = 1.0 - turn * turn;
    let st = turn + turn;
    let sine = max(u * ct - guess * st, u * 1e-6);
    return u * (guess * ct + u * st) / sine;
}

fn emission_scale(cam: LensCamera, c: f32) -> f32 {
    return c + cam.reach;
}

/// The part of the delay that is regular across the Einstein ring. `logs` are ln(r/L) and ln(h/2).
fn delay_across(cam: LensCamera, r: f32, c: f32, lapse2: f32, dr: f32, lens: vec3<f32>, logs: vec2<f32>) -> f32 {
    let mean = 1.0 + 3.0 * select(cam.a, logs.x / dr, abs(dr) > 1e-6 * cam.l);
    let both = lapse2 + cam.even * (cam.lapse_squared - lapse2) + lens.x * c * c * (cam.share - 1.5 * cam.share * cam.even);
    let across = (1.0 + 1.5 * (cam.a + c)) * both * r * cam.l * lens.z;
    return sqrt(mean * (mean * dr * dr + across)) - 2.0 * logs.y;
}

fn delay_factor(cam: LensCamera, c: f32, k: f32, e: f32) -> f32 {
    let near = c + 0.01;
    let c4 = near * near * near * near;
    return e / sqrt(e * e + 0.25 * k * k * c4 * c4 * cam.lift);
}

/// The rest of the delay: what is singular at the horizon and what falls with the rain.
fn delay_along(cam: LensCamera, r: f32, c: f32, dr: f32, cones: vec4<f32>) -> f32 {
    return 2.0 * (log(cones.y * cones.z * (r * cam.l)) - dr / (r * sqrt(c) + cam.l * cam.beta));
}

fn angle(across: f32, height: f32, r: f32) -> f32 {
    let ahead = abs(height);
    let steep = across > ahead;
    let behind = height < 0.0;
    let x = short_arctan(min(across, ahead) / (r + max(across, ahead)));
    return select(select(0.0, HALF_TURN, behind), 0.5 * HALF_TURN, steep) + select(-2.0, 2.0, steep == behind) * x;
}

fn source_point(cam: LensCamera, along: f32, across: f32, height: f32) -> SourcePoint {
    let square = along * along + across * across;
    let r = sqrt(height * height + across * across);
    let inverse = 1.0 / r;
    let phi = angle(across, height, r);
    let near = square < 0.25 * cam.l * cam.l;
    let offset = (2.0 * cam.l * along + square) / (r + cam.l);
    // r − 1 and r − L: near the camera from the offset, elsewhere from the place.
    let above = select(r - 1.0, cam.lapse_squared * cam.l + offset, near);
    return SourcePoint(r, above * inverse, select(r - cam.l, offset, near), phi);
}

fn finite(x: f32) -> bool {
    return abs(x) < 3e38;
}
