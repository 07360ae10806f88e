// The lookup: from a point's place to the direction in which it is seen and the time its light takes.
//
// Glossary (r_s = c = 1, radians; docs/glossary.md)
//   a = 1/L, c = 1/r       inverse radii of camera and point         lapse2     1 − 1/r (or 1 − 1/L), free of cancellation
//   sweep, Φ               the angle the ray sweeps: φ, 2π − φ, 2π + φ
//   w, w_e                 du/dΦ at the camera and at the point      e        1/b: e² = w² + a² − a³ = w_e² + c² − c³
//   ψ                      the look direction in the rain frame from the outward radial
//   T                      Painlevé–Gullstrand time
//   beta                   √a, the river's speed                     bent     Φ as the closed forms see it
//
// The twin of src/lensing/closed_form/formulas.rs, inside.rs and lookup.rs, function for function. No bindings here: the shader that includes
// this file supplies
//   const SEES_INSIDE: bool, false in passes that never look from inside the horizon at what is inside: they compile in half the time
//   fn residuals(cam: LensCamera, x: f32, y: f32) -> vec3<f32>, of residuals.wgsl or a method's own
//   fn lens_texel(index: u32) -> vec4<f32>
// the slice as `lensing::Slice::texels` has it: four texels with the constants of the camera radius, then the coefficients (tangent of half
// the turn of w, delay, the same of w_e, unused), r fastest.

const BEND_START: f32 = 3.4;
const BEND_RANGE: f32 = 1.4;
/// The least 1 − 1/r that the logarithm of the horizon is taken of.
const LEAST_LAPSE2: f32 = 1e-7;
const SMALLEST_SWEEP: f32 = 1e-9;
const HALF_TURN: f32 = 3.14159265358979;
const LARGEST_SWEEP: f32 = 9.42477796076938;

/// Texels before the coefficients.
const HEADER: u32 = 4u;

struct LensCamera {
    l: f32,      // L
    lapse2: f32,   // 1 − 1/L
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
    lapse2: f32,
    dr: f32,
    phi: f32,
}

/// What the lookup returns: directions in the rain frame, momenta per angular momentum (in 1/r_s).
struct LensRay {
    cos_psi: f32,              // the look direction from the outward radial
    sin_psi: f32,
    delay: f32,                // T_arrival − T_emission, r_s/c
    frequency: f32,            // of the photon in the rain frame at the camera
    emission_radial: f32,      // of the photon's rain-frame momentum at the point: outward,
    emission_tangential: f32,  // against the sweep,
    emission_frequency: f32,   // and its frequency
    slope: f32,                // w
    emission_slope: f32,       // w_e
    energy: f32,               // e, negative where E < 0
    valid: bool,
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
    let both = lapse2 + cam.even * (cam.lapse2 - lapse2) + lens.x * c * c * (cam.share - 1.5 * cam.share * cam.even);
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
    let above = select(r - 1.0, cam.lapse2 * cam.l + offset, near);
    return SourcePoint(r, above * inverse, select(r - cam.l, offset, near), phi);
}

const SIXTH: f32 = 0.166666666666667;

fn spline_weights(t: f32) -> vec4<f32> {
    let s = 1.0 - t;
    let t2 = t * t;
    let s2 = s * s;
    return vec4<f32>(SIXTH * s2 * s, 4.0 * SIXTH + t2 * (0.5 * t - 1.0), 4.0 * SIXTH + s2 * (0.5 * s - 1.0), SIXTH * t2 * t);
}

fn finite(x: f32) -> bool {
    return abs(x) < 3e38;
}

fn lens_camera() -> LensCamera {
    let t0 = lens_texel(0u);
    let t1 = lens_texel(1u);
    let t2 = lens_texel(2u);
    let t3 = lens_texel(3u);
    return LensCamera(t0.x, t0.y, t0.z, t0.w, t1.x, t1.y, t1.z, t1.w, t2.x, t2.y, t2.z, u32(t3.x), u32(t3.y), t2.w, t3.z, t3.w);
}

fn joined(w: f32, w_e: f32, cam: LensCamera, c: f32, lapse2: f32) -> vec3<f32> {
    let here = cam.a * cam.a * cam.lapse2;
    let there = c * c * lapse2;
    if cam.lapse2 <= 0.0 {
        // Inside, e is a small difference of large terms at the camera, a sum at the point; the ray comes from above.
        let square = max(w_e * w_e + there, 0.0);
        return vec3<f32>(-sqrt(square - here), sqrt(square), w_e);
    }
    let square = max(w * w + here, 0.0);
    // Away from a turning point the energy gives the magnitude more precisely.
    let rest = square - there;
    let root = sqrt(max(rest, 0.0));
    return vec3<f32>(w, sqrt(square), select(w_e, select(root, -root, w_e < 0.0), rest > 0.3 * square));
}

