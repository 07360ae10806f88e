#define_import_path lensrunner::lensing::inside

// Camera and point both inside the horizon. The twin of src/lensing/lookup/inside.rs, function for function.

#import lensrunner::lensing::closed_form::{angle, LensCamera, log1p, SourcePoint, stumpff}

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
/// nodes in six steps make a minute of compilation of each pass; a camera outside skips loops of length 0.
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
    let zl = -cam.lapse_squared * l;
    let zr = -at.lapse_squared * r;
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
    let steps = select(0u, INSIDE_STEPS, cam.lapse_squared < 0.0);
    let nodes = select(0u, 12u, cam.lapse_squared < 0.0);
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
