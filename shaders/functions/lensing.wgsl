// The lookup: from a point's place to the direction in which it is seen and the time its light takes.
//
// Glossary (r_s = c = 1, radians; DESIGN section 2)
//   a = 1/L, c = 1/r       inverse radii of camera and point         room     1 − 1/r (or 1 − 1/L), free of cancellation
//   sweep, Φ               the angle the ray sweeps: φ, 2π − φ, 2π + φ
//   w, w_e                 du/dΦ at the camera and at the point      e        1/b: e² = w² + a² − a³ = w_e² + c² − c³
//   ψ                      the look direction in the rain frame from the outward radial
//   T                      Painlevé–Gullstrand time
//   beta                   √a, the river's speed                     bent     Φ as the closed forms see it
//
// The twin of src/lensing/formulas.rs, inside.rs and lookup.rs, function for function. No bindings here: the shader that includes
// this file supplies
//   const SEES_INSIDE: bool, false in passes that never look from inside the horizon at what is inside: they compile in half the time
//   fn residuals(cam: LensCamera, x: f32, y: f32) -> vec3<f32>, of residuals.wgsl or a method's own
//   fn lens_texel(index: u32) -> vec4<f32>
// the slice as `lensing::Slice::texels` has it: four texels with the constants of the camera radius, then the coefficients (turn of w,
// delay, turn of w_e, unused), r fastest.

const BEND_START: f32 = 3.6;
const BEND_RANGE: f32 = 0.5;
const SMALLEST_SWEEP: f32 = 1e-9;
const HALF_TURN: f32 = 3.14159265358979;
const LARGEST_SWEEP: f32 = 9.42477796076938;

/// Texels before the coefficients.
const HEADER: u32 = 4u;

struct LensCamera {
    l: f32,      // L
    room: f32,   // 1 − 1/L
    a: f32,      // 1/L
    beta: f32,   // √a
    fade: f32,   // share of the weak-field terms
    bend: f32,   // n of K″ = 1 + nK
    rate: f32,   // √|n|
    force: f32,  // 3/2 a² − a
    soft: f32,   // softening, start and 1/length of the axis of points
    start: f32,
    scale: f32,
    nx: u32,     // nodes along r and Φ; two more coefficients than nodes each way
    ny: u32,
    share: f32,  // a/(1 + a)
    reach: f32,  // a/(1 + 4a)
    lift: f32,   // a⁴/(1 + a⁴)
}