const INSIDE_STEPS: u32 = 6u;
const INSIDE_CLOSE: f32 = 3e-7;
const INSIDE_ROOT: f32 = 0.12;
/// Nodes and weights of Gauss's rule of twelve, one half.
const INSIDE_NODES = array<vec2<f32>, 6>(
    vec2<f32>(0.12523341, 0.24914705), vec2<f32>(0.3678315, 0.23349254), vec2<f32>(0.58731794, 0.20316743),
    vec2<f32>(0.7699027, 0.16007833), vec2<f32>(0.90411726, 0.10693933), vec2<f32>(0.98156065, 0.047175337));

/// Integrals over a path inside the horizon: Φ, dΦ/dq, ∫ (t⁴ + 3 t²) 2 dt/W.
struct Path {
    sweep: f32,
    by_square: f32,
    lag: f32,
}

/// `nodes` is 12. It and `steps` below come from the camera and not from constants: compilers unroll loops of a known length, and twelve
/// nodes in six steps made a minute of compilation of each pass; a camera outside skips loops of length 0.
fn inside_path(q: f32, l: f32, r: f32, zl: f32, zr: f32, dr: f32, nodes: u32) -> Path {
    var d = 0.5;
    if q < INSIDE_ROOT {
        d = q;
        for (var i = 0u; i < nodes / 3u; i++) {
            let s = 1.0 + d;
            d -= (q * s * s * s - d) / (3.0 * q * s * s - 1.0);
        }
    }
    let s = 1.0 + d;
    let hl = zl + d;
    let hr = zr + d;
    let sine = dr / (sqrt(r * hl) + sqrt(l * hr));
    let cosine = (sqrt(r * l) + sqrt(hr * hl)) / s;
    let half = 0.5 * angle(sine, cosine, 1.0);
    let middle = angle(sqrt(l), sqrt(hl), sqrt(s)) + half;
    var rule = INSIDE_NODES;
    var path = Path(0.0, 0.0, 0.0);
    for (var k = 0u; k < nodes; k++) {
        let node = rule[k % 6u];
        let theta = middle + select(-half, half, k < 6u) * node.x;
        let turned = stumpff(theta * theta);
        let c = turned.y;
        let sn = theta * turned.x;
        let rho = s * sn * sn;
        let square = max(s * c * c - d + q * rho * rho * rho, 1e-12);
        let part = node.y * half * 2.0 * c * sqrt(s / square);
        path.sweep += part;
        path.by_square -= 0.5 * part * rho * rho * rho / square;
        path.lag += part * (rho + 3.0) * rho;
    }
    return path;
}

/// (w, e, w_e, delay) of the ray between two places inside; delay is 0 where there is none.
fn inside(cam: LensCamera, at: SourcePoint, sweep: f32, elapsed: f32) -> vec4<f32> {
    let l = cam.l;
    let r = at.r;
    let dr = at.dr;
    let zl = -cam.lapse2 * l;
    let zr = -at.lapse2 * r;
    if !(dr > 0.0 && zr > 0.0) {
        return vec4<f32>(0.0);
    }
    let tl = sqrt(l);
    let tr = sqrt(r);
    let dt = dr / (tl + tr);
    if sweep >= 2.0 * angle(dr / (tr * sqrt(zl) + tl * sqrt(zr)), tr * tl + sqrt(zr * zl), 1.0) {
        return vec4<f32>(0.0);
    }
    let m = 0.5 * (tl + tr);
    var q = max((4.0 * dt * dt / (sweep * sweep) - (1.0 - m * m)) / (m * m * m * m * m * m), 0.0);
    var path = Path(0.0, 0.0, 0.0);
    let steps = select(0u, INSIDE_STEPS, cam.lapse2 < 0.0);
    let nodes = select(0u, 12u, cam.lapse2 < 0.0);
    for (var i = 0u; i <= steps; i++) {
        path = inside_path(q, l, r, zl, zr, dr, nodes);
        let turn = path.sweep / sweep;
        if abs(turn - 1.0) < INSIDE_CLOSE {
            break;
        }
        if i < steps {
            q = max(q - 0.5 * (turn * turn - 1.0) * path.sweep / path.by_square, 0.0);
        }
    }
    let e = sqrt(q);
    let wl = sqrt(zl + q * l * l * l);
    let wr = sqrt(zr + q * r * r * r);
    let fall = e * dt * (l + tl * tr + r) + dr * (q * (r * r + r * l + l * l) - 1.0) / (wl + wr);
    let plus = 2.0 * (log1p(dt / (1.0 + tl)) - log1p(fall / (e * l * tl + wl)) - dt) + e * path.lag;
    let mean = log1p(2.0 * dt * (1.0 + tr) / (zr * (1.0 + tl))) - 2.0 * dt;
    let w = -wl / (l * tl);
    let w_e = -wr / (r * tr);
    if elapsed > mean {
        return vec4<f32>(w, -e, w_e, 2.0 * mean - plus);
    }
    return vec4<f32>(w, e, w_e, plus);
}

/// Light of no age, and of any: where there are two rays, E > 0 or E < 0.
const YOUNG: f32 = 0.0;
const OLD: f32 = 3e38;

/// The answer where there is none.
fn no_ray() -> LensRay {
    return LensRay(1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, false);
}

fn ray_of(cam: LensCamera, c: f32, lapse2: f32, w: f32, e: f32, w_e: f32, delay: f32) -> LensRay {
    let cones = light_cones(vec2<f32>(w, w_e), e, vec2<f32>(cam.a, c), vec2<f32>(cam.beta, sqrt(c)), vec2<f32>(cam.lapse2, lapse2));
    return ray_with(cam, c, vec4<f32>(w, e, w_e, delay), cones);
}

fn ray_with(cam: LensCamera, c: f32, ray: vec4<f32>, cones: vec4<f32>) -> LensRay {
    let twice = cones.x + cones.z;
    let left = cones.y + cones.w;
    if !finite(abs(twice) + abs(left) + abs(ray.x) + abs(ray.z) + abs(ray.w)) {
        return no_ray();
    }
    let inverse = 1.0 / twice;
    return LensRay((cones.z - cones.x) * inverse, 2.0 * cam.a * inverse, ray.w, 0.5 * twice, 0.5 * (cones.y - cones.w), c, 0.5 * left,
        ray.x, ray.z, ray.y, true);
}

fn lookup(cam: LensCamera, at: SourcePoint, sweep: f32, elapsed: f32) -> LensRay {
    if !(finite(at.r) && finite(at.dr) && finite(sweep) && at.r > 1e-3 && sweep >= 0.0) {
        return no_ray();
    }
    let swept = max(sweep, SMALLEST_SWEEP);
    let c = 1.0 / at.r;
    var lapse2 = at.lapse2;
    if lapse2 > 0.0 {
        lapse2 = max(lapse2, LEAST_LAPSE2);
        let bent = bent_sweep(swept);
        let square = half_angle(cam, bent);
        let halves = stumpffs(vec2<f32>(0.25 * bent * bent, square));
        let guesses = slopes(cam, -at.dr * c * cam.a, basis(cam, bent, square, halves.zw));
        let lens = lens_equation(cam, c, bent, halves.xy);
        let logs = log(vec3<f32>(c + cam.soft, near_axis(swept), 0.5 * lens.y));
        let xy = axes(cam, sqrt(lapse2), swept, logs);
        let across = delay_across(cam, at.r, c, lapse2, at.dr, lens, vec2<f32>(log1p(at.dr * cam.a), logs.z));
        let table = residuals(cam, xy.x, xy.y);
        let w = turned_slopes(guesses, vec2<f32>(cam.a, emission_scale(cam, c)), table.xz);
        let joint = joined(w.x, w.y, cam, c, lapse2);
        let cones = light_cones(joint.xz, joint.y, vec2<f32>(cam.a, c), vec2<f32>(cam.beta, sqrt(c)), vec2<f32>(cam.lapse2, lapse2));
        let delay = delay_along(cam, at.r, c, at.dr, cones) + delay_factor(cam, c, lens.x, joint.y) * (across + table.y);
        return ray_with(cam, c, vec4<f32>(joint, delay), cones);
    }
    if SEES_INSIDE && cam.lapse2 < 0.0 {
        let ray = inside(cam, at, swept, elapsed);
        if ray.w > 0.0 {
            return ray_of(cam, c, lapse2, ray.x, ray.y, ray.z, ray.w);
        }
    }
    return no_ray();
}

/// Φ of `order` for the point at `at`.
fn swept(at: SourcePoint, order: u32) -> f32 {
    // No branch: where the order is the same for a whole pass a driver would compile it anew for each.
    return select(at.phi, select(2.0 * HALF_TURN - at.phi, 2.0 * HALF_TURN + at.phi, order == 3u), order != 1u);
}

/// The ray of `order` from the point `along` outward and `across` from the axis, away from the camera; `height` = L + along; `elapsed` is
/// the time since the light left as far as it is known: where camera and point are both inside it decides between E > 0 and E < 0.
fn lens_lookup_aged(along: f32, across: f32, height: f32, order: u32, elapsed: f32) -> LensRay {
    // Far from the camera the place is known without it: it must be a number all the same.
    if !finite(along) {
        return no_ray();
    }
    let cam = lens_camera();
    let at = source_point(cam, along, across, height);
    return lookup(cam, at, swept(at, order), elapsed);
}

fn lens_lookup_at(along: f32, across: f32, height: f32, order: u32) -> LensRay {
    return lens_lookup_aged(along, across, height, order, YOUNG);
}

/// The same where only the offset is at hand.
fn lens_lookup(along: f32, across: f32, order: u32) -> LensRay {
    return lens_lookup_at(along, across, lens_texel(0u).x + along, order);
}