struct Place {
    r: f32,
    room: f32,
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

/// Stumpff's functions (sin √x / √x, cos √x), hyperbolic for x < 0, for −1 ≤ x ≤ 4.4.
fn stumpff(x: f32) -> vec2<f32> {
    let x2 = x * x;
    let x4 = x2 * x2;
    let s = (-0.16666667004543 + x * 0.00833333768415) + x2 * (-0.00019840930941 + x * 2.75098584e-6);
    let c = (-0.49999999998826 + x * 0.0416666673983) + x2 * (-0.00138888919447 + x * 2.48009826069e-5);
    return vec2<f32>(1.0 + x * (s - x4 * 2.34998e-8), 1.0 + x * (c + x4 * (-2.75080533053e-7 + x * 1.95904e-9)));
}

const SWEEP_END: f32 = 5.23910259165662;

fn axes(cam: LensCamera, c: f32, room: f32, sweep: f32) -> vec2<f32> {
    let s2 = 7.84 * (cam.share + c);
    let off = sweep - HALF_TURN;
    let first = HALF_TURN + sqrt(HALF_TURN * HALF_TURN + s2);
    let last = 2.0 * HALF_TURN + sqrt(4.0 * HALF_TURN * HALF_TURN + s2);
    let root = sqrt(off * off + s2);
    let here = select(first * (root + off), first, off < 0.0) / select(s2, root - off, off < 0.0);
    let near = 10.0 * sweep + sqrt(1.0 + 100.0 * sweep * sweep);
    let logs = log(vec4<f32>(c + cam.soft, here, first * last / s2, near));
    return vec2<f32>(
        (logs.x - 2.0 * sqrt(max(room, 0.0)) - cam.start) * cam.scale,
        (sweep + 0.3 * logs.y + logs.w) / (LARGEST_SWEEP + SWEEP_END + 0.3 * logs.z));
}

fn bent_sweep(sweep: f32) -> f32 {
    if sweep <= BEND_START {
        return sweep;
    }
    let x = (sweep - BEND_START) / BEND_RANGE;
    let x2 = x * x;
    return BEND_START + (sweep - BEND_START) / sqrt(sqrt(1.0 + x2 * x2));
}

fn basis(cam: LensCamera, sweep: f32) -> vec2<f32> {
    let square = sweep * sweep;
    let x = -0.25 * cam.bend * square;
    if x < -1.0 {
        let up = exp(cam.rate * sweep);
        let down = 1.0 / up;
        return vec2<f32>(0.5 * (up - down) / cam.rate, (0.5 * (up + down) - 1.0) / (cam.rate * cam.rate));
    }
    // By the half angle.
    let half = stumpff(x);
    return vec2<f32>(sweep * half.x * half.y, 0.5 * square * half.x * half.x);
}

fn slope_guess(cam: LensCamera, rise: f32, bent: f32) -> vec2<f32> {
    let sk = basis(cam, bent);
    let s = sk.x;
    let k = sk.y;
    // What is right only in weak fields, held down where K grows.
    let m = cam.fade / (1.0 + cam.a * cam.a * k * k);
    let am = cam.a * m;
    let f = cam.force;
    let b = s * (1.0 + am * k);
    let c = rise - f * k - 0.5 * am * f * k * k;
    let q = m * k * k;
    let root = sqrt(max(b * b + 2.0 * q * c, 0.05 * b * b + 1e-4 * q));
    let w = select(root - b, 2.0 * c, b > 0.0) / select(q, b + root, b > 0.0);
    let turn = 1.0 + cam.bend * k;
    if cam.bend > 0.0 {
        // The same derivative with the growing terms that cancel taken out by the equation for w.
        let rest = (1.5 + 0.5 * cam.bend * k) * k * k * (am * f + m * w * w);
        return vec2<f32>(w, (turn * rise + f * k + rest) / s + w * am * s * s);
    }
    return vec2<f32>(w, w * (turn * (1.0 + am * k) + am * s * s) + f * s + am * f * k * s + m * k * s * w * w);
}

fn energy(w: f32, u: f32, room: f32) -> f32 {
    return sqrt(max(w * w + u * u * room, 0.0));
}

fn radial_momentum(w: f32, e: f32, u: f32, beta: f32, room: f32) -> f32 {
    let along = beta * e;
    let outward = max(w, -e) > 0.0;
    return select(u * u - e * e, w + along, outward) / select(along - w, room, outward);
}

fn turned_slope(guess: f32, u: f32, turn: f32) -> f32 {
    // tan(turn/2) = p/q by Padé's approximant.
    let x = 0.5 * turn;
    let y = x * x;
    let p = x * (945.0 - y * (105.0 - y));
    let q = 945.0 - y * (420.0 - 15.0 * y);
    // Cosine and sine of the turn, both times p² + q², which cancels.
    let ct = q * q - p * p;
    let st = 2.0 * p * q;
    let sine = max(u * ct - guess * st, 1e-6 * u);
    return u * (guess * ct + u * st) / sine;
}

fn emission_scale(cam: LensCamera, c: f32) -> f32 {
    return c + cam.reach;
}

fn delay_parts(cam: LensCamera, r: f32, room: f32, dr: f32, bent: f32, w: f32, e: f32, w_e: f32) -> vec3<f32> {
    let l = cam.l;
    let a = cam.a;
    let c = 1.0 / r;
    let root_c = sqrt(c);
    let half = stumpff(0.25 * bent * bent);
    let x = bent * half.x;
    let k = 0.5 * x * x;
    let y = 2.0 * half.y;
    let soft = 2.0 * (a + c) / (1.0 + a + c) * k * k;
    let large = 0.5 * (abs(y) + sqrt(y * y + soft));
    let small = 0.25 * soft / large;
    let h = select(small, large, y > 0.0);
    let excess = select(large, small, y > 0.0);
    let q = x * x - 0.25 * soft - excess * y;
    let fall = dr / (r * root_c + l * cam.beta);
    let lg = log1p(dr * a);
    let mean = 1.0 + 3.0 * select(a, lg / dr, abs(dr) > 1e-6 * l);
    let direct = dr + 3.0 * lg;
    let across = mean * (1.0 + 3.0 * c) * (room + k * c * c * cam.share) * r * l * q;
    let chord = sqrt(direct * direct + across);
    let out = select(c, w_e + e, w_e > 0.0);
    let out_over = select(e - w_e, room * c, w_e > 0.0);
    let back = select(e - w, a * cam.room, w > 0.0);
    let back_over = select(a, e + w, w > 0.0);
    let doppler = out * back * (1.0 + root_c) / (out_over * back_over * (1.0 + cam.beta));
    let c4 = c * c * c * c;
    let factor = e / sqrt(e * e + 0.5 * k * c4 * c4 * cam.lift);
    return vec3<f32>(2.0 * (log(doppler) - fall), chord - 2.0 * log(0.5 * h), factor);
}

fn angle(across: f32, height: f32, r: f32) -> f32 {
    let ahead = abs(height);
    let x = 2.0 * short_arctan(min(across, ahead) / (r + max(across, ahead)));
    let acute = select(x, 0.5 * HALF_TURN - x, across > ahead);
    return select(acute, HALF_TURN - acute, height < 0.0);
}

fn place(cam: LensCamera, along: f32, across: f32, height: f32) -> Place {
    let square = along * along + across * across;
    let r = sqrt(height * height + across * across);
    let inverse = 1.0 / r;
    let phi = angle(across, height, r);
    if square < 0.25 * cam.l * cam.l {
        let dr = (2.0 * cam.l * along + square) / (r + cam.l);
        return Place(r, cam.room + dr * inverse * cam.a, dr, phi);
    }
    return Place(r, (r - 1.0) * inverse, r - cam.l, phi);
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

fn joined(w: f32, w_e: f32, cam: LensCamera, c: f32, room: f32) -> vec3<f32> {
    if cam.room <= 0.0 {
        // Inside, e is a small difference of large terms at the camera, a sum at the point; the ray comes from above.
        let e = energy(w_e, c, room);
        return vec3<f32>(-sqrt(e * e - cam.a * cam.a * cam.room), e, w_e);
    }
    let e = energy(w, cam.a, cam.room);
    // Away from a turning point the energy gives the magnitude more precisely.
    let square = e * e - c * c * room;
    if square > 0.3 * e * e {
        return vec3<f32>(w, e, select(sqrt(square), -sqrt(square), w_e < 0.0));
    }
    return vec3<f32>(w, e, w_e);
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

/// `nodes` is 12. It and `steps` below come from the camera and not from constants: compilers unroll loops of a known length, and twelve nodes
/// in six steps made a minute of compilation of each pass; a camera outside skips loops of length 0.
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
fn inside(cam: LensCamera, at: Place, sweep: f32, elapsed: f32) -> vec4<f32> {
    let l = cam.l;
    let r = at.r;
    let dr = at.dr;
    let zl = -cam.room * l;
    let zr = -at.room * r;
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
    let steps = select(0u, INSIDE_STEPS, cam.room < 0.0);
    let nodes = select(0u, 12u, cam.room < 0.0);
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

fn ray_of(cam: LensCamera, c: f32, room: f32, w: f32, e: f32, w_e: f32, delay: f32) -> LensRay {
    let radial = radial_momentum(w, e, cam.a, cam.beta, cam.room);
    let frequency = e + cam.beta * radial;
    let root_c = sqrt(c);
    let leaving = radial_momentum(w_e, e, c, root_c, room);
    let emission_frequency = e + root_c * leaving;
    if !finite(abs(frequency) + abs(emission_frequency) + abs(w) + abs(w_e) + abs(delay)) {
        return no_ray();
    }
    let inverse = 1.0 / frequency;
    return LensRay(-radial * inverse, cam.a * inverse, delay, frequency, leaving, c, emission_frequency, w, w_e, e, true);
}

fn lookup(cam: LensCamera, at: Place, sweep: f32, elapsed: f32) -> LensRay {
    if !(finite(at.r) && finite(at.dr) && finite(sweep) && at.r > 1e-3 && sweep >= 0.0) {
        return no_ray();
    }
    let swept = max(sweep, SMALLEST_SWEEP);
    let c = 1.0 / at.r;
    var w = 0.0;
    var e = 0.0;
    var w_e = 0.0;
    var delay = 0.0;
    var room = at.room;
    if room > 0.0 {
        room = max(room, 1e-4);
        let bent = bent_sweep(swept);
        let guess = slope_guess(cam, -at.dr * c * cam.a, bent);
        let xy = axes(cam, c, room, swept);
        let table = residuals(cam, xy.x, xy.y);
        let ray = joined(turned_slope(guess.x, cam.a, table.x), turned_slope(guess.y, emission_scale(cam, c), table.z), cam, c, room);
        w = ray.x;
        e = ray.y;
        w_e = ray.z;
        let parts = delay_parts(cam, at.r, room, at.dr, bent, w, e, w_e);
        delay = parts.x + parts.z * (parts.y + table.y);
    } else if SEES_INSIDE && cam.room < 0.0 {
        let ray = inside(cam, at, swept, elapsed);
        w = ray.x;
        e = ray.y;
        w_e = ray.z;
        delay = ray.w;
        if !(delay > 0.0) {
            return no_ray();
        }
    } else {
        return no_ray();
    }
    return ray_of(cam, c, room, w, e, w_e, delay);
}

/// Φ of `order` for the point at `at`.
fn swept(at: Place, order: u32) -> f32 {
    if order == 2u {
        return 2.0 * HALF_TURN - at.phi;
    }
    return select(at.phi, 2.0 * HALF_TURN + at.phi, order == 3u);
}

/// The ray of `order` from the point `along` outward and `across` from the axis, away from the camera; `height` = L + along; `elapsed` is the
/// time since the light left as far as it is known: where camera and point are both inside it decides between E > 0 and E < 0.
fn lens_lookup_aged(along: f32, across: f32, height: f32, order: u32, elapsed: f32) -> LensRay {
    let cam = lens_camera();
    let at = place(cam, along, across, height);
    return lookup(cam, at, swept(at, order), elapsed);
}

fn lens_lookup_at(along: f32, across: f32, height: f32, order: u32) -> LensRay {
    return lens_lookup_aged(along, across, height, order, YOUNG);
}

/// The same where only the offset is at hand.
fn lens_lookup(along: f32, across: f32, order: u32) -> LensRay {
    return lens_lookup_at(along, across, lens_texel(0u).x + along, order);
}
